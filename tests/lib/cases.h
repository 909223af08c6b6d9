/* cases.h - random cases for the machine: a volume, a table, a view and a machine from one seed, the same on every
 * platform. Corners are drawn more often than chance would: eyes on voxel borders, ties, odd sizes, values at both
 * ends. */
#ifndef TESTS_CASES_H
#define TESTS_CASES_H

#include <stdio.h>

#include "camera.h"
#include "rng.h"
#include "vodr.h"

typedef struct test_case {
    uint64_t seed;
    rng random;        /* where the next case_organise() goes on */
    volume geometry;   /* what the camera needs: size, spacing, orientation; no voxels */
    vodr_volume input; /* what the machine draws */
    void *voxels;
    uint16_t map[256];
    vodr_table table;
    vodr_rgba *entries;
    camera eye;
    vodr_view view;
    vodr_machine machine; /* picture parameters random, organisation at its default */
} test_case;

/* Makes the case of a seed. False when the host is out of memory. After any outcome case_free() may be called. */
bool case_make(uint64_t seed, test_case *c);
void case_free(test_case *c);

/* Gives one case in three a cubic filter instead of its own, with coefficients for voxels where the filter takes them.
 * Apart from case_make(), whose cases are recorded of a card. False when the host is out of memory. */
bool case_widen(test_case *c);

/* Draws every organisation parameter but the traversal anew, such that the machine can be built for the case's volume.
 */
void case_organise(test_case *c, vodr_machine *machine);

/* Draws every parameter anew that is about time alone. Small figures: what is full, late or in the way must happen
 * within frames of some thousand fragments. */
void case_time(test_case *c, vodr_machine *machine);

/* Gives a machine one to five pipelines, oftenest one. Drawn apart from the rest of the organisation, so that the cases
 * of one pipeline are the ones they are without it. */
void case_multiply(test_case *c, vodr_machine *machine);

/* A machine of which all of that is drawn, with the case's picture. */
void case_any_machine(test_case *c, vodr_machine *machine);

/* A machine that the Verilog has, one of few sets of its parameters, with registers drawn small, so that what is full,
 * late or in the way happens in small frames. Of the picture it keeps the widths of the case's densities and table:
 * others would be libraries of their own. It may be one that cannot be built for the case's volume. */
void case_verilog_machine(test_case *c, vodr_machine *machine);

/* Gives a machine about as much texture memory as its bricks need, or too small a cache: it may not be buildable. */
void case_spoil(test_case *c, vodr_machine *machine);

/* Fills a table of a reference renderer, CASE_ROWS rows of CASE_COLUMNS entries, RGBA premultiplied: stretches show
 * nothing, in every second table all but one; entries may be opaque. */
enum { CASE_COLUMNS = 64, CASE_ROWS = 3 };
void case_fill_rgba(rng *r, double rgba[4 * CASE_COLUMNS * CASE_ROWS]);

/* Writes what is needed to see the case: seed, volume, view, machine. */
void case_print(FILE *file, const test_case *c, const vodr_machine *machine);

#endif
