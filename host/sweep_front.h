/* sweep_front.h - what a sweep is judged by, and which points nothing beats (the Pareto front). */
#ifndef HOST_SWEEP_FRONT_H
#define HOST_SWEEP_FRONT_H

#include "sweep_row.h"

enum { SWEEP_OBJECTIVES = 8 };

/* Columns of numbers, each to be small or to be large. */
typedef struct sweep_objectives {
    size_t column[SWEEP_OBJECTIVES];
    bool largest[SWEEP_OBJECTIVES];
    size_t count;
} sweep_objectives;

/* Reads `COL[:min|max],...`. */
host_status sweep_objectives_parse(const char *text, const sweep_columns *c, const sweep_plan *p, sweep_objectives *o,
                                   host_error *error);

/* Fills marks[i] with whether point i is on the front: it has every value, and no other point is as good in all and
 * better in one. values[i*count + k] is objective k of point i, not a number where it has none. */
host_status sweep_front(const double *values, size_t points, const sweep_objectives *o, bool *marks, host_error *error);

#endif
