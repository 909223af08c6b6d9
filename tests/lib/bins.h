/* bins.h - functional coverage: situations that the tests' frames have to meet, each a bin with a name. Which there are
 * stands in bins_table.h and nowhere else. */
#ifndef TESTS_BINS_H
#define TESTS_BINS_H

#include "cases.h"

/* How many bins there are, and what one is called. */
int bins_count(void);
const char *bins_group(int bin);
const char *bins_name(int bin);

/* Draws a frame, clocked, and sets seen[bin] for each that it meets. */
vodr_status bins_draw(const test_case *c, const vodr_machine *machine, bool *seen, vodr_error *error);

#endif
