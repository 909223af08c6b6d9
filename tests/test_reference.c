/* test_reference.c - the reference renderer on the CPU over random cases: `fixed` draws the C model's frame to the
 * byte; in floating point, no way of passing over empty space, no instruction set, no thread changes a byte, and a
 * second frame is the first. Arguments: [CASES [FIRST_SEED]]; a failing case is drawn again by `test_reference 1 SEED`.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "outcome.h"
#include "reference.h"
#include "suite.h"

static reference_volume volume_of(const test_case *c)
{
    reference_volume v = {.type = c->input.voxel_bytes == 1 ? REFERENCE_UINT8 : REFERENCE_UINT16,
                          .voxels = c->input.voxels};
    memcpy(v.dims_vox, c->input.dims_vox, sizeof v.dims_vox);
    return v;
}

static bool open_cpu(const test_case *c, int32_t threads, vodr_simd simd, reference **r, FILE *file)
{
    const reference_options options = {REFERENCE_CPU, threads, simd};
    const reference_volume v = volume_of(c);
    vodr_error error;
    bool good = reference_open(&options, &v, r, &error) == REFERENCE_OK;
    if (!good)
        fprintf(file, "  open: %s\n", error.text);
    return good;
}

/* ---- the machine's arithmetic ---- */

static bool fixed_agrees(test_case *c, FILE *file)
{
    outcome model, ours = {0};
    reference *r;
    reference_stats stats;
    const vodr_options how = {.threads = 1};
    if (!open_cpu(c, 1 + (int32_t)(c->seed % 3), VODR_SIMD_BEST, &r, file))
        return false;
    outcome_draw(c, &c->machine, &how, &model);
    ours.status = reference_fixed(r, &c->machine, c->input.map, &c->table, &c->view, &ours.frame, &stats,
                                  &ours.error) == REFERENCE_OK
                      ? VODR_OK
                      : VODR_INVALID;
    bool same = outcome_same_frame(file, &model, &ours);
    /* Front to back the model goes on to look at a pixel that is full. */
    uint64_t fetched = model.counters.fragments - model.counters.terminated_fragments;
    if (stats.samples != fetched) {
        fprintf(file, "  samples: %llu, of the machine %llu\n", (unsigned long long)stats.samples,
                (unsigned long long)fetched);
        same = false;
    }
    if (!same)
        case_print(file, c, &c->machine);
    reference_close(r);
    outcome_free(&model);
    outcome_free(&ours);
    return same;
}

/* ---- floating point ---- */

static reference_march_job random_job(test_case *c, double *rgba)
{
    rng *r = &c->random;
    const double most = c->input.voxel_bytes == 1 ? 255 : 65535, width = most * rng_real(r, 0.1, 2);
    double spacing_vox[3], finest = 1e300;
    for (int a = 0; a < 3; a++)
        finest = c->geometry.spacing[a] < finest ? c->geometry.spacing[a] : finest;
    for (int a = 0; a < 3; a++)
        spacing_vox[a] = c->geometry.spacing[a] / finest;
    const bool rays = rng_one_in(r, 2), by_gradient = rng_one_in(r, 4);
    case_fill_rgba(r, rgba);
    return (reference_march_job){
        .camera = rays ? reference_camera_rays(&c->view, spacing_vox, rng_real(r, 0.3, 2))
                       : reference_camera_slices(&c->view),
        .numbers = (reference_numbers)rng_int(r, REFERENCE_FLOAT, REFERENCE_TEXTURE),
        .blend = rng_one_in(r, 3) ? REFERENCE_MIP : REFERENCE_OVER,
        .filter = rng_one_in(r, 4) ? REFERENCE_NEAREST : REFERENCE_LINEAR,
        .shading = rng_one_in(r, 3) ? REFERENCE_PHONG : REFERENCE_UNLIT,
        .block_vox = (int32_t)(rng_one_in(r, 4) ? rng_int(r, 2, 200) : rng_int(r, 2, 4)),
        .termination = rng_one_in(r, 3) ? 2 : rng_real(r, 0.3, 1),
        .table = {CASE_COLUMNS, by_gradient ? CASE_ROWS : 1, rgba, by_gradient ? rng_real(r, 0.05, 1) : 0},
        .window_scale = 1 / width,
        .window_offset = rng_real(r, -1, 0.5),
    };
}

/* One way of drawing a job. */
typedef struct way {
    const char *name;
    int32_t threads;
    vodr_simd simd;
    reference_accel accel;
} way;

static const way ways[] = {
    {"none", 1, VODR_SIMD_BEST, REFERENCE_ACCEL_NONE},
    {"block", 1, VODR_SIMD_BEST, REFERENCE_ACCEL_BLOCK},
    {"bisect", 1, VODR_SIMD_BEST, REFERENCE_ACCEL_BISECT},
    {"seed", 1, VODR_SIMD_BEST, REFERENCE_ACCEL_SEED},
    {"best", 1, VODR_SIMD_BEST, REFERENCE_ACCEL_BEST},
    {"portable", 1, VODR_SIMD_PORTABLE, REFERENCE_ACCEL_NONE},
    {"avx2", 2, VODR_SIMD_AVX2, REFERENCE_ACCEL_BEST},
    {"avx512", 1, VODR_SIMD_AVX512, REFERENCE_ACCEL_BLOCK},
    {"three threads", 3, VODR_SIMD_BEST, REFERENCE_ACCEL_BEST},
};

static bool draw_way(const test_case *c, reference_march_job job, const way *w, double *rgba, FILE *file)
{
    reference *r = NULL;
    reference_stats stats;
    vodr_error error;
    job.accel = w->accel;
    bool good = open_cpu(c, w->threads, w->simd, &r, file);
    for (int i = 0; good && i < 2; i++) { /* the second frame finds blocks and cells made */
        good = reference_march(r, &job, rgba, &stats, &error) == REFERENCE_OK;
        if (!good)
            fprintf(file, "  %s: %s\n", w->name, error.text);
    }
    reference_close(r);
    return good;
}

static bool ways_agree(test_case *c, FILE *file)
{
    double table[4 * CASE_COLUMNS * CASE_ROWS];
    const reference_march_job job = random_job(c, table);
    size_t channels = 4 * (size_t)c->view.width_px * (size_t)c->view.height_px;
    double *first = malloc(channels * sizeof *first), *other = malloc(channels * sizeof *other);
    bool same = first && other && draw_way(c, job, &ways[0], first, file);
    for (size_t i = 0; same && i < sizeof ways / sizeof *ways; i++) {
        if (!reference_accel_suits(ways[i].accel, job.blend, job.filter))
            continue;
        same = draw_way(c, job, &ways[i], other, file);
        for (size_t n = 0; same && n < channels; n++)
            if (memcmp(&first[n], &other[n], sizeof *first) != 0) {
                fprintf(file, "  %s: pixel (%zu, %zu), channel %zu: %.17g, %.17g; numbers %d, blend %d, shading %d\n",
                        ways[i].name, n / 4 % (size_t)c->view.width_px, n / 4 / (size_t)c->view.width_px, n % 4,
                        first[n], other[n], job.numbers, job.blend, job.shading);
                same = false;
            }
    }
    if (!same)
        case_print(file, c, &c->machine);
    free(first);
    free(other);
    return same;
}

static void test_fixed(void **state)
{
    assert_int_equal(suite_run(*state, fixed_agrees), 0);
}

static void test_ways(void **state)
{
    assert_int_equal(suite_run(*state, ways_agree), 0);
}

int main(int argc, char **argv)
{
    suite options;
    if (!suite_options(argc, argv, &options))
        return 2;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate(test_fixed, &options),
        cmocka_unit_test_prestate(test_ways, &options),
    };
    return cmocka_run_group_tests_name("reference", tests, NULL, NULL) == 0 ? 0 : 1;
}
