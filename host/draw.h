/* draw.h - a scene drawn on a machine and timed, with a progress line on a terminal. */
#ifndef HOST_DRAW_H
#define HOST_DRAW_H

#include "cosim.h"
#include "digest.h"
#include "host.h"
#include "scene.h"
#include "vodr.h"

/* What drawing a scene gave. The frame is freed with vodr_frame_free(). */
typedef struct result {
    vodr_frame frame;
    vodr_counters counters;
    double wall_s; /* median of the repetitions */
    int repeat;
    char frame_sha256[DIGEST_CHARS];
} result;

typedef struct draw_options {
    const char *label; /* what the progress line says is going on */
    int32_t threads;   /* 0 = all cores */
    vodr_path path;
    vodr_simd simd;
    bool cycles; /* count them */
    int repeat;  /* at least 1; an observer is told of every one */
    const vodr_observer *observer;
    const cosim_options *cosim; /* some blocks in Verilog: draws on one thread, and counts cycles; NULL: none */
} draw_options;

/* The median of `count` times, which are put in order. */
double draw_median(double *times, int count);

/* Draws `repeat` times on `machine`, whose picture parameters are the scene's own; the frame and counters are those of
 * the last, all being equal. *r is zeroed or holds an earlier result, whose frame is freed. Runs of less than a second,
 * and those whose standard error is no terminal, show no progress. */
host_status draw(const scene *s, const vodr_machine *machine, const draw_options *how, result *r, host_error *error);

#endif
