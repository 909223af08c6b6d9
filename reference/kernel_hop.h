/* kernel_hop.h - past the blocks with nothing to show, with many rays at once: where lanes are packets of rays that
 * keep together, one look at a block for all of them is coarser than a look for each (kernel_skip.h), and costs so much
 * less that it is faster. */
#ifndef REFERENCE_KERNEL_HOP_H
#define REFERENCE_KERNEL_HOP_H

#include "kernel_skip.h"

/* Samples taken between two looks. */
enum { HOP_RUN = 8 };

/* The rays of all lanes that go together as one: at sample n, all lie within `around` of middle + n*step along each
 * axis, in cells. */
typedef struct bundle {
    REAL middle[3], step[3], inverse[3], around[3];
    int32_t most; /* samples of the longest ray */
} bundle;

/* The bundle of the rays that have samples; its sample n is their sample n - lag. */
KERNEL bundle bundle_of(const packet *rays, whole lag, REAL shift)
{
    const mask some = rays->count > 0;
    bundle all;
    all.most = together_most(rays->count + lag);
    for (int a = 0; a < 3; a++) {
        REAL least[2], most[2];
        const real along[2] = {rays->start[a] + (rays->skipped - to_real(lag)) * rays->step[a] - rays->origin[a] +
                                   ((REAL)0.5 - shift),
                               rays->step[a]};
        for (int i = 0; i < 2; i++) {
            most[i] = together_most_real(pick(some, along[i], spread((REAL)-1e30)));
            least[i] = -together_most_real(pick(some, -along[i], spread((REAL)-1e30)));
        }
        all.middle[a] = (least[0] + most[0]) / 2;
        all.step[a] = (least[1] + most[1]) / 2;
        all.inverse[a] = all.step[a] < (REAL)1e-6 && all.step[a] > (REAL)-1e-6 ? 0 : 1 / all.step[a];
        all.around[a] = (most[0] - least[0]) / 2 + (most[1] - least[1]) / 2 * (REAL)all.most + (REAL)0x1p-6;
        if (all.inverse[a] == 0)
            all.around[a] += (REAL)1e-6 * (REAL)all.most;
    }
    return all;
}

/* How many samples after n lie in the blocks less than `distance` from block `at`, for all rays of the bundle. */
KERNEL int32_t bundle_stays(const kernel_blocks *b, const bundle *all, const REAL place[3], const int32_t at[3],
                            int32_t distance)
{
    REAL least = (REAL)(1 << 20);
    for (int a = 0; a < 3; a++) {
        REAL low = (REAL)((at[a] + 1 - distance) * b->edge_vox) + all->around[a] - place[a];
        REAL high = (REAL)((at[a] + distance) * b->edge_vox) - all->around[a] - place[a];
        if (low > 0 || high < 0)
            return 0;
        REAL steps = all->inverse[a] > 0 ? high * all->inverse[a] : low * all->inverse[a];
        least = all->inverse[a] != 0 && steps < least ? steps : least;
    }
    return (int32_t)least;
}

/* What march_skip() does, for all rays of the packet by the place of their bundle. `nearby`: samples taken between two
 * looks where no block in reach shows anything, but cannot be left. */
KERNEL void march_hop(const kernel_frame *f, const bundle *all, const packet *rays, int32_t nearby, progress *s)
{
    const kernel_blocks *b = &f->blocks;
    while (any_lane(s->live)) {
        REAL place[3];
        int32_t at[3];
        for (int a = 0; a < 3; a++) {
            place[a] = all->middle[a] + (REAL)s->n * all->step[a];
            at[a] = (int32_t)((place[a] > 0 ? place[a] : 0) * (REAL)(1.0 / b->edge_vox));
            at[a] = at[a] < b->count[a] ? at[a] : b->count[a] - 1;
        }
        size_t block = ((size_t)at[2] * (size_t)b->count[1] + (size_t)at[1]) * (size_t)b->count[0] + (size_t)at[0];
        const int32_t distance = b->distance[block];
        int32_t stays = distance > 0 ? bundle_stays(b, all, place, at, distance) : 0;
        if (stays == 0) {
            const int32_t run = distance > 0 ? nearby : HOP_RUN;
            s->end = all->most - s->n > run ? s->n + run : all->most;
            return;
        }
        s->n += stays;
        s->live = s->live & (s->n < rays->count);
    }
}

#endif
