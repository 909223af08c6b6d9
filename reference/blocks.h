/* blocks.h - private to reference/: the range of the voxels in each block, and what a transfer function makes of it. */
#ifndef REFERENCE_BLOCKS_H
#define REFERENCE_BLOCKS_H

#include "hull.h"

/* Ranges of stored values that samples in a block can have; block (i, j, l) is number (l*count[1] + j)*count[0] + i. */
typedef struct blocks {
    int32_t edge_vox, count[3];
    float *least, *most; /* owned; NULL: not made */
    uint8_t *distance;   /* owned; of blocks_classify() */
    double *known;       /* owned; what distance was made from */
    size_t known_count;
} blocks;

/* Room for the ranges of blocks of edge_vox cells (kernel_types.h), which is empty. */
reference_status blocks_alloc(const reference_volume *v, int32_t edge_vox, blocks *b, vodr_error *error);

/* The same with the ranges of voxels in it. */
reference_status blocks_make(const reference_volume *v, int32_t edge_vox, blocks *b, vodr_error *error);
void blocks_free(blocks *b);

/* Makes b->distance for a table: 0 where a block may show something, else, with `far`, how many blocks away, diagonals
 * counting 1, the nearest such block is (255 at most); without, 1. Asked again for the same, it is there already. */
reference_status blocks_classify(blocks *b, const reference_table *table, double scale, double offset, bool far,
                                 vodr_error *error);

/* Fills shows[] for the codes of cells (kernel_cells): whether a table shows anything of what a code stands for. */
reference_status blocks_classify_cells(hull_scale s, const reference_table *table, double scale, double offset,
                                       uint8_t shows[CELL_CODES], vodr_error *error);

/* Fills codes[] of the greatest values in the blocks, for KERNEL_LEAP, and what they stand for. */
void blocks_encode(const blocks *b, hull_scale s, uint16_t *codes, kernel_bounds *bounds);

static inline size_t blocks_count(const blocks *b)
{
    return (size_t)b->count[0] * (size_t)b->count[1] * (size_t)b->count[2];
}

#endif
