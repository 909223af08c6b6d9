/* cycles.c - the machine's pipeline as a system of recurrences (docs/timing.md has the rules).
 *
 * Four actors advance as far as what is known lets them: the rasterizer (with divider and slice generator before it and
 * the texture unit's door behind it), the tag stage (the alpha blender takes a fragment, the pixel cache looks it up),
 * the data stage of a non-blocking cache, and the memory bus. Rows and runs of hits move as wholes: their times have
 * slope one. The bus grants one transaction at a time, and only when nobody can move without it, so that whatever could
 * have come before has come. */
#include "cycles.h"

#include <string.h>

#include "layout.h"
#include "ring.h"

enum { VISITS = 8, EAGER_OPS = 4096 };

static const int64_t UNKNOWN = INT64_MIN;

typedef enum op_kind { OP_SLICE, OP_ROWS, OP_RUN } op_kind;

/* What the rasterizer does next. Most runs hit, and of those no more than their pixels matters. */
typedef struct cycle_op {
    op_kind kind;
    int32_t count; /* rows, or fragments */
    int32_t x, y;
    bool slice_start; /* a run: the first of its slice */
    bool killed, miss;
    int32_t detail; /* its number among details; -1: none */
} cycle_op;

/* `count` fragments of a run from its fragment `offset` on, fragment n of them at `cycle` + n. */
typedef struct segment {
    cycle_run run;
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

/* A write-back that was granted. */
typedef struct departure {
    int64_t line, granted;
} departure;

/* Pixels of a row that were read not long ago, one a cycle. */
typedef struct recent {
    int32_t x, y;
    int64_t count, cycle;
} recent;

RING(segment_ring, segment)
RING(stretch_ring, stretch)
RING(request_ring, bus_request)
RING(departure_ring, departure)
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
    int64_t latency, fifo, texture_base, line_bytes, pixel_bytes;
    bool eager, nonblocking, through, failed, ended;
    vodr_cycles n;
    int64_t last; /* cycle in which something happened */

    cycle_op *ops; /* of the visit worked on; unless eager, all of them, once the next visit is known */
    size_t op_count, op_room, op_next;
    int32_t op_done;    /* fragments of ops[op_next] accepted */
    bool new_slice;     /* the next run added begins a slice */
    cycle_run *details; /* of its runs: those that missed, or all when writing through */
    size_t detail_count, detail_room;
    visit_state visits[VISITS];
    int64_t announced, current;              /* numbers of visits; -1: none */
    bool loading;                            /* the current visit's first fragment has not been accepted */
    int64_t visit_fragments, visit_accepted; /* of the current visit */
    bool glides;                             /* a blocking cache, and a FIFO longer than the way to the blender */

    int64_t brick_taken, slice_made, slice_taken, raster, last_accept, accepted;

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
    bool write_pending;
    cycle_ring fills;          /* non-blocking: last data of granted reads, in order */
    departure_ring departures; /* not long ago */
    cycle_ring releases;       /* write-through: by entry of its FIFO, from number release_first on */
    int64_t entries, release_first;

    memory memory;
    request_ring fill_requests, write_requests;
    cycle_ring dirty; /* lines to flush at the end */
    int64_t load_visit, load_bytes, load_grant;
};

static int64_t max64(int64_t a, int64_t b)
{
    return a > b ? a : b;
}

static void happened(cycles *c, int64_t cycle)
{
    c->last = max64(c->last, cycle);
}

static void keep(cycles *c, bool pushed)
{
    c->failed |= !pushed;
}

static visit_state *visit_at(cycles *c, int64_t number)
{
    return &c->visits[number & (VISITS - 1)];
}

/* Appends `count` numbers at slope one. */
static void stretch_add(cycles *c, stretch_ring *r, int64_t first, int64_t count, int64_t cycle)
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
static int64_t stretch_cycle(stretch_ring *r, int64_t number, int64_t *length)
{
    while (stretch_ring_front(r)->first + stretch_ring_front(r)->count <= number)
        stretch_ring_pop(r);
    const stretch *s = stretch_ring_front(r);
    *length = s->first + s->count - number;
    return s->cycle + (number - s->first);
}

/* ---- divider, slice generator, rasterizer, texture unit ---- */

/* The slice generator takes the current brick; then the divider can hand on the next. */
static void enter_visit(cycles *c)
{
    visit_state *v = visit_at(c, ++c->current);
    c->brick_taken = max64(v->divided + 1, c->slice_made + 1);
    c->slice_made = c->brick_taken;
    c->n.blocks[VODR_BLOCK_SLICE_GENERATOR].busy++;
    c->loading = true;
    happened(c, c->brick_taken);
}

static void divide(cycles *c, int64_t number)
{
    visit_state *v = visit_at(c, number), *before = visit_at(c, number - 1);
    int64_t ready = (number ? before->divided : -1) + 1 + v->visit.work_cycles;
    v->divided = number ? max64(ready, c->brick_taken + 1) : ready;
    c->n.stalls[VODR_STALL_DIVIDER] += (uint64_t)(v->divided - ready);
    c->n.blocks[VODR_BLOCK_VOLUME_DIVIDER].busy += (uint64_t)v->visit.work_cycles + 1;
    happened(c, v->divided);
}

static void take_slice(cycles *c)
{
    int64_t ready = c->slice_made + c->m->slice_setup_cycles + 1;
    c->slice_made = max64(ready, c->slice_taken + 1);
    c->n.stalls[VODR_STALL_SLICE] += (uint64_t)(c->slice_made - ready);
    c->n.blocks[VODR_BLOCK_SLICE_GENERATOR].busy += (uint64_t)c->m->slice_setup_cycles + 1;
    c->slice_taken = max64(c->raster, c->slice_made + 1);
    c->raster = c->slice_taken + 1;
    c->n.blocks[VODR_BLOCK_RASTERIZER].busy++;
}

static cycle_run run_of(const cycles *c, const cycle_op *op)
{
    cycle_run run = {.count = 0};
    if (op->detail >= 0)
        run = c->details[op->detail];
    run.x = op->x;
    run.y = op->y;
    run.count = op->count;
    return run;
}

/* Offers the rest of a run; false when it is unknown when the texture unit accepts it. */
static bool offer(cycles *c, const cycle_op *op)
{
    int64_t cycle = c->raster, length = op->count - c->op_done, number = c->accepted - c->fifo;
    if (c->loading) {
        const visit_state *v = visit_at(c, c->current);
        if (v->loaded == UNKNOWN)
            return false;
        cycle = max64(cycle, v->loaded + 1);
    }
    int64_t open = cycle, slope = -number;
    if (number >= 0) {
        if (number >= c->popped)
            return false;
        open = max64(cycle, stretch_cycle(&c->pops, number, &slope) + 1);
    }
    length = slope < length ? slope : length;
    c->n.stalls[VODR_STALL_TEXTURE_LOAD] += (uint64_t)(cycle - c->raster);
    c->n.stalls[VODR_STALL_FRAGMENT_FIFO] += (uint64_t)(open - cycle);
    c->loading = false;
    keep(c, segment_ring_push(&c->door, (segment){.run = run_of(c, op),
                                                  .killed = op->killed,
                                                  .slice_start = op->slice_start && !c->op_done,
                                                  .offset = c->op_done,
                                                  .count = (int32_t)length,
                                                  .cycle = open}));
    c->accepted += length;
    c->visit_accepted += length;
    c->raster = open + length;
    c->last_accept = c->raster - 1;
    c->op_done += (int32_t)length;
    return true;
}

/* Bricks that need no loading are there once the divider handed them on. */
static void settle_loads(cycles *c)
{
    while (c->load_visit <= c->announced && visit_at(c, c->load_visit)->visit.load_bytes == 0 && !c->load_bytes) {
        visit_state *v = visit_at(c, c->load_visit);
        if (v->divided == UNKNOWN)
            return;
        v->loaded = v->divided;
        c->load_visit++;
    }
}

/* ---- what moves as one ---- */

static void read_pixels(cycles *c, int32_t x, int32_t y, bool slice_start, int64_t count, int64_t cycle);
static void pop(cycles *c, int32_t count, int64_t cycle);
static void begin_miss(cycles *c, int64_t cycle);
static bool resolve_miss(cycles *c, const cycle_run *run, bool slice_start);
static bool grant(cycles *c);
static void finish_load(cycles *c);
static void miss_at_once(cycles *c, const cycle_run *run, bool slice_start, int64_t cycle);

/* Whether the first of `count` accesses from (x, y) on could find their pixel still being blended. */
static bool may_conflict(const cycles *c, int32_t x, int32_t y, bool slice_start, int64_t count)
{
    int64_t window = c->m->blend_cycles, reads = slice_start ? 0 : c->slice_reads, seen = 0;
    if (reads >= window)
        return false;
    int64_t end = x + (count < window - reads ? count : window - reads);
    for (int64_t n = c->recent_count - 1; n >= 0 && seen < window; n--) {
        const recent *r = &c->recents[n & c->recent_mask];
        if (r->y == y && r->x < end && r->x + r->count > x)
            return true;
        seen += r->count;
    }
    return false;
}

/* Moves the rest of a run of hits, or a miss, from the rasterizer into a blocking cache at once; false when it has to
 * go step by step. Nothing may be on the way before it. Then, the FIFO being longer than the way to the blender, its
 * room is what delays acceptance but never a pop: pop(n - FIFO) + 1 + latency <= pop(n - FIFO) + FIFO <= pop(n). A miss
 * can be seen through to its end when the rasterizer cannot come to the visit's last fragment meanwhile: nothing else
 * it does asks for the bus. */
static bool glide(cycles *c, const cycle_op *op)
{
    if (!c->glides || c->door.count || c->miss != MISS_NONE || op->killed)
        return false;
    bool miss = op->miss && c->op_done == 0;
    int64_t count = miss ? 1 : op->count - c->op_done, ready = c->raster, length;
    if (miss && !c->eager && c->visit_fragments - c->visit_accepted <= c->fifo + 1)
        return false;
    if (c->loading) {
        finish_load(c);
        int64_t loaded = visit_at(c, c->current)->loaded;
        if (loaded == UNKNOWN)
            return false;
        ready = max64(ready, loaded + 1);
    }
    int32_t x = op->x + c->op_done;
    bool slice_start = c->slice_starts || (op->slice_start && c->op_done == 0);
    if (may_conflict(c, x, op->y, slice_start, count))
        return false;
    int64_t head = max64(ready + c->latency, c->last_pop + 1), cycle = max64(head, c->cache_free);
    int64_t accept = ready + count - 1, room = c->accepted + count - 1 - c->fifo;
    if (room >= c->popped)
        accept = max64(accept, cycle + (room - c->popped) + 1);
    else if (room >= 0)
        accept = max64(accept, stretch_cycle(&c->pops, room, &length) + 1);
    c->n.stalls[VODR_STALL_TEXTURE_LOAD] += (uint64_t)(ready - c->raster);
    c->n.stalls[VODR_STALL_FRAGMENT_FIFO] += (uint64_t)(accept - (ready + count - 1));
    c->n.stalls[VODR_STALL_CACHE] += (uint64_t)(cycle - head);
    c->loading = c->slice_starts = false;
    c->accepted += count;
    c->visit_accepted += count;
    c->last_accept = accept;
    c->raster = accept + 1;
    pop(c, (int32_t)count, cycle);
    c->tag_count += count;
    c->op_done += (int32_t)count;
    if (!miss) {
        read_pixels(c, x, op->y, slice_start, count, cycle);
        return true;
    }
    const cycle_run *run = &c->details[op->detail];
    if (!c->write_pending && (run->reads || !run->evicts)) {
        miss_at_once(c, run, slice_start, cycle);
        return true;
    }
    begin_miss(c, cycle);
    while (!resolve_miss(c, run, slice_start) && grant(c))
        ;
    return true;
}

static bool advance_raster(cycles *c)
{
    bool moved = false;
    settle_loads(c);
    while (c->op_next < c->op_count) {
        const cycle_op *op = &c->ops[c->op_next];
        if (op->kind == OP_SLICE) {
            take_slice(c);
        } else if (op->kind == OP_ROWS) {
            c->raster += op->count;
            c->n.blocks[VODR_BLOCK_RASTERIZER].busy += (uint64_t)op->count;
        } else if (!glide(c, op) && !offer(c, op)) {
            return moved;
        }
        moved = true;
        if (op->kind == OP_RUN && c->op_done < op->count)
            continue;
        c->op_done = 0;
        c->op_next++;
    }
    if (c->current >= 0 && !c->eager)
        visit_at(c, c->current)->drained = c->last_accept;
    return moved;
}

/* ---- hazards and the blend pipeline ---- */

/* The first cycle in which a pixel's blend is over. Pixels of one slice differ, so only a slice's first accesses can
 * wait. */
static int64_t hazard(const cycles *c, int32_t x, int32_t y)
{
    int64_t cycle = INT64_MIN, window = c->m->blend_cycles;
    if (c->slice_reads >= window)
        return cycle;
    int64_t seen = 0;
    for (int64_t n = c->recent_count - 1; n >= 0 && seen < window; n--) {
        const recent *r = &c->recents[n & c->recent_mask];
        if (r->y == y && x >= r->x && x < r->x + r->count)
            cycle = max64(cycle, r->cycle + (x - r->x) + window);
        seen += r->count;
    }
    return cycle;
}

/* How many fragments of a segment may go at once. */
static int32_t stride(const cycles *c, const segment *s)
{
    bool miss = s->run.miss && s->offset == 0;
    bool single = miss || c->through || s->slice_start || c->slice_reads < c->m->blend_cycles;
    return single ? 1 : s->count;
}

/* `count` pixels from (x, y) on read from `cycle` on; the blender writes them blend_cycles later. */
static void read_pixels(cycles *c, int32_t x, int32_t y, bool slice_start, int64_t count, int64_t cycle)
{
    if (slice_start)
        c->slice_reads = 0;
    if (c->nonblocking)
        stretch_add(c, &c->reads, c->read_count, count, cycle);
    c->recents[c->recent_count++ & c->recent_mask] = (recent){x, y, count, cycle};
    c->read_count += count;
    c->slice_reads += count;
    c->last_read = cycle + count - 1;
}

/* Asks the bus for bytes of a line; NULL when memory ran out. */
static bus_request *request(cycles *c, request_ring *queue, int64_t raised, int64_t line, int64_t bytes)
{
    bus_request *r = request_ring_add(queue);
    keep(c, r != NULL);
    if (!r)
        return NULL;
    r->raised = raised;
    r->address = line * c->line_bytes;
    r->bytes = bytes;
    r->line = line;
    return r;
}

/* Writing through: the entry of the write FIFO that the segment's first fragment took. */
static void take_entry(cycles *c, const segment *s, int64_t cycle)
{
    bool writes = s->run.written >> s->offset & 1;
    int64_t written = cycle + c->m->blend_cycles;
    keep(c, cycle_ring_push(&c->releases, writes ? UNKNOWN : written));
    if (writes) {
        bus_request *r = request(c, &c->write_requests, written, s->run.line, c->pixel_bytes);
        if (r) {
            r->line = -1;
            r->entry = c->entries;
        }
    }
    c->entries++;
}

/* The first `count` fragments of a segment are read. */
static void read_segment_pixels(cycles *c, const segment *s, int32_t count, int64_t cycle)
{
    read_pixels(c, s->run.x + s->offset, s->run.y, s->slice_start, count, cycle);
    if (c->through)
        take_entry(c, s, cycle);
}

static void consume(segment_ring *r, int32_t count)
{
    segment *s = segment_ring_front(r);
    s->offset += count;
    s->count -= count;
    s->cycle += count;
    s->slice_start = false;
    if (!s->count)
        segment_ring_pop(r);
}

/* ---- the pixel cache's misses ---- */

/* A dirty line moves to the write buffer, once blends are over and the buffer is free; false when that is unknown. */
static bool evict(cycles *c, const cycle_run *run, int64_t earliest, int64_t *cycle)
{
    *cycle = earliest;
    if (!run->evicts)
        return true;
    if (c->write_pending)
        return false;
    *cycle = max64(earliest, max64(c->last_read + c->m->blend_cycles, c->write_granted + 1));
    c->write_pending = true;
    request(c, &c->write_requests, *cycle, run->victim, c->line_bytes);
    return true;
}

static void request_fill(cycles *c, const cycle_run *run, int64_t cycle)
{
    request(c, &c->fill_requests, cycle, run->line, c->line_bytes);
}

/* ---- blocking: a miss holds everything up ---- */

static void begin_miss(cycles *c, int64_t cycle)
{
    c->miss = MISS_EVICT;
    c->miss_cycle = cycle;
}

/* Sees the miss under way, the run's first access, to its end; false when that depends on the bus. */
static bool resolve_miss(cycles *c, const cycle_run *run, bool slice_start)
{
    if (c->miss == MISS_EVICT) {
        int64_t cycle;
        if (!evict(c, run, c->miss_cycle + 1, &cycle))
            return false;
        c->n.stalls[VODR_STALL_WRITE_BACK] += (uint64_t)(cycle - c->miss_cycle - 1);
        c->miss_cycle = cycle;
        c->miss = MISS_FILL;
        c->fill_done = run->reads ? UNKNOWN : cycle;
        if (run->reads)
            request_fill(c, run, cycle);
    }
    if (c->fill_done == UNKNOWN)
        return false;
    c->n.stalls[VODR_STALL_FILL] += (uint64_t)(c->fill_done + 1 - c->miss_cycle);
    read_pixels(c, run->x, run->y, slice_start, 1, c->fill_done + 1);
    c->cache_free = c->last_read + 1;
    c->miss = MISS_NONE;
    return true;
}

/* ---- the tag stage ---- */

/* Write-through: an access needs an entry of the write FIFO. */
static bool entry_free(cycles *c, int64_t number, int64_t *cycle)
{
    number -= c->m->write_fifo;
    if (!c->through || number < 0)
        return true;
    if (number >= c->entries || *cycle_ring_at(&c->releases, (size_t)(number - c->release_first)) == UNKNOWN)
        return false;
    while (c->release_first < number) {
        cycle_ring_pop(&c->releases);
        c->release_first++;
    }
    *cycle = max64(*cycle, *cycle_ring_front(&c->releases) + 1);
    return true;
}

/* Non-blocking: room in the FIFO behind the tags, and for a miss among those under way; and a line that is leaving has
 * to be gone before it is read again. */
static bool tag_free(cycles *c, const segment *s, int64_t *cycle, int64_t *length)
{
    int64_t number = c->tag_count - c->m->nonblocking_fifo;
    *length = s->count;
    if (number >= 0) {
        if (number >= c->read_count)
            return false;
        *cycle = max64(*cycle, stretch_cycle(&c->reads, number, length) + 1);
    } else {
        *length = -number;
    }
    if (!s->run.miss || s->offset)
        return true;
    number = c->miss_tags - c->m->nonblocking_misses;
    if (number >= 0) {
        if (number - c->miss_first >= (int64_t)c->miss_reads.count)
            return false;
        for (; c->miss_first < number; c->miss_first++)
            cycle_ring_pop(&c->miss_reads);
        *cycle = max64(*cycle, *cycle_ring_front(&c->miss_reads) + 1);
    }
    for (size_t i = 0; i < c->tagged.count; i++) {
        const segment *t = segment_ring_at(&c->tagged, i);
        bool left = i == 0 && c->miss == MISS_FILL;
        if (!left && t->run.miss && !t->offset && t->run.evicts && t->run.victim == s->run.line)
            return false;
    }
    for (size_t i = 0; i < c->write_requests.count; i++)
        if (request_ring_at(&c->write_requests, i)->line == s->run.line)
            return false;
    for (size_t i = 0; i < c->departures.count; i++)
        if (departure_ring_at(&c->departures, i)->line == s->run.line)
            *cycle = max64(*cycle, departure_ring_at(&c->departures, i)->granted + 1);
    return true;
}

static void pop(cycles *c, int32_t count, int64_t cycle)
{
    stretch_add(c, &c->pops, c->popped, count, cycle);
    c->popped += count;
    c->last_pop = cycle + count - 1;
}

/* Pops what it can of the first segment; false when that is unknown. */
static bool pop_segment(cycles *c)
{
    segment *s = segment_ring_front(&c->door);
    int64_t head = max64(s->cycle + c->latency, c->last_pop + 1), cycle = max64(head, c->cache_free);
    int64_t length = s->count;
    if (s->killed) {
        c->n.stalls[VODR_STALL_CACHE] += (uint64_t)(cycle - head);
        pop(c, s->count, cycle);
        c->slice_starts |= s->slice_start; /* a slice that begins with killed fragments begins all the same */
        consume(&c->door, s->count);
        return true;
    }
    s->slice_start |= c->slice_starts;
    if (s->slice_start && !c->nonblocking)
        c->slice_reads = 0;
    if (!entry_free(c, c->tag_count, &cycle) || (c->nonblocking && !tag_free(c, s, &cycle, &length)))
        return false;
    c->n.stalls[VODR_STALL_CACHE] += (uint64_t)(cycle - head);
    int32_t count = c->nonblocking ? (c->through || (s->run.miss && !s->offset) ? 1 : s->count) : stride(c, s);
    count = length < count ? (int32_t)length : count;
    if (!c->nonblocking) {
        int64_t clear = max64(cycle, hazard(c, s->run.x + s->offset, s->run.y));
        c->n.stalls[VODR_STALL_HAZARD] += (uint64_t)(clear - cycle);
        cycle = clear;
    }
    pop(c, count, cycle);
    c->slice_starts = false;
    c->tag_count += count;
    if (c->nonblocking) {
        segment tagged = *s;
        tagged.count = count;
        tagged.cycle = cycle;
        keep(c, segment_ring_push(&c->tagged, tagged));
        if (s->run.miss && !s->offset) {
            c->miss_tags++;
            if (s->run.reads)
                request_fill(c, &s->run, cycle + 1);
        }
        consume(&c->door, count);
    } else if (s->run.miss && !s->offset) {
        begin_miss(c, cycle);
    } else {
        read_segment_pixels(c, s, count, cycle);
        consume(&c->door, count);
    }
    return true;
}

static bool advance_tags(cycles *c)
{
    bool moved = false;
    for (;;) {
        if (c->miss != MISS_NONE && !c->nonblocking) {
            const segment *s = segment_ring_front(&c->door);
            if (!resolve_miss(c, &s->run, s->slice_start))
                return moved;
            if (c->through)
                take_entry(c, s, c->last_read);
            consume(&c->door, 1);
        } else if (!c->door.count || !pop_segment(c)) {
            return moved;
        }
        moved = true;
    }
}

/* ---- non-blocking: the data stage ---- */

static bool read_segment(cycles *c)
{
    segment *s = segment_ring_front(&c->tagged);
    bool miss = s->run.miss && !s->offset;
    if (s->slice_start)
        c->slice_reads = 0;
    if (c->miss == MISS_NONE) {
        int64_t base = max64(s->cycle + 1, c->last_read + 1);
        int64_t clear = max64(base, hazard(c, s->run.x + s->offset, s->run.y));
        if (!miss) {
            int32_t count = stride(c, s);
            c->n.stalls[VODR_STALL_HAZARD] += (uint64_t)(clear - base);
            read_segment_pixels(c, s, count, clear);
            consume(&c->tagged, count);
            return true;
        }
        c->n.stalls[VODR_STALL_HAZARD] += (uint64_t)(clear - base);
        c->miss_cycle = clear;
        c->miss = MISS_EVICT;
    }
    if (c->miss == MISS_EVICT) {
        int64_t cycle;
        if (!evict(c, &s->run, c->miss_cycle, &cycle))
            return false;
        cycle += s->run.evicts;
        c->n.stalls[VODR_STALL_WRITE_BACK] += (uint64_t)(cycle - c->miss_cycle);
        c->miss_cycle = cycle;
        c->miss = MISS_FILL;
    }
    int64_t cycle = c->miss_cycle;
    if (s->run.reads) {
        if (!c->fills.count)
            return false;
        cycle = max64(cycle, *cycle_ring_front(&c->fills) + 1);
        cycle_ring_pop(&c->fills);
    }
    c->n.stalls[VODR_STALL_FILL] += (uint64_t)(cycle - c->miss_cycle);
    read_segment_pixels(c, s, 1, cycle);
    keep(c, cycle_ring_push(&c->miss_reads, cycle));
    c->miss = MISS_NONE;
    consume(&c->tagged, 1);
    return true;
}

static bool advance_data(cycles *c)
{
    bool moved = false;
    while (c->tagged.count && read_segment(c))
        moved = true;
    return moved;
}

/* ---- the bus ---- */

static int64_t eligible(const cycles *c, int64_t raised)
{
    return max64(c->memory.free_cycle, raised + 1);
}

/* When the next burst of a brick is wanted; UNKNOWN: none is, or it depends on what has not happened. */
static int64_t load_raised(cycles *c)
{
    settle_loads(c);
    if (c->load_visit > c->announced)
        return UNKNOWN;
    const visit_state *v = visit_at(c, c->load_visit);
    if (c->load_bytes)
        return c->load_grant;
    int64_t before = c->load_visit - (c->m->double_buffer ? 2 : 1), raised = max64(v->divided, c->load_grant) + 1;
    if (v->divided == UNKNOWN)
        return UNKNOWN;
    if (before < 0)
        return raised;
    int64_t drained = visit_at(c, before)->drained;
    return drained == UNKNOWN ? UNKNOWN : max64(raised, drained + 1);
}

static void grant_fill(cycles *c, int64_t cycle)
{
    const bus_request *r = request_ring_front(&c->fill_requests);
    int64_t done = memory_grant(&c->memory, cycle, r->address, r->bytes, false);
    if (c->nonblocking)
        keep(c, cycle_ring_push(&c->fills, done));
    else
        c->fill_done = done;
    request_ring_pop(&c->fill_requests);
}

static void grant_write(cycles *c, int64_t cycle)
{
    const bus_request *r = request_ring_front(&c->write_requests);
    happened(c, memory_grant(&c->memory, cycle, r->address, r->bytes, true));
    if (r->line >= 0) {
        c->write_pending = false;
        c->write_granted = cycle;
    }
    if (r->line >= 0 && c->nonblocking) {
        while (c->departures.count && departure_ring_front(&c->departures)->granted < c->last_pop)
            departure_ring_pop(&c->departures);
        keep(c, departure_ring_push(&c->departures, (departure){r->line, cycle}));
    }
    if (r->line < 0)
        *cycle_ring_at(&c->releases, (size_t)(r->entry - c->release_first)) = cycle;
    request_ring_pop(&c->write_requests);
}

static void grant_load(cycles *c, int64_t cycle)
{
    visit_state *v = visit_at(c, c->load_visit);
    int64_t rest = v->visit.load_bytes - c->load_bytes;
    int64_t bytes = rest < c->m->texture_burst_bytes ? rest : c->m->texture_burst_bytes;
    int64_t done = memory_grant(&c->memory, cycle, v->visit.load_address + c->load_bytes, bytes, false);
    c->load_grant = cycle;
    c->load_bytes += bytes;
    if (c->load_bytes == v->visit.load_bytes) {
        v->loaded = done;
        c->load_bytes = 0;
        c->load_visit++;
    }
}

/* A blocking miss looked up in `cycle`, with no other fill or write under way: loads that the bus takes before it come
 * first, then its fill, then its write-back, before anything else can ask. */
static void miss_at_once(cycles *c, const cycle_run *run, bool slice_start, int64_t cycle)
{
    int64_t moved = cycle + 1;
    if (run->evicts)
        moved = max64(moved, max64(c->last_read + c->m->blend_cycles, c->write_granted + 1));
    int64_t filled = moved, raised;
    while ((run->reads || run->evicts) && (raised = load_raised(c)) != UNKNOWN && eligible(c, raised) <= moved)
        grant_load(c, eligible(c, raised));
    if (run->reads)
        filled = memory_grant(&c->memory, eligible(c, moved), run->line * c->line_bytes, c->line_bytes, false);
    if (run->evicts) {
        c->write_granted = eligible(c, moved);
        happened(c, memory_grant(&c->memory, c->write_granted, run->victim * c->line_bytes, c->line_bytes, true));
    }
    c->n.stalls[VODR_STALL_WRITE_BACK] += (uint64_t)(moved - cycle - 1);
    c->n.stalls[VODR_STALL_FILL] += (uint64_t)(filled + 1 - moved);
    read_pixels(c, run->x, run->y, slice_start, 1, filled + 1);
    c->cache_free = c->last_read + 1;
}

/* The brick that the rasterizer waits for is loaded to its end: nothing else is on its way that could ask for the bus.
 * With a fixed latency and nobody in its way a load's bursts follow each other without a gap. */
static void finish_load(cycles *c)
{
    visit_state *v = visit_at(c, c->current);
    while (v->loaded == UNKNOWN && grant(c)) {
        int64_t burst = c->m->texture_burst_bytes, whole = (v->visit.load_bytes - c->load_bytes - 1) / burst;
        if (v->loaded != UNKNOWN || c->load_visit != c->current || !c->load_bytes || c->write_requests.count ||
            whole < 1 || c->m->memory != VODR_MEMORY_FIXED)
            continue;
        int64_t beats = memory_beats(&c->memory, burst);
        c->load_bytes += whole * burst;
        c->load_grant = c->memory.free_cycle + (whole - 1) * beats;
        c->memory.free_cycle += whole * beats;
        c->memory.busy_cycles += (uint64_t)(whole * beats);
    }
}

/* Grants the next transaction: the earliest, and of equals fills before writes before loads. False when there is none.
 */
static bool grant(cycles *c)
{
    if (c->fill_requests.count && request_ring_front(&c->fill_requests)->raised < c->memory.free_cycle) {
        grant_fill(c, c->memory.free_cycle); /* nobody comes before it */
        return true;
    }
    int64_t cycle = INT64_MAX, load = load_raised(c);
    int who = -1;
    if (c->fill_requests.count) {
        cycle = eligible(c, request_ring_front(&c->fill_requests)->raised);
        who = 0;
    }
    if (c->write_requests.count && eligible(c, request_ring_front(&c->write_requests)->raised) < cycle) {
        cycle = eligible(c, request_ring_front(&c->write_requests)->raised);
        who = 1;
    }
    if (load != UNKNOWN && eligible(c, load) < cycle) {
        cycle = eligible(c, load);
        who = 2;
    }
    if (who == 0)
        grant_fill(c, cycle);
    else if (who == 1)
        grant_write(c, cycle);
    else if (who == 2)
        grant_load(c, cycle);
    return who >= 0;
}

/* Moves everything as far as it is known. What the rasterizer has yet to be told could come before anything, so once it
 * has nothing left to do all others wait for its next word too. */
static void pump(cycles *c)
{
    for (;;) {
        bool moved = advance_raster(c);
        moved |= advance_tags(c);
        moved |= c->nonblocking && advance_data(c);
        if (moved)
            continue;
        bool starved = c->op_next == c->op_count && !c->ended;
        bool waits = c->op_next < c->op_count || c->door.count || c->tagged.count;
        if (starved || !waits || c->failed || !grant(c))
            return;
    }
}

/* ---- the walk's side ---- */

cycles *cycles_start(const vodr_machine *m, const vodr_view *view)
{
    cycles *c = calloc(1, sizeof *c);
    if (!c)
        return NULL;
    fb_layout layout = fb_layout_of(m, view->width_px, view->height_px);
    c->m = m;
    c->eager = m->traversal == VODR_TRAVERSAL_WHOLE;
    c->nonblocking = m->nonblocking;
    c->through = m->write_policy == VODR_WRITE_POLICY_THROUGH;
    c->latency = m->texture_latency_cycles + (c->eager ? m->mem_latency_cycles : 0);
    c->fifo = m->fragment_fifo + (c->eager ? m->mem_latency_cycles : 0);
    c->line_bytes = line_bytes(m);
    c->pixel_bytes = pixel_bytes(m);
    c->glides = !c->nonblocking && !c->through && c->latency < c->fifo;
    c->texture_base = layout.lines * line_bytes(m);
    c->memory = memory_of(m);
    c->announced = c->current = -1;
    c->slice_made = c->brick_taken = c->last_pop = c->load_grant = c->write_granted = c->last = -1;
    c->slice_taken = c->last_accept = -1;
    c->last_read = -m->blend_cycles;
    while (c->recent_mask < m->blend_cycles)
        c->recent_mask = 2 * c->recent_mask + 1;
    c->recents = calloc((size_t)c->recent_mask + 1, sizeof *c->recents);
    if (c->recents)
        return c;
    cycles_free(c);
    return NULL;
}

/* Room for one more of so many items of `size` bytes; false, and nothing changed, when there is none. */
static bool make_room(cycles *c, void *items, size_t count, size_t *room, size_t size)
{
    void **at = items;
    if (count < *room)
        return true;
    size_t wanted = *room ? 2 * *room : 1024;
    void *grown = realloc(*at, wanted * size);
    c->failed |= !grown;
    if (!grown)
        return false;
    *at = grown;
    *room = wanted;
    return true;
}

/* Drops the ops that are done. Details are numbered from the first op kept. */
static void drop_ops(cycles *c)
{
    int32_t first = -1;
    c->op_count -= c->op_next;
    memmove(c->ops, c->ops + c->op_next, c->op_count * sizeof *c->ops);
    c->op_next = 0;
    for (size_t i = 0; i < c->op_count; i++)
        if (c->ops[i].detail >= 0) {
            first = first < 0 ? c->ops[i].detail : first;
            c->ops[i].detail -= first;
        }
    size_t dropped = first < 0 ? c->detail_count : (size_t)first;
    c->detail_count -= dropped;
    memmove(c->details, c->details + dropped, c->detail_count * sizeof *c->details);
}

static void add_op(cycles *c, cycle_op op)
{
    if (!make_room(c, &c->ops, c->op_count, &c->op_room, sizeof *c->ops))
        return;
    c->ops[c->op_count++] = op;
    if (c->eager && c->op_count >= EAGER_OPS) {
        pump(c);
        drop_ops(c);
    }
}

/* The ops of the visit before are complete now, and the next brick is known. */
static void work_visit(cycles *c)
{
    pump(c);
    drop_ops(c);
    c->visit_fragments = c->visit_accepted = 0;
}

void cycles_visit(cycles *c, const cycle_visit *v)
{
    visit_state *next = visit_at(c, c->announced + 1);
    *next = (visit_state){.visit = *v, .divided = UNKNOWN, .loaded = UNKNOWN, .drained = UNKNOWN};
    next->visit.load_address += c->texture_base;
    c->announced++;
    divide(c, c->announced);
    if (c->announced > 0)
        work_visit(c);
    enter_visit(c);
}

void cycles_slice(cycles *c)
{
    add_op(c, (cycle_op){.kind = OP_SLICE, .detail = -1});
    c->new_slice = true;
}

void cycles_rows(cycles *c, int32_t count)
{
    if (count)
        add_op(c, (cycle_op){.kind = OP_ROWS, .count = count, .detail = -1});
}

/* Adds fragments to the run before where they go on from it, so that both move as one; else false. Which line they are
 * in matters to a first access alone, and which of them are written when writing through. */
static bool prolong(cycles *c, int32_t x, int32_t y, int32_t count, bool killed)
{
    if (c->through || c->op_next == c->op_count)
        return false;
    cycle_op *before = &c->ops[c->op_count - 1];
    bool goes_on =
        before->kind == OP_RUN && before->killed == killed && before->y == y && before->x + before->count == x;
    before->count += goes_on ? count : 0;
    return goes_on;
}

static void add_run(cycles *c, int32_t x, int32_t y, int32_t count, bool killed, int32_t detail)
{
    cycle_op op = {.kind = OP_RUN, .count = count, .x = x, .y = y, .killed = killed, .detail = detail};
    op.slice_start = c->new_slice;
    op.miss = detail >= 0 && c->details[detail].miss;
    c->new_slice = false;
    add_op(c, op);
}

void cycles_hits(cycles *c, int32_t x, int32_t y, int32_t count, bool killed)
{
    c->visit_fragments += count;
    if (!prolong(c, x, y, count, killed))
        add_run(c, x, y, count, killed, -1);
}

void cycles_access(cycles *c, const cycle_run *run)
{
    c->visit_fragments += run->count;
    if (!make_room(c, &c->details, c->detail_count, &c->detail_room, sizeof *c->details))
        return;
    c->details[c->detail_count] = *run;
    add_run(c, run->x, run->y, run->count, false, (int32_t)c->detail_count++);
}

void cycles_flush_line(cycles *c, int64_t line)
{
    keep(c, cycle_ring_push(&c->dirty, line));
}

/* Dirty lines leave one after the other through the write buffer, once the last blend is over. */
static void flush(cycles *c)
{
    while (grant(c))
        ;
    for (; c->dirty.count; cycle_ring_pop(&c->dirty)) {
        const cycle_run run = {.evicts = true, .victim = *cycle_ring_front(&c->dirty)};
        int64_t cycle;
        evict(c, &run, max64(c->raster - 1, c->last_pop), &cycle);
        grant(c);
    }
}

static void set_block(vodr_cycles *n, vodr_block block, uint64_t stalled)
{
    vodr_block_cycles *b = &n->blocks[block];
    b->stalled = stalled;
    b->idle = n->total - b->busy - stalled;
}

bool cycles_finish(cycles *c, int64_t work_cycles, vodr_cycles *result)
{
    vodr_cycles *n = &c->n;
    c->ended = true;
    pump(c);
    flush(c);
    n->blocks[VODR_BLOCK_RASTERIZER].busy += (uint64_t)c->accepted;
    n->blocks[VODR_BLOCK_TEXTURE_UNIT].busy = (uint64_t)c->accepted;
    n->blocks[VODR_BLOCK_ALPHA_BLENDER].busy = (uint64_t)c->popped;
    n->blocks[VODR_BLOCK_PIXEL_CACHE].busy = (uint64_t)c->read_count;
    happened(c, max64(c->raster - 1, c->last_pop));
    happened(c, c->last_read + c->m->blend_cycles - 1);
    n->blocks[VODR_BLOCK_VOLUME_DIVIDER].busy += (uint64_t)work_cycles;
    happened(c, (c->announced < 0 ? -1 : visit_at(c, c->announced)->divided) + work_cycles);
    n->total = (uint64_t)(c->last + 1);
    n->stalls[VODR_STALL_DRAM_ROW] = c->memory.row_cycles;
    n->stalls[VODR_STALL_DRAM_REFRESH] = c->memory.refresh_cycles;
    n->blocks[VODR_BLOCK_FRAME_BUFFER].busy = c->memory.busy_cycles;
    uint64_t door = n->stalls[VODR_STALL_TEXTURE_LOAD] + n->stalls[VODR_STALL_FRAGMENT_FIFO];
    uint64_t hazards = n->stalls[VODR_STALL_HAZARD];
    set_block(n, VODR_BLOCK_VOLUME_DIVIDER, n->stalls[VODR_STALL_DIVIDER]);
    set_block(n, VODR_BLOCK_SLICE_GENERATOR, n->stalls[VODR_STALL_SLICE]);
    set_block(n, VODR_BLOCK_RASTERIZER, door);
    set_block(n, VODR_BLOCK_TEXTURE_UNIT, door);
    set_block(n, VODR_BLOCK_ALPHA_BLENDER, n->stalls[VODR_STALL_CACHE] + (c->nonblocking ? 0 : hazards));
    set_block(n, VODR_BLOCK_PIXEL_CACHE,
              n->stalls[VODR_STALL_WRITE_BACK] + n->stalls[VODR_STALL_FILL] + (c->nonblocking ? hazards : 0));
    set_block(n, VODR_BLOCK_FRAME_BUFFER, n->stalls[VODR_STALL_DRAM_ROW] + n->stalls[VODR_STALL_DRAM_REFRESH]);
    *result = *n;
    return !c->failed;
}

void cycles_free(cycles *c)
{
    if (!c)
        return;
    free(c->ops);
    free(c->recents);
    free(c->details);
    segment_ring_free(&c->door);
    segment_ring_free(&c->tagged);
    stretch_ring_free(&c->pops);
    stretch_ring_free(&c->reads);
    cycle_ring_free(&c->miss_reads);
    cycle_ring_free(&c->fills);
    cycle_ring_free(&c->releases);
    cycle_ring_free(&c->dirty);
    departure_ring_free(&c->departures);
    request_ring_free(&c->fill_requests);
    request_ring_free(&c->write_requests);
    free(c);
}
