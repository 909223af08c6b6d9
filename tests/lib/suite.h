/* suite.h - what the tests over random cases share: their command line and the count of what failed. */
#ifndef TESTS_SUITE_H
#define TESTS_SUITE_H

#include "cases.h"

typedef struct suite {
    uint64_t cases, first_seed;
} suite;

/* Reads `[CASES [FIRST_SEED]]`. False, after a sentence on standard error, when they are not numbers. */
bool suite_options(int argc, char **argv, suite *s);

/* Runs `check` on every case; it writes what is wrong to the file and returns false when something is. The first few
 * failing cases are told in full, then how many failed. Returns their number. */
uint64_t suite_run(const suite *s, bool (*check)(test_case *c, FILE *file));

#endif
