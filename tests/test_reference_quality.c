/* test_reference_quality.c - how exact the reference renderer is in floating point: `double` against a render of the
 * same slices written another way, `float` against `double`, rays against slices where both are fine, and the machine
 * with 16-bit table and frame buffer and 12-bit densities against `float`: at least 55 dB; with its cubic filters
 * against `double` with the same: at least 65 dB. Prints a table. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "lib/ideal.h"
#include "lib/phantom.h"
#include "lib/staged.h"
#include "lib/unit.h"
#include "reference_scene.h"

static const char wide[] = "traversal=whole fb_bits=16 tf_bits=16 density_bits=12";

static void stage(scene *s, const char *phantom, const char *transfer_name, const char *machine, const camera *eye)
{
    volume v;
    assert_true(phantom_open(phantom, &v));
    staged_open(s, &v, transfer_name, machine, eye);
}

/* Draws a scene, whose voxels are converted. */
static double *march(scene *s, const reference_choice *choice)
{
    reference_scene r;
    reference_stats stats;
    host_error error;
    vodr_error reason;
    double *rgba = malloc(4 * (size_t)s->view.width_px * (size_t)s->view.height_px * sizeof *rgba);
    assert_non_null(rgba);
    if (reference_scene_open(s, choice, 2, VODR_SIMD_BEST, &r, &error) != HOST_OK)
        fail_msg("%s", error.text);
    if (reference_march(r.renderer, &r.job, rgba, &stats, &reason) != REFERENCE_OK)
        fail_msg("%s", reason.text);
    reference_scene_close(&r);
    return rgba;
}

static double *march_phantom(const char *phantom, const char *transfer_name, const char *machine, const camera *eye,
                             const reference_choice *choice, size_t *channels)
{
    scene s;
    stage(&s, phantom, transfer_name, machine, eye);
    double *rgba = march(&s, choice);
    *channels = 4 * (size_t)s.view.width_px * (size_t)s.view.height_px;
    scene_close(&s);
    return rgba;
}

static reference_choice slices_in(reference_numbers numbers)
{
    return (reference_choice){.numbers = numbers, .accel = REFERENCE_ACCEL_BEST, .block_vox = 8, .termination = 1};
}

/* The machine's frame against a picture. */
static double machine_psnr(const char *phantom, const char *transfer_name, const char *machine, const camera *eye,
                           const double *rgba)
{
    scene s;
    host_error error;
    vodr_error reason;
    vodr_frame frame;
    vodr_counters counters;
    stage(&s, phantom, transfer_name, machine, eye);
    if (scene_quantise(&s, &error) != HOST_OK)
        fail_msg("%s", error.text);
    if (vodr_render(&s.machine, &s.densities, &s.table, &s.view, NULL, &frame, &counters, &reason) != VODR_OK)
        fail_msg("%s", reason.text);
    double psnr = ideal_compare(&frame, rgba).psnr;
    vodr_frame_free(&frame);
    scene_close(&s);
    return psnr;
}

static bool look(const char *phantom, const char *transfer_name, const camera *eye)
{
    scene s;
    size_t channels;
    const reference_choice in_double = slices_in(REFERENCE_DOUBLE), in_float = slices_in(REFERENCE_FLOAT);
    stage(&s, phantom, transfer_name, wide, eye);
    double *ideal = staged_ideal(&s);
    scene_close(&s);
    double *exact = march_phantom(phantom, transfer_name, wide, eye, &in_double, &channels);
    double *rough = march_phantom(phantom, transfer_name, wide, eye, &in_float, &channels);
    double of_double = staged_psnr(exact, ideal, channels), of_float = staged_psnr(rough, exact, channels);
    double of_machine = machine_psnr(phantom, transfer_name, wide, eye, rough);
    bool good = of_double >= 90 && of_float >= 100 && of_machine >= 55;
    print_message("%-8s %-10s %4.0f,%-3.0f %-11s %4dx%-4d %8.1f %8.1f %8.1f%s\n", phantom, transfer_name,
                  eye->azimuth_deg, eye->elevation_deg, eye->perspective ? "perspective" : "parallel", eye->width_px,
                  eye->height_px, of_double, of_float, of_machine, good ? "" : "  too far");
    free(ideal);
    free(exact);
    free(rough);
    return good;
}

/* A cubic filter in integers, and with bspline of 16-bit coefficients, against the same in double precision. The
 * phantom's values lie within the window: those beyond would be cut before a spline is made of them. */
static void test_cubic(void **state)
{
    static const char *const filters[] = {"cardinal", "bspline"}, *const blends[] = {"over", "mip"};
    static const camera eyes[] = {{30, 30, 10, false, 40, 2.3, 80, 60, 90}, {-50, 20, 0, true, 60, 3, 64, 64, 72}};
    const reference_choice in_double = slices_in(REFERENCE_DOUBLE);
    (void)state;
    for (int i = 0; i < 8; i++) {
        char machine[160];
        size_t channels;
        const camera *eye = &eyes[i >> 2];
        snprintf(machine, sizeof machine, "%s filter=%s blend=%s", wide, filters[i & 1], blends[i >> 1 & 1]);
        double *exact = march_phantom("vessels", "vessels", machine, eye, &in_double, &channels);
        double psnr = machine_psnr("vessels", "vessels", machine, eye, exact);
        print_message("%s, %s, %s: %.1f dB\n", filters[i & 1], blends[i >> 1 & 1],
                      eye->perspective ? "perspective" : "parallel", psnr);
        assert_true(psnr >= 65);
        free(exact);
    }
}

static void test_slices(void **state)
{
    static const char *const transfers[] = {"bone", "skin-bone", "vessels"};
    static const camera eyes[] = {
        {.zoom = 1, .width_px = 72, .height_px = 72, .slices = 72},
        {30, 30, 10, false, 40, 1.3, 80, 60, 90},
        {-50, 20, 0, true, 60, 1, 64, 64, 72},
        {30, -30, 0, true, 110, 6, 48, 48, 60}, /* the eye is in the volume */
        {30, 30, 0, false, 40, 1, 1, 1, 72},
        {30, 30, 0, true, 40, 1, 1, 33, 72},
        {30, 30, 0, false, 40, 1, 33, 1, 36},
    };
    (void)state;
    bool good = true;
    print_message("volume   transfer    view     projection    pixels   double    float  machine, dB\n");
    for (int volume_at = 0; volume_at < 2; volume_at++)
        for (size_t t = 0; t < sizeof transfers / sizeof *transfers; t++)
            for (size_t i = 0; i < sizeof eyes / sizeof *eyes; i++)
                good = look(volume_at ? "head" : "vessels", transfers[t], &eyes[i]) && good;
    assert_true(good);
}

/* Rays with a fine step and as fine slices are both near the integral along the ray. */
static void test_rays(void **state)
{
    (void)state;
    static const camera eyes[] = {{30, 20, 0, false, 40, 0.6, 40, 40, 1400}, {-50, 20, 0, true, 30, 0.6, 40, 40, 1400}};
    static const char *const machines[] = {"traversal=whole", "traversal=whole blend=mip"};
    reference_choice fine = slices_in(REFERENCE_DOUBLE), rays = fine;
    rays.method = REFERENCE_RAYCAST;
    rays.step_vox = 0.05;
    for (int perspective = 0; perspective < 2; perspective++)
        for (int mip = perspective; mip < 2; mip++) { /* perspective slices are not as far apart along every ray */
            size_t channels;
            double *a = march_phantom("head", "bone", machines[mip], &eyes[perspective], &fine, &channels);
            double *b = march_phantom("head", "bone", machines[mip], &eyes[perspective], &rays, &channels);
            double psnr = staged_psnr(a, b, channels);
            print_message("rays, %s, %s: %.1f dB\n", perspective ? "perspective" : "parallel", mip ? "mip" : "over",
                          psnr);
            assert_true(psnr >= 50);
            free(a);
            free(b);
        }
}

/* In a parallel view rays with a sample every slice's share of the depth sample the slices themselves. */
static void test_rays_on_slices(void **state)
{
    (void)state;
    static const camera eye = {30, 20, 0, false, 40, 0.8, 48, 48, 31};
    scene s;
    size_t channels;
    reference_choice slices = slices_in(REFERENCE_DOUBLE), rays = slices;
    stage(&s, "head", "skin-bone", wide, &eye);
    rays.method = REFERENCE_RAYCAST;
    rays.step_vox = s.depth_vox;
    scene_close(&s);
    double *a = march_phantom("head", "skin-bone", wide, &eye, &slices, &channels);
    double *b = march_phantom("head", "skin-bone", wide, &eye, &rays, &channels);
    assert_true(staged_psnr(a, b, channels) >= 90);
    free(a);
    free(b);
}

/* A ray that ends early leaves out at most what its remaining transparency lets through. */
static void test_termination(void **state)
{
    (void)state;
    static const camera eye = {30, 20, 0, false, 40, 1, 72, 72, 72};
    reference_choice all = slices_in(REFERENCE_DOUBLE), some = all;
    all.method = some.method = REFERENCE_RAYCAST;
    all.step_vox = some.step_vox = 0.5;
    some.termination = 0.9;
    size_t channels;
    double *a = march_phantom("head", "skin-bone", wide, &eye, &all, &channels);
    double *b = march_phantom("head", "skin-bone", wide, &eye, &some, &channels), most = 0;
    for (size_t i = 0; i < channels; i++)
        most = fmax(most, fabs(a[i] - b[i]));
    assert_true(most > 0.01 && most <= 0.1);
    free(a);
    free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_slices),         cmocka_unit_test(test_cubic),       cmocka_unit_test(test_rays),
        cmocka_unit_test(test_rays_on_slices), cmocka_unit_test(test_termination),
    };
    return cmocka_run_group_tests_name("reference quality", tests, NULL, NULL);
}
