/* kernel_leap.h - the greatest sample of each ray, front to back, past the blocks that cannot raise it: Kye and Kim,
 * "Acceleration techniques for GPGPU-based maximum intensity projection", sections 3.2 to 3.4 and the appendix. Each
 * lane goes at its own pace.
 *
 * A block is left by the quotients of its border (section 3.2), or by bisection (3.3): a long step, halved wherever it
 * would leave the block. The halves are whole numbers of samples, so that no position is rounded otherwise than without
 * leaps. The first value is the ray's middle sample (3.4). */
#ifndef REFERENCE_KERNEL_LEAP_H
#define REFERENCE_KERNEL_LEAP_H

#include "kernel_march.h"

/* The rays in blocks, which loses nothing where the edge of a block is a power of two; else in cells. */
typedef struct leap_rays {
    real start[3], step[3];
    REAL blocks; /* in one of its units; 1 or, of cells, a fraction */
} leap_rays;

KERNEL leap_rays leap_scale(const kernel_blocks *b, const packet *rays, REAL shift)
{
    const bool even = (b->edge_vox & (b->edge_vox - 1)) == 0;
    const REAL share = (REAL)(1.0 / b->edge_vox), unit = even ? share : 1;
    leap_rays scaled;
    scaled.blocks = even ? 1 : share;
    for (int a = 0; a < 3; a++) {
        scaled.start[a] = (shift == (REAL)0.5 ? rays->start[a] : rays->start[a] + ((REAL)0.5 - shift)) * unit;
        scaled.step[a] = rays->step[a] * unit;
    }
    return scaled;
}

/* The number of sample n's block along each axis and in all. */
KERNEL whole leap_block(const kernel_blocks *b, const leap_rays *rays, whole n, whole at[3])
{
    for (int a = 0; a < 3; a++) {
        at[a] = truncate(rays->start[a] + to_real(n) * rays->step[a]);
        if (rays->blocks != 1)
            at[a] = truncate((to_real(at[a]) + (REAL)0.5) * rays->blocks);
    }
    return (at[2] * b->count[1] + at[1]) * b->count[0] + at[0];
}

/* The longest step of a bisection, in samples: with its halves it crosses any block. A power of two. */
KERNEL int32_t leap_longest(const kernel_blocks *b, const march_lane *lane)
{
    real across = spread(1 << 20);
    for (int a = 0; a < 3; a++) {
        real samples = pick(lane->inverse[a] < 0, -lane->inverse[a], lane->inverse[a]) * (REAL)b->edge_vox;
        across = smaller(across, pick(lane->inverse[a] == 0, across, samples));
    }
    const int32_t most = most_of(truncate(across));
    int32_t step = 1;
    while (2 * step - 1 < most)
        step *= 2;
    return step;
}

/* The last sample in the block of sample n. Outside the volume blocks have no numbers: there a ray has ended. */
KERNEL whole leap_bisect(const kernel_blocks *b, const leap_rays *rays, whole n, whole count, whole block,
                         int32_t longest)
{
    whole inside = n, at[3];
    ROLLED
    for (int32_t step = longest; step > 0; step /= 2) {
        const whole next = inside + step;
        const mask on = next < count; /* far beyond its end a ray's blocks have numbers that no integer holds */
        const mask stays = on & (leap_block(b, rays, pick_whole(on, next, inside), at) == block);
        inside = pick_whole(stays, next, inside);
    }
    return inside;
}

/* Takes sample n of the lanes `on`; of KERNEL_CUBIC, where its cell can raise the ray. */
KERNEL void leap_sample(const kernel_frame *f, const packet *rays, kernel_filter filter, reference_voxel type, whole n,
                        mask on, real *greatest, packet_result *out)
{
    real p[3];
    for (int a = 0; a < 3; a++)
        p[a] = rays->start[a] + to_real(n) * rays->step[a];
    if (filter == KERNEL_CUBIC && f->cells.step > 0) {
        on = on & cubic_raises(f, p, *greatest);
        if (!any_lane(on))
            return;
    }
    real value = sample_on(&f->volume, type, filter, p, on);
    *greatest = pick(on, larger(value, *greatest), *greatest);
    out->samples = out->samples + pick_whole(on, spread_whole(1), spread_whole(0));
}

/* What comes behind sample n of block `block`, which cannot raise the ray. */
KERNEL whole leap_over(const kernel_frame *f, const packet *rays, const leap_rays *scaled, const march_lane *lane,
                       REAL shift, int32_t longest, whole n, whole block, const whole at[3])
{
    const kernel_blocks *b = &f->blocks;
    if (b->bisects)
        return leap_bisect(b, scaled, n, rays->count, block, longest) + 1;
    real p[3];
    for (int a = 0; a < 3; a++)
        p[a] = rays->start[a] + to_real(n) * rays->step[a];
    return n + samples_to_leave(b, shift, lane, p, at, spread_whole(1));
}

/* The whole ray. */
KERNEL packet_result leap(const kernel_frame *f, const lookup *entries, const packet *rays, kernel_filter filter,
                          reference_voxel type)
{
    const kernel_blocks *b = &f->blocks;
    const REAL shift = place_shift(filter);
    const march_lane lane = march_prepare(f, rays);
    const leap_rays scaled = leap_scale(b, rays, shift);
    const int32_t longest = leap_longest(b, &lane);
    packet_result out = {{spread(0), spread(0), spread(0), spread(0)}, spread_whole(0)};
    real greatest = spread(MARCH_LOWEST);
    whole n = spread_whole(0), at[3];
    mask live = 0 < rays->count;
    if (b->seeds && any_lane(live))
        leap_sample(f, rays, filter, type, rays->count / 2, live, &greatest, &out);
    while (any_lane(live)) {
        n = pick_whole(live, n, spread_whole(0));
        const whole block = leap_block(b, &scaled, n, at);
        const mask hidden = live & (bound_value(&f->bounds, fetch_word(b->most, block)) <= greatest);
        const mask shows = live & unless(hidden);
        whole next = n + 1;
        if (any_lane(hidden))
            next = pick_whole(hidden, leap_over(f, rays, &scaled, &lane, shift, longest, n, block, at), next);
        if (any_lane(shows))
            leap_sample(f, rays, filter, type, n, shows, &greatest, &out);
        n = next;
        live = live & (n < rays->count);
    }
    march_greatest(f, entries, greatest, &out);
    return out;
}

#endif
