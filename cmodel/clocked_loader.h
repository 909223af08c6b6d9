/* clocked_loader.h - the texture unit's loader: which bricks lie in texture memory, which are on their way, and which
 * visit is being drawn (docs/timing.md, section 6). It joins the texture unit's buffers with what comes from memory. */
#ifndef VODR_CLOCKED_LOADER_H
#define VODR_CLOCKED_LOADER_H

#include "clocked_blocks.h"
#include "texture_unit.h"

enum { LOADER_VISITS = 8 }; /* more than divider, slice generator and rasterizer can hold */

typedef struct loader_visit {
    int buffer;
    uint64_t brick;
    vox_box region;
    int64_t bytes; /* to load; 0: the brick is there */
} loader_visit;

typedef struct loader {
    const vodr_machine *machine;
    int32_t dims_vox[3];
    int64_t texture_base, brick_room_bytes;
    int buffer_count;
    texture_buffer *buffers;            /* in which densities lie */
    uint64_t held[2];                   /* bricks that buffers hold or will, once all visits are loaded; */
    bool holds[2];                      /* if any */
    int last_buffer;                    /* of the visit that came last */
    loader_visit visits[LOADER_VISITS]; /* by number */
    int64_t known, wanted, asked;       /* visits that came; up to which the bus was asked, and has granted in full */
    int64_t loaded, drawn, drained; /* that have their brick; that the rasterizer has gone through; and the fetches */
    int64_t done_bytes;             /* of the brick that comes */
} loader;

/* Visits of `whole` need no loading. */
void loader_start(loader *l, const block_setup *setup, texture_buffer *buffers);

/* One cycle: takes visits and data in, asks for bricks. fetches: voxels are fetched in it for a fragment that was
 * accepted before. */
void loader_clock(loader *l, const texture_unit_in *in, bool fetches, load_port *out);

/* Whether the visit that is drawn next, or now, has its brick. */
bool loader_ready(const loader *l);

/* The buffer of that visit. */
int loader_buffer(const loader *l);

#endif
