#include "cosim.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "clocked.h"
#include "lockstep.h"
#include "pipeline.h"
#include "place.h"
#include "top.h"
#include "transactions.h"
#include "watchdog.h"
#include "waveform.h"

enum { PROGRESS_CYCLES = 1 << 14, NO_BLOCK = VODR_BLOCK_COUNT };

/* What a frame is drawn from. */
typedef struct inputs {
    const vodr_machine *machine;
    const vodr_volume *volume;
    const vodr_table *table;
    const vodr_view *view;
} inputs;

/* A machine whose blocks are partly in Verilog: of each block one of the two is there, or neither. */
typedef struct cosim {
    clocked *machine;
    lockstep *steps[VODR_BLOCK_COUNT];
    transactions *streams[VODR_BLOCK_COUNT];
    top *top; /* instead of both */
    transactions_reference reference;
    places places;
    watchdog watchdog;
    uint64_t limit; /* of cycles without a move */
    uint64_t cycle; /* the next */
} cosim;

static void cosim_close(cosim *c)
{
    for (int b = 0; b < VODR_BLOCK_COUNT; b++) {
        if (c->steps[b])
            lockstep_close(c->steps[b], clocked_faces(c->machine));
        free(c->steps[b]);
        if (c->streams[b])
            transactions_close(c->streams[b]);
    }
    if (c->top)
        top_close(c->top);
    free(c->top);
    places_finish(&c->places);
    clocked_free(c->machine);
    clocked_free(c->reference.machine);
}

static rtl_status step_with(cosim *c, vodr_block block, const rtl_source *source, vodr_error *error)
{
    lockstep *l = calloc(1, sizeof *l);
    if (!l)
        return rtl_fail(error, RTL_NO_MEMORY, "no memory for %s", signals_of(block)->name);
    rtl_status status = lockstep_open(l, source, block, clocked_setup(c->machine), clocked_faces(c->machine),
                                      clocked_reset(c->machine), error);
    if (status == RTL_OK)
        c->steps[block] = l;
    else
        free(l);
    return status;
}

static rtl_status step_top(cosim *c, const rtl_source *source, vodr_error *error)
{
    top *t = calloc(1, sizeof *t);
    if (!t)
        return rtl_fail(error, RTL_NO_MEMORY, "no memory for vodr_top");
    rtl_status status = top_open(t, source, c->machine, error);
    if (status == RTL_OK)
        c->top = t;
    else
        free(t);
    return status;
}

static rtl_status start(clocked **machine, const inputs *in, const vodr_observer *observer, vodr_error *error)
{
    vodr_status status = clocked_start(machine, in->machine, in->volume, in->table, in->view, observer, error);
    return status == VODR_OK ? RTL_OK : status == VODR_NO_MEMORY ? RTL_NO_MEMORY : RTL_INVALID;
}

/* `traced` is a block whose library can write waveforms, or NO_BLOCK. To be closed in either case. */
static rtl_status cosim_open(cosim *c, const inputs *in, const cosim_options *o, int traced, vodr_error *error)
{
    *c = (cosim){.limit = watchdog_limit(in->machine)};
    bool by_cycles = o->compare == COSIM_CYCLES;
    rtl_status status = RTL_OK;
    if (pipeline_check(in->machine, in->volume, in->view, error) != VODR_OK)
        return RTL_INVALID;
    for (int b = 0; status == RTL_OK && b < VODR_BLOCK_COUNT; b++)
        if (o->replaced[b] || o->top)
            status = cosim_check((vodr_block)b, in->machine, error);
    if (status == RTL_OK)
        status = start(&c->machine, in, traced == NO_BLOCK ? o->observer : NULL, error);
    if (status == RTL_OK && (!by_cycles || o->top))
        status = start(&c->reference.machine, in, NULL, error);
    if (status == RTL_OK && o->top)
        return step_top(c, &(rtl_source){.root = o->root, .build = o->build, .trace = traced != NO_BLOCK}, error);
    for (int b = 0; status == RTL_OK && b < VODR_BLOCK_COUNT; b++) {
        const rtl_source source = {.root = o->root, .build = o->build, .file = o->files[b], .trace = b == traced};
        if (!o->replaced[b])
            continue;
        status = by_cycles
                     ? step_with(c, (vodr_block)b, &source, error)
                     : transactions_open(&c->streams[b], &source, (vodr_block)b, c->machine, &c->reference, error);
    }
    return status;
}

/* A block in Verilog, or vodr_top for any, and what it did differently by now; NULLs: it is in C. */
typedef struct verilog {
    rtl_block *block;
    const difference *first;
} verilog;

static verilog verilog_of(const cosim *c, int block)
{
    if (c->top)
        return (verilog){&c->top->rtl, &c->top->first};
    if (c->steps[block])
        return (verilog){&c->steps[block]->rtl, &c->steps[block]->first};
    if (c->streams[block])
        return (verilog){transactions_block(c->streams[block]), transactions_first(c->streams[block])};
    return (verilog){NULL, NULL};
}

/* The first block whose Verilog differs by now; NO_BLOCK when none does. */
static int differing(const cosim *c)
{
    for (int b = 0; b < VODR_BLOCK_COUNT; b++) {
        const difference *first = verilog_of(c, b).first;
        if (first && first->found)
            return c->top ? (int)c->top->block : b;
    }
    return NO_BLOCK;
}

/* After the last cycle: whether something is missing. */
static void end(cosim *c)
{
    if (c->top)
        top_end(c->top, c->reference.machine);
    for (int b = 0; b < VODR_BLOCK_COUNT; b++) {
        if (c->steps[b])
            lockstep_end(c->steps[b]);
        if (c->streams[b])
            transactions_end(c->streams[b]);
    }
}

/* One cycle; false when there was nothing left to do. */
static bool step(cosim *c)
{
    const block_outs *before = clocked_outs(c->machine);
    bool left = c->top ? top_step(c->top) : clocked_step(c->machine, NULL);
    if (c->top) {
        clocked_step(c->reference.machine, NULL);
        top_compare(c->top, c->reference.machine);
    }
    places_cycle(&c->places, before, clocked_outs(c->machine));
    watchdog_cycle(&c->watchdog, c->cycle, before, clocked_outs(c->machine));
    c->cycle++;
    return left;
}

static bool hangs(const cosim *c)
{
    return c->cycle - c->watchdog.moved > c->limit;
}

/* Draws until the frame is done, a block differs, which is returned, or nothing moves any more. */
static int draw(cosim *c, const cosim_options *o)
{
    int block = differing(c);
    bool left = true;
    while (block == NO_BLOCK && left && !hangs(c)) {
        left = step(c);
        block = differing(c);
        if (o->progress && c->cycle % PROGRESS_CYCLES == 0)
            o->progress(o->progress_context, clocked_done(c->machine));
    }
    if (block != NO_BLOCK || left)
        return block;
    end(c);
    return differing(c);
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
        status = waveform_open(&w, o->waveform, verilog_of(&c, block).block, d, cycle, error);
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
    const difference d = *verilog_of(c, block).first;
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

static rtl_status tell_hanging(const cosim *c, vodr_error *error)
{
    watchdog_tell(&c->watchdog, clocked_outs(c->machine), error->text, sizeof error->text);
    return RTL_DIFFERS;
}

/* Whether something could not be kept for want of memory, so that what differs may differ for that alone. */
static bool failed(const cosim *c)
{
    bool any = c->places.failed;
    for (int b = 0; b < VODR_BLOCK_COUNT; b++)
        any |= c->streams[b] && transactions_failed(c->streams[b]);
    return any;
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
    if (status == RTL_OK && options->begin)
        options->begin(options->begin_context);
    if (status == RTL_OK)
        block = draw(&c, options);
    if (failed(&c))
        status = rtl_fail(error, RTL_NO_MEMORY, "no memory for what is under way");
    else if (block != NO_BLOCK)
        status = tell_difference(&c, &in, options, block, error);
    else if (status == RTL_OK && hangs(&c))
        status = tell_hanging(&c, error);
    if (status == RTL_OK && clocked_readout(c.machine, frame, counters, error) != VODR_OK)
        status = RTL_NO_MEMORY;
    cosim_close(&c);
    return status;
}
