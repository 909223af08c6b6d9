/* subvolumes.h - the volume as cubes: what values samples in each can have, and which are empty under a transfer
 * function (Lee, Park, Han, section 4.1: the octree). */
#ifndef CLUSTER_SUBVOLUMES_H
#define CLUSTER_SUBVOLUMES_H

#include "cluster.h"

enum { OCTREE_LEVELS = 16 };

/* Cubes of edge_vox voxels, those at the far sides cut off, x fastest; cube (i, j, k) has the samples in the half-open
 * box from (i, j, k)*edge_vox on. */
typedef struct subvolumes {
    int32_t dims_vox[3], edge_vox, count[3];
    float *least, *most; /* owned; least above most: not known yet */
} subvolumes;

/* The cubes of each level are eight, fewer at the far sides, of the level before; the last has one. */
typedef struct octree {
    int32_t levels, count[OCTREE_LEVELS][3];
    size_t offset[OCTREE_LEVELS];
    float *least, *most; /* owned; of all levels */
} octree;

cluster_status subvolumes_make(const int32_t dims_vox[3], int32_t edge_vox, subvolumes *s, vodr_error *error);
void subvolumes_free(subvolumes *s);

static inline size_t subvolumes_total(const int32_t count[3])
{
    return (size_t)count[0] * (size_t)count[1] * (size_t)count[2];
}

cluster_status octree_make(const subvolumes *s, octree *o, vodr_error *error);
void octree_free(octree *o);

/* Sets occupied[i] where cube i of level 0 may show something, else clears it. Returns how many are set. A cube whose
 * values are transparent is left out with all that it holds. With the maximum, a transparent value may hide one that
 * shows; only cubes below every value that shows are left out. */
int64_t octree_occupied(const octree *o, const cluster_function *f, uint8_t *occupied);

#endif
