/* cycles_state.h - what the parts of the cycle count share (cycles.h has its public face): times of fragments, and the
 * actors' calls to each other. */
#ifndef VODR_CYCLES_STATE_H
#define VODR_CYCLES_STATE_H

#include "cycles.h"
#include "layout.h"
#include "ring.h"

#define CYCLE_UNKNOWN INT64_MIN

enum { VISITS = 8 };

typedef enum op_kind { OP_SLICE, OP_ROWS, OP_RUN } op_kind;

/* Pixels of one row, or of several as one. Then the first row and the last are known: what lies between is longer than
 * a blend, and far enough from both ends of a slice for any hazard. */
typedef struct pixel_rows {
    int32_t count;
    int32_t x, y, first;          /* the first row: so many from (x, y) on */
    int32_t last_x, last_y, last; /* the last row, if it is another; last 0: it is not */
} pixel_rows;

/* What the rasterizer does next. Most runs hit, and of those no more than their pixels matters. */
typedef struct cycle_op {
    op_kind kind;
    pixel_rows px; /* a run's; .count alone: rows */
    cycle_access access;
    bool slice_start; /* a run: the first of its slice */
    bool killed;
} cycle_op;

/* `count` fragments of a run from its fragment `offset` on, fragment n of them at `cycle` + n. */
typedef struct segment {
    pixel_rows px;
    cycle_access access;
    bool killed;
    bool slice_start;
    int32_t offset, count;
    int64_t cycle;
} segment;

/* Fragments or accesses by number: number `first` + n at `cycle` + n. */
typedef struct stretch {
    int64_t first, count, cycle;
} stretch;

typedef struct bus_request {
    int64_t raised, address, bytes;
    int64_t line;  /* a write-back's; -1: a pixel written through */
    int64_t entry; /* of the write FIFO, written through */
} bus_request;

/* A line that was replaced and is gone, as the tags see it from the next cycle on. */
typedef struct departure {
    int64_t line, cycle;
} departure;

/* A place of the write FIFO: the line of its access, and when it was released, or CYCLE_UNKNOWN. */
typedef struct release {
    int64_t line, cycle;
} release;

/* Pixels of a row that were read not long ago, one a cycle. */
typedef struct recent {
    int32_t x, y;
    int64_t count, cycle;
} recent;

RING(segment_ring, segment)
RING(stretch_ring, stretch)
RING(request_ring, bus_request)
RING(departure_ring, departure)
RING(release_ring, release)
RING(cycle_ring, int64_t)

typedef struct visit_state {
    cycle_visit visit;
    int64_t divided; /* pushed by the divider */
    int64_t loaded;  /* last data of its load */
    int64_t drained; /* its last fragment was accepted */
} visit_state;

/* A miss that holds up the blocking cache, or the data stage. */
typedef enum miss_state { MISS_NONE, MISS_EVICT, MISS_FILL } miss_state;

struct cycles {
    const vodr_machine *m;
    fb_layout layout;
    int64_t latency, fifo, fetch_cycles, texture_base, line_bytes, pixel_bytes;
    bool eager, nonblocking, through, failed, ended;
    vodr_cycles n;
    int64_t last; /* cycle in which something happened */

    cycle_op *ops; /* of the visit worked on; unless eager, all of them, once the next visit is known */
    size_t op_count, op_room, op_next;
    int32_t op_done;     /* fragments of ops[op_next] accepted */
    bool new_slice;      /* the next run added begins a slice */
    int64_t slice_added; /* fragments of the slice in the ops */
    visit_state visits[VISITS];
    int64_t announced, current;              /* numbers of visits; -1: none */
    bool loading;                            /* the current visit's first fragment has not been accepted */
    int64_t visit_fragments, visit_accepted; /* of the current visit */
    bool glides; /* a blocking cache, a fragment accepted each cycle, a FIFO longer than the way to the blender */

    int64_t brick_taken, slice_made, slice_taken, raster, accepted;
    int64_t fetched; /* the cycle after the last fetch */
    bool glided;     /* room in the FIFO has yet to delay the rasterizer */

    segment_ring door; /* accepted, not yet popped */
    stretch_ring pops; /* by fragment */
    int64_t popped, last_pop, cache_free;
    bool slice_starts; /* with the next fragment that is alive */

    segment_ring tagged;   /* non-blocking: looked up, data not yet read */
    stretch_ring reads;    /* by access */
    cycle_ring miss_reads; /* by miss, from number miss_first on */
    int64_t tag_count, read_count, last_read, miss_tags, miss_first;
    recent *recents; /* the last ones, that hold blend_cycles pixels or more; a ring */
    int64_t recent_count, recent_mask;
    int64_t slice_reads;

    miss_state miss;
    int64_t miss_cycle, fill_done, write_granted;
    int64_t write_line; /* the one that last moved to the write buffer; -1 */
    bool write_pending;
    cycle_ring fills;          /* non-blocking: last data of granted reads, in order */
    departure_ring departures; /* not long ago */
    release_ring releases;     /* write-through: by entry of its FIFO, from number release_first on */
    int64_t entries, release_first;

    memory memory;
    request_ring fill_requests, write_requests;
    cycle_ring dirty; /* lines to flush at the end */
    int64_t load_visit, load_bytes, load_grant;
};

static inline int64_t max64(int64_t a, int64_t b)
{
    return a > b ? a : b;
}

static inline void happened(cycles *c, int64_t cycle)
{
    c->last = max64(c->last, cycle);
}

static inline void keep(cycles *c, bool pushed)
{
    c->failed |= !pushed;
}

static inline visit_state *visit_at(cycles *c, int64_t number)
{
    return &c->visits[number & (VISITS - 1)];
}

/* Appends `count` numbers at slope one. */
static inline void stretch_add(cycles *c, stretch_ring *r, int64_t first, int64_t count, int64_t cycle)
{
    if (r->count) {
        stretch *s = stretch_ring_back(r);
        if (s->first + s->count == first && s->cycle + s->count == cycle) {
            s->count += count;
            return;
        }
    }
    stretch *s = stretch_ring_add(r);
    keep(c, s != NULL);
    if (!s)
        return;
    s->first = first;
    s->count = count;
    s->cycle = cycle;
}

/* The cycle of a number that was appended, and how many from it on have slope one; forgets what lies before. */
static inline int64_t stretch_cycle(stretch_ring *r, int64_t number, int64_t *length)
{
    while (stretch_ring_front(r)->first + stretch_ring_front(r)->count <= number)
        stretch_ring_pop(r);
    const stretch *s = stretch_ring_front(r);
    *length = s->first + s->count - number;
    return s->cycle + (number - s->first);
}

/* `count` pixels from number `offset` on read from `cycle` on; the blender writes them blend_cycles later. */
static inline void read_pixels(cycles *c, const pixel_rows *px, int32_t offset, bool slice_start, int32_t count,
                               int64_t cycle)
{
    int32_t end = offset + count, last = px->count - px->last, from = offset > last ? offset : last;
    recent *r = &c->recents[c->recent_count++ & c->recent_mask];
    *r = (recent){px->x + offset, px->y, count, cycle};
    if (px->last && end > last)
        *r = (recent){px->last_x + from - last, px->last_y, end - from, cycle + from - offset};
    else if (px->last && end > px->first)
        r->y = -1; /* between the first row and the last */
    if (slice_start)
        c->slice_reads = 0;
    if (c->nonblocking)
        stretch_add(c, &c->reads, c->read_count, count, cycle);
    c->read_count += count;
    c->slice_reads += count;
    c->last_read = cycle + count - 1;
}

static inline void pop(cycles *c, int32_t count, int64_t cycle)
{
    stretch_add(c, &c->pops, c->popped, count, cycle);
    c->popped += count;
    c->last_pop = cycle + count - 1;
}

/* ---- divider, slice generator, rasterizer, texture unit: cycles_front.c ---- */

/* Brick `number` is handed on by the divider: as soon as it is found, and the slice generator has taken the one before.
 */
void cycles_divide(cycles *c, int64_t number);

/* The slice generator takes the next brick. */
void cycles_enter_visit(cycles *c);

/* Rasterizes as far as what is known allows; whether anything moved. */
bool cycles_advance_raster(cycles *c);

/* ---- alpha blender and pixel cache: cycles_cache.c ---- */

/* Pops and looks up, or reads the data of a non-blocking cache, as far as what is known allows; whether anything moved.
 */
bool cycles_advance_tags(cycles *c);
bool cycles_advance_data(cycles *c);

/* A blocking cache's miss, looked up in `cycle`, and its way to the end; false when that depends on the bus. */
void cycles_begin_miss(cycles *c, int64_t cycle);
bool cycles_resolve_miss(cycles *c, const cycle_access *access, const pixel_rows *px, bool slice_start);

/* A dirty line moves to the write buffer from cycle `earliest` on, once blends are over and the buffer is free. False
 * when it is unknown when that is. */
bool cycles_evict(cycles *c, const cycle_access *access, int64_t earliest, int64_t *cycle);

/* A replaced line is gone; lets go of those that no look-up can wait for any more. */
void cycles_depart(cycles *c, int64_t line, int64_t cycle);

/* A line must not be read from memory before what was written to it is on its way there: raises *cycle to when the
 * cache knows that it is. False when that is unknown. */
bool cycles_settled(const cycles *c, int64_t line, int64_t *cycle);

/* ---- the bus: cycles_bus.c ---- */

/* Grants the next transaction: the earliest, and of equals fills before writes before loads. False when there is none.
 */
bool cycles_grant(cycles *c);

/* Bricks that need no loading are there once the divider handed them on. */
void cycles_settle_loads(cycles *c);

/* The brick that the rasterizer waits for is loaded to its end: nothing else is on its way that could ask for the bus.
 */
void cycles_finish_load(cycles *c);

/* A blocking miss looked up in `cycle`, with no other fill or write under way, to its end. */
void cycles_miss_at_once(cycles *c, const cycle_access *access, const pixel_rows *px, bool slice_start, int64_t cycle);

#endif
