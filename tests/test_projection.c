/* test_projection.c - no fragment lies outside the bound of its box (cmodel/projection.h): every fragment of small
 * frames, and single fragments of the largest frames and of matrices that hardly have an inverse. */
#include "projection.h"

#include <stdlib.h>

#include "lib/unit.h"

static vox_box random_box(rng *c, const int32_t dims[3])
{
    vox_box box;
    for (int i = 0; i < 3; i++) {
        box.lo[i] = (int32_t)rng_int(c, 0, dims[i] - 1);
        box.hi[i] = (int32_t)rng_int(c, box.lo[i] + 1, dims[i]);
    }
    return box;
}

static px_rect random_clip(rng *c, const vodr_view *v)
{
    px_rect clip = {0, 0, v->width_px, v->height_px};
    if (rng_one_in(c, 2))
        return clip;
    clip.x0 = (int32_t)rng_int(c, 0, v->width_px - 1);
    clip.y0 = (int32_t)rng_int(c, 0, v->height_px - 1);
    clip.x1 = (int32_t)rng_int(c, clip.x0 + 1, v->width_px);
    clip.y1 = (int32_t)rng_int(c, clip.y0 + 1, v->height_px);
    return clip;
}

static bool in_rect(const px_rect *r, int32_t x, int32_t y)
{
    return x >= r->x0 && x < r->x1 && y >= r->y0 && y < r->y1;
}

/* Position of every sample of the frame, x fastest, then y, then k. */
static int64_t (*all_positions(const vodr_view *v))[3]
{
    int64_t(*all)[3] = malloc((size_t)v->width_px * (size_t)v->height_px * (size_t)v->slices * sizeof *all),
    (*p)[3] = all;
    assert_non_null(all);
    for (int32_t k = 0; k < v->slices; k++)
        for (int32_t y = 0; y < v->height_px; y++)
            for (int32_t x = 0; x < v->width_px; x++)
                unit_position(v, x, y, k, *p++);
    return all;
}

/* Returns how many fragments the box has within the clip. */
static int check_box(const vodr_view *v, const int32_t dims[3], int64_t (*position)[3], const vox_box *box,
                     const px_rect *clip)
{
    projection p = projection_of(v, dims);
    px_rect bound;
    int32_t k0, k1;
    bool seen = projection_bound(&p, box, clip, &bound, &k0, &k1);
    int fragments = 0;
    if (seen)
        assert_true(bound.x0 >= clip->x0 && bound.y0 >= clip->y0 && bound.x1 <= clip->x1 && bound.y1 <= clip->y1 &&
                    k0 >= 0 && k1 <= v->slices);
    for (int32_t k = 0; k < v->slices; k++)
        for (int32_t y = 0; y < v->height_px; y++)
            for (int32_t x = 0; x < v->width_px; x++, position++) {
                if (!in_rect(clip, x, y) || !unit_inside(*position, box->lo, box->hi))
                    continue;
                fragments++;
                if (!seen || !in_rect(&bound, x, y) || k < k0 || k >= k1)
                    fail_msg("the fragment of pixel (%d,%d) on slice %d lies outside", x, y, k);
            }
    return fragments;
}

static void small_frames(void **state)
{
    (void)state;
    rng c = {81};
    int hit = 0;
    for (int round = 0; round < 600; round++) {
        const int32_t dims[3] = {(int32_t)rng_int(&c, 1, 40), (int32_t)rng_int(&c, 1, 40), (int32_t)rng_int(&c, 1, 40)};
        volume geometry = unit_volume(dims[0], dims[1], dims[2]);
        bool perspective = rng_one_in(&c, 2);
        vodr_view v =
            rng_one_in(&c, 2) ? unit_camera_view(&c, &geometry, perspective) : views_wild(&c, dims, perspective);
        int64_t(*positions)[3] = all_positions(&v);
        for (int n = 0; n < 12; n++) {
            vox_box box = random_box(&c, dims);
            for (int i = 0; i < 3 && n == 0 && perspective; i++) { /* the brick that the eye is in, if it is in one */
                int64_t eye = v.base[i] >> 24;
                box.lo[i] = eye >= 0 && eye < dims[i] ? (int32_t)eye : box.lo[i];
                box.hi[i] = eye >= 0 && eye < dims[i] ? (int32_t)eye + 1 : box.hi[i];
            }
            px_rect clip = random_clip(&c, &v);
            hit += check_box(&v, dims, positions, &box, &clip) > 0;
        }
        free(positions);
    }
    assert_true(hit > 1000);
}

/* A view whose three directions lie almost in a plane, or whose pixels and slices are far smaller than a voxel. */
static vodr_view extreme_view(rng *c, const int32_t dims[3], bool perspective)
{
    for (;;) {
        vodr_view v = views_wild(c, dims, perspective);
        v.width_px = (int32_t)rng_int(c, 1, VODR_MAX_SIZE_PX);
        v.height_px = (int32_t)rng_int(c, 1, VODR_MAX_SIZE_PX);
        v.slices = (int32_t)rng_int(c, 1, VODR_MAX_SLICES);
        if (perspective)
            v.depth_step = -(rng_int(c, 0, v.depth_first / v.slices) >> (rng_one_in(c, 4) ? rng_int(c, 0, 40) : 0));
        bool flat = rng_one_in(c, 4), noise = rng_one_in(c, 2);
        int fine = (int)rng_int(c, 0, 14), near = rng_one_in(c, 4) ? (int)rng_int(c, 0, 30) : 0;
        for (int i = 0; i < 3; i++) {
            v.step_s[i] >>= near;
            v.step_u[i] >>= fine;
            v.step_v[i] >>= fine;
            if (rng_one_in(c, 2))
                v.step_v[i] = 3 * v.step_u[i] + rng_signed(c, 12);
        }
        for (int i = 0; i < 3 && flat; i++)
            v.step_s[i] = v.step_u[i] + v.step_v[i] + noise * rng_int(c, -1, 1);
        if (vodr_view_check(&v, dims, NULL) == VODR_OK)
            return v;
    }
}

/* As long as so many bits allow, or any shorter one. */
static int64_t long_step(rng *c, int bits, bool any)
{
    int64_t limit = (int64_t)1 << bits, step = limit - rng_int(c, 1, limit / 4);
    return any ? rng_signed(c, bits) : rng_one_in(c, 2) ? step : -step;
}

/* Frames of one pixel and one slice say nothing about their steps: these are as long as the inverse takes, and longer.
 */
static vodr_view single_sample_view(rng *c, const int32_t dims[3], bool perspective)
{
    for (;;) {
        vodr_view v = views_wild(c, dims, perspective);
        bool any = rng_one_in(c, 2);
        int bits = (int)rng_int(c, 40, 43);
        v.width_px = v.height_px = v.slices = 1;
        if (perspective)
            v.depth_first = rng_int(c, 1, 3) << 16;
        for (int i = 0; i < 3; i++) {
            v.base[i] = rng_signed(c, 42);
            v.step_u[i] = long_step(c, bits, any);
            v.step_v[i] = long_step(c, bits, any);
            v.step_s[i] = long_step(c, bits, any);
        }
        if (vodr_view_check(&v, dims, NULL) == VODR_OK)
            return v;
    }
}

static bool in_volume(const int64_t position[3], const int32_t dims[3])
{
    const int32_t origin[3] = {0, 0, 0};
    return unit_inside(position, origin, dims);
}

/* Samples of one view; returns how many lay in the volume. */
static int check_samples(rng *c, const vodr_view *v, const int32_t dims[3], int round)
{
    projection p = projection_of(v, dims);
    px_rect frame = {0, 0, v->width_px, v->height_px}, bound;
    int fragments = 0;
    for (int n = 0; n < 20; n++) {
        int32_t x = (int32_t)rng_int(c, 0, v->width_px - 1), y = (int32_t)rng_int(c, 0, v->height_px - 1);
        int32_t k = (int32_t)rng_int(c, 0, v->slices - 1), k0, k1;
        int64_t position[3];
        unit_position(v, x, y, k, position);
        if (!in_volume(position, dims))
            continue;
        fragments++;
        vox_box box;
        for (int i = 0; i < 3; i++) { /* any box that holds the sample */
            int32_t voxel = (int32_t)(position[i] >> 24);
            box.lo[i] = (int32_t)rng_int(c, voxel > n ? voxel - n : 0, voxel);
            box.hi[i] = (int32_t)rng_int(c, voxel + 1, voxel + 1 + n < dims[i] ? voxel + 1 + n : dims[i]);
        }
        if (!projection_bound(&p, &box, &frame, &bound, &k0, &k1) || !in_rect(&bound, x, y) || k < k0 || k >= k1)
            fail_msg("view %d: the fragment of pixel (%d,%d) on slice %d lies outside", round, x, y, k);
    }
    return fragments;
}

/* Whether a box can be bounded at all. */
static bool inverted(const vodr_view *v, const int32_t dims[3])
{
    projection p = projection_of(v, dims);
    return p.x.m[0] || p.x.m[1] || p.x.m[2];
}

static void extreme_frames(void **state)
{
    (void)state;
    rng c = {82};
    int usable = 0, fragments = 0, single = 0;
    for (int round = 0; round < 40000; round++) {
        const int32_t largest = rng_one_in(&c, 2) ? 64 : VODR_MAX_DIM_VOX;
        const int32_t dims[3] = {largest, (int32_t)rng_int(&c, 1, largest), (int32_t)rng_int(&c, 1, largest)};
        vodr_view v = extreme_view(&c, dims, rng_one_in(&c, 2));
        usable += inverted(&v, dims);
        fragments += check_samples(&c, &v, dims, round);
        v = single_sample_view(&c, dims, rng_one_in(&c, 2));
        single += inverted(&v, dims) && check_samples(&c, &v, dims, round) > 0;
    }
    assert_true(usable > 10000 && fragments > 10000 && single > 100);
}

/* It must save work, too: a brick of a plain view is bounded to its own pixels and slices. */
static void bounds_are_close(void **state)
{
    (void)state;
    volume geometry = unit_volume(64, 64, 64);
    camera cam = camera_default();
    vodr_view v;
    double depth;
    host_error error;
    for (int perspective = 0; perspective < 2; perspective++) {
        cam.perspective = perspective;
        assert_int_equal(camera_view(&cam, &geometry, &v, &depth, &error), HOST_OK);
        projection p = projection_of(&v, geometry.dims_vox);
        const vox_box box = {{24, 32, 40}, {32, 40, 48}};
        px_rect frame = {0, 0, 64, 64}, bound;
        int32_t k0, k1;
        assert_true(projection_bound(&p, &box, &frame, &bound, &k0, &k1));
        int32_t most = perspective ? 11 : 8; /* the brick's own 8, or as it looks near the eye */
        assert_true(bound.x1 - bound.x0 <= most && bound.y1 - bound.y0 <= most && k1 - k0 <= 8);
        const px_rect aside = {0, 0, 8, 8};
        assert_false(projection_bound(&p, &box, &aside, &bound, &k0, &k1));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(small_frames),
        cmocka_unit_test(extreme_frames),
        cmocka_unit_test(bounds_are_close),
    };
    return cmocka_run_group_tests_name("projection", tests, NULL, NULL);
}
