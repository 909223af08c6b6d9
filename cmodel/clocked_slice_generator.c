/* clocked_slice_generator.c - the slice generator, clocked: takes a brick, prepares its slices one after the other. */
#include "clocked_machine.h"

void clock_slice_generator(clocked *c)
{
    if (c->generating && c->setup_left) {
        c->setup_left--;
        busy(c, VODR_BLOCK_SLICE_GENERATOR);
    } else if (c->generating) {
        if (!can_push(c, &c->slice_link)) {
            c->n.stalls[VODR_STALL_SLICE]++;
            return;
        }
        c->slice = c->next_slice;
        c->slice_visit = c->drawn;
        c->slice_link.full = true;
        c->slice_link.pushed = c->now;
        c->setup_left = c->m->slice_setup_cycles;
        c->generating = slice_generator_next(&c->slices, &c->next_slice);
        busy(c, VODR_BLOCK_SLICE_GENERATOR);
    } else if (can_pop(c, &c->bricks)) {
        const candidate *b = &visit_at(c, ++c->drawn)->brick;
        c->bricks.full = false;
        c->bricks.popped = c->now;
        c->slices = slice_generator_start(c->view, &b->box, b->k0, b->k1, c->m->blend == VODR_BLEND_UNDER);
        c->generating = slice_generator_next(&c->slices, &c->next_slice);
        c->setup_left = c->m->slice_setup_cycles;
        busy(c, VODR_BLOCK_SLICE_GENERATOR);
    }
}
