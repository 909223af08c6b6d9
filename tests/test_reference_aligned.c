/* test_reference_aligned.c - the thread-aligned projection on the CPU: the angles, checked against what they are to
 * achieve; every pixel in its order once; turned pictures beside the usual ones, also along an axis, between two axes
 * and of voxels that are no cubes; volumes thinner than the margins of their copies, to the byte; one copy in place of
 * three; refusals. Random cases to the byte are test_reference_cubic's. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "aligned.h"
#include "camera.h"
#include "kernel_order.h"
#include "suite.h"

enum { SIDE_VOX = 40, SIDE_PX = 56, COLUMNS = 64 };

static const double cubes[3] = {1, 1, 1}, bricks[3] = {1, 1, 2.5};

/* ---- views ---- */

static reference_camera rays_of(const int32_t dims[3], const double spacing[3], double azimuth_deg,
                                double elevation_deg, double roll_deg, bool perspective)
{
    volume geometry = {.axis = {0, 1, 2}, .sign = {1, 1, 1}};
    camera c = camera_default();
    host_error reason;
    vodr_view registers;
    double depth;
    for (int a = 0; a < 3; a++) {
        geometry.dims_vox[a] = dims[a];
        geometry.spacing[a] = spacing[a];
    }
    c.azimuth_deg = azimuth_deg;
    c.elevation_deg = elevation_deg;
    c.roll_deg = roll_deg;
    c.perspective = perspective;
    c.width_px = SIDE_PX;
    c.height_px = SIDE_PX - 9;
    c.slices = dims[2];
    if (camera_view(&c, &geometry, &registers, &depth, &reason) != HOST_OK)
        fail_msg("%s", reason.text);
    return reference_camera_rays(&registers, spacing, 0.7);
}

static const struct {
    double azimuth_deg, elevation_deg, roll_deg;
    int dominant;
} views[] = {{0, 0, 0, 2},     {90, 0, 0, 0},   {0, 90, 0, 1},     {180, 0, 90, 2}, {-90, 0, 45, 0},
             {45, 0, 0, 2},    {90, 45, 0, 1},  {0, 45, 0, 2},     {30, 30, 0, 2},  {-60, 15, 10, 0},
             {10, 70, -20, 1}, {75, -40, 0, 0}, {-120, -35, 80, 0}};

enum { VIEWS = sizeof views / sizeof *views };

/* Equations 8 to 15: a step along theta goes nowhere but along the fast axis. */
static void test_angles(void **state)
{
    (void)state;
    static const int32_t dims[3] = {SIDE_VOX, SIDE_VOX, SIDE_VOX};
    for (int i = 0; i < VIEWS; i++) {
        const reference_camera c =
            rays_of(dims, cubes, views[i].azimuth_deg, views[i].elevation_deg, views[i].roll_deg, false);
        for (int kind = 0; kind < 2; kind++) {
            const aligned_view v = aligned_view_of(&c, dims, (reference_theta)kind);
            const int third = (v.fast_axis + 1) % 3, dominant = v.dominant_axis;
            double step[3];
            assert_int_equal(dominant, views[i].dominant);
            assert_int_equal(v.fast_axis, (dominant + 1) % 3);
            assert_true(fabs(v.theta) <= acos(0) + 1e-12);
            for (int a = 0; a < 3; a++)
                step[a] = cos(v.theta) * c.origin[1][a] + sin(v.theta) * c.origin[2][a];
            const double delta = -step[dominant] / c.direction[0][dominant];
            if (kind == REFERENCE_THETA_BOX) {
                for (int a = 0; a < 3; a++)
                    step[a] += delta * c.direction[0][a];
                assert_true(fabs(step[dominant]) < 1e-9);
                assert_true(fabs(step[v.fast_axis]) > 0.5);
            }
            assert_true(fabs(step[third]) < 1e-7);
        }
    }
    /* an axis across which voxels are long is gone along the less */
    const reference_camera slanted = rays_of(dims, bricks, 45, 0, 0, false);
    assert_int_equal(aligned_view_of(&slanted, dims, REFERENCE_THETA_BOX).dominant_axis, 0);
    /* a camera without rays has a view all the same */
    reference_camera none = slanted;
    memset(none.direction, 0, sizeof none.direction);
    assert_true(aligned_view_of(&none, dims, REFERENCE_THETA_BOX).theta == 0);
}

static void hold_order(int32_t width_px, int32_t height_px, double theta)
{
    kernel_frame f = {.camera = {.width_px = width_px, .height_px = height_px}};
    uint8_t *taken = calloc((size_t)width_px, (size_t)height_px);
    int32_t x, y, count = 0;
    assert_non_null(taken);
    f.order = aligned_order_of(&f.camera, theta);
    for (int32_t j = 0; j < f.order.rows + 3; j++)
        for (int32_t i = 0; i < f.order.columns + 3; i++)
            if (order_has(&f, i, j, &x, &y)) {
                assert_true(j < f.order.rows);
                taken[y * width_px + x]++;
                count++;
            }
    assert_int_equal(count, width_px * height_px);
    for (int32_t i = 0; i < count; i++)
        assert_int_equal(taken[i], 1);
    free(taken);
}

static void test_orders(void **state)
{
    (void)state;
    rng r = {3};
    const double right = acos(0);
    static const double eighths[] = {0, 0.5, 1, -0.5, -1, 0.25, -0.75};
    for (size_t i = 0; i < sizeof eighths / sizeof *eighths; i++) {
        hold_order(1, 1, eighths[i] * right);
        hold_order(33, 7, eighths[i] * right);
        hold_order(7, 130, eighths[i] * right);
    }
    for (int i = 0; i < 300; i++)
        hold_order((int32_t)rng_int(&r, 1, 90), (int32_t)rng_int(&r, 1, 90), rng_real(&r, -right, right));
    const reference_camera c = {.width_px = 20, .height_px = 30};
    const kernel_order usual = aligned_order_usual(&c), level = aligned_order_of(&c, 0);
    assert_true(!level.steep && level.slope == 0 && level.first == 0);
    assert_true(level.columns == usual.columns && level.rows == usual.rows && level.tile_log2 == usual.tile_log2);
}

/* ---- pictures ---- */

/* A smooth blob in a shell, which ends within the volume: turning a picture blurs the edges of what it shows, and those
 * of the volume's box would be all that is seen of it. */
static void fill(uint16_t *voxels, const int32_t dims[3])
{
    for (int32_t i = 0; i < dims[0] * dims[1] * dims[2]; i++) {
        const int32_t at[3] = {i % dims[0], i / dims[0] % dims[1], i / dims[0] / dims[1]};
        double square = 0;
        for (int a = 0; a < 3; a++) {
            const double p = (at[a] + 0.5) / dims[a] - 0.5 - 0.05 * a;
            square += p * p;
        }
        const double rest = fmax(0, 1 - square / (0.35 * 0.35));
        voxels[i] = (uint16_t)(30000 * (1 + cos(14 * sqrt(square))) * rest * rest);
    }
}

static double table[4 * COLUMNS];

static reference_march_job job_of(const reference_camera *rays)
{
    for (int i = 0; i < COLUMNS; i++) {
        const double opacity = 0.06 * i / COLUMNS;
        table[4 * i] = opacity * i / COLUMNS;
        table[4 * i + 1] = opacity * 0.8;
        table[4 * i + 2] = opacity * (COLUMNS - i) / COLUMNS;
        table[4 * i + 3] = opacity;
    }
    return (reference_march_job){.camera = *rays,
                                 .filter = REFERENCE_BSPLINE,
                                 .block_vox = 8,
                                 .termination = 2,
                                 .table = {COLUMNS, 1, table, 0},
                                 .window_scale = 1 / 65535.0};
}

static reference_stats draw(reference *r, reference_march_job job, reference_accel accel, double *rgba)
{
    reference_stats stats;
    vodr_error error;
    job.accel = accel;
    if (reference_march(r, &job, rgba, &stats, &error) != REFERENCE_OK)
        fail_msg("%s", error.text);
    return stats;
}

static reference *open_cpu(const int32_t dims[3], const uint16_t *voxels, vodr_simd simd)
{
    const reference_options options = {REFERENCE_CPU, 2, simd};
    const reference_volume v = {.dims_vox = {dims[0], dims[1], dims[2]}, .type = REFERENCE_UINT16, .voxels = voxels};
    reference *r = NULL;
    vodr_error error;
    if (reference_open(&options, &v, &r, &error) != REFERENCE_OK)
        fail_msg("%s", error.text);
    return r;
}

static double psnr_of(const double *a, const double *b, size_t count)
{
    double squares = 0;
    for (size_t i = 0; i < count; i++)
        squares += (a[i] - b[i]) * (a[i] - b[i]);
    return squares > 0 ? 10 * log10((double)count / squares) : INFINITY;
}

enum { CHANNELS = 4 * SIDE_PX * (SIDE_PX - 9) };

/* A turned picture is interpolated; where the angle is none, or a right one, nothing but the order of sums changes it.
 */
static void test_turned(void **state)
{
    (void)state;
    static const int32_t dims[3] = {SIDE_VOX, SIDE_VOX - 5, SIDE_VOX + 7};
    static double usual[CHANNELS], turned[CHANNELS];
    uint16_t *voxels = malloc((size_t)(dims[0] * dims[1] * dims[2]) * sizeof *voxels);
    double least = INFINITY;
    assert_non_null(voxels);
    fill(voxels, dims);
    reference *r = open_cpu(dims, voxels, VODR_SIMD_BEST);
    for (int i = 0; i < 2 * VIEWS; i++) {
        const int n = i / 2;
        const reference_camera c = rays_of(dims, i % 3 ? cubes : bricks, views[n].azimuth_deg, views[n].elevation_deg,
                                           views[n].roll_deg, i % 2);
        reference_march_job job = job_of(&c);
        draw(r, job, REFERENCE_ACCEL_NONE, usual);
        for (int kind = 0; kind < 2; kind++) {
            job.theta = (reference_theta)kind;
            const reference_stats stats = draw(r, job, REFERENCE_ACCEL_ALIGNED_PAPER, turned);
            const double psnr_db = psnr_of(usual, turned, CHANNELS);
            const double off_deg = fabs(remainder(stats.theta_deg, 90));
            assert_int_equal(stats.copies, 3);
            assert_true(psnr_db > (off_deg < 1e-6 ? 100 : 55));
            least = fmin(least, psnr_db);
        }
    }
    assert_true(least < 80); /* some were turned indeed */
    print_message("turned pictures: at least %.1f dB\n", least);
    reference_close(r);
    free(voxels);
}

static void test_one_copy(void **state)
{
    (void)state;
    static const int32_t dims[3] = {SIDE_VOX, SIDE_VOX - 5, SIDE_VOX + 7};
    static double three[CHANNELS], one[CHANNELS];
    uint16_t *voxels = malloc((size_t)(dims[0] * dims[1] * dims[2]) * sizeof *voxels);
    assert_non_null(voxels);
    fill(voxels, dims);
    reference *r = open_cpu(dims, voxels, VODR_SIMD_BEST);
    for (int n = 0; n < VIEWS; n++) {
        const reference_camera c =
            rays_of(dims, cubes, views[n].azimuth_deg, views[n].elevation_deg, views[n].roll_deg, false);
        reference_march_job job = job_of(&c);
        assert_int_equal(draw(r, job, REFERENCE_ACCEL_ALIGNED_PAPER, three).copies, 3);
        job.copies = 1;
        assert_int_equal(draw(r, job, REFERENCE_ACCEL_ALIGNED_PAPER, one).copies, 1);
        assert_true(psnr_of(three, one, CHANNELS) > 100);
        assert_int_equal(draw(r, job, REFERENCE_ACCEL_NONE, one).copies, 0);
    }
    reference_close(r);
    free(voxels);
}

/* Of copies nothing is left out or read beyond: sizes about those of quads and margins. */
static void test_thin(void **state)
{
    (void)state;
    static const int32_t sizes[][3] = {{1, 1, 1}, {2, 1, 5}, {1, 6, 2}, {3, 4, 1}, {4, 3, 9}, {5, 5, 2}, {17, 8, 3}};
    static const vodr_simd ways[] = {VODR_SIMD_BEST, VODR_SIMD_AVX2, VODR_SIMD_PORTABLE};
    static double none[CHANNELS], other[CHANNELS];
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        uint16_t voxels[17 * 8 * 3];
        fill(voxels, sizes[i]);
        for (int n = 0; n < VIEWS * 3; n++) {
            const reference_camera c = rays_of(sizes[i], cubes, views[n / 3].azimuth_deg, views[n / 3].elevation_deg,
                                               views[n / 3].roll_deg, n % 2);
            reference_march_job job = job_of(&c);
            job.shading = n % 5 ? REFERENCE_UNLIT : REFERENCE_PHONG;
            job.numbers = n % 4 ? REFERENCE_FLOAT : REFERENCE_DOUBLE;
            job.copies = n % 7 ? 0 : 1;
            reference *r = open_cpu(sizes[i], voxels, ways[n % 3]);
            draw(r, job, REFERENCE_ACCEL_NONE, none);
            draw(r, job, REFERENCE_ACCEL_ALIGNED, other);
            assert_memory_equal(none, other, sizeof none);
            draw(r, job, REFERENCE_ACCEL_ALIGNED_BEST, other);
            assert_memory_equal(none, other, sizeof none);
            reference_close(r);
        }
    }
}

static void test_refusals(void **state)
{
    (void)state;
    static const int32_t dims[3] = {1, 1, 1};
    static const reference_accel aligned[] = {REFERENCE_ACCEL_ALIGNED, REFERENCE_ACCEL_ALIGNED_BEST,
                                              REFERENCE_ACCEL_ALIGNED_PAPER};
    static double rgba[CHANNELS];
    const uint16_t voxel = 3;
    const reference_camera c = rays_of(dims, cubes, 0, 0, 0, false);
    reference *r = open_cpu(dims, &voxel, VODR_SIMD_BEST);
    reference_stats stats;
    vodr_error error;
    for (size_t i = 0; i < 3; i++) {
        reference_march_job job = job_of(&c);
        job.accel = aligned[i];
        assert_true(reference_accel_is_aligned(job.accel));
        assert_int_equal(reference_march(r, &job, rgba, &stats, &error), REFERENCE_OK);
        job.copies = 2;
        assert_int_equal(reference_march(r, &job, rgba, &stats, &error), REFERENCE_INVALID);
        assert_non_null(strstr(error.text, "copies are 2, must be 1, 3"));
        job.copies = 0;
        job.filter = i ? REFERENCE_CARDINAL : REFERENCE_LINEAR;
        assert_int_equal(reference_march(r, &job, rgba, &stats, &error), REFERENCE_INVALID);
        assert_non_null(strstr(error.text, "alignment of B-splines"));
    }
    reference_close(r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_angles),   cmocka_unit_test(test_orders), cmocka_unit_test(test_turned),
        cmocka_unit_test(test_one_copy), cmocka_unit_test(test_thin),   cmocka_unit_test(test_refusals),
    };
    return cmocka_run_group_tests_name("reference aligned", tests, NULL, NULL) == 0 ? 0 : 1;
}
