/* cycles.h - a frame's cycles from recurrences over slices, rows, runs and bus grants instead of from clocking
 * registers (docs/timing.md). Fed by the machine's own walk, in its order; equal to the clocked machine, cycle for
 * cycle. */
#ifndef VODR_CYCLES_H
#define VODR_CYCLES_H

#include "memory.h"
#include "vodr.h"

/* A brick visit as the divider hands it on. */
typedef struct cycle_visit {
    int64_t work_cycles;  /* of the divider, since the visit before */
    int64_t load_bytes;   /* 0: nothing to load */
    int64_t load_address; /* of the brick in memory */
} cycle_visit;

/* What the accesses of a run, one a fragment of a row, do beyond hitting. */
typedef struct cycle_access {
    int32_t line, victim; /* its number, and that of the dirty line which has to leave */
    uint32_t written;     /* written through: bit i: fragment i writes its pixel */
    bool miss;            /* the first access missed, */
    bool reads;           /* and the line is read, not filled with zeros */
    bool evicts;          /* and a dirty line has to leave */
} cycle_access;

typedef struct cycles cycles;

cycles *cycles_start(const vodr_machine *m, const vodr_view *view);

void cycles_visit(cycles *c, const cycle_visit *v); /* the first slice of the visit follows */
void cycles_slice(cycles *c);
void cycles_rows(cycles *c, int32_t count); /* rows without fragments */
/* Fragments that hit, or that kill_transparent dropped: none of them is written through. */
void cycles_hits(cycles *c, int32_t x, int32_t y, int32_t count, bool killed);

/* Any other run: its first access missed and the others, in this line or the next, hit; or, at most 32 fragments of a
 * line, the cache writes through. */
void cycles_run(cycles *c, int32_t x, int32_t y, int32_t count, const cycle_access *access);
void cycles_flush_line(cycles *c, int64_t line); /* a dirty line at the frame's end, after the last run */

/* The end of the frame: work_cycles of the divider after the last visit. False when memory ran out on the way. */
bool cycles_finish(cycles *c, int64_t work_cycles, vodr_cycles *result);

void cycles_free(cycles *c);

#endif
