/* kernel_search.h - the greatest sample of the rays of a packet, best bounds first: rays are cut into runs of samples,
 * the same for the whole packet, each with a bound from a window of the volume; runs are looked at in the order of
 * their bounds until none can raise any ray. In a run a ray takes the samples whose cell's greatest corner is above
 * what it has: corners are tested before they are read.
 *
 * The order makes the best block the first, and the last bound looked at is the greatest of all that is left: no run is
 * entered whose bound does not exceed the final value of one of the packet's rays. */
#ifndef REFERENCE_KERNEL_SEARCH_H
#define REFERENCE_KERNEL_SEARCH_H

#include "bounds.h"
#include "kernel_march.h"

/* Samples of a run and how many runs there are, of rays that are not longer than all of them together; runs of longer
 * rays are as many chunks of RUN samples long. */
enum { RUN = SEARCH_RUN, RUNS = SEARCH_RUNS, KEYS = RUNS / TOGETHER };

/* A key is a bound's code with a number below, of a run or of a sample of a chunk; -1: done. */
typedef struct search_state {
    whole lag; /* the packet's sample n is the lane's sample n - lag */
    int32_t run, runs;
    whole key[KEYS]; /* of run lane + index*TOGETHER */
    real greatest;
    mask live;
} search_state;

/* A chunk: the packet's samples from `begin` on. */
typedef struct search_chunk {
    int32_t begin;
    whole key[RUN];
} search_chunk;

/* The window grid whose windows hold a box as long as the packet's in any run, and half that box. */
KERNEL int32_t search_level(const kernel_bounds *b, const bundle *all, int32_t run, REAL half[3], bool *near)
{
    REAL longest = 0;
    for (int a = 0; a < 3; a++) {
        const REAL step = all->step[a] < 0 ? -all->step[a] : all->step[a];
        half[a] = all->around[a] + step * ((REAL)(run - 1) / 2);
        longest = 2 * half[a] > longest ? 2 * half[a] : longest;
    }
    int32_t level = 1;
    *near = BRICKED && longest <= 4;
    while (level < b->levels - 1 && longest > (REAL)(3 << level))
        level++;
    return level;
}

/* Keys of a lane that are of runs. */
KERNEL int32_t search_used(const search_state *s)
{
    return (s->runs + TOGETHER - 1) / TOGETHER;
}

/* Keys of all runs. On a card all KEYS are made, so that each has a register. */
KERNEL void search_keys(const kernel_bounds *b, const bundle *all, search_state *s)
{
    REAL half[3];
    bool near;
    const int32_t level = search_level(b, all, s->run, half, &near);
    const int32_t *count = b->count[level];
    const uint16_t *codes = near ? b->near : b->codes + b->offset[level];
    const REAL scale = (REAL)1 / (REAL)(1 << level);
    UNROLLED
    for (int i = 0; i < (LANES > 1 ? search_used(s) : KEYS); i++) {
        const whole run = lane_number() + i * TOGETHER;
        const mask some = run < s->runs;
        const real n = to_real(run) * (REAL)s->run + (REAL)(s->run - 1) / 2;
        whole at[3];
        for (int a = 0; a < 3; a++) {
            const real low = (n * all->step[a] + (all->middle[a] - half[a])) * scale;
            at[a] = clamp_whole(truncate(clamp_real(low, 0, (REAL)count[a])), 0, count[a] - 1);
        }
        const whole index = (at[2] * count[1] + at[1]) * count[0] + at[0];
        const whole code = fetch_word(codes, pick_whole(some, index, spread_whole(0)));
        s->key[i] = pick_whole(some, code * RUNS + run, spread_whole(-1));
    }
}

/* Asks for the codes that search_look() of a run's first chunk will read: the bricks of the box around its rays. */
KERNEL void search_ask(const kernel_bounds *b, const bundle *all, int32_t begin)
{
    int32_t lo[3], hi[3], bricks[3];
    for (int a = 0; a < 3; a++) {
        const REAL middle = all->middle[a] + ((REAL)begin + (REAL)(RUN - 1) / 2) * all->step[a];
        const REAL step = all->step[a] < 0 ? -all->step[a] : all->step[a];
        const REAL half = all->around[a] + step * ((REAL)(RUN - 1) / 2);
        const REAL last = (REAL)(b->count[0][a] - 1), low = middle - half, high = middle + half;
        bricks[a] = bounds_bricks(b->count[0][a]);
        lo[a] = (int32_t)(low < 0 ? 0 : low < last ? low : last) / BOUND_BRICK;
        hi[a] = (int32_t)(high < 0 ? 0 : high < last ? high : last) / BOUND_BRICK;
    }
    for (int32_t z = lo[2]; z <= hi[2]; z++)
        for (int32_t y = lo[1]; y <= hi[1]; y++)
            for (int32_t x = lo[0]; x <= hi[0]; x++)
                ask_brick(b->codes + (((int64_t)z * bricks[1] + y) * bricks[0] + x) * BOUND_BRICK_CELLS);
}

/* The code of the cell at a place. */
KERNEL whole search_cell(const kernel_frame *f, REAL shift, const real place[3])
{
    const int32_t *size = f->volume.dims_vox;
    whole cell[3];
    for (int a = 0; a < 3; a++)
        cell[a] = truncate(shift == (REAL)0.5 ? place[a] : place[a] + ((REAL)0.5 - shift));
    if (!BRICKED)
        return fetch_word(f->bounds.codes, (cell[2] * (size[1] + 1) + cell[1]) * (size[0] + 1) + cell[0]);
    const int32_t across = bounds_bricks(size[0] + 1), down = bounds_bricks(size[1] + 1);
    const whole brick = ((cell[2] >> 2) * down + (cell[1] >> 2)) * across + (cell[0] >> 2);
    const whole inside = (cell[2] & 3) * 16 + (cell[1] & 3) * 4 + (cell[0] & 3);
    return fetch_word(f->bounds.codes, brick * BOUND_BRICK_CELLS + inside);
}

/* Keys of the chunk's samples: what their cells can have. */
KERNEL void search_look(const kernel_frame *f, const packet *rays, kernel_filter filter, const search_state *s,
                        int32_t begin, search_chunk *chunk)
{
    chunk->begin = begin;
    UNROLLED
    for (int k = 0; k < RUN; k++) {
        whole n = begin + k - s->lag;
        const mask some = s->live & (n >= 0) & (n < rays->count);
        real p[3];
        n = pick_whole(some, n, spread_whole(0));
        place_of(rays, to_real(n), p);
        const whole code = search_cell(f, place_shift(filter), p);
        chunk->key[k] = pick_whole(some, code * RUN + k, spread_whole(-1));
    }
}

/* The greatest key of each lane. */
KERNEL whole search_top(const search_chunk *chunk)
{
    whole top = chunk->key[0];
    UNROLLED
    for (int k = 1; k < RUN; k++)
        top = pick_whole(chunk->key[k] > top, chunk->key[k], top);
    return top;
}

/* The places of the samples of such keys. */
KERNEL void search_place(const packet *rays, const search_state *s, const search_chunk *chunk, whole top, real p[3])
{
    place_of(rays, to_real(chunk->begin + top % RUN - s->lag), p);
}

/* Asks for the voxels of the samples that will be the first to be taken of a chunk. */
KERNEL void search_ask_voxels(const kernel_frame *f, const packet *rays, reference_voxel type, const search_state *s,
                              const search_chunk *chunk)
{
    const whole top = search_top(chunk);
    const mask on = s->live & (top >= 0) & unless(bound_value(&f->bounds, top / RUN) <= s->greatest);
    real p[3];
    if (!any_lane(on))
        return;
    search_place(rays, s, chunk, top, p);
    ask_voxels(&f->volume, type, p, on);
}

/* Takes the samples of a chunk that can raise their rays, each ray's in the order of their keys. */
KERNEL void search_take(const kernel_frame *f, const packet *rays, kernel_filter filter, reference_voxel type,
                        mask wants, search_chunk *chunk, search_state *s, packet_result *out)
{
    for (;;) {
        const whole top = search_top(chunk);
        const mask on = wants & (top >= 0) & unless(bound_value(&f->bounds, top / RUN) <= s->greatest);
        if (!any_lane(on))
            return;
        real p[3];
        search_place(rays, s, chunk, top, p);
        for (int a = 0; a < 3 && LANES > 1; a++) /* off the volume's sides, where sampling is slower */
            p[a] = pick(on, p[a], spread(1));
        const real value = sample_on(&f->volume, type, filter, p, on);
        s->greatest = pick(on, larger(value, s->greatest), s->greatest);
        out->samples = out->samples + pick_whole(on, spread_whole(1), spread_whole(0));
        UNROLLED
        for (int k = 0; k < RUN; k++)
            chunk->key[k] = pick_whole(chunk->key[k] == top, spread_whole(-1), chunk->key[k]);
    }
}

/* The greatest key of the runs, which is done from then on. */
KERNEL int32_t search_next(search_state *s)
{
    const int32_t used = LANES > 1 ? search_used(s) : KEYS;
    whole most = spread_whole(-1);
    UNROLLED
    for (int i = 0; i < used; i++)
        most = pick_whole(s->key[i] > most, s->key[i], most);
    const int32_t top = together_most(most);
    UNROLLED
    for (int i = 0; i < used; i++)
        s->key[i] = pick_whole(s->key[i] == top, spread_whole(-1), s->key[i]);
    return top;
}

/* Runs in the order of their keys, until no lane can gain by what is left. The next run is looked at before the samples
 * of one are taken, so that its reads are under way; what the one after it will be looked at with is asked for. */
KERNEL void search_runs(const kernel_frame *f, const packet *rays, kernel_filter filter, reference_voxel type,
                        const bundle *all, search_state *s, packet_result *out)
{
    search_chunk chunk, ahead;
    int32_t top = search_next(s), after = search_next(s);
    if (top >= 0)
        search_look(f, rays, filter, s, top % RUNS * s->run, &ahead);
    if (BRICKED && after >= 0)
        search_ask(&f->bounds, all, after % RUNS * s->run);
    while (top >= 0) {
        const mask wants = s->live & unless(bound_value(&f->bounds, spread_whole(top / RUNS)) <= s->greatest);
        if (!together_any(wants))
            return;
        chunk = ahead;
        top = after;
        after = search_next(s);
        if (BRICKED && after >= 0)
            search_ask(&f->bounds, all, after % RUNS * s->run);
        if (top >= 0) {
            search_look(f, rays, filter, s, top % RUNS * s->run, &ahead);
            search_ask_voxels(f, rays, type, s, &ahead);
        }
        const int32_t end = chunk.begin + s->run;
        search_take(f, rays, filter, type, wants, &chunk, s, out);
        for (int32_t begin = chunk.begin + RUN; begin < end; begin += RUN) {
            search_look(f, rays, filter, s, begin, &chunk);
            search_take(f, rays, filter, type, wants, &chunk, s, out);
        }
    }
}

/* The whole ray. */
KERNEL packet_result search(const kernel_frame *f, const lookup *entries, const packet *rays, kernel_filter filter,
                            reference_voxel type)
{
    packet_result out = {{spread(0), spread(0), spread(0), spread(0)}, spread_whole(0)};
    search_state s;
    s.live = 0 < rays->count;
    s.greatest = spread(MARCH_LOWEST);
    s.lag = rays->first - together_least(pick_whole(s.live, rays->first, spread_whole(INT32_MAX)));
    s.lag = pick_whole(s.live, s.lag, spread_whole(0));
    const bundle all = bundle_of(rays, s.lag, place_shift(filter));
    s.run = RUN;
    while ((all.most + s.run - 1) / s.run > RUNS)
        s.run *= 2;
    s.runs = (all.most + s.run - 1) / s.run;
    search_keys(&f->bounds, &all, &s);
    search_runs(f, rays, filter, type, &all, &s, &out);
    march_greatest(f, entries, s.greatest, &out);
    return out;
}

#endif
