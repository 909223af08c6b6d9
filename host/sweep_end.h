/* sweep_end.h - the end of a sweep, when all its rows are there: the file in the order of its points, and the front
 * marked. */
#ifndef HOST_SWEEP_END_H
#define HOST_SWEEP_END_H

#include "sweep_file.h"
#include "sweep_front.h"

/* The finished rows. */
typedef struct sweep_rows {
    uint64_t count;
    off_t *at;      /* where each point's row begins in the file */
    double *values; /* values[point*columns + i]: a number, or not one */
    bool *marks;    /* on the front; all false without objectives */
    uint64_t refused, front;
    bool in_order; /* as the rows lie in the file */
} sweep_rows;

/* Reads from every row the numbers of so many columns, and finds the front of the first o->count of them, which are the
 * objectives. To be freed in either case. */
host_status sweep_rows_read(sweep_rows *r, const sweep_file *f, const size_t *columns, size_t count,
                            const sweep_objectives *o, host_error *error);
void sweep_rows_free(sweep_rows *r);

/* Puts the file in order, `pareto` filled in where there are objectives: written beside, then put in its place. Leaves
 * a file alone that is so already. `objective` is --objective's text, NULL without. */
host_status sweep_end(const sweep_file *f, const sweep_rows *r, const char *objective, host_error *error);

#endif
