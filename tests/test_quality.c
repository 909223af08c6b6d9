/* test_quality.c - how near the machine's pictures come to a render of the same slices in double precision: at least 40
 * dB with 8 bits all through, 55 dB with 16-bit table and frame buffer and 12-bit densities. Prints a table. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lib/ideal.h"
#include "lib/phantom.h"
#include "lib/unit.h"

typedef struct pose {
    double azimuth_deg, elevation_deg;
    bool perspective;
} pose;

static const pose poses[] = {{0, 0, false}, {30, 30, false}, {0, 0, true}, {30, 30, true}};

/* The voxels' values, neither quantised nor clamped to the window. */
static float *values_of(const volume *v)
{
    size_t count = volume_count(v);
    float *values = malloc(count * sizeof *values);
    assert_non_null(values);
    for (size_t i = 0; i < count; i++)
        values[i] = (float)volume_value(v, i);
    return values;
}

/* A volume and a transfer function to look at it with. */
typedef struct subject {
    const char *name, *transfer;
    int32_t size_px; /* and slices; 0: the volume's own */
    double zoom;
    double floor_8, floor_16; /* decibels asked for */
    host_status (*open)(const char *name, volume *v, host_error *error);
} subject;

static host_status open_phantom(const char *name, volume *v, host_error *error)
{
    return phantom_open(name, v) ? HOST_OK : host_fail(error, HOST_ENVIRONMENT, "no memory");
}

static void directory_of_volumes(char *path, size_t size, const char *name)
{
    const char *directory = getenv("VODR_VOLUMES");
    snprintf(path, size, "%s/%s.nrrd", directory ? directory : "../shared/volumes", name);
}

static host_status open_file(const char *name, volume *v, host_error *error)
{
    char path[4096];
    directory_of_volumes(path, sizeof path, name);
    return volume_open(path, &(volume_options){0}, v, error);
}

/* Everything about a subject that does not depend on the pose. */
typedef struct prepared {
    volume geometry;
    transfer transfer;
    double lo, hi;
    float *values;
    vodr_volume densities[2]; /* 8 and 12 bits */
    volume owners[2];
} prepared;

static void check(host_status status, const host_error *error)
{
    if (status != HOST_OK)
        fail_msg("%s", error->text);
}

static void prepare(const subject *s, prepared *p)
{
    host_error error;
    for (int wide = 0; wide < 2; wide++)
        check(s->open(s->name, &p->owners[wide], &error), &error);
    p->geometry = p->owners[0];
    bool ct = volume_is_ct(&p->geometry);
    check(transfer_open(s->transfer, ct, &p->transfer, &error), &error);
    p->lo = ct && p->transfer.has_ct_window ? p->transfer.ct_lo : p->geometry.min;
    p->hi = ct && p->transfer.has_ct_window ? p->transfer.ct_hi : p->geometry.max;
    p->values = values_of(&p->geometry);
    for (int wide = 0; wide < 2; wide++)
        check(volume_quantise(&p->owners[wide], p->lo, p->hi, wide ? 12 : 8, &p->densities[wide], &error), &error);
}

static void release(prepared *p)
{
    free(p->values);
    transfer_close(&p->transfer);
    for (int wide = 0; wide < 2; wide++)
        volume_close(&p->owners[wide]);
}

static ideal_error measure(const prepared *p, const vodr_view *view, double depth_vox, bool wide, const double *ideal)
{
    static const char *const machines[] = {"traversal=whole", "traversal=whole fb_bits=16 tf_bits=16 density_bits=12"};
    vodr_machine m = unit_machine(machines[wide]);
    vodr_rgba *entries = malloc(sizeof *entries << m.density_bits);
    assert_non_null(entries);
    transfer_table(&p->transfer, p->lo, p->hi, m.density_bits, m.tf_bits, depth_vox, false, entries);
    vodr_table table = {entries, (size_t)1 << m.density_bits};
    vodr_frame frame;
    vodr_counters counters;
    vodr_error error;
    if (vodr_render(&m, &p->densities[wide], &table, view, NULL, &frame, &counters, &error) != VODR_OK)
        fail_msg("%s", error.text);
    ideal_error e = ideal_compare(&frame, ideal);
    vodr_frame_free(&frame);
    free(entries);
    return e;
}

/* Draws one pose, prints its line, and returns whether both pictures are near enough. */
static bool look(const subject *s, const prepared *p, const pose *at)
{
    camera c = {.azimuth_deg = at->azimuth_deg,
                .elevation_deg = at->elevation_deg,
                .perspective = at->perspective,
                .fov_deg = 40,
                .zoom = s->zoom,
                .width_px = s->size_px,
                .height_px = s->size_px,
                .slices = s->size_px};
    vodr_view view;
    double depth_vox;
    host_error error;
    check(camera_view(&c, &p->geometry, &view, &depth_vox, &error), &error);
    ideal_scene scene = {.dims_vox = {view.width_px},
                         .values = p->values,
                         .view = &view,
                         .transfer = &p->transfer,
                         .window_lo = p->lo,
                         .window_hi = p->hi,
                         .depth_vox = depth_vox};
    memcpy(scene.dims_vox, p->geometry.dims_vox, sizeof scene.dims_vox);
    double *ideal = malloc((size_t)view.width_px * (size_t)view.height_px * 4 * sizeof *ideal);
    assert_non_null(ideal);
    ideal_render(&scene, ideal);
    ideal_error narrow = measure(p, &view, depth_vox, false, ideal), wide = measure(p, &view, depth_vox, true, ideal);
    free(ideal);
    bool good = narrow.psnr >= s->floor_8 && wide.psnr >= s->floor_16;
    print_message("%-10s %-10s %2.0f,%-2.0f %-11s %7llu %9.1f %9.1f%s\n", s->name, s->transfer, at->azimuth_deg,
                  at->elevation_deg, at->perspective ? "perspective" : "parallel",
                  (unsigned long long)narrow.covered_px, narrow.psnr, wide.psnr, good ? "" : "  too far");
    return good;
}

static void look_at_all(const subject *subjects, size_t count)
{
    bool good = true;
    print_message("volume     transfer   view  projection  pixels  8 bit, dB 16 bit, dB\n");
    for (size_t i = 0; i < count; i++) {
        prepared p;
        prepare(&subjects[i], &p);
        for (size_t n = 0; n < sizeof poses / sizeof *poses; n++)
            good = look(&subjects[i], &p, &poses[n]) && good;
        release(&p);
    }
    assert_true(good);
}

static void phantoms(void **state)
{
    (void)state;
    static const subject subjects[] = {
        {"head", "bone", 0, 1, 40, 55, open_phantom},       {"head", "skin-bone", 0, 1, 40, 55, open_phantom},
        {"head", "vessels", 0, 1, 40, 55, open_phantom},    {"head", "ramp", 0, 1, 25, 30, open_phantom},
        {"vessels", "bone", 0, 1, 40, 55, open_phantom},    {"vessels", "skin-bone", 0, 1, 40, 55, open_phantom},
        {"vessels", "vessels", 0, 1, 40, 55, open_phantom}, {"vessels", "ramp", 0, 1, 25, 30, open_phantom},
    };
    look_at_all(subjects, sizeof subjects / sizeof *subjects);
}

static void real_volumes(void **state)
{
    (void)state;
    static const subject subjects[] = {
        {"cranium", "bone", 120, 0.5, 40, 55, open_file},     {"cranium", "skin-bone", 120, 0.5, 40, 55, open_file},
        {"cranium", "vessels", 120, 0.5, 40, 55, open_file},  {"cranium", "ramp", 120, 0.5, 25, 30, open_file},
        {"aneurism", "vessels", 120, 0.5, 40, 55, open_file}, {"engine", "bone", 120, 0.5, 40, 55, open_file},
    };
    char path[4096];
    directory_of_volumes(path, sizeof path, "cranium");
    FILE *file = fopen(path, "rb");
    if (!file)
        skip();
    fclose(file);
    look_at_all(subjects, sizeof subjects / sizeof *subjects);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(phantoms),
        cmocka_unit_test(real_volumes),
    };
    return cmocka_run_group_tests_name("quality", tests, NULL, NULL);
}
