/* test_reference_scene.c - a scene on the reference renderer: every type of voxel and its slope, voxels that are not
 * finite, tables that show nothing, light and gradients on a ramp where both are known, and what is refused. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lib/staged.h"
#include "lib/unit.h"
#include "reference_scene.h"

enum { SIDE = 24, COUNT = SIDE * SIDE * SIDE, PIXELS = SIDE * SIDE };

static const camera ahead = {.zoom = 1, .width_px = SIDE, .height_px = SIDE, .slices = SIDE};
static const camera oblique = {30, 20, 0, true, 50, 1, SIDE, SIDE, SIDE};

/* A volume whose voxel i is stored as `stored(i)`. */
static volume make_volume(volume_type type, double slope, double inter, double (*stored)(int))
{
    volume v = unit_volume(SIDE, SIDE, SIDE);
    v.type = type;
    v.slope = slope;
    v.inter = inter;
    v.bytes = COUNT * volume_type_bytes(type);
    v.voxels = malloc(v.bytes);
    assert_non_null(v.voxels);
    v.min = INFINITY;
    v.max = -INFINITY;
    for (int i = 0; i < COUNT; i++) {
        double x = stored(i);
        switch (type) {
        case VOLUME_UINT8: ((uint8_t *)v.voxels)[i] = (uint8_t)x; break;
        case VOLUME_INT8: ((int8_t *)v.voxels)[i] = (int8_t)x; break;
        case VOLUME_UINT16: ((uint16_t *)v.voxels)[i] = (uint16_t)x; break;
        case VOLUME_INT16: ((int16_t *)v.voxels)[i] = (int16_t)x; break;
        case VOLUME_UINT32: ((uint32_t *)v.voxels)[i] = (uint32_t)x; break;
        case VOLUME_INT32: ((int32_t *)v.voxels)[i] = (int32_t)x; break;
        default: ((float *)v.voxels)[i] = (float)x;
        }
        if (isfinite(x)) {
            v.min = fmin(v.min, x * slope + inter);
            v.max = fmax(v.max, x * slope + inter);
        }
    }
    return v;
}

/* 0 to 200, in waves. */
static double waves(int i)
{
    int x = i % SIDE, y = i / SIDE % SIDE, z = i / SIDE / SIDE;
    return floor(100 + 60 * sin(0.5 * x) + 40 * cos(0.4 * y + 0.3 * z));
}

static double waves_below(int i)
{
    return waves(i) - 100;
}

static double waves_falling(int i)
{
    return 200 - waves(i);
}

static double waves_falling_below(int i)
{
    return 100 - waves(i);
}

static void draw(volume v, const char *transfer_name, const char *machine, const camera *eye,
                 const reference_choice *choice, vodr_frame *frame, reference_stats *stats)
{
    scene s;
    reference_scene r;
    host_error error;
    staged_open(&s, &v, transfer_name, machine, eye);
    if (reference_scene_open(&s, choice, 1, VODR_SIMD_BEST, &r, &error) != HOST_OK ||
        reference_scene_draw(&r, frame, stats, &error) != HOST_OK)
        fail_msg("%s", error.text);
    reference_scene_close(&r);
    scene_close(&s);
}

static void draw_machine(volume v, const char *transfer_name, const char *machine, const camera *eye, vodr_frame *frame)
{
    scene s;
    host_error error;
    vodr_error reason;
    vodr_counters counters;
    staged_open(&s, &v, transfer_name, machine, eye);
    assert_int_equal(scene_quantise(&s, &error), HOST_OK);
    assert_int_equal(vodr_render(&s.machine, &s.densities, &s.table, &s.view, NULL, frame, &counters, &reason),
                     VODR_OK);
    scene_close(&s);
}

static int farthest(const vodr_frame *a, const vodr_frame *b)
{
    int most = 0;
    assert_int_equal(a->bytes, b->bytes);
    for (size_t i = 0; i < a->bytes / 2; i++) {
        int apart = abs(((const uint16_t *)a->pixels)[i] - ((const uint16_t *)b->pixels)[i]);
        most = apart > most ? apart : most;
    }
    return most;
}

static bool shows(const vodr_frame *f)
{
    for (size_t i = 0; i < f->bytes; i++)
        if (((const uint8_t *)f->pixels)[i])
            return true;
    return false;
}

static reference_choice choose(reference_method method, reference_numbers numbers)
{
    return (reference_choice){.method = method,
                              .numbers = numbers,
                              .accel = REFERENCE_ACCEL_BEST,
                              .step_vox = 0.7,
                              .block_vox = 4,
                              .termination = 1};
}

/* The same values, however they are stored, give the same picture: to rounding in float, to the byte in `fixed`. */
static void test_types(void **state)
{
    (void)state;
    static const struct {
        volume_type type;
        double slope, inter;
        double (*stored)(int);
    } ways[] = {
        {VOLUME_UINT8, 1, 0, waves},
        {VOLUME_INT8, 1, 100, waves_below},
        {VOLUME_UINT16, 1, 0, waves},
        {VOLUME_INT16, 1, 100, waves_below},
        {VOLUME_UINT32, 1, 0, waves},
        {VOLUME_INT32, 1, 100, waves_below},
        {VOLUME_FLOAT32, 1, 0, waves},
        {VOLUME_FLOAT32, -1, 200, waves_falling},
        {VOLUME_UINT8, -1, 200, waves_falling},
        {VOLUME_INT8, -1, 100, waves_falling_below},
        {VOLUME_UINT16, -1, 200, waves_falling},
        {VOLUME_INT16, -1, 100, waves_falling_below},
    };
    static const char *const machines[] = {"fb_bits=16 tf_bits=16", "fb_bits=16 tf_bits=16 blend=mip"};
    for (int mip = 0; mip < 2; mip++)
        for (int fixed = 0; fixed < 2; fixed++) {
            vodr_frame first = {0}, other;
            reference_stats stats;
            reference_choice choice = choose(REFERENCE_SLICES, REFERENCE_FLOAT);
            choice.fixed = fixed;
            for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
                volume v = make_volume(ways[i].type, ways[i].slope, ways[i].inter, ways[i].stored);
                draw(v, "ramp", machines[mip], &oblique, &choice, i ? &other : &first, &stats);
                if (i == 0)
                    continue;
                int apart = farthest(&first, &other);
                if (apart > (fixed ? 0 : 2))
                    fail_msg("%s, slope %g, mip %d, fixed %d: %d levels of 65535 apart", volume_type_name(ways[i].type),
                             ways[i].slope, mip, fixed, apart);
                vodr_frame_free(&other);
            }
            assert_true(shows(&first));
            vodr_frame_free(&first);
        }
}

static double holes(int i)
{
    return i % 7 == 0 ? NAN : i % 11 == 0 ? INFINITY : i % 13 == 0 ? -INFINITY : waves(i);
}

static double no_holes(int i)
{
    return isfinite(holes(i)) ? waves(i) : 0;
}

/* As the machine does, what is not finite counts as the minimum. */
static void test_nonfinite(void **state)
{
    (void)state;
    static const char machine[] = "fb_bits=16 tf_bits=16";
    for (int way = 0; way < 4; way++) {
        reference_choice choice =
            choose(way == 3 ? REFERENCE_RAYCAST : REFERENCE_SLICES, way == 2 ? REFERENCE_DOUBLE : REFERENCE_FLOAT);
        choice.fixed = way == 0;
        vodr_frame with, without, model;
        reference_stats stats;
        volume full = make_volume(VOLUME_FLOAT32, 1, 0, no_holes), broken = make_volume(VOLUME_FLOAT32, 1, 0, holes);
        float *voxels = full.voxels;
        for (int i = 0; i < COUNT; i++)
            voxels[i] = isfinite(holes(i)) ? voxels[i] : (float)broken.min;
        full.min = broken.min;
        draw(full, "ramp", machine, &oblique, &choice, &without, &stats);
        draw(broken, "ramp", machine, &oblique, &choice, &with, &stats);
        assert_true(shows(&with));
        assert_int_equal(farthest(&with, &without), 0);
        if (choice.fixed) {
            draw_machine(make_volume(VOLUME_FLOAT32, 1, 0, holes), "ramp", machine, &oblique, &model);
            assert_int_equal(farthest(&with, &model), 0);
            vodr_frame_free(&model);
        }
        vodr_frame_free(&with);
        vodr_frame_free(&without);
    }
}

static double below(int i)
{
    return -1000 - i % 3;
}

/* Air under the bone function: nothing shows, and where nothing shows nothing is fetched. (`block` lets rays that go
 * together leave a block together alone, and here hardly any do.) */
static void test_transparent(void **state)
{
    (void)state;
    static const char *const machines[] = {"blend=over", "blend=mip"};
    uint64_t all = 0; /* samples without skipping */
    for (int mip = 0; mip < 2; mip++)
        for (int method = REFERENCE_SLICES; method <= REFERENCE_RAYCAST; method++)
            for (int accel = REFERENCE_ACCEL_NONE; accel <= REFERENCE_ACCEL_BEST; accel++) {
                reference_choice choice = choose((reference_method)method, REFERENCE_FLOAT);
                vodr_frame frame;
                reference_stats stats;
                if (!mip && (accel == REFERENCE_ACCEL_BISECT || accel == REFERENCE_ACCEL_SEED))
                    continue; /* of the maximum alone */
                choice.accel = (reference_accel)accel;
                draw(make_volume(VOLUME_INT16, 1, 0, below), "bone", machines[mip], &oblique, &choice, &frame, &stats);
                assert_false(shows(&frame));
                if (accel == REFERENCE_ACCEL_NONE)
                    all = stats.samples;
                assert_true(all > 0);
                assert_true(mip || stats.samples <= all);
                if (accel == REFERENCE_ACCEL_BEST && !mip)
                    assert_int_equal(stats.samples, 0);
                vodr_frame_free(&frame);
            }
}

/* ---- a ramp, one slice of it ---- */

static double rising_along_x(int i)
{
    return i % SIDE;
}

static double rising_along_z(int i)
{
    return i / (SIDE * SIDE);
}

/* The middle pixel of the middle slice, of a job changed by `change`. */
static void sample_middle(double (*stored)(int), const double *table, int32_t rows, double gradient_most,
                          reference_shading shading, double rgba[4])
{
    static double frame[4 * PIXELS];
    scene s;
    reference_scene r;
    reference_stats stats;
    host_error error;
    vodr_error reason;
    camera eye = ahead;
    eye.slices = 1;
    volume v = make_volume(VOLUME_UINT8, 1, 0, stored);
    const reference_choice choice = choose(REFERENCE_SLICES, REFERENCE_DOUBLE);
    staged_open(&s, &v, "ramp", "traversal=whole", &eye);
    assert_int_equal(reference_scene_open(&s, &choice, 1, VODR_SIMD_BEST, &r, &error), HOST_OK);
    reference_march_job job = r.job;
    job.shading = shading;
    job.table = (reference_table){2, rows, table, gradient_most};
    if (reference_march(r.renderer, &job, frame, &stats, &reason) != REFERENCE_OK)
        fail_msg("%s", reason.text);
    memcpy(rgba, frame + 4 * (PIXELS / 2 + SIDE / 2), 4 * sizeof *rgba);
    reference_scene_close(&r);
    scene_close(&s);
}

static void assert_near(const double got[4], double red, double green, double blue, double alpha)
{
    const double want[4] = {red, green, blue, alpha};
    for (int c = 0; c < 4; c++)
        if (!(fabs(got[c] - want[c]) < 1e-9))
            fail_msg("channel %d is %.12g, not %.12g", c, got[c], want[c]);
}

/* Where the eye looks down a gradient, a surface is lit in full: 0.9 of its colour, and 0.3 of its opacity shine; where
 * it looks along the surface, 0.3 of its colour is left. */
static void test_phong(void **state)
{
    (void)state;
    static const double table[] = {0.2, 0.1, 0, 0.4, 0.2, 0.1, 0, 0.4};
    double rgba[4];
    sample_middle(rising_along_z, table, 1, 0, REFERENCE_UNLIT, rgba);
    assert_near(rgba, 0.2, 0.1, 0, 0.4);
    sample_middle(rising_along_z, table, 1, 0, REFERENCE_PHONG, rgba);
    assert_near(rgba, 0.2 * 0.9 + 0.12, 0.1 * 0.9 + 0.12, 0.12, 0.4);
    sample_middle(rising_along_x, table, 1, 0, REFERENCE_PHONG, rgba);
    assert_near(rgba, 0.06, 0.03, 0, 0.4);
}

/* The ramp climbs 1/23 of the window a voxel: 3/4 of the way from the first row of a table to the second. */
static void test_two_dimensions(void **state)
{
    (void)state;
    static const double table[] = {0, 0, 0, 0, 0, 0, 0, 0, 0.4, 0.2, 0, 0.8, 0.4, 0.2, 0, 0.8};
    double rgba[4];
    sample_middle(rising_along_x, table, 2, 1.0 / (SIDE - 1) * 4 / 3, REFERENCE_UNLIT, rgba);
    assert_near(rgba, 0.3, 0.15, 0, 0.6);
}

/* ---- refusals ---- */

static void test_refusals(void **state)
{
    (void)state;
    scene s;
    reference_scene r;
    reference_stats stats;
    host_error error;
    vodr_error reason;
    static double frame[4 * PIXELS];
    volume v = make_volume(VOLUME_UINT8, 1, 0, waves);
    const reference_choice choice = choose(REFERENCE_SLICES, REFERENCE_FLOAT);
    staged_open(&s, &v, "ramp", "traversal=whole", &ahead);
    assert_int_equal(reference_scene_open(&s, &choice, 1, VODR_SIMD_BEST, &r, &error), HOST_OK);
    reference_march_job job = r.job;
    job.block_vox = 1;
    assert_int_equal(reference_march(r.renderer, &job, frame, &stats, &reason), REFERENCE_INVALID);
    assert_non_null(strstr(reason.text, "block"));
    job = r.job;
    job.table.columns = 1;
    assert_int_equal(reference_march(r.renderer, &job, frame, &stats, &reason), REFERENCE_INVALID);
    assert_non_null(strstr(reason.text, "table"));
    vodr_view view = s.view;
    view.slices = 0;
    vodr_frame none;
    vodr_rgba entries[256] = {{0}};
    const vodr_table table = {entries, 256};
    assert_int_equal(reference_fixed(r.renderer, &s.machine, NULL, &table, &view, &none, &stats, &reason),
                     REFERENCE_INVALID);
    assert_non_null(strstr(reason.text, "slices"));
    assert_null(none.pixels);
    reference_scene_close(&r);
    scene_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_types), cmocka_unit_test(test_nonfinite),      cmocka_unit_test(test_transparent),
        cmocka_unit_test(test_phong), cmocka_unit_test(test_two_dimensions), cmocka_unit_test(test_refusals),
    };
    return cmocka_run_group_tests_name("reference scene", tests, NULL, NULL);
}
