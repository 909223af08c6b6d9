/* test_opacity.c - opacity correction: 128 and 512 slices of one volume give the same picture, within a bound; without
 * the correction they would not. With 16 bits less than two and a half levels are left; with 8 the opacities of thin
 * slices are rounded to a few levels, which is the more the fainter the function. Prints a table. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lib/unit.h"
#include "transfer.h"

enum { EDGE_VOX = 128, SIZE_PX = 96, FEW = 128, MANY = 512 };

/* Shells and balls with soft edges, 0 to 255: voxel by voxel neighbours differ by little. */
static uint8_t *make_voxels(void)
{
    uint8_t *voxels = malloc(EDGE_VOX * EDGE_VOX * EDGE_VOX), *next = voxels;
    assert_non_null(voxels);
    for (int z = 0; z < EDGE_VOX; z++)
        for (int y = 0; y < EDGE_VOX; y++)
            for (int x = 0; x < EDGE_VOX; x++) {
                double dx = 2.0 * x / EDGE_VOX - 1, dy = 2.0 * y / EDGE_VOX - 1, dz = 2.0 * z / EDGE_VOX - 1;
                double radius = sqrt(dx * dx + 1.4 * dy * dy + dz * dz);
                double shell = exp(-pow((radius - 0.7) / 0.08, 2));
                double balls = exp(-12 * (pow(dx - 0.2, 2) + pow(dy, 2) + pow(dz + 0.1, 2)));
                *next++ = (uint8_t)lround(255 * fmin(1, 0.8 * shell + balls));
            }
    return voxels;
}

typedef struct bound {
    double rmse, most; /* 8-bit levels */
} bound;

/* A transfer function, and how near the pictures must be. */
typedef struct subject {
    const char *function;
    bound bounds[2]; /* of machines[] */
} subject;

static const char *const machines[2] = {"traversal=whole fb_bits=16 tf_bits=16 density_bits=12", "traversal=whole"};
static const subject subjects[] = {
    {"ramp", {{0.5, 2.5}, {19, 50}}},
    {"bone", {{0.5, 2.5}, {6, 28}}},
    {"vessels", {{0.5, 2.5}, {6, 28}}},
    {"mri", {{0.5, 2.5}, {6, 28}}},
};

typedef struct pose {
    double azimuth_deg, elevation_deg;
    bool perspective;
} pose;

static const pose poses[] = {{0, 0, false}, {33, 21, false}, {33, 21, true}};

static vodr_frame draw(const uint8_t *voxels, const char *function, const pose *at, const char *machine, int32_t slices,
                       bool corrected)
{
    volume geometry = unit_volume(EDGE_VOX, EDGE_VOX, EDGE_VOX);
    camera c = {.azimuth_deg = at->azimuth_deg,
                .elevation_deg = at->elevation_deg,
                .perspective = at->perspective,
                .fov_deg = 40,
                .zoom = 0.6,
                .width_px = SIZE_PX,
                .height_px = SIZE_PX,
                .slices = slices};
    vodr_view view;
    vodr_frame frame;
    vodr_counters counters;
    vodr_error fault;
    host_error error;
    double depth_vox;
    transfer t;
    if (camera_view(&c, &geometry, &view, &depth_vox, &error) != HOST_OK ||
        transfer_open(function, false, &t, &error) != HOST_OK)
        fail_msg("%s", error.text);
    vodr_machine m = unit_machine(machine);
    vodr_rgba *entries = malloc(sizeof *entries << m.density_bits);
    uint16_t map[256];
    assert_non_null(entries);
    for (int i = 0; i < 256; i++)
        map[i] = (uint16_t)(m.density_bits == 8 ? i : lround(i * 4095.0 / 255));
    transfer_table(&t, 0, 255, m.density_bits, m.tf_bits, corrected ? depth_vox : 1, false, entries);
    vodr_volume v = {.dims_vox = {EDGE_VOX, EDGE_VOX, EDGE_VOX}, .voxel_bytes = 1, .voxels = voxels, .map = map};
    vodr_table table = {entries, (size_t)1 << m.density_bits};
    if (vodr_render(&m, &v, &table, &view, NULL, &frame, &counters, &fault) != VODR_OK)
        fail_msg("%s", fault.text);
    free(entries);
    transfer_close(&t);
    return frame;
}

static double level(const vodr_frame *f, size_t i)
{
    return f->bits == 16 ? ((const uint16_t *)f->pixels)[i] / 257.0 : ((const uint8_t *)f->pixels)[i];
}

/* Over the channels of the pixels that either covers: root mean square and largest difference. */
static void compare(const vodr_frame *a, const vodr_frame *b, double *rmse, double *most)
{
    double sum = 0;
    size_t covered = 0;
    *most = 0;
    for (size_t i = 0; i < SIZE_PX * SIZE_PX; i++) {
        if (level(a, 4 * i + 3) == 0 && level(b, 4 * i + 3) == 0)
            continue;
        covered++;
        for (size_t c = 0; c < 4; c++) {
            double d = fabs(level(a, 4 * i + c) - level(b, 4 * i + c));
            sum += d * d;
            *most = fmax(*most, d);
        }
    }
    assert_true(covered > SIZE_PX * SIZE_PX / 4);
    *rmse = sqrt(sum / (4 * (double)covered));
}

static void measure(const uint8_t *voxels, const char *function, const pose *at, const char *machine, bool corrected,
                    double *rmse, double *most)
{
    vodr_frame few = draw(voxels, function, at, machine, FEW, corrected),
               many = draw(voxels, function, at, machine, MANY, corrected);
    compare(&few, &many, rmse, most);
    vodr_frame_free(&few);
    vodr_frame_free(&many);
}

/* Measures one pose, prints its line, and returns whether the pictures are near enough. */
static bool look(const uint8_t *voxels, const subject *s, const pose *at, int machine)
{
    double rmse, most, without, largest;
    measure(voxels, s->function, at, machines[machine], true, &rmse, &most);
    measure(voxels, s->function, at, machines[machine], false, &without, &largest);
    bool good = rmse <= s->bounds[machine].rmse && most <= s->bounds[machine].most && without > 3 * rmse;
    print_message("%-8s %2.0f,%-2.0f  %-11s %-7s %7.3f %8.2f %17.1f%s\n", s->function, at->azimuth_deg,
                  at->elevation_deg, at->perspective ? "perspective" : "parallel", machine ? "8 bit" : "16 bit", rmse,
                  most, without, good ? "" : "  too far");
    return good;
}

static void few_and_many_slices(void **state)
{
    (void)state;
    uint8_t *voxels = make_voxels();
    bool good = true;
    print_message("%d against %d slices: difference in 8-bit levels, and what it would be without the correction\n"
                  "function  view  projection  numbers    rmse  largest  uncorrected rmse\n",
                  FEW, MANY);
    for (size_t s = 0; s < sizeof subjects / sizeof *subjects; s++)
        for (size_t p = 0; p < sizeof poses / sizeof *poses; p++)
            for (int machine = 0; machine < 2; machine++)
                good = look(voxels, &subjects[s], &poses[p], machine) && good;
    free(voxels);
    assert_true(good);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(few_and_many_slices)};
    return cmocka_run_group_tests_name("opacity", tests, NULL, NULL);
}
