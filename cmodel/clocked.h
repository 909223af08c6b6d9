/* clocked.h - the machine with every block clocked: each cycle each block looks at what the others registered and moves
 * by one step. The slow truth of cycles (docs/timing.md); frame and counters come out as of the pipeline. */
#ifndef VODR_CLOCKED_H
#define VODR_CLOCKED_H

#include "vodr.h"

/* As vodr_render(), with counters->cycles. */
vodr_status clocked_render(const vodr_machine *machine, const vodr_volume *volume, const vodr_table *table,
                           const vodr_view *view, vodr_frame *frame, vodr_counters *counters, vodr_error *error);

#endif
