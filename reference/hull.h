/* hull.h - private to reference/: what samples of a cubic filter can be, of cells and of blocks of them.
 *
 * Along an axis a cell's cubic is a Bezier curve whose four points follow from the four voxels around (Kye, equation
 * 4); in three axes it has 64 of them, made one axis after the other, and lies between the least and the greatest.
 * Bounds are rounded outward past what sampling rounds. */
#ifndef REFERENCE_HULL_H
#define REFERENCE_HULL_H

#include <stddef.h>

#include "kernel_types.h"
#include "lanes.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What a block's bound is made of. */
typedef enum hull_bound {
    HULL_BEZIER, /* the Bezier points of its cells */
    HULL_RIVAL,  /* the extremes of the voxels that they read, and what the worst of such voxels overshoots */
    HULL_UNSAFE, /* the same with what the worst along one axis overshoots: too little */
} hull_bound;

/* Samples of the volume lie within [least, most]; cells are bounded in 255 steps of it. */
typedef struct hull_scale {
    float least, most, inverse; /* inverse: steps a unit */
    float margin;               /* more than what samples and bounds are rounded by */
} hull_scale;

/* The scale of a volume whose voxels, or coefficients, lie within [least, most]. */
hull_scale hull_scale_of(bool spline, float least, float most);

/* How much of the distance of voxels' extremes a bound adds on both sides. */
float hull_share(hull_bound bound, bool spline);

/* The voxels [*lo, *hi) that samples in block i of an axis are made of. */
HOST_AND_KERNEL void hull_voxels(int32_t i, int32_t edge_vox, int32_t dim_vox, int32_t *lo, int32_t *hi)
{
    const int32_t last = dim_vox - 1, from = i * edge_vox - 2, to = i * edge_vox + edge_vox;
    *lo = from < 0 ? 0 : from < last ? from : last;
    *hi = to < last ? to + 1 : dim_vox;
}

/* A cell's code (kernel_cells), of bounds as they are without the margin. */
HOST_AND_KERNEL uint16_t hull_code(hull_scale s, float least, float most)
{
    const float low = (least - s.margin - s.least) * s.inverse, high = (s.most - most - s.margin) * s.inverse;
    const int32_t below = (int32_t)(low > 0 ? low : 0), above = (int32_t)(high > 0 ? high : 0);
    return (uint16_t)((below < 255 ? below : 255) | (255 - (above < 255 ? above : 255)) << 8);
}

/* What a cell's codes stand for, with a margin for how they are rounded. */
double hull_least(hull_scale s, uint32_t code);
double hull_greatest(hull_scale s, uint32_t code);

/* ---- the CPU ---- */

typedef struct hull_job {
    reference_volume volume; /* voxels, or coefficients of B-splines */
    bool spline;
    int32_t edge_vox, count[3]; /* of blocks */
    hull_scale scale;
    float share; /* rival */
    float *least, *most;
    uint16_t *codes; /* of cells; NULL: none; Bezier */
} hull_job;

/* Bounds the layers [l0, l1) of blocks. False when the host is out of memory. */
typedef bool hull_fill(const hull_job *job, int32_t l0, int32_t l1);

typedef struct hull_rows {
    hull_fill *hull, *rival;
    /* The least and the greatest voxel of each layer from z0 to z1 - 1, at place 2*z. */
    bool (*extremes)(const reference_volume *v, int32_t z0, int32_t z1, float *extremes);
} hull_rows;

extern const hull_rows hull_rows_portable, hull_rows_avx2, hull_rows_avx512;

#ifdef __cplusplus
}
#endif

#endif
