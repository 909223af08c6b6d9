/* pipeline.h - the machine's blocks joined, one frame at a time. A machine of several pipelines is drawn by one that
 * takes the part of each in turn: they share no pixel and no line, so their order makes no difference. */
#ifndef VODR_PIPELINE_H
#define VODR_PIPELINE_H

#include "alpha_blender.h"
#include "cycles.h"
#include "frame_buffer.h"
#include "marks.h"
#include "pixel_cache.h"
#include "texture_unit.h"
#include "vodr.h"
#include "volume_divider.h"

typedef struct pipeline {
    const vodr_machine *machine;
    const vodr_view *view;
    int32_t turn; /* whose part is drawn */
    bool picture;
    bool lines_only; /* without a picture: all fragments write their pixels, and lines alone matter */
    volume_divider divider;
    texture_unit texture;
    alpha_blender blender;
    pixel_cache cache;
    frame_buffer memory;
    uint16_t *densities;  /* of a span */
    vodr_rgba *fragments; /* likewise */
    int64_t line_row;     /* of the span at hand */
    uint8_t *seen;        /* by brick: visited before */
    vodr_counters counters;
    const marks *marks;            /* without a picture: what a picture drawn before tells; set it as the observer */
    cycles *clock;                 /* counts cycles; NULL: nobody does */
    bool failed;                   /* memory ran out while it did */
    bool flushing;                 /* what is written now is the flush at the frame's end */
    int64_t probe_cycles;          /* since the last visit: the divider's work beside its walk */
    int32_t *leading_rows;         /* of a candidate's slices before its first fragment */
    const vodr_observer *observer; /* set it after pipeline_start(); NULL: nobody */
} pipeline;

/* Checks every input and prepares a frame. With `picture` false the walk leaves out densities, colours and pixels and
 * counts what the whole machine counts. In `over` without kill_transparent every fragment writes its pixel, and
 * geometry alone suffices; otherwise it needs the marks of the finished picture. Cycles (`clock`) are those of a
 * machine of one pipeline. The inputs must outlive the pipeline. Free with pipeline_finish() in either case. */
vodr_status pipeline_start(pipeline *p, const vodr_machine *machine, const vodr_volume *volume, const vodr_table *table,
                           const vodr_view *view, bool picture, bool clock, vodr_error *error);

/* Whether a machine can be built and draw a volume and a view; the sentence says why not. */
vodr_status pipeline_check(const vodr_machine *m, const vodr_volume *volume, const vodr_view *view, vodr_error *error);

/* Draws the next candidate of the divider; false when the frame is done, flushed and counted. */
bool pipeline_step(pipeline *p);

/* How far the frame is, 0 to 1. */
double pipeline_done(const pipeline *p);

/* The finished frame, where there is a picture. The caller frees it with vodr_frame_free(). */
vodr_status pipeline_readout(const pipeline *p, vodr_frame *frame, vodr_error *error);

void pipeline_finish(pipeline *p);

#endif
