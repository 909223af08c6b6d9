/* clocked_alpha_blender.c - the alpha blender, clocked: keeps the colours of fragments that wait for their pixel,
 * blends each pixel that is read, and hands it back when blend_cycles are over. */
#include "alpha_blender.h"

#include <stdlib.h>

#include "clocked_blocks.h"
#include "pixel_word.h"
#include "ring.h"

RING(colour_ring, uint64_t)

/* A pixel under way to the cache. */
typedef struct result {
    bool valid, writes;
    uint64_t pixel;
} result;

typedef struct blender_state {
    const vodr_machine *machine;
    alpha_blender blender;
    colour_port waiting; /* the fragment before the cache */
    colour_ring colours; /* of fragments that are gone from there */
    int32_t at, delay;
    result *stages; /* a ring: results by the cycle in which they were blended; `at`: in this one */
    alpha_blender_out out;
} blender_state;

static void blend(blender_state *s, uint64_t pixel)
{
    vodr_rgba source = pixel_of_word(s->machine, *colour_ring_front(&s->colours));
    vodr_rgba target = pixel_of_word(s->machine, pixel);
    uint64_t terminated;
    result *r = &s->stages[s->at];
    colour_ring_pop(&s->colours);
    r->valid = true;
    r->writes = alpha_blender_run(&s->blender, &source, 1, &target, &terminated) > 0;
    r->pixel = pixel_word(s->machine, target);
}

static void clock(void *state, const alpha_blender_in *in, alpha_blender_out *out)
{
    blender_state *s = state;
    blended_port *b = &s->out.blended;
    report_port *report = &s->out.report;
    result *stage = &s->stages[s->at];
    stage->valid = false;
    if (in->pixel->valid)
        blend(s, in->pixel->pixel);
    b->known = stage->valid;
    b->known_writes = stage->writes;
    s->at = s->at + 1 < s->delay ? s->at + 1 : 0;
    stage = &s->stages[s->at];
    b->valid = stage->valid;
    b->writes = stage->writes;
    b->pixel = stage->pixel;
    report->status = BLOCK_IDLE;
    if (s->waiting.valid)
        report->status =
            in->door->gone ? BLOCK_BUSY : BLOCK_STALLED + (in->door->hazard ? VODR_STALL_HAZARD : VODR_STALL_CACHE);
    if (s->waiting.valid && in->door->gone) {
        s->waiting.valid = false;
        if (!s->waiting.dead)
            colour_ring_push(&s->colours, s->waiting.colour);
    }
    if (in->colour->valid && in->door->ready)
        s->waiting = *in->colour;
    report->idle = !s->waiting.valid && !s->colours.count;
    *out = s->out;
}

static void finish(void *state)
{
    blender_state *s = state;
    colour_ring_free(&s->colours);
    free(s->stages);
    free(s);
}

bool clocked_alpha_blender(const block_setup *setup, alpha_blender_face *face, alpha_blender_out *reset)
{
    blender_state *s = calloc(1, sizeof *s);
    *face = (alpha_blender_face){.state = s, .clock = clock, .finish = finish};
    if (!s)
        return false;
    s->machine = setup->machine;
    s->blender = alpha_blender_of(setup->machine);
    /* A pixel read in a cycle comes in the next, and what became of it is seen blend_cycles - 1 after the read. */
    s->delay = setup->machine->blend_cycles - 2;
    s->stages = calloc((size_t)s->delay, sizeof *s->stages);
    s->out.report.idle = true;
    *reset = s->out;
    return s->stages && colour_ring_reserve(&s->colours, (size_t)setup->machine->nonblocking_fifo + 1);
}
