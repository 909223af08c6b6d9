/* clocked_volume_divider.c - the divider, clocked: looks for the next brick with a fragment, works for as many cycles
 * as that takes, hands it on. For the look it fuses what slice generator and rasterizer know of rows. */
#include "volume_divider.h"

#include <stdlib.h>

#include "clocked_blocks.h"
#include "rasterizer.h"
#include "slice_generator.h"

typedef struct divider_state {
    const vodr_view *view;
    bool front_to_back;
    volume_divider *walk;
    bool found; /* a visit: `next` */
    candidate next;
    int64_t work_left; /* cycles, before it can be handed on */
    volume_divider_out out;
} divider_state;

/* Cycles for a slice: one for each row that is looked at, which are all, or those up to the first that has a fragment.
 * That it has no row takes a cycle to see. */
static int64_t probe_slice(const brick_slice *slice, const px_rect *bound, bool *found)
{
    rasterizer rows;
    span s;
    rasterizer_start(&rows, slice, bound);
    int32_t first = rows.bound.y0, end = rows.bound.y1;
    *found = rasterizer_next(&rows, &s);
    if (*found)
        return s.y + 1 - first;
    return end > first ? end - first : 1;
}

/* Looks for the next brick with a fragment; the work is done at once here and takes its cycles afterwards. */
static void search(divider_state *s)
{
    s->found = false;
    while (!s->found && volume_divider_next(s->walk, &s->next)) {
        const candidate *c = &s->next;
        slice_generator slices = slice_generator_start(s->view, &c->box, c->k0, c->k1, s->front_to_back);
        brick_slice slice;
        while (!s->found && slice_generator_next(&slices, &slice))
            s->work_left += probe_slice(&slice, &c->bound, &s->found);
    }
    s->work_left += volume_divider_work(s->walk);
}

static void push(divider_state *s)
{
    const candidate *c = &s->next;
    s->out.brick = (brick_port){
        .valid = true, .fresh = true, .brick = c->brick, .box = c->box, .bound = c->bound, .k0 = c->k0, .k1 = c->k1};
    search(s);
}

static void clock(void *state, const volume_divider_in *in, volume_divider_out *out)
{
    divider_state *s = state;
    brick_port *brick = &s->out.brick;
    report_port *report = &s->out.report;
    bool full = brick->valid;
    report->status = BLOCK_IDLE;
    brick->fresh = false;
    if (full && in->brick->ready)
        brick->valid = false;
    if (s->work_left) {
        s->work_left--;
        report->status = BLOCK_BUSY;
    } else if (s->found && full) {
        report->status = BLOCK_STALLED + VODR_STALL_DIVIDER;
    } else if (s->found) {
        push(s);
        report->status = BLOCK_BUSY;
    }
    report->idle = !s->found && !s->work_left && !brick->valid;
    *out = s->out;
}

bool clocked_volume_divider(const block_setup *setup, volume_divider_face *face, volume_divider_out *reset)
{
    divider_state *s = calloc(1, sizeof *s);
    *face = (volume_divider_face){.state = s, .clock = clock, .finish = free};
    if (!s)
        return false;
    s->view = setup->view;
    s->front_to_back = setup->machine->blend == VODR_BLEND_UNDER;
    s->walk = setup->walk;
    search(s);
    *reset = s->out;
    return true;
}
