#include "cosim.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "clocked.h"
#include "lockstep.h"
#include "place.h"
#include "waveform.h"

enum { PROGRESS_CYCLES = 1 << 14, NO_BLOCK = VODR_BLOCK_COUNT };

/* What a frame is drawn from. */
typedef struct inputs {
    const vodr_machine *machine;
    const vodr_volume *volume;
    const vodr_table *table;
    const vodr_view *view;
} inputs;

/* A machine whose blocks are partly in Verilog. */
typedef struct cosim {
    clocked *machine;
    lockstep *blocks[VODR_BLOCK_COUNT]; /* NULL: in C */
    places places;
    uint64_t cycle; /* the next */
} cosim;

static void cosim_close(cosim *c)
{
    for (int b = 0; b < VODR_BLOCK_COUNT; b++) {
        if (c->blocks[b])
            lockstep_close(c->blocks[b], clocked_faces(c->machine));
        free(c->blocks[b]);
    }
    places_finish(&c->places);
    clocked_free(c->machine);
}

static rtl_status replace(cosim *c, vodr_block block, const rtl_source *source, vodr_error *error)
{
    lockstep *l = calloc(1, sizeof *l);
    if (!l)
        return rtl_fail(error, RTL_NO_MEMORY, "no memory for %s", signals_of(block)->name);
    rtl_status status = lockstep_open(l, source, block, clocked_setup(c->machine), clocked_faces(c->machine),
                                      clocked_reset(c->machine), error);
    if (status == RTL_OK)
        c->blocks[block] = l;
    else
        free(l);
    return status;
}

/* `traced` is a block whose library can write waveforms, or NO_BLOCK. To be closed in either case. */
static rtl_status cosim_open(cosim *c, const inputs *in, const cosim_options *o, int traced, vodr_error *error)
{
    *c = (cosim){0};
    rtl_status status = RTL_OK;
    for (int b = 0; status == RTL_OK && b < VODR_BLOCK_COUNT; b++)
        if (o->replaced[b])
            status = cosim_check((vodr_block)b, in->machine, error);
    if (status != RTL_OK)
        return status;
    const vodr_observer *observer = traced == NO_BLOCK ? o->observer : NULL;
    vodr_status started = clocked_start(&c->machine, in->machine, in->volume, in->table, in->view, observer, error);
    if (started != VODR_OK)
        return started == VODR_NO_MEMORY ? RTL_NO_MEMORY : RTL_INVALID;
    for (int b = 0; status == RTL_OK && b < VODR_BLOCK_COUNT; b++) {
        const rtl_source source = {.root = o->root, .build = o->build, .file = o->files[b], .trace = b == traced};
        if (o->replaced[b])
            status = replace(c, (vodr_block)b, &source, error);
    }
    return status;
}

/* The first block whose Verilog differs by now; NO_BLOCK when none does. */
static int differing(const cosim *c)
{
    for (int b = 0; b < VODR_BLOCK_COUNT; b++)
        if (c->blocks[b] && c->blocks[b]->first.found)
            return b;
    return NO_BLOCK;
}

/* One cycle; false when there was nothing left to do. */
static bool step(cosim *c)
{
    const block_outs *before = clocked_outs(c->machine);
    bool left = clocked_step(c->machine, NULL);
    places_cycle(&c->places, before, clocked_outs(c->machine));
    c->cycle++;
    return left;
}

/* Draws until the frame is done or a block differs, which is returned. */
static int draw(cosim *c, const cosim_options *o)
{
    int block = differing(c);
    bool left = true;
    while (block == NO_BLOCK && left) {
        left = step(c);
        block = differing(c);
        if (o->progress && c->cycle % PROGRESS_CYCLES == 0)
            o->progress(o->progress_context, clocked_done(c->machine));
    }
    if (block == NO_BLOCK && c->blocks[VODR_BLOCK_FRAME_BUFFER] && !lockstep_end(c->blocks[VODR_BLOCK_FRAME_BUFFER]))
        block = VODR_BLOCK_FRAME_BUFFER;
    return block;
}

/* ---- a difference ---- */

/* Draws the frame again up to the difference, and a little beyond, with the block's signals written down. */
static rtl_status draw_waveform(const inputs *in, const cosim_options *o, int block, const difference *d,
                                uint64_t cycle, vodr_error *error)
{
    cosim c;
    waveform w;
    rtl_status status = cosim_open(&c, in, o, block, error);
    if (status == RTL_OK)
        status = waveform_open(&w, o->waveform, c.blocks[block], d, cycle, error);
    bool left = status == RTL_OK;
    while (left && c.cycle < w.end_cycle) {
        waveform_cycle(&w, c.cycle);
        left = step(&c);
    }
    cosim_close(&c);
    return status;
}

static rtl_status tell_difference(cosim *c, const inputs *in, const cosim_options *o, int block, vodr_error *error)
{
    const difference d = c->blocks[block]->first;
    const place p = places_of(&c->places, (vodr_block)block);
    const uint64_t cycle = c->cycle ? c->cycle - 1 : 0;
    char where[120], waveform_note[160] = "";
    place_tell(&p, where, sizeof where);
    if (o->waveform) {
        vodr_error why;
        if (draw_waveform(in, o, block, &d, cycle, &why) == RTL_OK)
            snprintf(waveform_note, sizeof waveform_note, "; waveform: %.100s.fst, .gtkw", o->waveform);
        else
            snprintf(waveform_note, sizeof waveform_note, "; no waveform: %.130s", why.text);
    }
    return rtl_fail(error, RTL_DIFFERS, "%s differs %s %" PRIu64 ", port %s: expected %s, got %s (%s)%s",
                    signals_of((vodr_block)block)->name, c->cycle ? "in cycle" : "at reset, before cycle", cycle,
                    d.field->name, d.expected, d.got, where, waveform_note);
}

rtl_status cosim_render(const vodr_machine *machine, const vodr_volume *volume, const vodr_table *table,
                        const vodr_view *view, const cosim_options *options, vodr_frame *frame, vodr_counters *counters,
                        vodr_error *error)
{
    const inputs in = {machine, volume, table, view};
    cosim c;
    int block = NO_BLOCK;
    *frame = (vodr_frame){0};
    *counters = (vodr_counters){0};
    rtl_status status = cosim_open(&c, &in, options, NO_BLOCK, error);
    if (status == RTL_OK)
        block = draw(&c, options);
    if (block != NO_BLOCK)
        status = tell_difference(&c, &in, options, block, error);
    if (status == RTL_OK && c.places.failed)
        status = rtl_fail(error, RTL_NO_MEMORY, "no memory for the fragments under way");
    if (status == RTL_OK && clocked_readout(c.machine, frame, counters, error) != VODR_OK)
        status = RTL_NO_MEMORY;
    cosim_close(&c);
    return status;
}
