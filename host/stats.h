/* stats.h - the statistics of a frame as JSON (--stats). */
#ifndef HOST_STATS_H
#define HOST_STATS_H

#include "digest.h"
#include "output.h"
#include "scene.h"

/* What drawing a scene gave. */
typedef struct result {
    vodr_frame frame;
    vodr_counters counters;
    double wall_s; /* median of the repetitions */
    int repeat;
    char frame_sha256[DIGEST_CHARS];
} result;

/* hits/(hits + misses); negative when there was no access. */
double stats_hit_rate(const vodr_counters *c);

/* Fragments a second; 0 when the time is too short to measure. */
double stats_fragments_per_s(const result *r);

host_status stats_write(output *o, const scene *s, const view_options *options, const result *r, host_error *error);

#endif
