/* sums.c - summed-area tables over the sub-volumes. */
#include "sums.h"

#include <stdlib.h>

#include "fail.h"

static size_t place(const sums *s, int32_t x, int32_t y, int32_t z)
{
    return ((size_t)z * (size_t)(s->count[1] + 1) + (size_t)y) * (size_t)(s->count[0] + 1) + (size_t)x;
}

cluster_status sums_make(const int32_t count[3], const double *weight, sums *s, vodr_error *error)
{
    *s = (sums){.count = {count[0], count[1], count[2]}};
    s->sum = calloc(place(s, 0, 0, count[2] + 1), sizeof *s->sum);
    if (!s->sum)
        return cluster_fail(error, CLUSTER_ENVIRONMENT, "no memory for the sums of %dx%dx%d sub-volumes", count[0],
                            count[1], count[2]);
    for (int32_t z = 1; z <= count[2]; z++)
        for (int32_t y = 1; y <= count[1]; y++) {
            double row = 0;
            for (int32_t x = 1; x <= count[0]; x++) {
                row += *weight++;
                s->sum[place(s, x, y, z)] = row + s->sum[place(s, x, y - 1, z)] + s->sum[place(s, x, y, z - 1)] -
                                            s->sum[place(s, x, y - 1, z - 1)];
            }
        }
    return CLUSTER_OK;
}

void sums_free(sums *s)
{
    free(s->sum);
    *s = (sums){0};
}

double sums_of(const sums *s, const box *b)
{
    double layer[2];
    if (box_is_empty(b))
        return 0;
    for (int i = 0; i < 2; i++) {
        const int32_t z = i ? b->hi[2] : b->lo[2];
        layer[i] = s->sum[place(s, b->hi[0], b->hi[1], z)] - s->sum[place(s, b->lo[0], b->hi[1], z)] -
                   s->sum[place(s, b->hi[0], b->lo[1], z)] + s->sum[place(s, b->lo[0], b->lo[1], z)];
    }
    return layer[1] - layer[0];
}

double sums_between(const sums *s, const box *b, int axis, int32_t lo, int32_t hi)
{
    box slab = *b;
    slab.lo[axis] = lo;
    slab.hi[axis] = hi;
    return sums_of(s, &slab);
}

box sums_shrink(const sums *s, const box *b)
{
    box least = *b;
    for (int a = 0; a < 3; a++) {
        while (least.lo[a] < least.hi[a] && sums_between(s, &least, a, least.lo[a], least.lo[a] + 1) == 0)
            least.lo[a]++;
        while (least.lo[a] < least.hi[a] && sums_between(s, &least, a, least.hi[a] - 1, least.hi[a]) == 0)
            least.hi[a]--;
    }
    return least;
}
