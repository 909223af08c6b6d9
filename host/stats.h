/* stats.h - the statistics of a frame as JSON (--stats). */
#ifndef HOST_STATS_H
#define HOST_STATS_H

#include <jansson.h>

#include "draw.h"
#include "output.h"
#include "scene.h"

/* hits/(hits + misses); negative when there was no access. */
double stats_hit_rate(const vodr_counters *c);

/* Fragments a second; 0 when the time is too short to measure. */
double stats_fragments_per_s(const result *r);

/* The view as an object; NULL when memory is out. */
json_t *stats_view(const scene *s);

/* An object of the machine's counters; NULL when memory is out. */
json_t *stats_counters(const vodr_counters *c);

/* The whole of what stats_write() writes; NULL when memory is out. */
json_t *stats_json(const scene *s, const view_options *options, const result *r);

host_status stats_write(output *o, const scene *s, const view_options *options, const result *r, host_error *error);

#endif
