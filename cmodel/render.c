/* render.c - vodr_render(): chooses who draws. */
#include <stdlib.h>

#include "clocked.h"
#include "error.h"
#include "fused.h"
#include "pipeline.h"
#include "vodr.h"

static void report(const vodr_options *options, double done)
{
    if (options->progress)
        options->progress(options->progress_context, done);
}

static vodr_status draw_blocks(pipeline *p, const vodr_options *options, vodr_frame *frame, vodr_error *error)
{
    while (pipeline_step(p))
        report(options, pipeline_done(p));
    return pipeline_readout(p, frame, error);
}

vodr_status vodr_render(const vodr_machine *machine, const vodr_volume *volume, const vodr_table *table,
                        const vodr_view *view, const vodr_options *options, vodr_frame *frame, vodr_counters *counters,
                        vodr_error *error)
{
    static const vodr_options defaults = {0};
    *frame = (vodr_frame){0};
    *counters = (vodr_counters){0};
    if (!options)
        options = &defaults;
    bool several = options->cycles && machine->pipelines != 1; /* what the recurrences do not know */
    if (several || options->path == VODR_PATH_CLOCKED) {
        vodr_status checked = pipeline_check(machine, volume, view, error);
        return checked == VODR_OK ? clocked_render(machine, volume, table, view, options, frame, counters, error)
                                  : checked;
    }
    bool fast = options->path == VODR_PATH_FAST && fused_supports(machine, view);
    pipeline p;
    vodr_status status = pipeline_start(&p, machine, volume, table, view, !fast, options->cycles, error);
    p.observer = options->observer;
    if (status == VODR_OK)
        status = fast ? fused_render(&p, volume, options, frame, error) : draw_blocks(&p, options, frame, error);
    if (status == VODR_OK && p.failed) {
        status = vodr_fail(error, VODR_NO_MEMORY, "no memory to count cycles");
        vodr_frame_free(frame);
    }
    if (status == VODR_OK)
        *counters = p.counters;
    pipeline_finish(&p);
    return status;
}

void vodr_frame_free(vodr_frame *frame)
{
    free(frame->pixels);
    *frame = (vodr_frame){0};
}
