/* blocks.h - private to reference/: the range of the voxels in each block, and what a transfer function makes of it. */
#ifndef REFERENCE_BLOCKS_H
#define REFERENCE_BLOCKS_H

#include "kernel_types.h"

/* Ranges of stored values that samples in a block can have; block (i, j, l) is number (l*count[1] + j)*count[0] + i. */
typedef struct blocks {
    int32_t edge_vox, count[3];
    float *least, *most; /* owned; NULL: not made */
    uint8_t *distance;   /* owned; of blocks_classify() */
    double *known;       /* owned; what distance was made from */
    size_t known_count;
} blocks;

/* Makes the ranges of blocks of edge_vox cells (kernel_types.h). */
reference_status blocks_make(const reference_volume *v, int32_t edge_vox, blocks *b, vodr_error *error);
void blocks_free(blocks *b);

/* Makes b->distance for a table: 0 where a block may show something, else, with `far`, how many blocks away, diagonals
 * counting 1, the nearest such block is (255 at most); without, 1. Asked again for the same, it is there already. */
reference_status blocks_classify(blocks *b, const reference_table *table, double scale, double offset, bool far,
                                 vodr_error *error);

static inline size_t blocks_count(const blocks *b)
{
    return (size_t)b->count[0] * (size_t)b->count[1] * (size_t)b->count[2];
}

#endif
