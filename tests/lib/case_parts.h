/* case_parts.h - the parts that cases.c puts together; each draws from c->random. */
#ifndef TESTS_CASE_PARTS_H
#define TESTS_CASE_PARTS_H

#include "cases.h"

/* Voxels, map and geometry, for the density_bits of c->machine. False when out of memory. `even`: a cube of
 * an even side, so that the eye's axis runs along borders of bricks. */
bool case_make_volume(test_case *c, bool even);

/* The table, for the density_bits and tf_bits of c->machine. False when out of memory. */
bool case_make_table(test_case *c);

/* The view of the volume. `delicate`: perspective at 0,0 or 30,30 with odd sizes and many slices. */
void case_make_view(test_case *c, bool delicate);

#endif
