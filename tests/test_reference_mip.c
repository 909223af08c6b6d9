/* test_reference_mip.c - the maximum by every --accel and block size is the picture of `none` to the byte: over random
 * cases, in volumes one voxel thin or all the same, along axes, in blocks that are refused or larger than the volume,
 * and at the sizes of the volumes of Kye and Kim's paper. Arguments: [CASES [FIRST_SEED]]. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mip_case.h"
#include "suite.h"
#include "synthetic.h"
#include "unit.h"

/* ---- random cases ---- */

static bool accels_agree(test_case *base, FILE *file)
{
    const reference_options options = {REFERENCE_CPU, 1 + (int32_t)(base->seed % 3), (vodr_simd)(base->seed % 4)};
    mip_tally t = {0};
    mip_case c;
    bool good = mip_case_make(base->seed, &c) && mip_case_hold(&c, &options, file, &t);
    for (int accel = REFERENCE_ACCEL_BLOCK; good && accel <= REFERENCE_ACCEL_BISECT; accel++)
        if (t.samples[accel] > t.samples[REFERENCE_ACCEL_NONE]) {
            fprintf(file, "  %s took more samples than there are\n", mip_accel_name((reference_accel)accel));
            good = false;
        }
    mip_case_free(&c);
    return good && t.differ == 0;
}

static void test_random(void **state)
{
    assert_int_equal(suite_run(*state, accels_agree), 0);
}

/* ---- volumes made here ---- */

/* A volume, the rays at it, and how it is to be drawn. */
typedef struct scene {
    int32_t dims_vox[3];
    const uint16_t *voxels;
    camera eye;
    reference_filter filter;
    double step_vox;
} scene;

static double table[4 * MIP_COLUMNS];

static reference_march_job job_of(const scene *s)
{
    static const double spacing[3] = {1, 1, 1};
    const volume geometry = unit_volume(s->dims_vox[0], s->dims_vox[1], s->dims_vox[2]);
    host_error reason;
    vodr_view view;
    double depth;
    if (camera_view(&s->eye, &geometry, &view, &depth, &reason) != HOST_OK)
        fail_msg("%s", reason.text);
    return (reference_march_job){.camera = reference_camera_rays(&view, spacing, s->step_vox),
                                 .blend = REFERENCE_MIP,
                                 .filter = s->filter,
                                 .termination = 2,
                                 .block_vox = 2,
                                 .table = {.columns = MIP_COLUMNS, .rows = 1, .rgba = table},
                                 .window_scale = 1 / 65535.0};
}

static reference *open_scene(const scene *s, vodr_simd simd)
{
    const reference_options options = {REFERENCE_CPU, 2, simd};
    reference_volume v = {.type = REFERENCE_UINT16, .voxels = s->voxels};
    reference *r;
    memcpy(v.dims_vox, s->dims_vox, sizeof v.dims_vox);
    mip_fill_ramp(table);
    assert_int_equal(reference_open(&options, &v, &r, NULL), REFERENCE_OK);
    return r;
}

static uint64_t draw(reference *r, reference_march_job job, reference_accel accel, int32_t block_vox, double *rgba)
{
    reference_stats stats;
    vodr_error error;
    job.accel = accel;
    job.block_vox = block_vox;
    if (reference_march(r, &job, rgba, &stats, &error) != REFERENCE_OK)
        fail_msg("%s: %s", mip_accel_name(accel), error.text);
    return stats.samples;
}

/* Draws the scene by `none`, without packed cells, then by the others in blocks of each of `count` edges. */
static void hold(const scene *s, const int32_t *edges_vox, int count)
{
    const size_t channels = 4 * (size_t)s->eye.width_px * (size_t)s->eye.height_px;
    const reference_march_job job = job_of(s);
    double *none = malloc(channels * sizeof *none), *other = malloc(channels * sizeof *other);
    assert_true(none && other);
    reference *r = open_scene(s, VODR_SIMD_PORTABLE);
    assert_true(draw(r, job, REFERENCE_ACCEL_NONE, 2, none) > 0);
    reference_close(r);
    r = open_scene(s, VODR_SIMD_BEST);
    for (int accel = REFERENCE_ACCEL_BLOCK; accel <= REFERENCE_ACCEL_BEST; accel++)
        for (int e = 0; e < (accel == REFERENCE_ACCEL_BEST ? 1 : count); e++) {
            draw(r, job, (reference_accel)accel, edges_vox[e], other);
            if (memcmp(none, other, channels * sizeof *none) != 0)
                fail_msg("%s, blocks of %d, %dx%dx%d voxels, view %g,%g: not the picture of none",
                         mip_accel_name((reference_accel)accel), edges_vox[e], s->dims_vox[0], s->dims_vox[1],
                         s->dims_vox[2], s->eye.azimuth_deg, s->eye.elevation_deg);
        }
    reference_close(r);
    free(none);
    free(other);
}

static const camera oblique = {30, 20, 10, false, 40, 1, 37, 29, 40};

static uint16_t *random_voxels(const int32_t dims_vox[3])
{
    uint16_t *voxels = malloc((size_t)dims_vox[0] * (size_t)dims_vox[1] * (size_t)dims_vox[2] * sizeof *voxels);
    assert_non_null(voxels);
    synthetic_fill(SYNTHETIC_NOISE, dims_vox, voxels);
    return voxels;
}

/* One voxel thin along one axis, two or three; by both filters and in every block there can be. */
static void test_thin(void **state)
{
    static const int32_t edges_vox[] = {2, 3, 40, VODR_MAX_DIM_VOX};
    (void)state;
    for (int thin = 1; thin < 8; thin++) {
        scene s = {.eye = oblique, .step_vox = 0.25};
        for (int a = 0; a < 3; a++)
            s.dims_vox[a] = thin >> a & 1 ? 1 : 33 + a;
        uint16_t *voxels = random_voxels(s.dims_vox);
        s.voxels = voxels;
        for (int filter = REFERENCE_NEAREST; filter <= REFERENCE_LINEAR; filter++) {
            s.filter = (reference_filter)filter;
            hold(&s, edges_vox, 4);
        }
        free(voxels);
    }
}

/* The six views along an axis, whose rays never leave a row of blocks, upright and rolled, parallel and perspective. */
static void test_axes(void **state)
{
    static const double views[][2] = {{0, 0}, {90, 0}, {180, 0}, {-90, 0}, {0, 90}, {0, -90}};
    static const int32_t edges_vox[] = {2, 4, 5, 64};
    (void)state;
    scene s = {.dims_vox = {32, 21, 40}, .filter = REFERENCE_LINEAR, .step_vox = 1};
    uint16_t *voxels = random_voxels(s.dims_vox);
    s.voxels = voxels;
    for (int i = 0; i < 24; i++) {
        s.eye = oblique;
        s.eye.azimuth_deg = views[i / 4][0];
        s.eye.elevation_deg = views[i / 4][1];
        s.eye.roll_deg = i % 2 ? 90 : 0;
        s.eye.perspective = i / 2 % 2;
        hold(&s, edges_vox, 4);
    }
    free(voxels);
}

/* All voxels the same: the pixels with samples have that value, and `seed` and `best` take one sample for each. */
static void test_constant(void **state)
{
    enum { SIDE = 24, VALUE = 0x3333 };
    static uint16_t voxels[SIDE * SIDE * SIDE];
    (void)state;
    for (int i = 0; i < SIDE * SIDE * SIDE; i++)
        voxels[i] = VALUE;
    const scene s = {
        .dims_vox = {SIDE, SIDE, SIDE}, .voxels = voxels, .eye = oblique, .filter = REFERENCE_LINEAR, .step_vox = 1};
    const size_t pixels = (size_t)s.eye.width_px * (size_t)s.eye.height_px;
    double *rgba = malloc(4 * pixels * sizeof *rgba);
    assert_non_null(rgba);
    reference *r = open_scene(&s, VODR_SIMD_BEST);
    for (int accel = 0; accel <= REFERENCE_ACCEL_BEST; accel++) {
        const uint64_t samples = draw(r, job_of(&s), (reference_accel)accel, 8, rgba);
        uint64_t seen = 0;
        for (size_t i = 0; i < pixels; i++) {
            seen += rgba[4 * i + 3] > 0;
            if (rgba[4 * i + 3] > 0)
                assert_true(fabs(rgba[4 * i] - VALUE / 65535.0) < 1e-6);
        }
        assert_true(seen > pixels / 4 && seen < pixels);
        if (accel >= REFERENCE_ACCEL_SEED)
            assert_int_equal(samples, seen);
    }
    reference_close(r);
    free(rgba);
}

/* Blocks are 2 to VODR_MAX_DIM_VOX voxels; what is refused is told, whatever the --accel. */
static void test_edges(void **state)
{
    static const int32_t bad[] = {-1, 0, 1, VODR_MAX_DIM_VOX + 1};
    static const int32_t larger[] = {25, 1000, VODR_MAX_DIM_VOX};
    (void)state;
    scene s = {.dims_vox = {24, 24, 24}, .eye = oblique, .filter = REFERENCE_LINEAR, .step_vox = 1};
    uint16_t *voxels = random_voxels(s.dims_vox);
    s.voxels = voxels;
    hold(&s, larger, 3);
    reference *r = open_scene(&s, VODR_SIMD_BEST);
    for (int accel = 0; accel <= REFERENCE_ACCEL_BEST; accel++)
        for (int i = 0; i < 4; i++) {
            reference_march_job job = job_of(&s);
            reference_stats stats;
            vodr_error error;
            char text[96];
            job.accel = (reference_accel)accel;
            job.block_vox = bad[i];
            assert_int_equal(reference_march(r, &job, NULL, &stats, &error), REFERENCE_INVALID);
            snprintf(text, sizeof text, "a block has %d voxels a side, must have 2 to %d", bad[i], VODR_MAX_DIM_VOX);
            assert_string_equal(error.text, text);
        }
    reference_close(r);
    free(voxels);
}

/* Shells, tubes and noise as large as the paper's volumes. */
static void test_paper_sizes(void **state)
{
    static const int32_t sizes_vox[][3] = {{256, 256, 225}, {512, 512, 216}, {512, 512, 256}, {512, 512, 512}};
    static const synthetic_kind kinds[] = {SYNTHETIC_SHELLS, SYNTHETIC_TUBES, SYNTHETIC_NOISE, SYNTHETIC_TUBES};
    static const int32_t edges_vox[] = {2, 16};
    (void)state;
    for (int i = 0; i < 4; i++) {
        scene s = {.eye = oblique, .filter = REFERENCE_LINEAR, .step_vox = 1};
        memcpy(s.dims_vox, sizes_vox[i], sizeof s.dims_vox);
        s.eye.width_px = s.eye.height_px = 64;
        s.eye.slices = s.dims_vox[2];
        s.eye.zoom = 64.0 / s.dims_vox[0];
        uint16_t *voxels =
            malloc((size_t)s.dims_vox[0] * (size_t)s.dims_vox[1] * (size_t)s.dims_vox[2] * sizeof *voxels);
        assert_non_null(voxels);
        synthetic_fill(kinds[i], s.dims_vox, voxels);
        s.voxels = voxels;
        hold(&s, edges_vox, 2);
        free(voxels);
    }
}

int main(int argc, char **argv)
{
    suite options;
    if (!suite_options(argc, argv, &options))
        return 2;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate(test_random, &options),
        cmocka_unit_test(test_thin),
        cmocka_unit_test(test_axes),
        cmocka_unit_test(test_constant),
        cmocka_unit_test(test_edges),
        cmocka_unit_test(test_paper_sizes),
    };
    return cmocka_run_group_tests_name("reference mip", tests, NULL, NULL) == 0 ? 0 : 1;
}
