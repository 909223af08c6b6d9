/* stage_volumes.h - private to the stage of a sweep: volumes made ready for the machine, shared between threads. */
#ifndef HOST_STAGE_VOLUMES_H
#define HOST_STAGE_VOLUMES_H

#include "sweep_stage.h"

typedef struct stage_volume {
    /* Which one it is. */
    const char *path;
    volume_options options;
    double window_lo, window_hi;
    int density_bits;
    bool coefficients; /* in the place of densities */
    /* What is known of it, loaded or not. */
    double min, max;
    bool ct;
    /* What it holds while it is loaded. */
    bool loaded;
    volume volume;
    vodr_volume densities;
    int users;
    uint64_t used; /* when last, in uses of the stage */
    struct stage_volume *next;
} stage_volume;

/* Reads every file once: whether it can be read, and what is in it. */
host_status stage_volumes_look(sweep_stage *s, const char *path, host_error *error);

/* A volume with the densities of a window, as the machine takes them, loaded where it is not there yet. `t` says which
 * window where `v` does not. To be given back with stage_volumes_release(). *refused: the point cannot be drawn, the
 * sentence says why. */
host_status stage_volumes_take(sweep_stage *s, const char *path, const view_options *v, const stage_transfer *t,
                               const vodr_machine *m, stage_volume **taken, bool *refused, host_error *error);
void stage_volumes_release(sweep_stage *s, stage_volume *taken);

void stage_volumes_free(sweep_stage *s);

#endif
