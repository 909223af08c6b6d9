/* outcome.h - what drawing a frame gave: compared, hashed, and its differences told. */
#ifndef TESTS_OUTCOME_H
#define TESTS_OUTCOME_H

#include <stdio.h>

#include "cases.h"

typedef struct outcome {
    vodr_status status;
    vodr_frame frame; /* its pixels are freed by vodr_frame_free() */
    vodr_counters counters;
    vodr_error error;
} outcome;

enum { OUTCOME_COUNTERS = 17 };

/* Draws the case with libvodr. */
void outcome_draw(const test_case *c, const vodr_machine *machine, const vodr_options *options, outcome *o);

void outcome_free(outcome *o);

/* Whether two frames are the same to the byte; if not, their first difference goes to `file`. */
bool outcome_same_frame(FILE *file, const outcome *a, const outcome *b);

/* Whether all counters are the same; those that are not go to `file`. */
bool outcome_same_counters(FILE *file, const outcome *a, const outcome *b);

/* Whether frames, counters, cycles and stalls are the same; what is not goes to `file`. */
bool outcome_same(FILE *file, const outcome *a, const outcome *b);

/* Continues an FNV-1a hash over the frame's channels and the counters, in an order that is the same on every platform.
 */
#define OUTCOME_HASH_START 0xCBF29CE484222325u
uint64_t outcome_hash(uint64_t hash, const outcome *o);

#endif
