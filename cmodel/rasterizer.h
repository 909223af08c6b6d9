/* rasterizer.h - the fragments of a slice: runs of pixels, row by row from the top, left to right (Figure 2). */
#ifndef VODR_RASTERIZER_H
#define VODR_RASTERIZER_H

#include "view.h"

/* One border of the brick as a bound on x: on row y the bound is floor(n/d) + 1 with n affine in y. Kept as quotient
 * and remainder, so that a row further down costs two additions. */
typedef struct raster_edge {
    int64_t quotient, remainder, divisor;
    int64_t quotient_step, remainder_step;
} raster_edge;

typedef struct rasterizer {
    const brick_slice *slice;
    px_rect bound;
    int32_t y;
    int edges; /* left[] and right[], one of each for an axis along which x moves */
    raster_edge left[3], right[3];
} rasterizer;

/* The slice's fragments within `bound`. The slice must outlive the walk. */
void rasterizer_start(rasterizer *r, const brick_slice *slice, const px_rect *bound);

/* The next row that has fragments; false after the last. */
bool rasterizer_next(rasterizer *r, span *s);

#endif
