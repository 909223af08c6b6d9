/* render.c - vodr_render(): chooses who draws. */
#include <stdlib.h>

#include "error.h"
#include "pipeline.h"
#include "vodr.h"

static void report(const vodr_options *options, double done)
{
    if (options->progress)
        options->progress(options->progress_context, done);
}

static vodr_status render_blocks(const vodr_machine *machine, const vodr_volume *volume, const vodr_table *table,
                                 const vodr_view *view, const vodr_options *options, vodr_frame *frame,
                                 vodr_counters *counters, vodr_error *error)
{
    pipeline p;
    vodr_status status = pipeline_start(&p, machine, volume, table, view, true, error);
    if (status == VODR_OK) {
        while (pipeline_step(&p))
            report(options, volume_divider_done(&p.divider));
        status = pipeline_readout(&p, frame, error);
    }
    if (status == VODR_OK)
        *counters = p.counters;
    pipeline_finish(&p);
    return status;
}

vodr_status vodr_render(const vodr_machine *machine, const vodr_volume *volume, const vodr_table *table,
                        const vodr_view *view, const vodr_options *options, vodr_frame *frame, vodr_counters *counters,
                        vodr_error *error)
{
    static const vodr_options defaults = {0};
    *frame = (vodr_frame){0};
    *counters = (vodr_counters){0};
    return render_blocks(machine, volume, table, view, options ? options : &defaults, frame, counters, error);
}

void vodr_frame_free(vodr_frame *frame)
{
    free(frame->pixels);
    *frame = (vodr_frame){0};
}
