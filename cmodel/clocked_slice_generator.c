/* clocked_slice_generator.c - the slice generator, clocked: takes a brick, prepares its slices one after the other. */
#include "slice_generator.h"

#include <stdlib.h>

#include "clocked_blocks.h"

typedef struct generator_state {
    const vodr_view *view;
    bool front_to_back;
    int32_t setup_cycles;
    slice_generator slices;
    bool generating; /* there is a next slice */
    brick_slice next;
    px_rect bound;
    int32_t setup_left;
    slice_generator_out out;
} generator_state;

static void prepare_next(generator_state *s)
{
    s->generating = slice_generator_next(&s->slices, &s->next);
    s->setup_left = s->setup_cycles;
}

static void push(generator_state *s)
{
    s->out.slice.valid = true;
    s->out.slice.slice = s->next;
    s->out.slice.bound = s->bound;
    prepare_next(s);
    s->out.slice.last = !s->generating;
}

static void pop(generator_state *s, const brick_port *brick)
{
    s->bound = brick->bound;
    s->slices = slice_generator_start(s->view, &brick->box, brick->k0, brick->k1, s->front_to_back);
    prepare_next(s);
}

static void clock(void *state, const slice_generator_in *in, slice_generator_out *out)
{
    generator_state *s = state;
    slice_port *slice = &s->out.slice;
    report_port *report = &s->out.report;
    bool full = slice->valid;
    report->status = BLOCK_BUSY;
    if (full && in->slice->ready)
        slice->valid = false;
    if (s->generating && s->setup_left)
        s->setup_left--;
    else if (s->generating && full)
        report->status = BLOCK_STALLED + VODR_STALL_SLICE;
    else if (s->generating)
        push(s);
    else if (in->brick->valid)
        pop(s, in->brick);
    else
        report->status = BLOCK_IDLE;
    s->out.brick.ready = !s->generating;
    report->idle = !s->generating && !slice->valid;
    *out = s->out;
}

bool clocked_slice_generator(const block_setup *setup, slice_generator_face *face, slice_generator_out *reset)
{
    generator_state *s = calloc(1, sizeof *s);
    *face = (slice_generator_face){.state = s, .clock = clock, .finish = free};
    if (!s)
        return false;
    s->view = setup->view;
    s->front_to_back = setup->machine->blend == VODR_BLEND_UNDER;
    s->setup_cycles = setup->machine->slice_setup_cycles;
    s->out.brick.ready = s->out.report.idle = true;
    *reset = s->out;
    return true;
}
