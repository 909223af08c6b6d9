/* kernel_march.h - along the rays of LANES pixels, front to back: sampled, classified, shaded, blended or the greatest
 * kept; empty blocks passed over; ended when opaque. */
#ifndef REFERENCE_KERNEL_MARCH_H
#define REFERENCE_KERNEL_MARCH_H

#include "kernel_hop.h"

/* On the CPU cells are asked for this many samples ahead. */
enum { AHEAD = 6 };

/* What is below the greatest sample. */
#define MARCH_LOWEST ((REAL)-1e30)

typedef struct packet_result {
    real rgba[4]; /* premultiplied */
    whole samples;
} packet_result;

KERNEL march_lane march_prepare(const kernel_frame *f, const packet *rays)
{
    march_lane lane;
    real square = spread(0);
    for (int a = 0; a < 3; a++) {
        mask still = (rays->step[a] < (REAL)1e-12) & (rays->step[a] > (REAL)-1e-12);
        lane.inverse[a] = pick(still, spread(0), 1 / pick(still, spread(1), rays->step[a]));
        lane.light[a] = -rays->step[a] * (REAL)f->camera.spacing_vox[a];
        square = square + lane.light[a] * lane.light[a];
    }
    real length = root(square);
    length = pick(length > 0, length, spread(1));
    for (int a = 0; a < 3; a++)
        lane.light[a] = lane.light[a] / length;
    return lane;
}

/* Adds the sample at p of the lanes `on` behind what is there. */
KERNEL void march_over(const kernel_frame *f, const march_lane *lane, const lookup *entries, kernel_mode mode,
                       reference_voxel type, kernel_filter filter, const real p[3], real value, mask on,
                       packet_result *out)
{
    const bool by_gradient = mode == KERNEL_LIT && f->table.rows > 1;
    real colour[4] = {value, value, value, value}, gradient[3], column = classify_column(&f->table, value);
    mask seen = on & (column > (REAL)f->table.first) & (column < (REAL)f->table.last);
    if ((LANES > 1 || mode == KERNEL_LIT) && !any_lane(seen))
        return;
    if (!by_gradient) {
        classify(entries, column, colour);
        seen = seen & (colour[3] > 0);
    }
    if (mode == KERNEL_LIT) {
        if (!any_lane(seen))
            return;
        sample_gradient(f, type, filter, p, seen, gradient);
        out->samples = out->samples + pick_whole(seen, spread_whole(6), spread_whole(0));
        real magnitude = root(gradient[0] * gradient[0] + gradient[1] * gradient[1] + gradient[2] * gradient[2]);
        if (by_gradient)
            classify_by_gradient(&f->table, entries, column, magnitude, colour);
        if (f->phong)
            shade_phong(lane, gradient, magnitude, magnitude * (REAL)f->surface_scale, colour);
    }
    real through = pick(on, 1 - out->rgba[3], spread(0));
    for (int c = 0; c < 4; c++)
        out->rgba[c] = out->rgba[c] + colour[c] * through;
}

/* Asks for what sample n will read, of KERNEL_CUBIC for its cell's bounds alone; for gradients also for what lies
 * around the tile of rays: places drawn apart from the middle by two thirds, a pixel's width for the outer ones of
 * four. */
KERNEL void march_ask(const kernel_frame *f, const packet *rays, const bundle *all, kernel_mode mode,
                      kernel_filter filter, reference_voxel type, int32_t n)
{
    real at = smaller(spread((REAL)n), to_real(rays->count - 1)), place[3];
    place_of(rays, at, place);
    if (filter == KERNEL_CUBIC) {
        cubic_ask(f, place);
        return;
    }
    fetch_ahead(&f->volume, type, place);
    if (mode != KERNEL_LIT)
        return;
    for (int a = 0; a < 3; a++) {
        real apart = place[a] - (all->middle[a] + (REAL)n * all->step[a]);
        place[a] = clamp_real(place[a] + apart * (REAL)(2 / 3.0), 0, (REAL)f->volume.dims_vox[a]);
    }
    fetch_ahead(&f->volume, type, place);
}

/* Takes the samples n to n + batch - 1 of the live lanes; without `all`, only those before `end`; of KERNEL_CUBIC, only
 * those that may show something. The volume is read for all of them before the first is
 * used, so that a card has several reads under way. With `ends`, opaque rays end. */
KERNEL void march_batch(const kernel_frame *f, const march_lane *lane, const lookup *entries, const packet *rays,
                        kernel_mode mode, kernel_filter filter, kernel_skip skip, reference_voxel type, int batch,
                        bool all, bool ends, progress *s, packet_result *out)
{
    real p[MAX_BATCH][3], value[MAX_BATCH];
    mask shows[MAX_BATCH];
    const bool looks = filter == KERNEL_CUBIC && (skip == KERNEL_SKIP_CELLS || (LANES > 1 && skip != KERNEL_SKIP_NONE));
    const real last = to_real(LANES > 1 ? rays->count - 1 : spread_whole(s->end - 1));
    for (int k = 0; k < batch; k++) {
        real at = spread((REAL)s->n + (REAL)k);
        if (LANES > 1 || !all)
            at = pick(at > last, last, at);
        place_of(rays, at, p[k]);
        shows[k] = s->live;
        value[k] = spread(0);
        if (looks) {
            shows[k] = shows[k] & place_shows(f, skip, p[k]);
            if (!any_lane(shows[k]))
                continue;
        }
        value[k] = sample_on(&f->volume, type, filter, p[k], shows[k]);
    }
    for (int k = 0; k < batch; k++) {
        mask on = all ? s->live : s->live & (s->n + k < s->end); /* a batch may end a ray */
        if (looks) {
            on = on & shows[k];
            if (!any_lane(on))
                continue;
        }
        out->samples = out->samples + pick_whole(on, spread_whole(1), spread_whole(0));
        if (mode == KERNEL_MIP) {
            real most = larger(value[k], s->greatest);
            s->greatest = all && LANES == 1 ? most : pick(on, most, s->greatest);
            continue;
        }
        march_over(f, lane, entries, mode, type, filter, p[k], value[k], on, out);
        if (ends)
            s->live = s->live & (out->rgba[3] < (REAL)f->termination);
    }
}

/* Takes the samples before `end`. On the CPU rays end one by one. */
KERNEL void march_run(const kernel_frame *f, const march_lane *lane, const lookup *entries, const packet *rays,
                      kernel_mode mode, kernel_filter filter, kernel_skip skip, reference_voxel type, const bundle *all,
                      progress *s, packet_result *out)
{
    const int batch = mode == KERNEL_LIT || filter == KERNEL_CUBIC ? 1 : MAX_BATCH;
    if (LANES > 1) {
        const bool asks = filter == KERNEL_CELLS || (filter == KERNEL_CUBIC && skip == KERNEL_SKIP_CELLS);
        if (asks) {
            ROLLED
            for (int32_t n = s->asked > s->n ? s->asked : s->n; n < s->n + AHEAD; n++)
                march_ask(f, rays, all, mode, filter, type, n);
        }
        while (s->n < s->end && any_lane(s->live)) {
            if (asks)
                march_ask(f, rays, all, mode, filter, type, s->n + AHEAD);
            march_batch(f, lane, entries, rays, mode, filter, skip, type, 1, true, true, s, out);
            s->n++;
            s->live = s->live & (s->n < rays->count);
        }
        s->asked = s->n + AHEAD;
        return;
    }
    if (mode == KERNEL_MIP || f->termination > 1)
        for (; s->n + batch <= s->end; s->n = s->n + batch)
            march_batch(f, lane, entries, rays, mode, filter, skip, type, batch, true, false, s, out);
    else
        for (; any_lane(s->live & (s->n + batch <= s->end)); s->n = s->n + batch)
            march_batch(f, lane, entries, rays, mode, filter, skip, type, batch, true, true, s, out);
    if (batch > 1 && any_lane(s->live & (s->n < s->end)))
        march_batch(f, lane, entries, rays, mode, filter, skip, type, batch, false, true, s, out);
    s->n = s->end;
    s->live = s->live & (s->n < rays->count);
}

/* What the greatest of all samples shows; MARCH_LOWEST: there was none. */
KERNEL void march_greatest(const kernel_frame *f, const lookup *entries, real greatest, packet_result *out)
{
    const mask some = greatest > MARCH_LOWEST;
    real colour[4] = {greatest, greatest, greatest, spread(1)};
    if (!f->stored)
        classify(entries, classify_column(&f->table, greatest), colour);
    for (int c = 0; c < 4; c++)
        out->rgba[c] = pick(some, colour[c], spread(0));
}

/* The whole ray, in KERNEL_OVER, KERNEL_LIT or KERNEL_MIP. */
KERNEL packet_result march(const kernel_frame *f, const lookup *entries, const packet *rays, kernel_mode mode,
                           kernel_filter filter, kernel_skip skip, reference_voxel type)
{
    packet_result out = {{spread(0), spread(0), spread(0), spread(0)}, spread_whole(0)};
    const march_lane lane = march_prepare(f, rays);
    const bool hops = LANES > 1 && (filter == KERNEL_CELLS || filter == KERNEL_CUBIC) && skip != KERNEL_SKIP_NONE;
    bundle all;
    if (LANES > 1)
        all = bundle_of(rays, spread_whole(0), place_shift(filter));
    else
        all.most = most_of(rays->count);
    progress s = {0, skip == KERNEL_SKIP_NONE ? all.most : 0, 0, spread(MARCH_LOWEST), 0 < rays->count};
    while (any_lane(s.live)) {
        if (hops)
            march_hop(f, &all, rays, filter == KERNEL_CUBIC ? 1 : HOP_RUN, &s);
        else if (skip != KERNEL_SKIP_NONE)
            march_skip(f, &lane, rays, filter, &s);
        if (any_lane(s.live))
            march_run(f, &lane, entries, rays, mode, filter, skip, type, &all, &s, &out);
    }
    if (mode == KERNEL_MIP)
        march_greatest(f, entries, s.greatest, &out);
    return out;
}

#endif
