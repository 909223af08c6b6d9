/* cycles.c - the machine's pipeline as a system of recurrences (docs/timing.md has the rules).
 *
 * Four actors advance as far as what is known lets them: the rasterizer (with divider and slice generator before it and
 * the texture unit's door behind it), the tag stage (the alpha blender takes a fragment, the pixel cache looks it up),
 * the data stage of a non-blocking cache, and the memory bus. Rows and runs of hits move as wholes: their times have
 * slope one. The bus grants one transaction at a time, and only when nobody can move without it, so that whatever could
 * have come before has come. */
#include "cycles.h"

#include <string.h>

#include "cycles_state.h"
#include "layout.h"
#include "totals.h"

enum { EAGER_OPS = 4096 };

/* Moves everything as far as it is known. What the rasterizer has yet to be told could come before anything, so once it
 * has nothing left to do all others wait for its next word too. */
static void pump(cycles *c)
{
    while (!c->failed) {
        bool moved = cycles_advance_raster(c);
        moved |= cycles_advance_tags(c);
        moved |= c->nonblocking && cycles_advance_data(c);
        if (moved)
            continue;
        bool starved = c->op_next == c->op_count && !c->ended;
        bool waits = c->op_next < c->op_count || c->door.count || c->tagged.count;
        if (starved || !waits || !cycles_grant(c))
            return;
    }
}

/* ---- the walk's side ---- */

cycles *cycles_start(const vodr_machine *m, const vodr_view *view)
{
    cycles *c = calloc(1, sizeof *c);
    if (!c)
        return NULL;
    c->m = m;
    c->layout = fb_layout_of(m, view->width_px, view->height_px);
    c->eager = m->traversal == VODR_TRAVERSAL_WHOLE;
    c->nonblocking = m->nonblocking;
    c->through = m->write_policy == VODR_WRITE_POLICY_THROUGH;
    c->fetch_cycles = filter_fetch_cycles(m);
    c->latency = m->texture_latency_cycles + (c->eager ? m->mem_latency_cycles : 0) + c->fetch_cycles - 1;
    c->fifo = m->fragment_fifo + (c->eager ? m->mem_latency_cycles : 0);
    c->line_bytes = line_bytes(m);
    c->pixel_bytes = pixel_bytes(m);
    c->glides = !c->nonblocking && !c->through && c->fetch_cycles == 1 && c->latency < c->fifo;
    c->texture_base = c->layout.lines * line_bytes(m);
    c->memory = memory_of(m);
    c->announced = c->current = c->write_line = -1;
    c->slice_made = c->brick_taken = c->last_pop = c->load_grant = c->write_granted = c->last = -1;
    c->slice_taken = -1;
    c->last_read = -m->blend_cycles;
    while (c->recent_mask < m->blend_cycles)
        c->recent_mask = 2 * c->recent_mask + 1;
    c->recents = calloc((size_t)c->recent_mask + 1, sizeof *c->recents);
    if (c->recents)
        return c;
    cycles_free(c);
    return NULL;
}

/* Room for one more op; false when there is none. */
static bool make_room(cycles *c)
{
    if (c->failed || c->op_count < c->op_room)
        return !c->failed;
    size_t room = c->op_room ? 2 * c->op_room : 1024;
    cycle_op *grown = realloc(c->ops, room * sizeof *grown);
    c->failed |= !grown;
    if (!grown)
        return false;
    c->ops = grown;
    c->op_room = room;
    return true;
}

/* Drops the ops that are done. */
static void drop_ops(cycles *c)
{
    if (!c->op_next)
        return;
    c->op_count -= c->op_next;
    memmove(c->ops, c->ops + c->op_next, c->op_count * sizeof *c->ops);
    c->op_next = 0;
}

/* One more op, for the caller to fill in; NULL when memory ran out. */
static cycle_op *add_op(cycles *c)
{
    if (c->eager && c->op_count >= EAGER_OPS) {
        pump(c);
        drop_ops(c);
    }
    return make_room(c) ? &c->ops[c->op_count++] : NULL;
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
    *next = (visit_state){.visit = *v, .loaded = CYCLE_UNKNOWN, .drained = CYCLE_UNKNOWN};
    next->visit.load_address += c->texture_base;
    c->announced++;
    cycles_divide(c, c->announced);
    if (c->announced > 0)
        work_visit(c);
    cycles_enter_visit(c);
}

void cycles_slice(cycles *c)
{
    cycle_op *op = add_op(c);
    if (op)
        op->kind = OP_SLICE;
    c->new_slice = true;
    c->slice_added = 0;
}

void cycles_rows(cycles *c, int32_t count)
{
    cycle_op *op = count ? add_op(c) : NULL;
    if (!op)
        return;
    op->kind = OP_ROWS;
    op->px.count = count;
}

/* Adds pixels to a run where they go on from it: in its last row, or as a row of their own below. A row of its own has
 * to be as long as a blend, and so has what its slice had before: then hazards never ask for what lies between. */
static bool lengthen(pixel_rows *px, int32_t x, int32_t y, int32_t count, bool new_row)
{
    bool several = px->last > 0;
    int32_t end = several ? px->last_x + px->last : px->x + px->first;
    if (y == (several ? px->last_y : px->y) && x == end) {
        px->first += several ? 0 : count;
        px->last += several ? count : 0;
    } else if (new_row) {
        px->last_x = x;
        px->last_y = y;
        px->last = count;
    } else {
        return false;
    }
    px->count += count;
    return true;
}

/* Adds fragments to the run before where they go on from it, so that both move as one; else false. Which line they are
 * in matters to a first access alone, and which of them are written when writing through. */
static bool prolong(cycles *c, int32_t x, int32_t y, int32_t count, bool killed)
{
    if (c->through || c->op_next == c->op_count)
        return false;
    cycle_op *before = &c->ops[c->op_count - 1];
    int32_t window = c->m->blend_cycles;
    bool new_row = !killed && !c->new_slice && count >= window && c->slice_added >= window;
    return before->kind == OP_RUN && before->killed == killed && lengthen(&before->px, x, y, count, new_row);
}

static void add_run(cycles *c, int32_t x, int32_t y, int32_t count, bool killed, const cycle_access *access)
{
    cycle_op *op = add_op(c);
    if (op)
        *op = (cycle_op){.kind = OP_RUN,
                         .px = {.count = count, .x = x, .y = y, .first = count},
                         .access = *access,
                         .slice_start = c->new_slice,
                         .killed = killed};
    c->new_slice = false;
}

/* Fragments join the visit and the slice, but for those that are killed, which no hazard concerns. */
static void tally(cycles *c, int32_t count, bool killed)
{
    c->visit_fragments += count;
    c->slice_added += killed ? 0 : count;
}

void cycles_hits(cycles *c, int32_t x, int32_t y, int32_t count, bool killed)
{
    static const cycle_access hit = {0};
    if (!prolong(c, x, y, count, killed))
        add_run(c, x, y, count, killed, &hit);
    tally(c, count, killed);
}

void cycles_run(cycles *c, int32_t x, int32_t y, int32_t count, const cycle_access *access)
{
    add_run(c, x, y, count, false, access);
    tally(c, count, false);
}

void cycles_flush_line(cycles *c, int64_t line)
{
    keep(c, cycle_ring_push(&c->dirty, line));
}

/* ---- the end ---- */

/* Dirty lines leave one after the other through the write buffer, once the last blend is over, and the cycle after the
 * divider, too, has nothing left to do. */
static void flush(cycles *c, int64_t searched)
{
    int64_t begin = max64(max64(c->raster - 1, c->last_pop), searched) + 1;
    while (cycles_grant(c))
        ;
    for (; c->dirty.count; cycle_ring_pop(&c->dirty)) {
        const cycle_access access = {.evicts = true, .victim = (int32_t)*cycle_ring_front(&c->dirty)};
        int64_t cycle;
        cycles_evict(c, &access, begin, &cycle);
        cycles_grant(c);
    }
}

bool cycles_finish(cycles *c, int64_t work_cycles, vodr_cycles *result)
{
    vodr_cycles *n = &c->n;
    c->ended = true;
    pump(c);
    if (c->failed)
        return false;
    int64_t searched = (c->announced < 0 ? -1 : visit_at(c, c->announced)->divided) + work_cycles;
    flush(c, searched);
    n->blocks[VODR_BLOCK_RASTERIZER].busy += (uint64_t)c->accepted;
    n->blocks[VODR_BLOCK_TEXTURE_UNIT].busy = (uint64_t)(c->accepted * c->fetch_cycles);
    n->blocks[VODR_BLOCK_ALPHA_BLENDER].busy = (uint64_t)c->popped;
    n->blocks[VODR_BLOCK_PIXEL_CACHE].busy = (uint64_t)c->read_count;
    happened(c, max64(c->raster - 1, c->last_pop));
    happened(c, c->last_read + c->m->blend_cycles - 1);
    n->blocks[VODR_BLOCK_VOLUME_DIVIDER].busy += (uint64_t)work_cycles;
    happened(c, searched);
    totals_close(n, &c->memory, c->last);
    *result = *n;
    return !c->failed;
}

void cycles_free(cycles *c)
{
    if (!c)
        return;
    free(c->ops);
    free(c->recents);
    segment_ring_free(&c->door);
    segment_ring_free(&c->tagged);
    stretch_ring_free(&c->pops);
    stretch_ring_free(&c->reads);
    cycle_ring_free(&c->miss_reads);
    cycle_ring_free(&c->fills);
    release_ring_free(&c->releases);
    cycle_ring_free(&c->dirty);
    departure_ring_free(&c->departures);
    request_ring_free(&c->fill_requests);
    request_ring_free(&c->write_requests);
    free(c);
}
