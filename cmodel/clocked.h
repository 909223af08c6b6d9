/* clocked.h - the machine with every block clocked: each cycle each block looks at what the others registered and moves
 * by one step. The slow truth of cycles (docs/timing.md); frame and counters come out as of the pipeline. */
#ifndef VODR_CLOCKED_H
#define VODR_CLOCKED_H

#include "clocked_blocks.h"

enum { CLOCKED_BLOCKS = VODR_BLOCK_COUNT + 1 }; /* and the external memory of `whole` */

typedef struct clocked clocked;

/* A machine before its first cycle, of inputs that were checked; it outlives none of them. The observer may be NULL.
 * *c is NULL on failure; free it with clocked_free(). */
vodr_status clocked_start(clocked **c, const vodr_machine *machine, const vodr_volume *volume, const vodr_table *table,
                          const vodr_view *view, const vodr_observer *observer, vodr_error *error);

/* Where the machine's blocks are, and what their outputs hold at reset; of several pipelines those of the first. Before
 * the first cycle another block can be put into a face, and its reset values into its outputs; what was there is the
 * caller's then. The frame buffer of several pipelines can be surrounded, not replaced. */
block_faces *clocked_faces(clocked *c);
block_outs *clocked_reset(clocked *c);

/* What they are made from, for whoever makes another. */
const block_setup *clocked_setup(const clocked *c);

/* One cycle. `order` names each of CLOCKED_BLOCKS blocks once, a vodr_block or VODR_BLOCK_COUNT for the external
 * memory, and makes no difference; NULL: as they stand. False when there was nothing left to do. */
bool clocked_step(clocked *c, const uint8_t *order);

/* What all blocks registered last; of several pipelines, those of the first. */
const block_outs *clocked_outs(const clocked *c);

/* The share of the bricks that the divider has gone through. */
double clocked_done(const clocked *c);

/* The finished frame, to be freed with vodr_frame_free(), and its counts. */
vodr_status clocked_readout(const clocked *c, vodr_frame *frame, vodr_counters *counters, vodr_error *error);

void clocked_free(clocked *c);

/* As vodr_render(), with counters->cycles. */
vodr_status clocked_render(const vodr_machine *machine, const vodr_volume *volume, const vodr_table *table,
                           const vodr_view *view, const vodr_options *options, vodr_frame *frame,
                           vodr_counters *counters, vodr_error *error);

#endif
