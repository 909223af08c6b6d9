/* jobs.h - frames of the cube drawn side by side for a table, one thread a core. */
#ifndef BENCH_JOBS_H
#define BENCH_JOBS_H

#include "cube.h"

enum { JOB_SETTINGS = 4 };

/* A named machine with settings on top. */
typedef struct job_machine {
    const char *label, *machine;
    const char *settings[JOB_SETTINGS][2]; /* parameter and value */
} job_machine;

/* A frame to draw, and what came of it. */
typedef struct job {
    const job_machine *row;
    const vodr_view *view;
    vodr_machine machine;
    vodr_counters counters;
    bool drawn;
} job;

/* False after a sentence on standard error that begins with `program`. */
bool job_machine_make(const char *program, const job_machine *row, vodr_machine *machine);

/* Draws all jobs, with cycles or without; false, after a sentence on standard error, when one was not drawn. */
bool jobs_draw(const char *program, const cube *c, job *jobs, size_t count, bool cycles);

/* 1048576 as "1,048,576". */
const char *job_commas(uint64_t number, char text[32]);

#endif
