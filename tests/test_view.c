/* test_view.c - which registers the machine accepts: every limit from both sides (docs/architecture.md, section 2). */
#include "view.h"

#include <string.h>

#include "lib/unit.h"

static const int32_t dims[3] = {16, 16, 16};

static vodr_view parallel(void)
{
    return (vodr_view){.width_px = 11, .height_px = 11, .slices = 11, .footprint = 1 << 20};
}

static vodr_view perspective(void)
{
    vodr_view v = parallel();
    v.perspective = true;
    v.shift = 10;
    v.depth_first = 1000 << 16;
    v.depth_step = -(1 << 16);
    return v;
}

static void assert_accepted(const vodr_view *v)
{
    vodr_error error = {"accepted"};
    if (vodr_view_check(v, dims, &error) != VODR_OK)
        fail_msg("%s", error.text);
}

static void assert_refused(const vodr_view *v, const char *sentence)
{
    vodr_error error = {"accepted"};
    if (vodr_view_check(v, dims, &error) != VODR_INVALID || !strstr(error.text, sentence))
        fail_msg("'%s' does not say '%s'", error.text, sentence);
    assert_int_equal(vodr_view_check(v, dims, NULL), VODR_INVALID);
}

static void sizes(void **state)
{
    (void)state;
    static const struct {
        int32_t width, height, slices;
        const char *sentence;
    } cases[] = {{0, 1, 1, "the frame is 0x1 pixels but must be 1x1 to 16384x16384"},
                 {1, 0, 1, "the frame is 1x0 pixels"},
                 {-1, 1, 1, "the frame is -1x1 pixels"},
                 {16385, 1, 1, "the frame is 16385x1 pixels"},
                 {1, INT32_MAX, 1, "the frame is 1x2147483647 pixels"},
                 {1, 1, 0, "the view has 0 slices but must have 1 to 16384"},
                 {1, 1, 16385, "the view has 16385 slices"},
                 {1, 1, INT32_MIN, "the view has -2147483648 slices"},
                 {1, 1, 1, NULL},
                 {16384, 16384, 16384, NULL}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        vodr_view v = parallel();
        v.width_px = cases[i].width;
        v.height_px = cases[i].height;
        v.slices = cases[i].slices;
        if (cases[i].sentence)
            assert_refused(&v, cases[i].sentence);
        else
            assert_accepted(&v);
    }
}

static void small_registers(void **state)
{
    (void)state;
    vodr_view v = parallel();
    v.footprint = 0;
    assert_refused(&v, "footprint is 0 but must be at least 1");
    v = parallel();
    v.shift = 1;
    assert_refused(&v, "shift is 1 but must be 0 in a parallel view");
    v = perspective();
    v.shift = 31;
    assert_refused(&v, "shift is 31 but must be 0 to 30");
    v.shift = -1;
    assert_refused(&v, "shift is -1 but must be 0 to 30");
    v.shift = 30;
    assert_accepted(&v);
    v.shift = 0;
    assert_accepted(&v);
}

static void depths(void **state)
{
    (void)state;
    vodr_view v = perspective();
    v.depth_step = 1;
    assert_refused(&v, "the step zero or negative");
    v = perspective();
    v.depth_step = 0;
    assert_accepted(&v);
    v.depth_step = -(99 << 16) - (58982); /* 1000 - 10*99.9: depth 1, the fraction dropped */
    assert_accepted(&v);
    v.depth_step = -(100 << 16); /* depth 0 */
    assert_refused(&v, "slice 10 has depth 0 but must be in front of the eye");
    v.depth_step = INT64_MIN;
    assert_refused(&v, "depth_step -9223372036854775808");
    v = perspective();
    v.depth_first = INT64_MAX;
    assert_refused(&v, "depth_first 9223372036854775807");
    v.depth_first = INT64_MIN;
    assert_refused(&v, "depth_first -9223372036854775808");
}

static void positions_at_the_corners(void **state)
{
    (void)state;
    const int64_t limit = (int64_t)1 << 42;
    for (int c = 0; c < 3; c++)
        for (int sign = -1; sign <= 1; sign += 2) {
            vodr_view v = parallel();
            v.base[c] = sign * (limit - 1);
            assert_accepted(&v);
            v.base[c] = sign * limit;
            assert_refused(&v, "base_");
            int64_t *const steps[] = {v.step_u, v.step_v, v.step_s};
            v.base[c] = sign * (limit - 1 - 10);
            for (int s = 0; s < 3; s++) {
                steps[s][c] = sign; /* ten steps of one unit reach the last position that fits */
                assert_accepted(&v);
                steps[s][c] = 2 * sign;
                assert_refused(&v, "does not fit Q19.24");
                steps[s][c] = 0;
            }
        }
    vodr_view v = parallel();
    v.step_u[1] = (int64_t)1 << 40;
    assert_refused(&v, "the y position of pixel (10,0) on slice 0 does not fit Q19.24");
}

/* Products that 64 bits cannot hold are found, whatever their sum would have wrapped to. */
static void overflows(void **state)
{
    (void)state;
    static const int64_t huge[] = {INT64_MAX,        INT64_MIN,           INT64_MIN + 1,
                                   (int64_t)1 << 62, -((int64_t)1 << 62), (int64_t)1 << 60};
    for (int projection = 0; projection < 2; projection++)
        for (int c = 0; c < 3; c++)
            for (size_t i = 0; i < sizeof huge / sizeof *huge; i++)
                for (int s = 0; s < 4; s++) {
                    vodr_view v = projection ? perspective() : parallel();
                    int64_t *const registers[] = {v.base, v.step_u, v.step_v, v.step_s};
                    registers[s][c] = huge[i];
                    assert_refused(&v, "fit");
                }
    /* Two steps that cancel at the far corner still pass through numerators of 62 bits. */
    vodr_view v = perspective();
    v.step_u[0] = ((int64_t)1 << 62) / 1000 / 10 + 1;
    v.step_v[0] = -v.step_u[0];
    assert_refused(&v, "does not fit Q19.24");
}

/* Both borders of the volume must be numerators: (border - base) * 2^shift below 2^62. */
static void borders(void **state)
{
    (void)state;
    vodr_view v = perspective();
    v.shift = 30;
    v.base[2] = -((int64_t)1 << 32) + ((int64_t)16 << 24) + 1; /* 16 voxels - base = 2^32 - 1 */
    assert_accepted(&v);
    v.base[2]--;
    assert_refused(&v, "base_z -4026531840 with shift 30 does not fit its format");
    v.base[2] = ((int64_t)1 << 32) - 1;
    assert_accepted(&v);
    v.base[2]++;
    assert_refused(&v, "base_z 4294967296 with shift 30 does not fit its format");
}

/* What is accepted can be computed: no numerator or position leaves its format anywhere in the frame. */
static void accepted_views_fit_everywhere(void **state)
{
    (void)state;
    rng c = {61};
    const wide_int limit = (wide_int)1 << 62;
    int accepted = 0;
    for (int round = 0; round < 200000; round++) {
        vodr_view v = round & 1 ? perspective() : parallel();
        v.shift = v.perspective ? (int32_t)rng_int(&c, 0, 30) : 0;
        for (int i = 0; i < 3; i++) {
            v.base[i] = rng_signed(&c, 44);
            v.step_u[i] = rng_signed(&c, 64);
            v.step_v[i] = rng_signed(&c, 64);
            v.step_s[i] = rng_signed(&c, 64);
        }
        if (vodr_view_check(&v, dims, NULL) != VODR_OK)
            continue;
        accepted++;
        for (int n = 0; n < 8; n++) {
            int32_t k = n & 1 ? 10 : (int32_t)rng_int(&c, 0, 10);
            int32_t x = n & 2 ? 10 : (int32_t)rng_int(&c, 0, 10), y = n & 4 ? 10 : (int32_t)rng_int(&c, 0, 10);
            wide_int z = v.perspective ? 1000 - k : 1;
            for (int i = 0; i < 3; i++) {
                wide_int a = (v.perspective ? z : k) * v.step_s[i] + x * z * v.step_u[i] + y * z * v.step_v[i];
                assert_true(a > -limit && a < limit);
                wide_int position = v.base[i] + (a >> v.shift);
                assert_true(position > -((wide_int)1 << 42) && position < (wide_int)1 << 42);
            }
        }
    }
    assert_true(accepted > 500);
}

/* Registers go by name: in, and out again; one of the volume is read, and no field of the view. */
static void registers_by_name(void **state)
{
    (void)state;
    vodr_view v = {.width_px = 3};
    int64_t value = -1;
    assert_true(vodr_register_set("step_u_y", -5, &v));
    assert_int_equal(v.step_u[1], -5);
    assert_true(vodr_register_get("step_u_y", &v, dims, &value));
    assert_int_equal(value, -5);
    assert_true(vodr_register_set("perspective", 1, &v));
    assert_true(v.perspective);
    assert_false(vodr_register_set("perspective", 2, &v));
    assert_false(vodr_register_set("footprint", (int64_t)1 << 32, &v));
    assert_true(vodr_register_get("dim_z", &v, dims, &value));
    assert_int_equal(value, 16);
    assert_false(vodr_register_set("dim_z", 7, &v));
    assert_false(vodr_register_set("coffee", 1, &v));
    assert_false(vodr_register_get("coffee", &v, dims, &value));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sizes),
        cmocka_unit_test(small_registers),
        cmocka_unit_test(depths),
        cmocka_unit_test(positions_at_the_corners),
        cmocka_unit_test(overflows),
        cmocka_unit_test(borders),
        cmocka_unit_test(accepted_views_fit_everywhere),
        cmocka_unit_test(registers_by_name),
    };
    return cmocka_run_group_tests_name("view", tests, NULL, NULL);
}
