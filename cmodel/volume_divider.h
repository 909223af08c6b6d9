/* volume_divider.h - cuts the volume into bricks and hands them out in visibility order (Figures 1, 3 and 4 of the
 * paper).
 *
 * The divider proposes candidates: bricks (in `tile` order, bricks with the tile they are clipped to) that may have
 * fragments. A candidate becomes a visit when the rasterizer finds its first fragment. */
#ifndef VODR_VOLUME_DIVIDER_H
#define VODR_VOLUME_DIVIDER_H

#include "projection.h"
#include "view.h"
#include "vodr.h"

typedef struct candidate {
    vox_box box;
    size_t brick;   /* number of the brick, x fastest */
    px_rect bound;  /* its fragments lie within */
    int32_t k0, k1; /* and on slices [k0, k1) */
} candidate;

typedef struct volume_divider {
    const vodr_view *view;
    projection projection;
    vox_box drawn;       /* what the bricks make up */
    int32_t edge_vox[3]; /* of a brick */
    int32_t bricks[3];   /* along each axis */
    int32_t nest[3];     /* axes of the three loops, outermost first */
    int32_t *order[3];   /* indices along an axis, in the order visited */
    uint8_t *empty;      /* by brick number; NULL unless skip_empty */
    uint64_t empty_bricks;
    int32_t tile_px;    /* edge of a screen tile; 0 when the window is not cut */
    int32_t tile_first; /* of all tiles, row by row, the first that is drawn, */
    int32_t tile_step;  /* and from one to the next */
    int32_t tile_at;    /* number of the current one */
    px_rect tile;       /* the current one, or the whole window */
    px_rect window;     /* the part of the frame that is drawn */
    int32_t at[3];      /* loop counters, outermost first */
    bool started, left; /* left: the loops stand at a brick */
    int32_t setup_cycles;
    int64_t work_cycles; /* of bounding boxes and looking up empty bricks, not yet told */
} volume_divider;

/* The brick's edge that a machine uses for a view, in voxels (the paper's section 3.1):
 * its own `brick`, else the largest that its footprint and texture memory allow, at least brick_min. 0 for `whole`. */
int32_t volume_divider_edge(const vodr_machine *m, const vodr_view *view);

/* VODR_INVALID when a brick of this edge, with its border, does not fit the machine's texture memory. */
vodr_status volume_divider_check(const vodr_machine *m, const int32_t dims_vox[3], int32_t edge_vox, vodr_error *error);

/* Prepares a walk over the fragments within `window`, a part of the frame, in bricks of edge_vox voxels along each
 * axis. For skip_empty, transparent_to[lo] >= hi exactly when every density of [lo, hi] is transparent. Free with
 * volume_divider_finish() in either case. */
vodr_status volume_divider_start(volume_divider *d, const vodr_machine *m, const vodr_volume *volume,
                                 const vodr_view *view, const int32_t edge_vox[3], const px_rect *window,
                                 const int32_t *transparent_to, vodr_error *error);

/* Begins the walk, whose window is the frame, anew over the share of one of the machine's pipelines: some of the tiles,
 * else a band of the frame, which may be empty. */
void volume_divider_deal(volume_divider *d, const vodr_machine *m, int32_t pipeline);

/* The index that axis c is walked towards from both ends, and visited last; in `under` it is the first. In perspective
 * that of the eye's brick or, where the eye is beyond the volume, of the nearest; in parallel views that of the nearest
 * end. */
int32_t volume_divider_eye(const volume_divider *d, int c);

/* The next candidate in visibility order; false after the last, and from then on. */
bool volume_divider_next(volume_divider *d, candidate *c);

/* Cuts the window in two while it is walked over, in an order without tiles: `other`, which is new, goes on from the
 * same brick over the rows from y_px on, and `d` over those above. Free `other` in either case. */
vodr_status volume_divider_split(volume_divider *d, int32_t y_px, volume_divider *other, vodr_error *error);

/* Cycles that the walk took since the last call: brick_setup_cycles for each slab, row or brick bounded, one for each
 * brick that skip_empty left out. */
int64_t volume_divider_work(volume_divider *d);

/* How far the walk is, 0 to 1. */
double volume_divider_done(const volume_divider *d);

void volume_divider_finish(volume_divider *d);

#endif
