/* fused_brick.h - a brick repacked for the fast path's kernels. */
#ifndef VODR_FUSED_BRICK_H
#define VODR_FUSED_BRICK_H

#include "fused_kernels.h"
#include "view.h"
#include "vodr.h"

typedef struct fused_brick {
    const vodr_volume *volume;
    const fused_kernels *kernels;
    int32_t density_bits;
    bool linear, wide;     /* wide: 12-bit densities in 64-bit words */
    bool direct;           /* the volume's voxels are 8-bit densities: rows inside it are read where they lie */
    int32_t row_words;     /* of a row */
    int32_t origin_vox[3]; /* voxel of word 0 */
    fused_texture texture;
    void *words;
    void *rows; /* of one plane: densities that were converted or clamped to the volume's edge */
} fused_brick;

/* The bricks that make the frame cheapest, in voxels along each axis: long along the rows of the screen, small enough
 * for a level-1 cache. False when samples are so few that repacking bricks for them is no gain. */
bool fused_brick_edges(const vodr_machine *m, const vodr_view *view, int32_t edge_vox[3]);

/* Room for one brick of these edges. Free with fused_brick_finish() in either case. */
vodr_status fused_brick_start(fused_brick *b, const vodr_machine *m, const vodr_volume *volume,
                              const int32_t edge_vox[3], const fused_kernels *kernels, vodr_error *error);

/* Repacks the voxels of `box`. *min and *max receive bounds of the densities that its samples can have. */
void fused_brick_load(fused_brick *b, const vox_box *box, int32_t *min, int32_t *max);

void fused_brick_finish(fused_brick *b);

#endif
