/* projection.h - where a box of voxels can appear: a rectangle of pixels and a range of slices that no fragment of the
 * box lies outside of. It only saves work: which fragments there are is decided by exact arithmetic (the rasterizer).
 */
#ifndef VODR_PROJECTION_H
#define VODR_PROJECTION_H

#include "view.h"

/* The inverse of the view: pixel and slice as functions of a position. */
typedef struct projection {
    const vodr_view *view;
    bool usable;                /* false: the view has no inverse worth the name, every bound is the whole frame */
    double to_x[3], to_y[3];    /* parallel: pixels per voxel; perspective: numerators over to_depth */
    double to_depth[3];         /* parallel: slices per voxel; perspective: depth per voxel */
    double base[3];             /* voxels */
    double margin_px, margin_k; /* what rounding can move */
    double margin_eye;          /* perspective: a box that comes nearer the eye than this depth has no rectangle */
} projection;

projection projection_of(const vodr_view *view);

/* Bounds of the fragments of `box` within `clip`: false when there can be none. Slices are [*k0, *k1). */
bool projection_bound(const projection *p, const vox_box *box, const px_rect *clip, px_rect *bound, int32_t *k0,
                      int32_t *k1);

#endif
