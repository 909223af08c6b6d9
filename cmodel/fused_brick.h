/* fused_brick.h - a brick repacked for the fast path's kernels. */
#ifndef VODR_FUSED_BRICK_H
#define VODR_FUSED_BRICK_H

#include "fused_kernels.h"
#include "view.h"
#include "vodr.h"

enum { FUSED_EDGE_VOX = 16 }; /* its words fit a level-1 cache of 32 KiB beside a batch */

typedef struct fused_brick {
    const vodr_volume *volume;
    int32_t density_bits;
    bool linear, wide;     /* wide: 12-bit densities in 64-bit words */
    int32_t origin_vox[3]; /* voxel of word 0 */
    fused_texture texture;
    void *words;
    uint16_t *voxels; /* the brick with its border, clamped to the volume's edge */
} fused_brick;

/* Room for one brick of FUSED_EDGE_VOX. Free with fused_brick_finish() in either case. */
vodr_status fused_brick_start(fused_brick *b, const vodr_machine *m, const vodr_volume *volume, vodr_error *error);

/* Repacks the voxels of `box`; false, and nothing packed, when every density that its samples can have is transparent
 * (transparent_to as for volume_divider_start()). */
bool fused_brick_load(fused_brick *b, const vox_box *box, const int32_t *transparent_to);

void fused_brick_finish(fused_brick *b);

#endif
