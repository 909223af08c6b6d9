/* test_reference_cubic.c - the cubic filters of the reference renderer on the CPU: samples against kernels and a direct
 * solve in double, written another way; every --accel, instruction set and thread count against `none` to the byte over
 * random cases; a bound that is too tight, which must break a picture; volumes thinner than the filter, constant, and
 * overshooting their type. Arguments: [CASES [FIRST_SEED]]. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "../bench/record/cubic_cases.h"
#include "prefilter.h"
#include "suite.h"

/* Samples are told by a table over so many times the voxels' range: splines overshoot. */
enum { SIDE_PX = 9, WINDOW = 16 };

/* ---- samples, another way ---- */

static double cardinal_kernel(double x)
{
    x = fabs(x);
    return x < 1 ? 1 + x * x * (-2.5 + 1.5 * x) : x < 2 ? 2 + x * (-4 + x * (2.5 - 0.5 * x)) : 0;
}

static double bspline_kernel(double x)
{
    x = fabs(x);
    return x < 1 ? 2 / 3.0 - x * x * (1 - x / 2) : x < 2 ? (2 - x) * (2 - x) * (2 - x) / 6 : 0;
}

/* Solves (c(k-1) + 4 c(k) + c(k+1))/6 = f(k) by elimination, c going on as it is at both ends. */
static void solve(double *line, int32_t count, size_t stride)
{
    double *upper = calloc((size_t)count, sizeof *upper);
    assert_non_null(upper);
    for (int32_t k = 0; k < count; k++) {
        const double own = 4 + (k == 0) + (k == count - 1), pivot = own - (k > 0 ? upper[k - 1] : 0);
        double *at = line + (size_t)k * stride;
        upper[k] = 1 / pivot;
        *at = (6 * *at - (k > 0 ? at[-(ptrdiff_t)stride] : 0)) / pivot;
    }
    for (int32_t k = count - 2; k >= 0; k--)
        line[(size_t)k * stride] -= upper[k] * line[(size_t)(k + 1) * stride];
    free(upper);
}

static void solve_volume(double *c, const int32_t dims[3])
{
    const size_t row = (size_t)dims[0], layer = row * (size_t)dims[1], count = layer * (size_t)dims[2];
    for (size_t i = 0; i < count; i++) {
        if (i % row == 0)
            solve(c + i, dims[0], 1);
    }
    for (size_t i = 0; i < count; i++)
        if (i % layer < row)
            solve(c + i, dims[1], row);
    for (size_t i = 0; i < layer; i++)
        solve(c + i, dims[2], layer);
}

/* The sum over all voxels, those beyond the border too, that the kernel reaches. */
static double evaluate(const double *values, const int32_t dims[3], double (*kernel)(double), const double p[3])
{
    double sum = 0;
    int64_t first[3];
    for (int a = 0; a < 3; a++)
        first[a] = (int64_t)floor(p[a] - 2.5);
    for (int n = 0; n < 216; n++) {
        const int64_t i[3] = {first[0] + n % 6, first[1] + n / 6 % 6, first[2] + n / 36};
        double weight = 1;
        size_t at[3];
        for (int a = 0; a < 3; a++) {
            weight *= kernel(p[a] - ((double)i[a] + 0.5));
            at[a] = (size_t)(i[a] < 0 ? 0 : i[a] >= dims[a] ? dims[a] - 1 : i[a]);
        }
        sum += weight * values[(at[2] * (size_t)dims[1] + at[1]) * (size_t)dims[0] + at[0]];
    }
    return sum;
}

/* A camera of one sample a pixel, scattered over the volume and its borders. */
static reference_camera scatter(rng *r, const int32_t dims[3])
{
    reference_camera c = {.width_px = SIDE_PX, .height_px = SIDE_PX, .most = 1, .spacing_vox = {1, 1, 1}};
    for (int a = 0; a < 3; a++) {
        const double size = dims[a], x = rng_real(r, -size, size), y = rng_real(r, -size, size);
        c.origin[1][a] = x / SIDE_PX;
        c.origin[2][a] = y / SIDE_PX;
        c.origin[0][a] = rng_real(r, -0.5, size + 0.5) - (c.origin[1][a] + c.origin[2][a]) * (SIDE_PX / 2);
        c.direction[0][a] = a == 2;
    }
    return c;
}

static bool is_inside(const int32_t dims[3], const double p[3])
{
    return p[0] >= 0 && p[1] >= 0 && p[2] >= 0 && p[0] < dims[0] && p[1] < dims[1] && p[2] < dims[2];
}

/* The stored values of the job's samples, and its pixels. */
static void draw_samples(const reference_volume *v, reference_march_job job, double range, double *rgba)
{
    static const double table[8] = {0, 0, 0, 0, 1, 1, 1, 1};
    const reference_options options = {REFERENCE_CPU, 1, VODR_SIMD_BEST};
    reference *r = NULL;
    reference_stats stats;
    vodr_error error;
    job.blend = REFERENCE_MIP;
    job.block_vox = 4;
    job.table = (reference_table){2, 1, table, 0};
    job.window_scale = 1 / (WINDOW * range);
    job.window_offset = 0.5;
    if (reference_open(&options, v, &r, &error) != REFERENCE_OK ||
        reference_march(r, &job, rgba, &stats, &error) != REFERENCE_OK)
        fail_msg("%s", error.text);
    reference_close(r);
}

/* Random volumes, many thinner than the filter reaches, at random places, borders among them. */
static void test_samples(void **state)
{
    (void)state;
    rng r = {7};
    double most_off[2][2] = {{0}};
    for (int round = 0; round < 120; round++) {
        int32_t dims[3];
        for (int a = 0; a < 3; a++)
            dims[a] = (int32_t)rng_int(&r, 1, rng_one_in(&r, 2) ? 4 : 20);
        const size_t count = (size_t)dims[0] * (size_t)dims[1] * (size_t)dims[2];
        const double range = 1000;
        float *voxels = malloc(count * sizeof *voxels);
        double *values = malloc(count * sizeof *values), rgba[4 * SIDE_PX * SIDE_PX];
        assert_true(voxels && values);
        for (size_t i = 0; i < count; i++)
            values[i] = voxels[i] = (float)rng_real(&r, -range, range);
        const bool spline = round % 2;
        if (spline)
            solve_volume(values, dims);
        for (int is_double = 0; is_double < 2; is_double++) {
            const reference_volume v = {
                .dims_vox = {dims[0], dims[1], dims[2]}, .type = REFERENCE_FLOAT32, .voxels = voxels};
            const reference_march_job job = {.camera = scatter(&r, dims),
                                             .numbers = is_double ? REFERENCE_DOUBLE : REFERENCE_FLOAT,
                                             .filter = spline ? REFERENCE_BSPLINE : REFERENCE_CARDINAL,
                                             .termination = 2};
            const reference_camera *c = &job.camera;
            draw_samples(&v, job, range, rgba);
            for (int i = 0; i < SIDE_PX * SIDE_PX; i++) {
                double p[3];
                for (int a = 0; a < 3; a++)
                    p[a] = c->origin[0][a] + i % SIDE_PX * c->origin[1][a] + i / SIDE_PX * c->origin[2][a];
                if (!is_inside(dims, p))
                    continue;
                const double want = evaluate(values, dims, spline ? bspline_kernel : cardinal_kernel, p);
                const double off = fabs((rgba[4 * i] - 0.5) * WINDOW * range - want) / range;
                most_off[spline][is_double] = fmax(most_off[spline][is_double], off);
            }
        }
        free(voxels);
        free(values);
    }
    print_message("off by, of the range: cardinal %.1e float, %.1e double; bspline %.1e float, %.1e double\n",
                  most_off[0][0], most_off[0][1], most_off[1][0], most_off[1][1]);
    assert_true(most_off[0][0] > 0 && most_off[0][0] < 3e-5 && most_off[1][0] < 3e-5);
    assert_true(most_off[0][1] < 1e-12);
    assert_true(most_off[1][1] < 1e-6); /* coefficients are floats */
}

/* The recursion against the direct solve. */
static void test_prefilter(void **state)
{
    (void)state;
    static const int32_t sizes[][3] = {{1, 1, 1},   {2, 1, 3},    {1, 5, 2},   {3, 2, 1},
                                       {300, 3, 2}, {17, 33, 40}, {130, 2, 31}};
    rng r = {11};
    for (size_t n = 0; n < sizeof sizes / sizeof *sizes; n++) {
        const int32_t *dims = sizes[n];
        const size_t count = (size_t)dims[0] * (size_t)dims[1] * (size_t)dims[2];
        uint16_t *voxels = malloc(count * sizeof *voxels);
        double *exact = malloc(count * sizeof *exact), most_off = 0;
        float *ours = malloc(count * sizeof *ours);
        assert_true(voxels && exact && ours);
        for (size_t i = 0; i < count; i++)
            exact[i] = voxels[i] = (uint16_t)rng_int(&r, 0, 65535);
        const reference_volume v = {
            .dims_vox = {dims[0], dims[1], dims[2]}, .type = REFERENCE_UINT16, .voxels = voxels};
        assert_true(prefilter_layers(&v, 0, dims[2], ours));
        prefilter_rows(dims, 0, dims[1], ours);
        solve_volume(exact, dims);
        for (size_t i = 0; i < count; i++)
            most_off = fmax(most_off, fabs(ours[i] - exact[i]));
        assert_true(most_off < 65535 * 2e-6);
        free(voxels);
        free(exact);
        free(ours);
    }
}

/* ---- pictures ---- */

static bool ways_agree(test_case *c, FILE *file)
{
    static const reference_options ways[] = {
        {REFERENCE_CPU, 1, VODR_SIMD_BEST}, {REFERENCE_CPU, 3, VODR_SIMD_AVX2}, {REFERENCE_CPU, 1, VODR_SIMD_PORTABLE}};
    cubic_tally tally = {0};
    return cubic_case_hold(c, ways, sizeof ways / sizeof *ways, file, &tally);
}

static void test_ways(void **state)
{
    assert_int_equal(suite_run(*state, ways_agree), 0);
}

enum { WORST_VOX = 12 };

/* What a view along z through a volume shows by an accel; returns how many samples were taken. */
static uint64_t show(const reference_volume *v, reference_filter filter, reference_numbers numbers,
                     reference_accel accel, const reference_table *table, double scale, double offset, double *rgba)
{
    const reference_options options = {REFERENCE_CPU, 2, VODR_SIMD_BEST};
    reference *r = NULL;
    reference_stats stats = {0};
    vodr_error error;
    reference_march_job job = {
        .camera = {.width_px = SIDE_PX, .height_px = SIDE_PX, .spacing = 0.5, .most = 1000, .spacing_vox = {1, 1, 1}},
        .numbers = numbers,
        .filter = filter,
        .accel = accel,
        .block_vox = 32,
        .termination = 2,
        .table = *table,
        .window_scale = scale,
        .window_offset = offset};
    for (int a = 0; a < 2; a++) { /* near together, so that they leap together */
        job.camera.origin[1 + a][a] = fmin(0.25, v->dims_vox[a] / (2.0 * SIDE_PX));
        job.camera.origin[0][a] = v->dims_vox[a] / 2.0 - SIDE_PX / 2 * job.camera.origin[1 + a][a];
    }
    job.camera.direction[0][2] = 1;
    if (reference_open(&options, v, &r, &error) != REFERENCE_OK ||
        reference_march(r, &job, rgba, &stats, &error) != REFERENCE_OK)
        fail_msg("%s", error.text);
    reference_close(r);
    return stats.samples;
}

/* Around the cell between voxels 5 and 6 each voxel is at the end that its weight asks for. The sample in its middle is
 * beyond the type's range by 0.4766 of it, and only what is beyond 0.3 shows. */
static void test_overshoot(void **state)
{
    (void)state;
    uint8_t voxels[WORST_VOX * WORST_VOX * WORST_VOX];
    static const double table[] = {0, 0, 0, 0, 0, 0, 0, 0, 0.5, 0.5, 0.5, 1, 0.5, 0.5, 0.5, 1};
    const reference_table shown = {4, 1, table, 0};
    const reference_volume v = {
        .dims_vox = {WORST_VOX, WORST_VOX, WORST_VOX}, .type = REFERENCE_UINT8, .voxels = voxels};
    double none[4 * SIDE_PX * SIDE_PX], other[4 * SIDE_PX * SIDE_PX];
    for (int i = 0; i < (int)sizeof voxels; i++) {
        const int at[3] = {i % WORST_VOX, i / WORST_VOX % WORST_VOX, i / WORST_VOX / WORST_VOX};
        int sign = 1;
        for (int a = 0; a < 3; a++)
            sign *= at[a] == 5 || at[a] == 6 ? 1 : -1;
        voxels[i] = sign > 0 ? 255 : 0;
    }
    /* column 1 is 0.3 of the range above it */
    const double scale = 1 / (3 * 0.2 * 255.0), offset = 1 / 3.0 - 1.3 * 255 * scale;
    for (int is_double = 0; is_double < 2; is_double++) {
        const reference_numbers numbers = is_double ? REFERENCE_DOUBLE : REFERENCE_FLOAT;
        show(&v, REFERENCE_CARDINAL, numbers, REFERENCE_ACCEL_NONE, &shown, scale, offset, none);
        double most = 0;
        for (int i = 0; i < SIDE_PX * SIDE_PX; i++)
            most = fmax(most, none[4 * i + 3]);
        assert_true(most > 0);
        static const reference_accel safe[] = {REFERENCE_ACCEL_RIVAL, REFERENCE_ACCEL_HULL, REFERENCE_ACCEL_BEST};
        for (size_t i = 0; i < sizeof safe / sizeof *safe; i++) {
            show(&v, REFERENCE_CARDINAL, numbers, safe[i], &shown, scale, offset, other);
            assert_memory_equal(none, other, sizeof none);
        }
        show(&v, REFERENCE_CARDINAL, numbers, REFERENCE_ACCEL_UNSAFE, &shown, scale, offset, other);
        assert_memory_not_equal(none, other, sizeof none);
    }
}

/* Constant volumes, of any thickness, are that constant to rounding; functions that show nothing need no sample, those
 * that show all draw all. */
static void test_constants(void **state)
{
    (void)state;
    static const double nothing[8] = {0}, all[8] = {0.1, 0.1, 0.1, 0.2, 0.1, 0.1, 0.1, 0.2};
    static const int32_t sizes[][3] = {{1, 1, 1}, {2, 3, 1}, {9, 1, 2}, {16, 11, 20}};
    static const reference_filter filters[] = {REFERENCE_CARDINAL, REFERENCE_BSPLINE};
    uint16_t voxels[16 * 11 * 20];
    double none[4 * SIDE_PX * SIDE_PX], other[4 * SIDE_PX * SIDE_PX];
    for (size_t i = 0; i < sizeof voxels / sizeof *voxels; i++)
        voxels[i] = 40000;
    for (size_t n = 0; n < 8; n++) {
        const reference_volume v = {.dims_vox = {sizes[n / 2][0], sizes[n / 2][1], sizes[n / 2][2]},
                                    .type = REFERENCE_UINT16,
                                    .voxels = voxels};
        const reference_filter filter = filters[n % 2];
        const reference_table empty = {2, 1, nothing, 0}, full = {2, 1, all, 0};
        const double step = 1 / 65535.0;
        uint64_t samples = show(&v, filter, REFERENCE_FLOAT, REFERENCE_ACCEL_BEST, &empty, step, 0, other);
        assert_int_equal(samples, 0);
        for (int i = 0; i < 4 * SIDE_PX * SIDE_PX; i++)
            assert_true(other[i] == 0);
        samples = show(&v, filter, REFERENCE_FLOAT, REFERENCE_ACCEL_NONE, &full, step, 0, none);
        assert_true(samples == (uint64_t)(SIDE_PX * SIDE_PX * 2 * v.dims_vox[2]));
        assert_true(show(&v, filter, REFERENCE_FLOAT, REFERENCE_ACCEL_BEST, &full, step, 0, other) == samples);
        assert_memory_equal(none, other, sizeof none);
        const reference_march_job job = {.camera = {.width_px = SIDE_PX,
                                                    .height_px = SIDE_PX,
                                                    .origin = {{0, 0, 0.1}, {v.dims_vox[0] / 9.1, 0, 0}, {0, 0, 0}},
                                                    .direction = {{0, 0, 1}},
                                                    .most = 1,
                                                    .spacing_vox = {1, 1, 1}},
                                         .filter = filter,
                                         .termination = 2};
        draw_samples(&v, job, 65535, other);
        for (int i = 0; i < SIDE_PX * SIDE_PX; i++)
            assert_true(fabs((other[4 * i] - 0.5) * WINDOW * 65535 - 40000) < 0.2);
    }
}

static void test_refusals(void **state)
{
    (void)state;
    const uint8_t voxel = 3;
    const reference_volume v = {.dims_vox = {1, 1, 1}, .type = REFERENCE_UINT8, .voxels = &voxel};
    const reference_options options = {REFERENCE_CPU, 1, VODR_SIMD_BEST};
    static const double table[8] = {0};
    double rgba[4];
    reference *r = NULL;
    reference_stats stats;
    vodr_error error;
    assert_int_equal(reference_open(&options, &v, &r, &error), REFERENCE_OK);
    const reference_march_job good = {.camera = {.width_px = 1, .height_px = 1, .most = 1, .spacing_vox = {1, 1, 1}},
                                      .filter = REFERENCE_CARDINAL,
                                      .block_vox = 8,
                                      .table = {2, 1, table, 0}};
    assert_int_equal(reference_march(r, &good, rgba, &stats, &error), REFERENCE_OK);
    reference_march_job bad = good;
    bad.numbers = REFERENCE_TEXTURE;
    assert_int_equal(reference_march(r, &bad, rgba, &stats, &error), REFERENCE_INVALID);
    assert_non_null(strstr(error.text, "cubics"));
    static const reference_accel of_linear[] = {REFERENCE_ACCEL_BLOCK, REFERENCE_ACCEL_BISECT, REFERENCE_ACCEL_SEED};
    for (size_t i = 0; i < sizeof of_linear / sizeof *of_linear; i++) {
        bad = good;
        bad.blend = REFERENCE_MIP;
        bad.accel = of_linear[i];
        assert_int_equal(reference_march(r, &bad, rgba, &stats, &error), REFERENCE_INVALID);
    }
    bad = good;
    bad.filter = REFERENCE_LINEAR;
    bad.accel = REFERENCE_ACCEL_HULL;
    assert_int_equal(reference_march(r, &bad, rgba, &stats, &error), REFERENCE_INVALID);
    reference_close(r);
    const float large = -2e36F;
    const reference_volume huge = {.dims_vox = {1, 1, 1}, .type = REFERENCE_FLOAT32, .voxels = &large};
    assert_int_equal(reference_open(&options, &huge, &r, &error), REFERENCE_OK);
    assert_int_equal(reference_march(r, &good, rgba, &stats, &error), REFERENCE_INVALID);
    assert_non_null(strstr(error.text, "magnitude 2e+36"));
    reference_close(r);
}

int main(int argc, char **argv)
{
    suite options;
    if (!suite_options(argc, argv, &options))
        return 2;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_samples),   cmocka_unit_test(test_prefilter),
        cmocka_unit_test(test_overshoot), cmocka_unit_test(test_constants),
        cmocka_unit_test(test_refusals),  cmocka_unit_test_prestate(test_ways, &options),
    };
    return cmocka_run_group_tests_name("reference cubic", tests, NULL, NULL) == 0 ? 0 : 1;
}
