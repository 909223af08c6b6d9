/* clocked_machine.h - the clocked machine's state (it joins all blocks), and a function a block that moves it by one
 * cycle.
 *
 * Whatever a block registers carries the cycle in which it did; the others see it from the next one on. So within a
 * cycle the order of these calls does not matter. */
#ifndef VODR_CLOCKED_MACHINE_H
#define VODR_CLOCKED_MACHINE_H

#include "alpha_blender.h"
#include "frame_buffer.h"
#include "layout.h"
#include "memory.h"
#include "pixel_cache.h"
#include "rasterizer.h"
#include "ring.h"
#include "slice_generator.h"
#include "texture_unit.h"
#include "vodr.h"
#include "volume_divider.h"

#define CLOCKED_NEVER INT64_MAX

enum { VISITS = 8 };

/* A brick on its way from the divider to the slice generator and the texture unit's loader. */
typedef struct brick_visit {
    candidate brick;
    int64_t work_cycles, load_bytes, load_address;
    int64_t divided, loaded, drained; /* cycles; CLOCKED_NEVER: not yet */
} brick_visit;

/* Divider to slice generator, slice generator to rasterizer: one register. */
typedef struct link {
    bool full;
    int64_t pushed, popped;
} link;

/* A fragment between rasterizer and data stage. */
typedef struct fragment {
    int32_t x, y;
    int64_t cycle; /* accepted; later looked up */
    bool dead, miss, reads, evicts, writes;
    int64_t line, victim;
    int64_t filled; /* last data of its line; CLOCKED_NEVER */
    bool evicted;   /* its victim left for the write buffer */
    vodr_rgba colour;
} fragment;

typedef struct transaction {
    int64_t raised, address, bytes, line, entry;
} transaction;

typedef struct blend_stage {
    int32_t x, y;
    int64_t cycle;
} blend_stage;

RING(fragment_ring, fragment)
RING(transaction_ring, transaction)
RING(release_ring, int64_t)

typedef struct clocked {
    const vodr_machine *m;
    const vodr_view *view;
    int64_t now, last;
    vodr_counters counters;
    vodr_cycles n;
    bool failed;

    /* what the blocks do, apart from when */
    volume_divider divider;
    texture_unit texture;
    texture_unit books; /* which brick lies in which buffer, at the time of the divider's search */
    alpha_blender blender;
    pixel_cache cache;
    frame_buffer pixels;
    uint8_t *seen;

    /* volume divider: works, then pushes */
    brick_visit visits[VISITS];   /* by number */
    int64_t found, pushed, drawn; /* numbers: searched for, pushed, taken by the slice generator; -1 */
    int64_t work_left;
    bool last_found; /* no visit follows */
    link bricks;

    /* slice generator */
    slice_generator slices;
    bool generating;
    int64_t setup_left;
    brick_slice next_slice, slice;
    int64_t slice_visit, drawn_slice_visit;
    link slice_link;

    /* rasterizer */
    rasterizer rows;
    brick_slice raster_slice;
    bool rastering, have_span;
    span current;
    int32_t next_row, done_px;
    px_rect covered;
    uint64_t covered_slices;
    bool slice_has_fragments;

    /* texture unit and its loader */
    int64_t accepted, load_visit, load_bytes, load_raised, load_grant;
    bool load_wanted, visit_accepted;
    uint16_t density;

    /* alpha blender and pixel cache */
    fragment_ring door, tagged;
    int64_t popped, last_pop, tags, reads, last_read;
    int64_t miss_tags, miss_reads, last_miss_read;
    enum { IDLE, EVICT, FILL } miss; /* of the head of `tagged` */
    blend_stage *stages;             /* the last blend_cycles reads, a ring */
    bool write_pending;
    int64_t write_granted;
    transaction departures[VISITS]; /* write-backs granted last: line, and the cycle in `raised` */
    int64_t departure_count;
    release_ring releases; /* of the write FIFO's entries, in order; CLOCKED_NEVER: still waiting */
    int64_t entries, flush_next;

    memory memory;
    transaction_ring fill_requests, write_requests;
} clocked;

static inline void happened(clocked *c)
{
    c->last = c->now > c->last ? c->now : c->last;
}

static inline void busy(clocked *c, vodr_block block)
{
    c->n.blocks[block].busy++;
    happened(c);
}

static inline brick_visit *visit_at(clocked *c, int64_t number)
{
    return &c->visits[number & (VISITS - 1)];
}

static inline bool can_push(const clocked *c, const link *l)
{
    return !l->full && l->popped < c->now;
}

static inline bool can_pop(const clocked *c, const link *l)
{
    return l->full && l->pushed < c->now;
}

/* Rows of a slice that are looked at for a fragment: all, or up to the first that has one. */
int64_t clocked_probe_slice(const brick_slice *slice, const px_rect *bound, bool *found);

/* Looks for the next brick that has a fragment; its work takes its cycles afterwards. */
void clocked_search(clocked *c);

/* One cycle of each block. */
void clock_volume_divider(clocked *c);
void clock_slice_generator(clocked *c);
void clock_rasterizer(clocked *c);
void clock_texture_loader(clocked *c);
void clock_alpha_blender(clocked *c);
void clock_pixel_cache(clocked *c);
void clock_frame_buffer(clocked *c);

/* One cycle of the flush at the frame's end; false when no dirty line is left. */
bool clock_flush(clocked *c);

/* The fragment at hand as the texture unit accepts it, with its colour: the first of its visit makes its brick current.
 */
fragment clocked_shade(clocked *c, int64_t number, const brick_slice *slice, const span *s);

/* Whether a pixel's last blend is not over. */
bool clocked_blending(const clocked *c, int32_t x, int32_t y);

/* A pixel is read from the cache and enters the blender. */
void clocked_read_pixel(clocked *c, const fragment *f);

/* Asks the bus for a fragment's line. */
void clocked_push_fill(clocked *c, const fragment *f, int64_t raised);

#endif
