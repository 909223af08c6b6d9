/* cycle_stats.h - a frame's cycles in words and as JSON: per block, per stall cause, and what limits the frame. */
#ifndef HOST_CYCLE_STATS_H
#define HOST_CYCLE_STATS_H

#include <jansson.h>

#include "vodr.h"

/* {"total": ..., and each block by name: {"busy", "stalled", "idle"}}; NULL when memory is out. */
json_t *cycle_stats_blocks(const vodr_cycles *c);

/* Each stall cause by name; NULL when memory is out. */
json_t *cycle_stats_stalls(const vodr_cycles *c);

/* One sentence without a final full stop: the largest of the blocks' busy shares, the bus's, and the stall causes that
 * are not merely the wait for a block further down; and the next largest. size >= 192. */
void cycle_stats_bottleneck(const vodr_cycles *c, char *text, size_t size);

#endif
