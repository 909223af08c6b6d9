/* mip_case.h - random cases of the maximum, and what every --accel must make of them: the picture of `none`. */
#ifndef RECORD_MIP_CASE_H
#define RECORD_MIP_CASE_H

#include <stdio.h>

#include "cases.h"
#include "reference.h"

enum { MIP_COLUMNS = 256, MIP_EDGES = 4 };

typedef struct mip_case {
    test_case base;
    float *floats; /* of every fourth case, some below zero; else NULL */
    reference_volume volume;
    int32_t edges_vox[MIP_EDGES]; /* blocks: 2, a few voxels, as many as the volume has, and more */
    reference_march_job job;      /* rays or slices, exact or of a texture unit, linear or nearest */
    double table[4 * MIP_COLUMNS];
} mip_case;

/* What was drawn of some cases. */
typedef struct mip_tally {
    uint64_t cases, frames, differ;
    uint64_t samples[REFERENCE_ACCELS]; /* of blocks of 2 */
    double sum;                         /* of the last case's maxima */
} mip_tally;

/* The names of --accel. */
const char *mip_accel_name(reference_accel accel);

/* Fills a table of MIP_COLUMNS from black to white, opaque. */
void mip_fill_ramp(double *rgba);

/* Makes the case of a seed. False when the host is out of memory. After any outcome mip_case_free() may be called. */
bool mip_case_make(uint64_t seed, mip_case *c);
void mip_case_free(mip_case *c);

/* Draws the case by every --accel and block size on a device, and adds to the tally; pictures that are not `none`'s are
 * told to the file. False, after a sentence there, when something cannot be drawn. */
bool mip_case_hold(const mip_case *c, const reference_options *options, FILE *file, mip_tally *t);

/* The same of `none` alone. */
bool mip_case_draw(const mip_case *c, const reference_options *options, FILE *file, mip_tally *t);

#endif
