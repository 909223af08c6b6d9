/* bounds.h - private to reference/: what samples can be at most, as codes of 16 bits, block by block; and the grids of
 * kernel_bounds (kernel_types.h). Shapes serve every device; the filling is the CPU's. */
#ifndef REFERENCE_BOUNDS_H
#define REFERENCE_BOUNDS_H

#include <stddef.h>

#include "kernel_types.h"
#include "lanes.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What codes stand for: of integers themselves; of floats steps of their range, rounded up with a margin for what
 * interpolation rounds. The code of a value is ceil((value - least)*inverse). */
typedef struct bounds_code {
    float least, inverse;
    float scale, offset; /* of kernel_bounds */
    float largest;       /* magnitude of any value */
} bounds_code;

/* Reads the whole volume if its voxels are floats. */
bounds_code bounds_code_of(const reference_volume *v);

/* What a frame drawn through a filter is to use; a texture unit rounds more. */
void bounds_decode(const bounds_code *code, kernel_filter filter, kernel_bounds *b);

/* Blocks of edge_vox cells along an axis of dim_vox voxels. */
HOST_AND_KERNEL int32_t bounds_count(int32_t dim_vox, int32_t edge_vox)
{
    return dim_vox / edge_vox + 1;
}

/* The voxels [*lo, *hi) that samples in block i of an axis lie between. */
HOST_AND_KERNEL void bounds_voxels(int32_t i, int32_t edge_vox, int32_t dim_vox, int32_t *lo, int32_t *hi)
{
    *lo = i * edge_vox - 1 < 0 ? 0 : i * edge_vox - 1;
    *hi = i * edge_vox + edge_vox > dim_vox ? dim_vox : i * edge_vox + edge_vox;
    if (*lo >= dim_vox)
        *lo = dim_vox - 1;
}

/* Bricks of cells along an axis of that many cells. */
HOST_AND_KERNEL int32_t bounds_bricks(int32_t cells)
{
    return (cells + BOUND_BRICK - 1) / BOUND_BRICK;
}

/* Fills b->levels, count and offset for a volume, whose cells lie in bricks or row by row. Returns how many codes the
 * grids have in all; 0 where they have too many cells to be numbered in 32 bits. */
size_t bounds_shape(const int32_t dims_vox[3], bool bricks, kernel_bounds *b);

/* The greatest codes of the blocks of layers [l0, l1), of edge_vox cells a side. */
void bounds_fill(const reference_volume *v, const bounds_code *code, int32_t edge_vox, int32_t l0, int32_t l1,
                 uint16_t *codes);

/* Layers [r0, r1) of bricks of grid 0, and what lies there of the blocks of grid 1, of two cells a side. */
void bounds_fill_cells(const reference_volume *v, const bounds_code *code, const kernel_bounds *b, int32_t r0,
                       int32_t r1, uint16_t *codes);

/* Layers [l0, l1) of grid k from 2 on, made of the blocks of the grid below, which are not yet widened. */
void bounds_halve(const kernel_bounds *b, int32_t k, int32_t l0, int32_t l1, uint16_t *codes);

/* Makes windows of grid k's blocks: first along x and y, of the layers [l0, l1); then along z, of the rows [j0, j1). */
void bounds_widen_layers(const kernel_bounds *b, int32_t k, int32_t l0, int32_t l1, uint16_t *codes);
void bounds_widen_rows(const kernel_bounds *b, int32_t k, int32_t j0, int32_t j1, uint16_t *codes);

/* Layers [l0, l1) of kernel_bounds' `near`, made of grid 1's blocks, which are not yet widened. */
void bounds_fill_near(const kernel_bounds *b, int32_t l0, int32_t l1, const uint16_t *codes, uint16_t *near);

#ifdef __cplusplus
}
#endif

#endif
