/* pipeline.h - the machine's blocks joined, one frame at a time. */
#ifndef VODR_PIPELINE_H
#define VODR_PIPELINE_H

#include "alpha_blender.h"
#include "frame_buffer.h"
#include "marks.h"
#include "pixel_cache.h"
#include "texture_unit.h"
#include "vodr.h"
#include "volume_divider.h"

typedef struct pipeline {
    const vodr_machine *machine;
    const vodr_view *view;
    bool picture;
    volume_divider divider;
    texture_unit texture;
    alpha_blender blender;
    pixel_cache cache;
    frame_buffer memory;
    uint16_t *densities;  /* of a span */
    vodr_rgba *fragments; /* likewise */
    uint8_t *seen;        /* by brick: visited before */
    vodr_counters counters;
    const marks *marks;            /* without a picture: what a picture drawn before tells; set it as the observer */
    const vodr_observer *observer; /* set it after pipeline_start(); NULL: nobody */
} pipeline;

/* Checks every input and prepares a frame. With `picture` false the walk leaves out densities, colours and pixels and
 * counts what the whole machine counts. In `over` without kill_transparent every fragment writes its pixel, and
 * geometry alone suffices; otherwise it needs the marks of the finished picture. The inputs must outlive the pipeline.
 * Free with pipeline_finish() in either case. */
vodr_status pipeline_start(pipeline *p, const vodr_machine *machine, const vodr_volume *volume, const vodr_table *table,
                           const vodr_view *view, bool picture, vodr_error *error);

/* Draws the next candidate of the divider; false when the frame is done, flushed and counted. */
bool pipeline_step(pipeline *p);

/* The finished frame, where there is a picture. The caller frees it with vodr_frame_free(). */
vodr_status pipeline_readout(const pipeline *p, vodr_frame *frame, vodr_error *error);

void pipeline_finish(pipeline *p);

#endif
