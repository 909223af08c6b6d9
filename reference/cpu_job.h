/* cpu_job.h - private to the CPU device: work in rows, dealt out to threads in bands. */
#ifndef REFERENCE_CPU_JOB_H
#define REFERENCE_CPU_JOB_H

#include <pthread.h>

#include "cpu_march.h"

enum { BAND = CPU_TILE_PX, MAX_THREADS = 256 };

/* `work` is called for bands of rows until none is left. */
typedef struct cpu_job cpu_job;
struct cpu_job {
    void (*work)(const cpu_job *job, int32_t begin, int32_t end, uint64_t *samples);
    const void *input; /* what the work is on */
    void *output;
    cpu_march_rows *march_rows;
    int32_t grid; /* edge of a block, or number of a grid */
    int32_t rows;
    int32_t band;         /* rows of a band; 0: BAND */
    pthread_mutex_t lock; /* over what follows */
    int32_t next;
    uint64_t samples;
};

/* Returns milliseconds. A thread that cannot be started is done without. */
double cpu_job_run(int32_t threads, cpu_job *job);

#endif
