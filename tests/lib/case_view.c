/* case_view.c - random views, through the application's camera, and some with registers that no camera would write. */
#include "case_parts.h"

static double pick(rng *r, const double *from, int count)
{
    return from[rng_int(r, 0, count - 1)];
}

static int32_t random_size(rng *r, bool odd)
{
    int32_t size = (int32_t)rng_int(r, 1, rng_one_in(r, 6) ? 8 : 70);
    return odd ? size | 1 : size;
}

/* The view that per-slice rounding would break: see case_make_machine(). */
static void choose_delicate(rng *r, camera *eye)
{
    eye->perspective = true;
    eye->azimuth_deg = eye->elevation_deg = rng_one_in(r, 2) ? 0 : 30;
    eye->width_px = random_size(r, true);
    eye->height_px = random_size(r, true);
    eye->slices = (int32_t)rng_int(r, 8, 70);
}

static camera random_camera(rng *r, bool delicate)
{
    static const double views[][2] = {{0, 0},  {30, 30}, {45, 35.264}, {90, 0},  {180, 0}, {270, 0},
                                      {0, 90}, {0, -90}, {45, 0},      {0, -45}, {30, 0},  {-135, -35.264}};
    static const double fields[] = {40, 40, 1, 20, 90, 120, 150};
    static const double zooms[] = {1, 1, 0.5, 2, 0.3, 4};
    camera eye = camera_default();
    const double *angles = views[rng_int(r, 0, (int64_t)(sizeof views / sizeof *views) - 1)];
    bool named = rng_one_in(r, 2);
    eye.azimuth_deg = named ? angles[0] : rng_real(r, -180, 180);
    eye.elevation_deg = named ? angles[1] : rng_real(r, -90, 90);
    eye.roll_deg = rng_one_in(r, 4) ? rng_real(r, -180, 180) : rng_one_in(r, 4) ? 90 : 0;
    eye.perspective = rng_one_in(r, 2);
    eye.fov_deg = rng_one_in(r, 2) ? pick(r, fields, 7) : rng_real(r, 1, 150);
    eye.zoom = rng_one_in(r, 2) ? pick(r, zooms, 6) : rng_real(r, 0.3, rng_one_in(r, 2) ? 1.2 : 4);
    eye.width_px = random_size(r, false);
    eye.height_px = random_size(r, false);
    eye.slices = random_size(r, false);
    if (rng_one_in(r, 12)) {
        eye.width_px = (int32_t)rng_int(r, 71, 400);
        eye.height_px = (int32_t)rng_int(r, 1, 8);
    }
    if (delicate) {
        choose_delicate(r, &eye);
    }
    return eye;
}

/* Moves the base's component c to within some units of a voxel's border, oftenest the middle one, or onto it. */
static void move_to_border(test_case *c, int axis)
{
    rng *r = &c->random;
    int64_t size = c->input.dims_vox[axis];
    int64_t border = rng_one_in(r, 2) ? size / 2 : rng_int(r, -1, size + 1);
    c->view.base[axis] = border * (1 << 24) + (rng_one_in(r, 2) ? rng_int(r, -40, 40) : 0);
}

/* Makes component c nearly constant over the frame: positions graze the border of voxels. */
static void graze(test_case *c, int axis)
{
    rng *r = &c->random;
    vodr_view *v = &c->view;
    int64_t unit = v->perspective ? (int64_t)1 << rng_int(r, 0, 12) : 1;
    v->step_u[axis] = rng_int(r, -3, 3) * unit;
    v->step_v[axis] = rng_int(r, -3, 3) * unit;
    v->step_s[axis] = rng_int(r, -3, 3) * unit;
    move_to_border(c, axis);
}

/* Makes every position of a parallel view a multiple of a quarter voxel: many lie on borders. */
static void snap(vodr_view *v)
{
    int64_t *const registers[] = {v->base, v->step_u, v->step_v, v->step_s};
    for (int i = 0; i < 12; i++) {
        int64_t *value = &registers[i / 3][i % 3];
        *value = ((*value + (1 << 21)) >> 22) * (1 << 22);
    }
}

/* Makes two components move alike or in mirror image: ties of the dominant axis. */
static void tie(rng *r, vodr_view *v, int to)
{
    int from = (int)rng_int(r, 0, 2);
    int64_t sign = rng_one_in(r, 2) ? -1 : 1;
    v->step_s[to] = sign * v->step_s[from];
    v->step_u[to] = sign * v->step_u[from];
    v->step_v[to] = sign * v->step_v[from];
}

/* Changes registers to what is legal but unlikely. */
static void disturb(test_case *c)
{
    rng *r = &c->random;
    const vodr_view before = c->view;
    vodr_view *v = &c->view;
    int axis = (int)rng_int(r, 0, 2);
    switch (rng_int(r, 0, 8)) {
    case 0: v->footprint = (uint32_t)rng_int(r, 1, (int64_t)1 << rng_int(r, 1, 31)); break;
    case 1: tie(r, v, axis); break;
    case 2: v->step_s[axis] = 0; break;
    case 3: snap(v); break;
    case 4: v->step_u[axis] *= 1 << rng_int(r, 1, 20); break;
    case 5: v->step_v[axis] *= 1 << rng_int(r, 1, 20); break;
    case 6: v->step_s[axis] *= 1 << rng_int(r, 1, 20); break;
    case 7: graze(c, axis); break;
    default: move_to_border(c, axis); break;
    }
    vodr_error error;
    if (vodr_view_check(v, c->input.dims_vox, &error) != VODR_OK) {
        c->view = before;
    }
}

void case_make_view(test_case *c, bool delicate)
{
    rng *r = &c->random;
    double depth_vox;
    host_error error;
    vodr_error refused;
    bool usable = false;
    while (!usable) { /* some cameras' registers do not fit their formats */
        c->eye = random_camera(r, delicate);
        if (camera_view(&c->eye, &c->geometry, &c->view, &depth_vox, &error) == HOST_OK) {
            usable = vodr_view_check(&c->view, c->input.dims_vox, &refused) == VODR_OK;
        }
    }
    for (int i = 0; delicate && i < 3; i++) { /* rounding down, too, then crosses the borders that the eye lies on */
        c->view.base[i] += rng_one_in(r, 2) ? rng_int(r, 0, 30) : 0;
    }
    if (!delicate && rng_one_in(r, 2)) {
        disturb(c);
    }
}
