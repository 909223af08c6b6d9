/* clocked_rasterizer.c - the rasterizer, clocked: a slice row by row, a fragment a cycle, offered to the texture unit.
 */
#include "clocked_machine.h"

static void begin_visit(clocked *c, int64_t number)
{
    const candidate *b = &visit_at(c, number)->brick;
    c->counters.brick_visits++;
    c->counters.bricks += !c->seen[b->brick];
    c->seen[b->brick] = 1;
}

static void end_visit(clocked *c)
{
    int32_t limit = tile_px(c->m);
    c->counters.brick_slices += c->covered_slices;
    if (c->m->traversal != VODR_TRAVERSAL_WHOLE)
        c->counters.brick_overflows += c->covered.x1 - c->covered.x0 > limit || c->covered.y1 - c->covered.y0 > limit;
}

static bool is_last_fragment(clocked *c, const span *s)
{
    /* Whether anything of the visit follows: ask the blocks themselves. */
    if (c->done_px + 1 < s->x1 - s->x0)
        return false;
    rasterizer rows = c->rows;
    span next;
    if (rasterizer_next(&rows, &next))
        return false;
    const candidate *b = &visit_at(c, c->drawn_slice_visit)->brick;
    bool reverse = c->m->blend == VODR_BLEND_UNDER;
    slice_generator rest = slice_generator_start(c->view, &b->box, b->k0, b->k1, reverse);
    brick_slice slice;
    while (slice_generator_next(&rest, &slice)) {
        if (reverse ? slice.k >= c->raster_slice.k : slice.k <= c->raster_slice.k)
            continue;
        bool found;
        clocked_probe_slice(&slice, &b->bound, &found);
        if (found)
            return false;
    }
    return true;
}

static void cover(clocked *c, const span *s)
{
    px_rect *r = &c->covered;
    r->x0 = s->x0 < r->x0 ? s->x0 : r->x0;
    r->x1 = s->x1 > r->x1 ? s->x1 : r->x1;
    r->y0 = s->y < r->y0 ? s->y : r->y0;
    r->y1 = s->y >= r->y1 ? s->y + 1 : r->y1;
}

/* Offers the fragment at hand to the texture unit. */
static void offer(clocked *c)
{
    int64_t number = c->drawn_slice_visit, inside = c->accepted - c->popped + (c->last_pop == c->now);
    brick_visit *v = visit_at(c, number);
    if (!c->visit_accepted && v->loaded >= c->now) {
        c->n.stalls[VODR_STALL_TEXTURE_LOAD]++;
        return;
    }
    /* Fetches from external memory hold as many fragments more as they take cycles. */
    int64_t room = c->m->fragment_fifo + (c->m->traversal == VODR_TRAVERSAL_WHOLE ? c->m->mem_latency_cycles : 0);
    if (inside >= room) {
        c->n.stalls[VODR_STALL_FRAGMENT_FIFO]++;
        return;
    }
    if (!c->visit_accepted)
        begin_visit(c, number);
    bool last = is_last_fragment(c, &c->current);
    c->failed |= !fragment_ring_push(&c->door, clocked_shade(c, number, &c->raster_slice, &c->current));
    c->visit_accepted = true;
    c->counters.fragments++;
    c->accepted++;
    if (!c->slice_has_fragments) {
        c->slice_has_fragments = true;
        c->covered_slices++;
    }
    busy(c, VODR_BLOCK_RASTERIZER);
    busy(c, VODR_BLOCK_TEXTURE_UNIT);
    if (++c->done_px == c->current.x1 - c->current.x0) {
        cover(c, &c->current);
        c->next_row = c->current.y + 1;
        c->done_px = 0;
        c->have_span = rasterizer_next(&c->rows, &c->current);
    }
    if (last) {
        v->drained = c->now;
        end_visit(c);
    }
}

void clock_rasterizer(clocked *c)
{
    if (c->rastering) {
        if (c->have_span && c->next_row == c->current.y) {
            offer(c);
        } else {
            c->next_row++;
            busy(c, VODR_BLOCK_RASTERIZER);
        }
        c->rastering = c->next_row < c->rows.bound.y1;
    } else if (can_pop(c, &c->slice_link)) {
        if (c->drawn_slice_visit != c->slice_visit) {
            c->drawn_slice_visit = c->slice_visit;
            c->visit_accepted = false;
            c->covered = (px_rect){INT32_MAX, INT32_MAX, 0, 0};
            c->covered_slices = 0;
        }
        c->slice_link.full = false;
        c->slice_link.popped = c->now;
        c->raster_slice = c->slice;
        rasterizer_start(&c->rows, &c->raster_slice, &visit_at(c, c->slice_visit)->brick.bound);
        c->next_row = c->rows.bound.y0;
        c->done_px = 0;
        c->slice_has_fragments = false;
        c->have_span = rasterizer_next(&c->rows, &c->current);
        c->rastering = c->next_row < c->rows.bound.y1;
        busy(c, VODR_BLOCK_RASTERIZER);
    }
}
