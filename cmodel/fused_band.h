/* fused_band.h - rows of the frame while they are drawn, with their place in the order of bricks (fuses volume_divider
 * and frame_buffer): one thread at a time draws brick after brick in visibility order, so that every pixel meets its
 * fragments in the machine's order. Between two bricks a band can be cut in two. */
#ifndef VODR_FUSED_BAND_H
#define VODR_FUSED_BAND_H

#include "fused_kernels.h"
#include "marks.h"
#include "texture_unit.h"
#include "view.h"
#include "vodr.h"
#include "volume_divider.h"

/* What all threads draw from; constant while they do. */
typedef struct fused_scene {
    const vodr_machine *machine; /* the one drawn */
    vodr_machine walk;           /* the same picture, in layers of all bricks */
    const vodr_volume *volume;
    const vodr_view *view;
    const fused_kernels *kernels;
    const texture_unit *texture; /* for its tables */
    texture_unit direct;         /* sparse: the same, drawing the volume whole */
    bool sparse;                 /* so few samples that voxels are fetched one by one from the volume, undivided; */
    bool cubic;                  /* or 64 a sample, too: undivided when there are few samples, else by bricks */
    bool droppable;              /* fragments of a transparent brick leave no trace, neither in frame nor in marks */
    int32_t edge_vox[3];         /* of the fast path's bricks; undivided: of the volume */
    uint32_t *table8;            /* by density: a packed colour, or in mip a token; */
    uint64_t *table16;           /* or, where a pixel's channels have 16 bits, a packed colour */
    marks marks;                 /* filled by all, each thread its rows */
    vodr_frame *frame;           /* likewise */
} fused_scene;

typedef struct fused_band {
    const fused_scene *scene;
    px_rect px;
    size_t stride_px;       /* of its rows, with room for a group of lanes beyond */
    void *pixels;           /* 32 or 64 bits each, as the tables; owned */
    volume_divider divider; /* stands at the brick drawn last */
} fused_band;

/* Index of a pixel of the frame in the band's. */
static inline size_t fused_band_at(const fused_band *b, int32_t x, int32_t y)
{
    return (size_t)(y - b->px.y0) * b->stride_px + (size_t)x;
}

/* Rows y0_px to y1_px-1, nothing drawn. Free with fused_band_finish() in either case. */
vodr_status fused_band_start(fused_band *b, const fused_scene *scene, int32_t y0_px, int32_t y1_px, vodr_error *error);

/* The rows from y_px on, as far as they are drawn, become a band of their own: `other` is new. */
vodr_status fused_band_split(fused_band *b, int32_t y_px, fused_band *other, vodr_error *error);

/* Writes the finished rows to the frame. */
void fused_band_store(const fused_band *b);

void fused_band_finish(fused_band *b);

#endif
