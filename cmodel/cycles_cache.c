/* cycles_cache.c - alpha blender and pixel cache: the pop that looks a fragment up, hazards, misses, and behind a
 * non-blocking cache's tags its data stage. */
#include "cycles_state.h"
#include "layout.h"

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
    bool miss = s->access.miss && s->offset == 0;
    bool single = miss || c->through || s->slice_start || c->slice_reads < c->m->blend_cycles;
    return single ? 1 : s->count;
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
    bool writes = s->access.written >> s->offset & 1;
    int64_t written = cycle + c->m->blend_cycles;
    keep(c, release_ring_push(&c->releases, (release){s->access.line, writes ? CYCLE_UNKNOWN : written}));
    if (writes) {
        bus_request *r = request(c, &c->write_requests, written, s->access.line, c->pixel_bytes);
        if (r) {
            r->address += line_offset(&c->layout, s->px.x + s->offset, s->px.y) * c->pixel_bytes;
            r->line = -1;
            r->entry = c->entries;
        }
    }
    c->entries++;
}

/* The first `count` fragments of a segment are read. */
static void read_segment_pixels(cycles *c, const segment *s, int32_t count, int64_t cycle)
{
    read_pixels(c, &s->px, s->offset, s->slice_start, count, cycle);
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

/* ---- misses ---- */

void cycles_depart(cycles *c, int64_t line, int64_t cycle)
{
    while (c->departures.count && departure_ring_front(&c->departures)->cycle < c->last_pop)
        departure_ring_pop(&c->departures);
    keep(c, departure_ring_push(&c->departures, (departure){line, cycle}));
}

bool cycles_settled(const cycles *c, int64_t line, int64_t *cycle)
{
    if (c->write_line == line) {
        if (c->write_pending)
            return false;
        *cycle = max64(*cycle, c->write_granted + 1);
    }
    for (size_t i = 0; c->through && i < c->releases.count; i++) {
        const release *r = release_ring_at(&c->releases, i);
        if (r->line == line && r->cycle == CYCLE_UNKNOWN)
            return false;
        if (r->line == line)
            *cycle = max64(*cycle, r->cycle);
    }
    return true;
}

/* A dirty line moves to the write buffer, once blends are over and the buffer is free; false when that is unknown. */
bool cycles_evict(cycles *c, const cycle_access *access, int64_t earliest, int64_t *cycle)
{
    *cycle = earliest;
    if (!access->evicts)
        return true;
    if (c->write_pending)
        return false;
    *cycle = max64(earliest, max64(c->last_read + c->m->blend_cycles, c->write_granted + 1));
    c->write_pending = true;
    c->write_line = access->victim;
    request(c, &c->write_requests, *cycle, access->victim, c->line_bytes);
    return true;
}

static void request_fill(cycles *c, const cycle_access *access, int64_t cycle)
{
    request(c, &c->fill_requests, cycle, access->line, c->line_bytes);
}

void cycles_begin_miss(cycles *c, int64_t cycle)
{
    c->miss = MISS_EVICT;
    c->miss_cycle = cycle;
}

/* Sees the miss under way, the run's first access, to its end; false when that depends on the bus. */
bool cycles_resolve_miss(cycles *c, const cycle_access *access, const pixel_rows *px, bool slice_start)
{
    if (c->miss == MISS_EVICT) {
        int64_t earliest = c->miss_cycle + 1, cycle;
        if (!access->evicts && access->reads && !cycles_settled(c, access->line, &earliest))
            return false;
        if (!cycles_evict(c, access, earliest, &cycle))
            return false;
        c->n.stalls[VODR_STALL_WRITE_BACK] += (uint64_t)(cycle - c->miss_cycle - 1);
        c->miss_cycle = cycle;
        c->miss = MISS_FILL;
        c->fill_done = access->reads ? CYCLE_UNKNOWN : cycle;
        if (access->reads)
            request_fill(c, access, cycle);
    }
    if (c->fill_done == CYCLE_UNKNOWN)
        return false;
    c->n.stalls[VODR_STALL_FILL] += (uint64_t)(c->fill_done + 1 - c->miss_cycle);
    read_pixels(c, px, 0, slice_start, 1, c->fill_done + 1);
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
    if (number >= c->entries ||
        release_ring_at(&c->releases, (size_t)(number - c->release_first))->cycle == CYCLE_UNKNOWN)
        return false;
    while (c->release_first < number) {
        release_ring_pop(&c->releases);
        c->release_first++;
    }
    *cycle = max64(*cycle, release_ring_front(&c->releases)->cycle + 1);
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
    if (!s->access.miss || s->offset)
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
        if (!left && t->access.miss && !t->offset && t->access.victim == s->access.line)
            return false;
    }
    int64_t gone = *cycle - 1;
    if (!cycles_settled(c, s->access.line, &gone))
        return false;
    for (size_t i = 0; i < c->departures.count; i++)
        if (departure_ring_at(&c->departures, i)->line == s->access.line)
            gone = max64(gone, departure_ring_at(&c->departures, i)->cycle);
    *cycle = max64(*cycle, gone + 1);
    return true;
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
    int32_t count = c->nonblocking ? (c->through || (s->access.miss && !s->offset) ? 1 : s->count) : stride(c, s);
    count = length < count ? (int32_t)length : count;
    if (!c->nonblocking) {
        int64_t clear = max64(cycle, hazard(c, s->px.x + s->offset, s->px.y));
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
        if (s->access.miss && !s->offset) {
            c->miss_tags++;
            if (s->access.reads)
                request_fill(c, &s->access, cycle + 1);
        }
        consume(&c->door, count);
    } else if (s->access.miss && !s->offset) {
        cycles_begin_miss(c, cycle);
    } else {
        read_segment_pixels(c, s, count, cycle);
        consume(&c->door, count);
    }
    return true;
}

bool cycles_advance_tags(cycles *c)
{
    bool moved = false;
    while (!c->failed) {
        if (c->miss != MISS_NONE && !c->nonblocking) {
            const segment *s = segment_ring_front(&c->door);
            if (!cycles_resolve_miss(c, &s->access, &s->px, s->slice_start))
                return moved;
            if (c->through)
                take_entry(c, s, c->last_read);
            consume(&c->door, 1);
        } else if (!c->door.count || !pop_segment(c)) {
            return moved;
        }
        moved = true;
    }
    return moved;
}

/* ---- non-blocking: the data stage ---- */

static bool read_segment(cycles *c)
{
    segment *s = segment_ring_front(&c->tagged);
    bool miss = s->access.miss && !s->offset;
    if (s->slice_start)
        c->slice_reads = 0;
    if (c->miss == MISS_NONE) {
        int64_t base = max64(s->cycle + 1, c->last_read + 1 + miss);
        int64_t clear = max64(base, hazard(c, s->px.x + s->offset, s->px.y));
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
        if (!cycles_evict(c, &s->access, c->miss_cycle, &cycle))
            return false;
        cycle += s->access.evicts;
        c->n.stalls[VODR_STALL_WRITE_BACK] += (uint64_t)(cycle - c->miss_cycle);
        c->miss_cycle = cycle;
        c->miss = MISS_FILL;
        if (!s->access.evicts && s->access.victim >= 0)
            cycles_depart(c, s->access.victim, cycle);
    }
    int64_t cycle = c->miss_cycle;
    if (s->access.reads) {
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

bool cycles_advance_data(cycles *c)
{
    bool moved = false;
    while (!c->failed && c->tagged.count && read_segment(c))
        moved = true;
    return moved;
}
