/* cluster_stats.h - what a frame of several nodes took, as JSON (--stats). */
#ifndef HOST_CLUSTER_STATS_H
#define HOST_CLUSTER_STATS_H

#include "cluster_options.h"
#include "digest.h"
#include "scene.h"

/* What a change of the transfer function took; of the report, its shares are none. */
typedef struct cluster_changed {
    const char *transfer;
    double seconds;
    cluster_report report;
} cluster_changed;

/* What drawing gave; the frame is freed with vodr_frame_free(). */
typedef struct cluster_result {
    vodr_frame frame;
    cluster_report report;
    double wall_s; /* median of the repetitions: drawing and compositing */
    int repeat;
    int changes;
    cluster_changed change[CLUSTER_CHANGES];
    char frame_sha256[DIGEST_CHARS];
} cluster_result;

host_status cluster_stats_write(output *o, const scene *s, const view_options *v, const cluster_options *options,
                                const reference_choice *choice, const cluster_result *r, host_error *error);

#endif
