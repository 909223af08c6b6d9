/* fused_band.h - a band of the frame's rows, drawn by one thread with small bricks in visibility order (fuses
 * volume_divider, slice_generator, rasterizer, texture_unit and alpha_blender). */
#ifndef VODR_FUSED_BAND_H
#define VODR_FUSED_BAND_H

#include "fused_brick.h"
#include "fused_kernels.h"
#include "marks.h"
#include "texture_unit.h"
#include "view.h"
#include "vodr.h"

/* What all threads draw from; constant while they do. */
typedef struct fused_scene {
    const vodr_machine *machine; /* the one drawn */
    vodr_machine walk;           /* the same picture, in layers of all bricks */
    const vodr_volume *volume;
    const vodr_view *view;
    const fused_kernels *kernels;
    const texture_unit *texture; /* for its tables */
    texture_unit direct;         /* sparse: the same, drawing the volume whole */
    bool sparse;                 /* so few samples that voxels are fetched one by one from the volume, undivided */
    bool droppable;              /* fragments of a transparent brick leave no trace, neither in frame nor in marks */
    int32_t edge_vox[3];         /* of the fast path's bricks; sparse: of the volume */
    uint32_t *table8;            /* by density: a packed colour, or in mip a token; */
    uint64_t *table16;           /* or, where a pixel's channels have 16 bits, a packed colour */
    marks marks;                 /* filled by all, each thread its rows */
    vodr_frame *frame;           /* likewise */
} fused_scene;

/* Part of a batch: so many fragments on a row of the frame. */
typedef struct band_row {
    int32_t y, x, count;
} band_row;

/* One thread's brick, batch and band. Aligned to 64 bytes. */
typedef struct fused_band {
    const fused_scene *scene;
    fused_brick brick;
    fused_batch batch;
    int32_t count;              /* fragments in the batch, */
    int32_t k;                  /* all of one slice */
    band_row rows[FUSED_BATCH]; /* where they go; none is empty */
    int32_t row_count;
    px_rect px;       /* the band */
    size_t stride_px; /* of its rows, with room for a group of lanes beyond */
    void *pixels;     /* 32 or 64 bits each, as the tables */
} fused_band;

vodr_status fused_band_start(fused_band *b, const fused_scene *scene, vodr_error *error);

/* Draws rows y0_px to y1_px-1 into the frame, and their marks. */
vodr_status fused_band_draw(fused_band *b, int32_t y0_px, int32_t y1_px, vodr_error *error);

void fused_band_finish(fused_band *b);

#endif
