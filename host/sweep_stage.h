/* sweep_stage.h - what the points of a sweep are drawn from: volumes, machines and transfer functions opened once and
 * shared by all threads, tables and registers made anew for each point. */
#ifndef HOST_SWEEP_STAGE_H
#define HOST_SWEEP_STAGE_H

#include <pthread.h>

#include "costs.h"
#include "digest.h"
#include "sweep_plan.h"
#include "transfer.h"

/* What a point gave. */
typedef struct sweep_sample {
    vodr_machine machine;
    vodr_view view;
    vodr_counters counters;
    char frame_sha256[DIGEST_CHARS];
    char refused[1024]; /* why the machine cannot draw it, and nothing else is there; empty: it was drawn */
} sweep_sample;

struct stage_volume;

typedef struct stage_machine {
    const char *name;
    vodr_machine machine; /* with the fixed overrides */
} stage_machine;

typedef struct stage_transfer {
    const char *name;
    transfer transfers[2]; /* [1]: for a CT */
} stage_transfer;

/* What a volume's file says of it as a whole. */
typedef struct stage_file {
    const char *path;
    char file_sha256[DIGEST_CHARS], voxels_sha256[DIGEST_CHARS]; /* voxels: as they lie in memory */
    volume header;                                               /* without voxels and path */
} stage_file;

typedef struct sweep_stage {
    const sweep_plan *plan;
    const view_options *fixed;
    const char *volume; /* where volumes do not vary */
    cost_tables tables;
    stage_machine *machines;
    size_t machine_count;
    stage_transfer *transfers;
    size_t transfer_count;
    stage_file *files;
    size_t file_count;
    pthread_mutex_t lock; /* over what follows */
    struct stage_volume *volumes;
    size_t idle_bytes;
    uint64_t uses;
} sweep_stage;

/* Opens every machine, transfer function and volume that a point may name; volumes are read one after the other and put
 * away again. `path` is NULL where the plan has them. To be closed in either case. */
host_status sweep_stage_open(sweep_stage *s, const sweep_plan *plan, const view_options *fixed, const char *path,
                             host_error *error);

/* Draws a point on one thread. Any number of threads may at once. What the machine or the view refuses is a sample too;
 * a failure is the environment's. */
host_status sweep_stage_draw(sweep_stage *s, uint64_t point, sweep_sample *sample, host_error *error);

void sweep_stage_close(sweep_stage *s);

#endif
