/* clocked_counts.h - what a clocked machine did, counted at its ports alone: so the counts are the same whoever its
 * blocks are (docs/architecture.md, section 10; docs/timing.md, section 10). */
#ifndef VODR_CLOCKED_COUNTS_H
#define VODR_CLOCKED_COUNTS_H

#include "blocks.h"
#include "ring.h"

typedef struct counted_visit {
    vodr_visit visit;
    uint64_t first; /* number of its first fragment */
} counted_visit;

RING(counted_visit_ring, counted_visit)

/* What all pipelines of a machine count together. */
typedef struct clocked_sums {
    vodr_counters n;
    uint8_t *seen; /* by brick: visited before */
} clocked_sums;

/* One pipeline's. */
typedef struct clocked_counts {
    const vodr_machine *machine;
    const vodr_observer *observer; /* or NULL */
    px_rect window;                /* the pipeline's part of the frame; in `tile` all of it */
    clocked_sums *sums;
    vodr_cycles cycles;
    int64_t now, last;             /* the last cycle in which something happened */
    counted_visit_ring visits;     /* handed on by the divider, and none of their fragments is gone from the door */
    uint64_t begun;                /* so many of these have had a fragment accepted */
    uint64_t accepted, gone;       /* fragments; gone: from the door */
    bool visit_begun, slice_begun; /* the visit, the slice at hand has had a fragment */
    px_rect covered;               /* by the visit's fragments */
} clocked_counts;

/* False when there is no memory. Free with clocked_counts_finish(). */
bool clocked_counts_start(clocked_counts *c, const vodr_machine *machine, const px_rect *window,
                          const vodr_observer *observer, clocked_sums *sums);

/* A cycle: what all blocks had registered before it, and at its end. */
void clocked_counts_cycle(clocked_counts *c, const block_outs *before, const block_outs *after);

/* The accounts of the blocks of a machine with so many pipelines (docs/timing.md, section 14). */
vodr_cycles clocked_counts_close(const clocked_counts *c, int32_t pipelines);

void clocked_counts_finish(clocked_counts *c);

#endif
