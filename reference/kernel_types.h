/* kernel_types.h - what a kernel is given: plain data, the same on the CPU and on a card, pointers aside. */
#ifndef REFERENCE_KERNEL_TYPES_H
#define REFERENCE_KERNEL_TYPES_H

#include "reference.h"

/* Reconstruction, as kernels know it: the filters of reference.h, and what numbers make of them. */
typedef enum kernel_filter {
    KERNEL_NEAREST,
    KERNEL_LINEAR,  /* from the voxels as they are */
    KERNEL_CELLS,   /* the same filter, from packed cells */
    KERNEL_TEXTURE, /* weights of 8 fraction bits */
    KERNEL_CUBIC,   /* of 64 voxels: kernel_cubic.h */
    KERNEL_FILTERS,
} kernel_filter;

/* What becomes of the samples of a ray. */
typedef enum kernel_mode {
    KERNEL_OVER,
    KERNEL_LIT,
    KERNEL_MIP,
    KERNEL_LEAP,   /* mip past blocks: kernel_leap.h */
    KERNEL_SEARCH, /* mip best bounds first: kernel_search.h */
    KERNEL_MODES
} kernel_mode;

/* Whether blocks with nothing to show are passed over, in KERNEL_OVER and KERNEL_LIT; with KERNEL_SKIP_CELLS, of
 * KERNEL_CUBIC, cells too. */
typedef enum kernel_skip { KERNEL_SKIP_NONE, KERNEL_SKIP_EMPTY, KERNEL_SKIP_CELLS, KERNEL_SKIPS } kernel_skip;

/* One pixel's ray, clipped to the volume, or to a box of it: sample n of `count` lies at start + (n + skipped)*step, in
 * voxels of the whole volume. */
typedef struct kernel_ray {
    double start[3], step[3]; /* start: where the ray enters the whole volume */
    int32_t skipped;          /* samples in the whole volume before the box */
    int32_t count;
    int32_t first; /* number of sample 0 on the ray before it was clipped: the same plane for all pixels */
} kernel_ray;

/* Which samples of the whole volume are drawn, and where in it the voxels at hand begin. */
typedef struct kernel_part {
    int32_t whole_vox[3], origin_vox[3], lo_vox[3], hi_vox[3];
    bool boxed; /* lo and hi are not the whole volume's */
} kernel_part;

/* How the voxels of KERNEL_CUBIC lie in memory. */
typedef enum kernel_layout {
    KERNEL_PLAIN, /* x fastest, then y, then z; beyond the border there is nothing */
    KERNEL_WIDE,  /* in steps of `stride`; LAYOUT_MARGIN_VOX beyond each border are there, and `voxels` is the first
                     within it */
    KERNEL_QUADS, /* likewise, four rows as one: LAYOUT_QUAD voxels along y for each x; `stride` of y is of four rows */
} kernel_layout;

/* The filter reads so many voxels beyond the border: a sample may lie half a voxel beyond the centre of the last. */
enum { LAYOUT_MARGIN_VOX = 2, LAYOUT_QUAD = 4 };

/* Cell i of an axis lies between the centres of voxels i-1 and i, clamped to the volume, so that an axis has one more
 * than voxels. A position p voxels from the volume's corner lies in cell floor(p + 0.5). */
typedef struct kernel_volume {
    int32_t dims_vox[3];
    reference_voxel type;
    const void *voxels;
    kernel_layout layout;       /* KERNEL_CUBIC: how voxels lie in memory */
    int32_t stride[3];          /* KERNEL_CUBIC: voxels from one to the next along each axis */
    const void *cells;          /* the voxels around each cell, together: as lanes_*.h of the device reads them */
    unsigned long long texture; /* CUDA: the same voxels as a texture object; normalised where they are integers */
    bool spline;                /* KERNEL_CUBIC: voxels are coefficients of B-splines, not values of cardinal ones */
} kernel_volume;

/* Blocks of `edge` cells. distance[b]: 0, the block is to be sampled; D, no block closer than D, diagonals counting 1,
 * has anything to show. */
typedef struct kernel_blocks {
    int32_t edge_vox, count[3];
    const uint8_t *distance; /* over */
    const uint16_t *most;    /* KERNEL_LEAP: a code of the greatest value that a sample in the block can have */
    bool bisects, seeds;     /* KERNEL_LEAP: blocks are left by bisection; the middle sample comes first */
} kernel_blocks;

/* What samples of KERNEL_CUBIC can be in each cell, as codes of 8 bits: the least below, the greatest above.
 * KERNEL_SKIP_CELLS: shows[code] says whether the cell is to be sampled. KERNEL_LEAP: the greatest is at most code*step
 * + base; with a step of 0 cells are not looked at. */
typedef struct kernel_cells {
    const uint16_t *codes;
    const uint8_t *shows;
    double step, base;
} kernel_cells;

enum { CELL_CODES = 1 << 16 };

/* What samples can be at most, as codes that rise with it: grid 0 has the code of each cell; entry (i, j, l) of grid k
 * that of a window of four times 2^k cells a side, which begins at cell (i, j, l)*2^k. The last grid has one entry. On
 * the CPU grid 0 lies in bricks of BOUND_BRICK^3 cells, so that few lines of a cache hold what a run of rays meets. */
enum { BOUND_GRIDS = 17, BOUND_BRICK = 4, BOUND_BRICK_CELLS = BOUND_BRICK * BOUND_BRICK * BOUND_BRICK };

typedef struct kernel_bounds {
    const uint16_t *codes;
    const uint16_t *near; /* as grid 1, of windows of six cells a side; where cells lie in bricks */
    int32_t levels, count[BOUND_GRIDS][3];
    int64_t offset[BOUND_GRIDS]; /* of a grid in codes */
    float scale, offset_value;   /* a code stands for code*scale + offset_value */
} kernel_bounds;

/* Colour of a sample: entries of r, g, b, a. Each row has a copy of its last entry behind it, and the last row a copy
 * below, so that what is linear between entries needs no care at the ends. */
typedef struct kernel_table {
    int32_t columns, rows;
    const void *rgba;      /* of the numbers drawn in; entry (row, column) is number row*(columns + 1) + column */
    double first, last;    /* columns between which a sample may show something; with one row */
    double scale, offset;  /* column = (stored*scale + offset) * (columns - 1) */
    double gradient_scale; /* row = gradient magnitude, of stored values a finest voxel, times this * (rows - 1) */
} kernel_table;

/* Which pixel a lane takes: column i and row j of the order are a pixel of the frame, each pixel of just one of them.
 * Runs along a row of the order are runs of pixels along a line of the picture: (i, j + first + shift) where shift is
 * the whole number nearest i*slope/2^16, with `steep` x and y exchanged. All zeros but columns and rows: the frame's
 * own rows. kernel_order.h. */
typedef struct kernel_order {
    bool steep;
    int32_t slope; /* -2^16 to 2^16 */
    int32_t first, columns, rows;
    int32_t tile_log2; /* the CPU: of pixels that a tile is wide, 2 or more */
} kernel_order;

typedef struct kernel_frame {
    reference_camera camera;
    kernel_order order;
    kernel_volume volume;
    kernel_part part;
    kernel_blocks blocks;
    kernel_cells cells;
    kernel_bounds bounds; /* KERNEL_SEARCH; of KERNEL_LEAP only what a code stands for */
    kernel_table table;
    kernel_filter filter;
    kernel_skip skip;
    double termination;
    bool phong;
    bool stored;          /* mip: the greatest stored value comes out, and 1 where there is one */
    double surface_scale; /* phong: from a gradient magnitude of 1/surface_scale on there is a whole surface */
} kernel_frame;

/* ---- the machine's arithmetic ---- */

typedef struct kernel_fixed {
    vodr_view view;
    int32_t dims_vox[3], voxel_bytes, density_bits, weight_bits, guard_bits, bits; /* bits: of a channel of the frame */
    int32_t blend, filter;                                                         /* of vodr_hw.h */
    const void *voxels;
    const uint16_t *map;    /* of 256 entries; 8-bit voxels only */
    const vodr_rgba *table; /* of the frame's bits */
} kernel_fixed;

#endif
