/* kernel_skip.h - past the blocks with nothing to show. */
#ifndef REFERENCE_KERNEL_SKIP_H
#define REFERENCE_KERNEL_SKIP_H

#include "kernel_colour.h"

/* The rays of kernel_ray.h, a lane each, at places of the filter in the whole volume; past its count a lane rests. */
typedef struct packet {
    real start[3], step[3];
    bool boxed;   /* as of kernel_part; where not, skipped and origin are zero */
    real skipped; /* as of kernel_ray */
    whole count;
    whole first;    /* as of kernel_ray */
    REAL origin[3]; /* of the volume in the whole */
} packet;

/* The places of sample n in the volume. A place in the whole volume is rounded alike whatever part is drawn, and what
 * is taken off it for the part's origin leaves no rest: a part's sample is the whole's to the bit. */
KERNEL void place_of(const packet *rays, real n, real place[3])
{
    const real at = rays->boxed ? n + rays->skipped : n;
    for (int a = 0; a < 3; a++) {
        place[a] = rays->start[a] + at * rays->step[a];
        if (rays->boxed)
            place[a] = place[a] - rays->origin[a];
    }
}

/* Where the rays of a packet are: all at the same of their samples, so that what they read lies together. */
typedef struct progress {
    int32_t n;     /* the next sample */
    int32_t end;   /* the samples before this one are to be taken, of each ray that has them */
    int32_t asked; /* the CPU: what the samples before this one read is on its way */
    real greatest; /* mip: so far */
    mask live;     /* rays that have sample n and are not opaque */
} progress;

/* What a code stands for. */
KERNEL real bound_value(const kernel_bounds *b, whole code)
{
    return to_real(code) * (REAL)b->scale + (REAL)b->offset_value;
}

/* The block of a place in the volume, its number along each axis and in all. */
KERNEL whole block_of(const kernel_blocks *b, REAL shift, const real p[3], whole at[3])
{
    for (int a = 0; a < 3; a++) {
        real cell = floor_real(p[a] + ((REAL)0.5 - shift));
        at[a] = truncate((cell + (REAL)0.5) * (REAL)(1.0 / b->edge_vox));
    }
    return (at[2] * b->count[1] + at[1]) * b->count[0] + at[0];
}

/* Whether samples of KERNEL_CUBIC at places may show something: what is passed over goes by blocks, or by cells. */
KERNEL mask place_shows(const kernel_frame *f, kernel_skip skip, const real p[3])
{
    whole at[3];
    if (skip == KERNEL_SKIP_CELLS)
        return cubic_shows(f, p);
    return fetch_byte(f->blocks.distance, block_of(&f->blocks, place_shift(KERNEL_CUBIC), p, at)) == 0;
}

/* How many samples on, at least one, the first lies that may be outside the blocks less than `distance` from block
 * `at`. The region is taken smaller by far more than positions are rounded by. */
KERNEL whole samples_to_leave(const kernel_blocks *b, REAL shift, const march_lane *lane, const real p[3],
                              const whole at[3], whole distance)
{
    real least = spread(1 << 20);
    for (int a = 0; a < 3; a++) {
        mask rising = lane->inverse[a] > 0;
        whole border = pick_whole(rising, at[a] + distance, at[a] + 1 - distance) * b->edge_vox;
        real margin = pick(rising, spread(shift - (REAL)0.5 - (REAL)0x1p-6), spread(shift - (REAL)0.5 + (REAL)0x1p-6));
        real steps = (to_real(border) + margin - p[a]) * lane->inverse[a];
        steps = pick(lane->inverse[a] == 0, least, steps);
        least = smaller(steps, least);
    }
    return truncate(larger(least, spread(1)));
}

/* Once all samples before `end` are taken: moves to the next at which a live ray is in a block that shows something,
 * and `end` to where all such rays may have left theirs. */
KERNEL void march_skip(const kernel_frame *f, const march_lane *lane, const packet *rays, kernel_filter filter,
                       progress *s)
{
    const kernel_blocks *b = &f->blocks;
    const REAL shift = place_shift(filter);
    while (any_lane(s->live)) {
        real p[3];
        whole at[3], distance;
        const real from = pick(s->live, spread((REAL)s->n), spread(0));
        place_of(rays, from, p);
        whole block = block_of(b, shift, p, at);
        distance = fetch_byte(b->distance, block);
        mask shows = distance == 0;
        whole next = s->n + samples_to_leave(b, shift, lane, p, at, pick_whole(shows, spread_whole(1), distance));
        shows = shows & s->live;
        if (any_lane(shows)) {
            next = pick_whole(next >= rays->count, rays->count, next);
            s->end = most_of(pick_whole(shows, next, spread_whole(0)));
            return;
        }
        s->n = least_of(pick_whole(s->live, next, spread_whole(INT32_MAX)));
        s->live = s->live & (s->n < rays->count);
    }
}
#endif
