/* sweep_run.h - the points of a sweep drawn by threads, in one process or several. */
#ifndef HOST_SWEEP_RUN_H
#define HOST_SWEEP_RUN_H

#include "sweep_file.h"
#include "sweep_row.h"

/* Where this process stands among those that mpirun started; 0 of 1 without. */
typedef struct sweep_rank {
    int rank, ranks, local_ranks; /* local: on this host */
} sweep_rank;

sweep_rank sweep_rank_here(void);

/* Draws what is left, one thread a point; when it succeeds the row of every point is in the file. threads 0: the cores
 * that this process may use, shared with the other ranks of the host. */
host_status sweep_run(sweep_stage *s, const sweep_columns *c, sweep_file *f, int threads, const sweep_rank *rank,
                      host_error *error);

#endif
