/* synthetic.h - volumes of 16 bits of any size, as the maximum meets them: shells, tubes, noise. */
#ifndef BENCH_SYNTHETIC_H
#define BENCH_SYNTHETIC_H

#include <stdint.h>

typedef enum synthetic_kind {
    SYNTHETIC_SHELLS, /* three, one in the other, each brighter than the one outside, with soft edges */
    SYNTHETIC_TUBES,  /* four that wind along y and grow thinner, in faint tissue: vessels */
    SYNTHETIC_NOISE,  /* every voxel drawn alone: nothing can be passed over */
    SYNTHETIC_KINDS
} synthetic_kind;

/* Fills dims_vox[0]*dims_vox[1]*dims_vox[2] voxels, x fastest. */
void synthetic_fill(synthetic_kind kind, const int32_t dims_vox[3], uint16_t *voxels);

#endif
