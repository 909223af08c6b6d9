/* kernel_march.h - along the rays of LANES pixels, front to back: sampled, classified, shaded, blended or the greatest
 * kept; empty blocks passed over; ended when opaque. */
#ifndef REFERENCE_KERNEL_MARCH_H
#define REFERENCE_KERNEL_MARCH_H

#include "kernel_sample.h"

/* The rays of kernel_ray.h, a lane each; past its count a lane rests. */
typedef struct packet {
    real start[3], step[3];
    whole count;
} packet;

typedef struct packet_result {
    real rgba[4]; /* premultiplied */
    whole samples;
} packet_result;

/* What does not change along a ray. */
typedef struct march_lane {
    real inverse[3]; /* of step; large where a step has no such component */
    real light[3];   /* from a sample to the eye, of length one, in finest voxels */
} march_lane;

/* The entry of a table at (column, row), linear between its neighbours. */
KERNEL void classify_row(const void *rgba, whole first, real share, real colour[4])
{
    real next[4];
    fetch_entry(rgba, first, colour);
    fetch_entry(rgba, first + 1, next);
    for (int c = 0; c < 4; c++)
        colour[c] = mix(colour[c], next[c], share);
}

/* Splits a place in [0, last] into an index below `last` and a share; places outside are moved to the ends. */
KERNEL whole classify_place(real at, int32_t last, real *share)
{
    at = pick(at < 0, spread(0), at);
    at = pick(at > (REAL)last, spread((REAL)last), at);
    whole i = clamp_whole(truncate(at), 0, last > 0 ? last - 1 : 0);
    *share = at - to_real(i);
    return i;
}

KERNEL void classify(const kernel_table *t, const void *rgba, real value, real gradient, real colour[4])
{
    real across, down;
    whole column = classify_place(value * (REAL)t->scale + (REAL)t->offset, t->columns - 1, &across);
    if (t->rows == 1) {
        classify_row(rgba, column, across, colour);
        return;
    }
    whole row = classify_place(gradient * (REAL)t->gradient_scale, t->rows - 1, &down);
    real below[4];
    classify_row(rgba, row * t->columns + column, across, colour);
    classify_row(rgba, (row + 1) * t->columns + column, across, below);
    for (int c = 0; c < 4; c++)
        colour[c] = mix(colour[c], below[c], down);
}

/* Light from the eye, on both sides of a surface; ambient 0.3, diffuse 0.6, specular 0.3 to the 20th power. `surface`,
 * 0 to 1, says how much of a surface there is: where there is none, the colour stays. */
KERNEL void shade_phong(const march_lane *lane, const real gradient[3], real magnitude, real surface, real colour[4])
{
    real along = gradient[0] * lane->light[0] + gradient[1] * lane->light[1] + gradient[2] * lane->light[2];
    real facing = along / pick(magnitude > 0, magnitude, spread(1));
    facing = pick(facing < 0, -facing, facing);
    real power4 = facing * facing * facing * facing, power16 = power4 * power4 * power4 * power4;
    real lit = (REAL)0.3 + (REAL)0.6 * facing, shine = (REAL)0.3 * power16 * power4 * colour[3];
    surface = pick(surface > 1, spread(1), surface);
    for (int c = 0; c < 3; c++) {
        real shaded = colour[c] * lit + shine;
        shaded = pick(shaded > colour[3], colour[3], shaded);
        colour[c] = mix(colour[c], shaded, surface);
    }
}

/* The block of a position, its number along each axis and in all. */
KERNEL whole block_of(const kernel_blocks *b, const real p[3], whole at[3])
{
    for (int a = 0; a < 3; a++)
        at[a] = clamp_whole(truncate((to_real(floor_of(p[a] - (REAL)0.5)) + (REAL)1.5) * (REAL)(1.0 / b->edge_vox)), 0,
                            b->count[a] - 1);
    return (at[2] * b->count[1] + at[1]) * b->count[0] + at[0];
}

/* How many samples on, at least one, the first lies that may be outside the blocks less than `distance` from block
 * `at`. The region is taken smaller by far more than positions are rounded by. */
KERNEL whole samples_to_leave(const kernel_blocks *b, const march_lane *lane, const packet *rays, const real p[3],
                              const whole at[3], whole distance)
{
    real least = spread(1 << 20);
    for (int a = 0; a < 3; a++) {
        mask rising = rays->step[a] > 0;
        whole border = pick_whole(rising, at[a] + distance, at[a] + 1 - distance) * b->edge_vox;
        real margin = pick(rising, spread((REAL)(-0.5 - 0x1p-6)), spread((REAL)(-0.5 + 0x1p-6)));
        real steps = (to_real(border) + margin - p[a]) * lane->inverse[a];
        least = pick(steps < least, steps, least);
    }
    whole n = truncate(least);
    return pick_whole(n < 1, spread_whole(1), n);
}

/* Moves the live lanes past blocks with nothing to show; at is where each then stands. */
KERNEL void march_skip(const kernel_frame *f, const march_lane *lane, const packet *rays, kernel_mode mode,
                       real greatest, whole *n, mask *live, real p[3])
{
    const kernel_blocks *b = &f->blocks;
    const REAL above = f->filter == KERNEL_TEXTURE ? (REAL)(1 + 0x1p-16) : 1; /* a texture unit's own rounding */
    for (;;) {
        whole at[3], distance;
        for (int a = 0; a < 3; a++)
            p[a] = rays->start[a] + to_real(*n) * rays->step[a];
        whole block = block_of(b, p, at);
        if (mode == KERNEL_MIP)
            distance = pick_whole(fetch_float(b->most, block) * above <= greatest, spread_whole(1), spread_whole(0));
        else
            distance = fetch_byte(b->distance, block);
        mask hop = *live & (distance > 0);
        if (!any_lane(hop))
            return;
        *n = pick_whole(hop, *n + samples_to_leave(b, lane, rays, p, at, distance), *n);
        *live = *live & (*n < rays->count);
        *n = pick_whole(*n < rays->count, *n, rays->count - 1);
    }
}

KERNEL march_lane march_prepare(const kernel_frame *f, const packet *rays)
{
    march_lane lane;
    real square = spread(0);
    for (int a = 0; a < 3; a++) {
        mask still = (rays->step[a] < (REAL)1e-12) & (rays->step[a] > (REAL)-1e-12);
        lane.inverse[a] = 1 / pick(still, spread((REAL)1e-12), rays->step[a]);
        lane.light[a] = -rays->step[a] * (REAL)f->camera.spacing_vox[a];
        square = square + lane.light[a] * lane.light[a];
    }
    real length = root(square);
    length = pick(length > 0, length, spread(1));
    for (int a = 0; a < 3; a++)
        lane.light[a] = lane.light[a] / length;
    return lane;
}

/* Adds the sample at p of the live lanes behind what is there. */
KERNEL void march_over(const kernel_frame *f, const march_lane *lane, const void *rgba, kernel_mode mode,
                       reference_voxel type, kernel_filter filter, const real p[3], real value, mask live,
                       packet_result *out)
{
    const bool by_gradient = f->table.rows > 1;
    real colour[4], gradient[3], magnitude = spread(0);
    mask seen = live;
    if (!by_gradient) {
        classify(&f->table, rgba, value, magnitude, colour);
        seen = live & (colour[3] > 0);
    }
    if (mode == KERNEL_LIT && any_lane(seen)) {
        sample_gradient(f, type, filter, p, gradient);
        out->samples = out->samples + pick_whole(seen, spread_whole(6), spread_whole(0));
        magnitude = root(gradient[0] * gradient[0] + gradient[1] * gradient[1] + gradient[2] * gradient[2]);
        if (by_gradient)
            classify(&f->table, rgba, value, magnitude, colour);
        if (f->phong)
            shade_phong(lane, gradient, magnitude, magnitude * (REAL)f->surface_scale, colour);
    }
    real through = pick(live, 1 - out->rgba[3], spread(0));
    for (int c = 0; c < 4; c++)
        out->rgba[c] = out->rgba[c] + colour[c] * through;
}

/* The whole ray. mode, filter, skip and type are constants where this is inlined; rgba is the table, wherever the
 * device keeps it. */
KERNEL packet_result march(const kernel_frame *f, const void *rgba, const packet *rays, kernel_mode mode,
                           kernel_filter filter, kernel_skip skip, reference_voxel type)
{
    packet_result out = {{spread(0), spread(0), spread(0), spread(0)}, spread_whole(0)};
    const march_lane lane = march_prepare(f, rays);
    const REAL lowest = (REAL)-1e30, enough = (REAL)f->termination;
    real greatest = spread(lowest);
    whole n = spread_whole(0);
    mask live = n < rays->count;
    while (any_lane(live)) {
        real p[3];
        if (skip == KERNEL_SKIP_NONE) {
            for (int a = 0; a < 3; a++)
                p[a] = rays->start[a] + to_real(n) * rays->step[a];
        } else {
            march_skip(f, &lane, rays, mode, greatest, &n, &live, p);
            if (!any_lane(live))
                break;
        }
        real value = sample(&f->volume, type, filter, p);
        out.samples = out.samples + pick_whole(live, spread_whole(1), spread_whole(0));
        if (mode == KERNEL_MIP) {
            greatest = pick(live & (value > greatest), value, greatest);
        } else {
            march_over(f, &lane, rgba, mode, type, filter, p, value, live, &out);
            live = live & (out.rgba[3] < enough);
        }
        n = n + 1;
        live = live & (n < rays->count);
        if (LANES > 1)
            n = pick_whole(live, n, n - 1);
    }
    if (mode == KERNEL_MIP) {
        real colour[4];
        classify(&f->table, rgba, greatest, spread(0), colour);
        for (int c = 0; c < 4; c++)
            out.rgba[c] = pick(greatest > lowest, colour[c], spread(0));
    }
    return out;
}

#endif
