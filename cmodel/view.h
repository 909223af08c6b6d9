/* view.h - exact positions: the arithmetic that every block shares (docs/architecture.md, "Positions"), and what the
 * blocks hand to each other: slices of bricks and spans of fragments.
 *
 * With A the numerator of a slice at a pixel, a position is base + (A >> shift), component by component. A is affine in
 * x and y on each slice, in both projections, so that whether a sample lies in a box is a question about A alone. */
#ifndef VODR_VIEW_H
#define VODR_VIEW_H

#include "vodr.h"

/* One slice: A(x, y) = origin + x*step_u + y*step_v, each component. */
typedef struct slice_plane {
    int64_t origin[3], step_u[3], step_v[3];
} slice_plane;

/* A half-open box of voxels. */
typedef struct vox_box {
    int32_t lo[3], hi[3];
} vox_box;

/* A half-open rectangle of pixels. */
typedef struct px_rect {
    int32_t x0, y0, x1, y1;
} px_rect;

/* One slice of one brick: the brick's borders as limits of the plane's numerators. The sample of pixel (x, y) belongs
 * to the brick exactly when lo <= A(x, y) < hi on each component. */
typedef struct brick_slice {
    int32_t k;
    slice_plane plane;
    int64_t lo[3], hi[3];
} brick_slice;

/* Pixels [x0, x1) of row y, all inside the brick. */
typedef struct span {
    int32_t y, x0, x1;
} span;

/* Depth of slice k of a perspective view. */
static inline int64_t slice_depth(const vodr_view *v, int32_t k)
{
    return (v->depth_first + k * v->depth_step) >> VODR_DEPTH_BITS;
}

static inline slice_plane slice_plane_of(const vodr_view *v, int32_t k)
{
    slice_plane p;
    int64_t z = v->perspective ? slice_depth(v, k) : 1;
    for (int c = 0; c < 3; c++) {
        p.origin[c] = v->perspective ? z * v->step_s[c] : k * v->step_s[c];
        p.step_u[c] = z * v->step_u[c];
        p.step_v[c] = z * v->step_v[c];
    }
    return p;
}

/* A, component c, at pixel (x, y). */
static inline int64_t numerator_at(const slice_plane *p, int c, int32_t x, int32_t y)
{
    return p->origin[c] + x * p->step_u[c] + y * p->step_v[c];
}

/* The A at which a position reaches voxel border `vox`: position >= vox exactly when A >= border_of(). */
static inline int64_t border_of(const vodr_view *v, int c, int32_t vox)
{
    return (((int64_t)vox << VODR_POSITION_BITS) - v->base[c]) * ((int64_t)1 << v->shift);
}

#endif
