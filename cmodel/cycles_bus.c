/* cycles_bus.c - the memory bus: fills, writes and brick loads, in the order of their grants. */
#include "cycles_state.h"

/* Bricks that need no loading are there once the divider handed them on. */
void cycles_settle_loads(cycles *c)
{
    while (c->load_visit <= c->announced && visit_at(c, c->load_visit)->visit.load_bytes == 0 && !c->load_bytes) {
        visit_state *v = visit_at(c, c->load_visit);
        v->loaded = v->divided;
        c->load_visit++;
    }
}

static int64_t eligible(const cycles *c, int64_t raised)
{
    return max64(c->memory.free_cycle, raised + 1);
}

/* When the next burst of a brick is wanted; CYCLE_UNKNOWN: none is, or it depends on what has not happened. */
static int64_t load_raised(cycles *c)
{
    cycles_settle_loads(c);
    if (c->load_visit > c->announced)
        return CYCLE_UNKNOWN;
    const visit_state *v = visit_at(c, c->load_visit);
    if (c->load_bytes)
        return c->load_grant;
    int64_t before = c->load_visit - (c->m->double_buffer ? 2 : 1), raised = max64(v->divided, c->load_grant) + 1;
    if (before < 0)
        return raised;
    int64_t drained = visit_at(c, before)->drained;
    return drained == CYCLE_UNKNOWN ? CYCLE_UNKNOWN : max64(raised, drained + 1);
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
    /* The cache is told in the next cycle. */
    if (r->line >= 0 && c->nonblocking)
        cycles_depart(c, r->line, cycle + 1);
    if (r->line < 0)
        release_ring_at(&c->releases, (size_t)(r->entry - c->release_first))->cycle = cycle + 1;
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
void cycles_miss_at_once(cycles *c, const cycle_access *access, const pixel_rows *px, bool slice_start, int64_t cycle)
{
    int64_t moved = cycle + 1;
    if (access->evicts)
        moved = max64(moved, max64(c->last_read + c->m->blend_cycles, c->write_granted + 1));
    int64_t filled = moved, raised;
    while ((access->reads || access->evicts) && (raised = load_raised(c)) != CYCLE_UNKNOWN &&
           eligible(c, raised) <= moved)
        grant_load(c, eligible(c, raised));
    if (access->reads)
        filled = memory_grant(&c->memory, eligible(c, moved), access->line * c->line_bytes, c->line_bytes, false);
    if (access->evicts) {
        c->write_line = access->victim;
        c->write_granted = eligible(c, moved);
        happened(c, memory_grant(&c->memory, c->write_granted, access->victim * c->line_bytes, c->line_bytes, true));
    }
    c->n.stalls[VODR_STALL_WRITE_BACK] += (uint64_t)(moved - cycle - 1);
    c->n.stalls[VODR_STALL_FILL] += (uint64_t)(filled + 1 - moved);
    read_pixels(c, px, 0, slice_start, 1, filled + 1);
    c->cache_free = c->last_read + 1;
}

/* The brick that the rasterizer waits for is loaded to its end: nothing else is on its way that could ask for the bus.
 * With a fixed latency and nobody in its way a load's bursts follow each other without a gap. */
void cycles_finish_load(cycles *c)
{
    visit_state *v = visit_at(c, c->current);
    while (v->loaded == CYCLE_UNKNOWN && cycles_grant(c)) {
        int64_t burst = c->m->texture_burst_bytes, whole = (v->visit.load_bytes - c->load_bytes - 1) / burst;
        if (v->loaded != CYCLE_UNKNOWN || c->load_visit != c->current || !c->load_bytes || c->write_requests.count ||
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
bool cycles_grant(cycles *c)
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
    if (load != CYCLE_UNKNOWN && eligible(c, load) < cycle) {
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
