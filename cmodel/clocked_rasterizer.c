/* clocked_rasterizer.c - the rasterizer, clocked: a slice row by row, a fragment a cycle, offered to the texture unit.
 */
#include "rasterizer.h"

#include <stdlib.h>

#include "clocked_blocks.h"

typedef struct rasterizer_state {
    brick_slice slice;
    bool last; /* slice of its visit */
    rasterizer rows;
    bool rastering; /* a row is left */
    bool have_span;
    span current; /* the next row that has fragments */
    int32_t y;    /* of the row at hand */
    int32_t done_px;
    rasterizer_out out;
} rasterizer_state;

static void pop(rasterizer_state *s, const slice_port *slice)
{
    s->slice = slice->slice;
    s->last = slice->last;
    rasterizer_start(&s->rows, &s->slice, &slice->bound);
    s->y = s->rows.bound.y0;
    s->done_px = 0;
    s->have_span = rasterizer_next(&s->rows, &s->current);
}

static void accepted(rasterizer_state *s)
{
    if (++s->done_px < s->current.x1 - s->current.x0)
        return;
    s->y++;
    s->done_px = 0;
    s->have_span = rasterizer_next(&s->rows, &s->current);
}

/* The fragment at hand, if the row at hand has one. */
static void offer(rasterizer_state *s)
{
    fragment_port *f = &s->out.fragment;
    f->valid = s->rastering && s->have_span && s->y == s->current.y;
    if (!f->valid)
        return;
    f->x = s->current.x0 + s->done_px;
    f->y = s->y;
    for (int c = 0; c < 3; c++)
        f->a[c] = numerator_at(&s->slice.plane, c, f->x, f->y);
}

static void clock(void *state, const rasterizer_in *in, rasterizer_out *out)
{
    rasterizer_state *s = state;
    report_port *report = &s->out.report;
    bool working = s->rastering || in->slice->valid;
    report->status = working ? BLOCK_BUSY : BLOCK_IDLE;
    if (!s->rastering && working)
        pop(s, in->slice);
    else if (s->out.fragment.valid && in->fragment->ready)
        accepted(s);
    else if (s->out.fragment.valid)
        report->status = BLOCK_STALLED + (in->fragment->loading ? VODR_STALL_TEXTURE_LOAD : VODR_STALL_FRAGMENT_FIFO);
    else if (working)
        s->y++;
    s->rastering = working && s->y < s->rows.bound.y1;
    s->out.slice.ready = report->idle = !s->rastering;
    offer(s);
    s->out.fragment.visit_done = working && !s->rastering && s->last;
    *out = s->out;
}

bool clocked_rasterizer(const block_setup *setup, rasterizer_face *face, rasterizer_out *reset)
{
    (void)setup;
    rasterizer_state *s = calloc(1, sizeof *s);
    *face = (rasterizer_face){.state = s, .clock = clock, .finish = free};
    if (!s)
        return false;
    s->out.slice.ready = s->out.report.idle = true;
    *reset = s->out;
    return true;
}
