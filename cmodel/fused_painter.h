/* fused_painter.h - one thread's tools to draw bricks with (fuses slice_generator, rasterizer, texture_unit and
 * alpha_blender). */
#ifndef VODR_FUSED_PAINTER_H
#define VODR_FUSED_PAINTER_H

#include "fused_band.h"
#include "fused_brick.h"
#include "fused_kernels.h"

/* Part of a batch: so many fragments on a row of the frame. */
typedef struct band_row {
    int32_t y, x, count;
} band_row;

/* Aligned to 64 bytes. */
typedef struct fused_painter {
    const fused_scene *scene;
    fused_band *band; /* drawn on at the moment */
    fused_brick brick;
    fused_batch batch;
    int32_t count;              /* fragments in the batch, */
    int32_t k;                  /* all of one slice */
    band_row rows[FUSED_BATCH]; /* where they go; none is empty */
    int32_t row_count;
} fused_painter;

/* Free with fused_painter_finish() in either case. */
vodr_status fused_painter_start(fused_painter *p, const fused_scene *scene, vodr_error *error);

/* Draws a brick on a band, and its marks. */
void fused_painter_draw(fused_painter *p, fused_band *band, const candidate *c);

void fused_painter_finish(fused_painter *p);

#endif
