/* sums.h - summed-area tables over the sub-volumes: what lies in a box, in eight look-ups. */
#ifndef CLUSTER_SUMS_H
#define CLUSTER_SUMS_H

#include "cluster.h"

/* A box of sub-volumes, or of voxels, half-open. */
typedef struct box {
    int32_t lo[3], hi[3];
} box;

typedef struct sums {
    int32_t count[3];
    double *sum; /* owned; entry (i, j, k), of count + 1 a side: of all sub-volumes below it along each axis */
} sums;

/* Of a weight for each sub-volume, x fastest; whole numbers below 2^53 in all are summed exactly. */
cluster_status sums_make(const int32_t count[3], const double *weight, sums *s, vodr_error *error);
void sums_free(sums *s);

/* What lies in a box. */
double sums_of(const sums *s, const box *b);

/* What lies between the planes lo and hi of an axis, in a box: lo and hi in place of the box's own. */
double sums_between(const sums *s, const box *b, int axis, int32_t lo, int32_t hi);

/* The least box that holds all that is not 0 in it; an empty one, lo = hi, where nothing is. */
box sums_shrink(const sums *s, const box *b);

static inline box sums_all(const sums *s)
{
    return (box){{0, 0, 0}, {s->count[0], s->count[1], s->count[2]}};
}

static inline bool box_is_empty(const box *b)
{
    return b->hi[0] <= b->lo[0] || b->hi[1] <= b->lo[1] || b->hi[2] <= b->lo[2];
}

/* How many of them. */
static inline int64_t box_size(const box *b)
{
    return box_is_empty(b) ? 0 : (int64_t)(b->hi[0] - b->lo[0]) * (b->hi[1] - b->lo[1]) * (b->hi[2] - b->lo[2]);
}

#endif
