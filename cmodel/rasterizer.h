/* rasterizer.h - the fragments of a slice: runs of pixels, row by row from the top, left to right (Figure 2). */
#ifndef VODR_RASTERIZER_H
#define VODR_RASTERIZER_H

#include "view.h"

enum { RASTER_ROWS = 32 }; /* found at once */

/* A border of the brick as a bound on x: floor(n/divisor) + 1 with n growing by `step` a row. */
typedef struct raster_edge {
    int64_t n, step, divisor;
} raster_edge;

/* The same in doubles: the floor of at + i*step on row i. */
typedef struct raster_line {
    double at, step;
} raster_line;

typedef struct rasterizer {
    px_rect bound;                 /* no fragment lies outside */
    int32_t y, end_y;              /* the next row, and behind the last, to look at */
    bool any, rounds;              /* a row had fragments; doubles are wide enough */
    int32_t axes;                  /* along which x moves; each has an edge on the left and one on the right */
    raster_edge left[3], right[3]; /* on row bound.y0 */
    raster_line left_line[3], right_line[3]; /* likewise; beyond `axes` the bound */
    int32_t filled_y0, filled_y1;            /* rows whose runs are known: */
    int32_t x0[RASTER_ROWS], x1[RASTER_ROWS];
} rasterizer;

/* The slice's fragments within `bound`. */
void rasterizer_start(rasterizer *r, const brick_slice *slice, const px_rect *bound);

/* The next row that has fragments; false after the last. */
bool rasterizer_next(rasterizer *r, span *s);

#endif
