/* rasterizer.h - the fragments of a slice: runs of pixels, row by row from the top, left to right (Figure 2). */
#ifndef VODR_RASTERIZER_H
#define VODR_RASTERIZER_H

#include "view.h"

/* The brick's borders as bounds on x. On row y a bound is floor(n/divisor) + 1 with n affine in y; kept as quotient and
 * remainder, so that a row further down costs two additions. Bounds from the left come first, as many from the right
 * follow: one of each for an axis along which x moves. */
typedef struct raster_edges {
    int32_t count;
    int64_t quotient[6], remainder[6], divisor[6];
    int64_t quotient_step[6], remainder_step[6];
} raster_edges;

typedef struct rasterizer {
    const brick_slice *slice;
    px_rect bound;
    int32_t y;
    bool any;       /* a row had fragments */
    int64_t row[3]; /* the plane's numerators at (0, y) */
    raster_edges edges;
} rasterizer;

/* The slice's fragments within `bound`. The slice must outlive the walk. */
void rasterizer_start(rasterizer *r, const brick_slice *slice, const px_rect *bound);

/* The next row that has fragments; false after the last. */
bool rasterizer_next(rasterizer *r, span *s);

#endif
