/* cubic_cases.h - random cases of the cubic filters: each --accel's picture held against that of `none`. For make check
 * and for the record of a card. */
#ifndef BENCH_CUBIC_CASES_H
#define BENCH_CUBIC_CASES_H

#include "cases.h"
#include "reference.h"

/* `unsafe`: pictures of REFERENCE_ACCEL_UNSAFE that are not none's, of `unsafe_frames`. */
typedef struct cubic_tally {
    uint64_t cases, frames, differ, unsafe_frames, unsafe;
    uint64_t samples[REFERENCE_ACCELS];
} cubic_tally;

/* Draws a case, by every accel that its blend and filter have, in each of the ways; its picture is to be that of `none`
 * in the first way, to the byte. Pictures that are not are counted and told. False when one is not, or a frame could
 * not be drawn. */
bool cubic_case_hold(test_case *c, const reference_options *ways, int count, FILE *file, cubic_tally *t);

const char *cubic_accel_name(reference_accel accel);

#endif
