#include "views.h"

/* Directions are in 1/norm of a voxel: right, down and towards the eye, as columns. */
typedef struct turn {
    int64_t right[3], down[3], eye[3], norm;
} turn;

static turn turn_of(const int32_t q[4])
{
    const int64_t w = q[0], x = q[1], y = q[2], z = q[3];
    return (turn){.right = {w * w + x * x - y * y - z * z, 2 * (x * y + w * z), 2 * (x * z - w * y)},
                  .down = {-2 * (x * y - w * z), -(w * w - x * x + y * y - z * z), -2 * (y * z + w * x)},
                  .eye = {2 * (x * z + w * y), 2 * (y * z - w * x), w * w - x * x - y * y + z * z},
                  .norm = w * w + x * x + y * y + z * z};
}

static int64_t floor_div(int64_t a, int64_t b)
{
    return a / b - (a % b < 0);
}

/* Units of 1/norm of the volume's extent along the view. */
static int64_t depth_of(const turn *t, const int32_t dims_vox[3])
{
    int64_t depth = 0;
    for (int c = 0; c < 3; c++)
        depth += (t->eye[c] < 0 ? -t->eye[c] : t->eye[c]) * dims_vox[c];
    return depth;
}

enum { DEPTH_BITS = 8, SHIFT = 8, STEP_BITS = VODR_POSITION_BITS + SHIFT - DEPTH_BITS };

/* Distances from the eye have DEPTH_BITS fraction bits, and depth registers as many as positions: products with steps
 * have SHIFT bits to lose. */
static void set_perspective(const views_camera *c, const turn *t, const int32_t dims_vox[3], vodr_view *v)
{
    const int64_t one = (int64_t)1 << (DEPTH_BITS + VODR_DEPTH_BITS);
    int64_t distance = one * c->focal_px * c->across / c->pixels, depth = depth_of(t, dims_vox) * one / t->norm;
    int64_t near = distance - depth / 2, far = distance + depth / 2;
    near = near < one ? one : near;
    far = far < near ? near : far;
    v->perspective = true;
    v->shift = SHIFT;
    v->depth_step = -((far - near) / c->slices);
    v->depth_first = far + v->depth_step / 2;
    for (int i = 0; i < 3; i++) {
        const int64_t unit = (int64_t)1 << STEP_BITS, across = t->norm * c->focal_px;
        v->step_u[i] = floor_div(t->right[i] * unit, across);
        v->step_v[i] = floor_div(t->down[i] * unit, across);
        v->step_s[i] = floor_div((1 - c->width_px) * v->step_u[i] + (1 - c->height_px) * v->step_v[i], 2) -
                       floor_div(t->eye[i] * unit, t->norm);
        v->base[i] = ((int64_t)dims_vox[i] << (VODR_POSITION_BITS - 1)) + floor_div(t->eye[i] * distance, t->norm);
    }
}

static void set_parallel(const views_camera *c, const turn *t, const int32_t dims_vox[3], vodr_view *v)
{
    const int64_t unit = (int64_t)1 << VODR_POSITION_BITS, pixel = unit * c->across / c->pixels;
    const int64_t slice = depth_of(t, dims_vox) * unit / t->norm / c->slices;
    for (int i = 0; i < 3; i++) {
        v->step_u[i] = floor_div(t->right[i] * pixel, t->norm);
        v->step_v[i] = floor_div(t->down[i] * pixel, t->norm);
        v->step_s[i] = floor_div(t->eye[i] * slice, t->norm);
        int64_t half =
            (1 - c->width_px) * v->step_u[i] + (1 - c->height_px) * v->step_v[i] + (1 - c->slices) * v->step_s[i];
        v->base[i] = ((int64_t)dims_vox[i] << (VODR_POSITION_BITS - 1)) + floor_div(half, 2);
    }
}

bool views_of_camera(const views_camera *c, const int32_t dims_vox[3], vodr_view *view)
{
    const turn t = turn_of(c->quaternion);
    int64_t footprint = ((int64_t)2 << VODR_FOOTPRINT_BITS) * c->pixels / c->across;
    *view = (vodr_view){.width_px = c->width_px,
                        .height_px = c->height_px,
                        .slices = c->slices,
                        .footprint = (uint32_t)(footprint < 1 ? 1 : footprint)};
    if (c->perspective)
        set_perspective(c, &t, dims_vox, view);
    else
        set_parallel(c, &t, dims_vox, view);
    return vodr_view_check(view, dims_vox, NULL) == VODR_OK;
}

/* ---- random ones ---- */

static int64_t wild_step(rng *r, int bits)
{
    return rng_one_in(r, 8) ? 0 : rng_signed(r, bits);
}

/* Steps are shorter by some bits where frames are larger, or hardly any view would be legal. */
static vodr_view wild(rng *r, const int32_t dims_vox[3], bool perspective, int32_t most_px, int shorter_bits)
{
    for (;;) {
        vodr_view v = {.width_px = (int32_t)rng_int(r, 1, most_px),
                       .height_px = (int32_t)rng_int(r, 1, most_px),
                       .slices = (int32_t)rng_int(r, 1, most_px),
                       .perspective = perspective,
                       .shift = perspective ? (int32_t)rng_int(r, 0, 30) : 0,
                       .footprint = 1u << rng_int(r, 14, 24)};
        int depth_bits = (int)rng_int(r, 1, 23), step_bits = 28 - shorter_bits / 4;
        if (perspective) {
            v.depth_first = rng_int(r, 1 << 16, ((int64_t)2 << 16) << depth_bits);
            v.depth_step = -rng_int(r, 0, (v.depth_first - (1 << 16)) / v.slices);
            step_bits = 31 + v.shift - depth_bits - shorter_bits;
            step_bits = step_bits < 2 ? 2 : step_bits;
        }
        for (int i = 0; i < 3; i++) {
            v.base[i] = rng_int(r, -((int64_t)dims_vox[i] << 23), (int64_t)dims_vox[i] * 3 << 23);
            v.base[i] = rng_one_in(r, 4) ? v.base[i] & ~(int64_t)0xFFFFFF : v.base[i];
            v.step_u[i] = wild_step(r, step_bits - 1);
            v.step_v[i] = wild_step(r, step_bits - 1);
            v.step_s[i] = wild_step(r, step_bits);
        }
        for (int i = 0; i < 3 && rng_one_in(r, 4); i++)
            v.step_v[i] = 2 * v.step_u[i]; /* no inverse */
        if (vodr_view_check(&v, dims_vox, NULL) == VODR_OK)
            return v;
    }
}

vodr_view views_wild(rng *r, const int32_t dims_vox[3], bool perspective)
{
    return wild(r, dims_vox, perspective, 24, 0);
}

vodr_view views_large(rng *r, const int32_t dims_vox[3])
{
    vodr_view view = wild(r, dims_vox, rng_one_in(r, 2), VODR_MAX_SIZE_PX, 12);
    if (rng_one_in(r, 8))
        view.depth_step = 0; /* all slices lie in one */
    return view;
}

static int32_t any_size(rng *r)
{
    return (int32_t)rng_int(r, 1, rng_one_in(r, 6) ? 8 : 70);
}

static views_camera any_camera(rng *r, const int32_t dims_vox[3])
{
    views_camera c = {.perspective = rng_one_in(r, 2),
                      .focal_px = (int32_t)rng_int(r, 2, rng_one_in(r, 2) ? 20 : 300),
                      .width_px = any_size(r),
                      .height_px = any_size(r),
                      .slices = any_size(r)};
    int64_t turns = rng_one_in(r, 3) ? 1 : 7;
    while (!c.quaternion[0] && !c.quaternion[1] && !c.quaternion[2] && !c.quaternion[3])
        for (int i = 0; i < 4; i++)
            c.quaternion[i] = (int32_t)rng_int(r, -turns, turns);
    c.across = dims_vox[rng_int(r, 0, 2)];
    c.pixels = rng_one_in(r, 3) ? c.across : (int32_t)rng_int(r, 1, 2 * (int64_t)c.width_px);
    if (rng_one_in(r, 16))
        *(rng_one_in(r, 2) ? &c.width_px : &c.height_px) =
            rng_one_in(r, 4) ? VODR_MAX_SIZE_PX : (int32_t)rng_int(r, 71, 400);
    return c;
}

/* Legal, but unlikely. */
static void disturb(rng *r, const int32_t dims_vox[3], vodr_view *v)
{
    int axis = (int)rng_int(r, 0, 2);
    int64_t *const steps[] = {v->step_u, v->step_v, v->step_s};
    int64_t border = rng_one_in(r, 2) ? dims_vox[axis] / 2 : rng_int(r, -1, dims_vox[axis] + 1);
    switch (rng_int(r, 0, 3)) {
    case 0: /* positions graze a border of voxels */
        for (int i = 0; i < 3; i++)
            steps[i][axis] = rng_int(r, -3, 3);
        v->base[axis] = border * (1 << VODR_POSITION_BITS) + rng_int(r, -40, 40);
        break;
    case 1: /* many positions are borders */
        for (int i = 0; i < 3 && !v->perspective; i++)
            for (int c = 0; c < 3; c++)
                steps[i][c] = floor_div(steps[i][c], 1 << 22) * (1 << 22);
        v->base[axis] = border * (1 << VODR_POSITION_BITS);
        break;
    case 2: steps[rng_int(r, 0, 2)][axis] *= (int64_t)1 << rng_int(r, 1, 20); break;
    default: v->base[axis] = border * (1 << VODR_POSITION_BITS); break;
    }
}

vodr_view views_any(rng *r, const int32_t dims_vox[3])
{
    vodr_view view, other;
    if (rng_one_in(r, 5))
        return views_wild(r, dims_vox, rng_one_in(r, 2));
    for (;;) {
        const views_camera camera = any_camera(r, dims_vox);
        if (views_of_camera(&camera, dims_vox, &view))
            break;
    }
    other = view;
    if (rng_one_in(r, 3))
        disturb(r, dims_vox, &other);
    return vodr_view_check(&other, dims_vox, NULL) == VODR_OK ? other : view;
}
