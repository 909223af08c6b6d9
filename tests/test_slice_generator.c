/* test_slice_generator.c - planes, borders and order of slices (docs/architecture.md, sections 2, 3 and 5). */
#include "slice_generator.h"

#include "lib/unit.h"

/* At every pixel of the slice: lo <= A < hi on an axis exactly where the position lies between the box's borders. */
static void check_slice(const vodr_view *v, const vox_box *box, const brick_slice *s)
{
    for (int32_t y = 0; y < v->height_px; y++)
        for (int32_t x = 0; x < v->width_px; x++) {
            int64_t position[3];
            unit_position(v, x, y, s->k, position);
            for (int c = 0; c < 3; c++) {
                wide_int a = s->plane.origin[c] + (wide_int)x * s->plane.step_u[c] + (wide_int)y * s->plane.step_v[c];
                bool below = position[c] < (int64_t)box->lo[c] * (1 << 24);
                bool above = position[c] >= (int64_t)box->hi[c] * (1 << 24);
                assert_int_equal(a < s->lo[c], below);
                assert_int_equal(a >= s->hi[c], above);
            }
        }
}

static void slices_of_random_boxes(void **state)
{
    (void)state;
    rng c = {41};
    for (int round = 0; round < 3000; round++) {
        const int32_t dims[3] = {(int32_t)rng_int(&c, 1, 60), (int32_t)rng_int(&c, 1, 60), (int32_t)rng_int(&c, 1, 60)};
        volume geometry = unit_volume(dims[0], dims[1], dims[2]);
        bool perspective = rng_one_in(&c, 2), front_to_back = rng_one_in(&c, 2);
        vodr_view v =
            rng_one_in(&c, 2) ? unit_camera_view(&c, &geometry, perspective) : views_wild(&c, dims, perspective);
        vox_box box;
        for (int i = 0; i < 3; i++) {
            box.lo[i] = (int32_t)rng_int(&c, 0, dims[i] - 1);
            box.hi[i] = (int32_t)rng_int(&c, box.lo[i] + 1, dims[i]);
        }
        int32_t k0 = (int32_t)rng_int(&c, 0, v.slices), k1 = (int32_t)rng_int(&c, k0, v.slices);
        slice_generator g = slice_generator_start(&v, &box, k0, k1, front_to_back);
        brick_slice s;
        for (int32_t k = k0; k < k1; k++) {
            assert_true(slice_generator_next(&g, &s));
            assert_int_equal(s.k, front_to_back ? k1 - 1 - (k - k0) : k);
            check_slice(&v, &box, &s);
        }
        assert_false(slice_generator_next(&g, &s));
        assert_false(slice_generator_next(&g, &s));
    }
}

/* A slice is one plane in every brick: the borders differ, the plane does not. */
static void planes_are_global(void **state)
{
    (void)state;
    vodr_view v = {.width_px = 4,
                   .height_px = 4,
                   .slices = 5,
                   .perspective = true,
                   .shift = 3,
                   .footprint = 1,
                   .base = {-7, 3 << 24, 99},
                   .step_s = {11, -5, 1},
                   .step_u = {2, 0, 0},
                   .step_v = {0, 3, 1},
                   .depth_first = 100 << 16 | 0xFFFF,
                   .depth_step = -(10 << 16)};
    const vox_box far = {{0, 0, 0}, {8, 8, 8}}, near = {{8, 0, 0}, {16, 8, 8}};
    slice_generator f = slice_generator_start(&v, &far, 2, 3, false);
    slice_generator n = slice_generator_start(&v, &near, 2, 3, true);
    brick_slice a, b;
    assert_true(slice_generator_next(&f, &a) && slice_generator_next(&n, &b));
    assert_memory_equal(&a.plane, &b.plane, sizeof a.plane);
    assert_int_equal(a.plane.origin[0], 80 * 11); /* depth 100 - 2*10, its fraction dropped */
    assert_int_equal(a.plane.step_v[1], 80 * 3);
    assert_int_equal(a.lo[0], 7 * 8);
    assert_int_equal(a.hi[0], (((int64_t)8 << 24) + 7) * 8);
    assert_int_equal(b.lo[0], a.hi[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slices_of_random_boxes),
        cmocka_unit_test(planes_are_global),
    };
    return cmocka_run_group_tests_name("slice_generator", tests, NULL, NULL);
}
