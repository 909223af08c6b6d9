/* rasterizer.h - the fragments of a slice: runs of pixels, row by row from the top, left to right (Figure 2). */
#ifndef VODR_RASTERIZER_H
#define VODR_RASTERIZER_H

#include "view.h"

typedef struct rasterizer {
    const brick_slice *slice;
    px_rect bound;
    int32_t y;
} rasterizer;

/* The slice's fragments within `bound`. The slice must outlive the walk. */
rasterizer rasterizer_start(const brick_slice *slice, const px_rect *bound);

/* The next row that has fragments; false after the last. */
bool rasterizer_next(rasterizer *r, span *s);

#endif
