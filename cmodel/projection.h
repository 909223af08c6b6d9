/* projection.h - where a box of voxels can appear: a rectangle of pixels and a range of slices that no fragment of the
 * box lies outside of (docs/timing.md, section 2). It only saves work: which fragments there are is decided by the
 * rasterizer.
 *
 * The inverse of the view is derived once a frame into registers; a box then costs multiplications of its borders by 32
 * bits and sums, and in perspective four divisions whose quotients have no more than 15 bits. */
#ifndef VODR_PROJECTION_H
#define VODR_PROJECTION_H

#include "view.h"

/* An affine function of a position in voxels, bounded over boxes. With s the sum of m[c] times a box's border on each
 * axis, whichever makes it least, no position in the box has less than s + lo; with the sum greatest, none more than
 * s + hi. */
typedef struct bound_row {
    int32_t m[3];
    int64_t lo, hi;   /* magnitude below 2^52 */
    int32_t fraction; /* bits, 0 to 24 */
} bound_row;

/* k: slices, and in parallel views x, y: pixels. Their lo is rounded such that (s + lo) >> fraction is the first slice
 * or pixel, and hi such that (s + hi) >> fraction is the one after the last. In perspective x, y are numerators over z
 * of a pixel's distance from the frame's middle. A function that does not fit its registers is bounded by everything.
 */
typedef struct projection {
    bool perspective;
    int32_t slices;
    int32_t centre_px[2]; /* perspective: the frame's middle */
    bound_row x, y, z, k;
} projection;

/* Of a view that was checked, for boxes within a volume of these sides. */
projection projection_of(const vodr_view *view, const int32_t dims_vox[3]);

/* Bounds of the fragments of `box` within `clip`: false when there can be none. Slices are [*k0, *k1). */
bool projection_bound(const projection *p, const vox_box *box, const px_rect *clip, px_rect *bound, int32_t *k0,
                      int32_t *k1);

#endif
