/* totals.h - from what was counted cycle by cycle to each block's account (docs/timing.md, section 10). */
#ifndef VODR_TOTALS_H
#define VODR_TOTALS_H

#include "memory.h"
#include "vodr.h"

/* Closes the accounts of a frame whose last event was in cycle `last` (-1: there was none): the busy cycles of all
 * blocks but the frame buffer, and all stall causes but the memory's, are filled in. Each block's waits are the causes
 * that are its own. */
void totals_close(vodr_cycles *n, const memory *bus, int64_t last);

#endif
