/* test_screen.c - screen_map_of(): every sample of a view is seen at its own pixel's centre, at its own depth. */
#include "screen.h"

#include <math.h>

#include "lib/unit.h"

/* Where the map puts sample (x, y, k), against the pixel's centre; W against the slice's depth. */
static void check_sample(const vodr_view *v, const screen_map *m, int32_t x, int32_t y, int32_t k)
{
    int64_t position[3];
    double at[3], w = v->perspective ? (double)((v->depth_first + k * v->depth_step) >> VODR_DEPTH_BITS) : 1;
    unit_position(v, x, y, k, position);
    for (int row = 0; row < 3; row++) {
        at[row] = m->row[row][3];
        for (int i = 0; i < 3; i++)
            at[row] += m->row[row][i] * ldexp((double)position[i], -VODR_POSITION_BITS);
    }
    assert_true(fabs(at[0] / at[2] - (x + 0.5)) < 0.01);
    assert_true(fabs(at[1] / at[2] - (y + 0.5)) < 0.01);
    assert_true(fabs(at[2] / w - 1) < 1e-3);
    assert_true(at[2] >= m->near * (1 - 1e-3));
}

static void check_views(bool perspective)
{
    rng c = {perspective ? 2 : 1};
    for (int i = 0; i < 200; i++) {
        volume box =
            unit_volume((int32_t)rng_int(&c, 1, 300), (int32_t)rng_int(&c, 1, 300), (int32_t)rng_int(&c, 1, 300));
        vodr_view view = unit_camera_view(&c, &box, perspective);
        screen_map map = screen_map_of(&view);
        for (int sample = 0; sample < 50; sample++)
            check_sample(&view, &map, (int32_t)rng_int(&c, 0, view.width_px - 1),
                         (int32_t)rng_int(&c, 0, view.height_px - 1), (int32_t)rng_int(&c, 0, view.slices - 1));
    }
}

static void test_parallel(void **state)
{
    (void)state;
    check_views(false);
}

static void test_perspective(void **state)
{
    (void)state;
    check_views(true);
}

/* A view that squeezes the volume into a plane is no reason to divide by zero. */
static void test_degenerate(void **state)
{
    (void)state;
    vodr_view view = {.width_px = 4, .height_px = 4, .slices = 4, .step_u = {1 << 24, 0, 0}, .step_s = {0, 0, 1 << 24}};
    screen_map map = screen_map_of(&view);
    for (int row = 0; row < 3; row++)
        for (int i = 0; i < 4; i++)
            assert_true(map.row[row][i] == 0);
    assert_true(map.near > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_parallel),
        cmocka_unit_test(test_perspective),
        cmocka_unit_test(test_degenerate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
