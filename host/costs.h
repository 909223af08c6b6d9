/* costs.h - what a frame costs beside what the machine counted: bytes off the chip, energy, memory on the chip, cells
 * (docs/sweep.md, "Costs"). */
#ifndef HOST_COSTS_H
#define HOST_COSTS_H

#include <jansson.h>

#include "cells.h"
#include "energy.h"
#include "vodr.h"

/* What they are reckoned from. */
typedef struct cost_tables {
    energy_table energy;
    cell_table cells;
} cost_tables;

/* The tables of the files, where they are not NULL, in place of, or beside, the project's own (energy.h, cells.h). To
 * be freed also after an error. */
host_status cost_tables_open(const char *energy, const char *cells, cost_tables *tables, host_error *error);
void cost_tables_free(cost_tables *tables);

typedef struct costs {
    uint64_t fb_bytes, texture_bytes; /* to and from the frame buffer; of the volume */
    /* Energy by where it goes, pJ. */
    double offchip_pj;    /* every byte off the chip */
    double cache_pj;      /* the pixel cache's data and tags */
    double texture_pj;    /* texture memory: bricks in, voxels out */
    double table_pj;      /* the transfer-function table */
    double arithmetic_pj; /* positions, interpolation, blending */
    /* Memory on the chip, bits, of a machine built for frames of this size. */
    uint64_t cache_data_bits, cache_tag_bits, texture_bits, table_bits, fifo_bits;
    uint64_t touch_bits; /* clear_on_first_touch: a bit a line of the frame */
    bool has_cells;
    cell_counts cells;
} costs;

costs costs_of(const vodr_machine *machine, const vodr_view *view, const vodr_counters *counters,
               const cost_tables *tables);

uint64_t costs_offchip_bytes(const costs *c);
uint64_t costs_onchip_bits(const costs *c);
double costs_energy_pj(const costs *c);

/* An object of these, their sums offchip_bytes, energy_pj and onchip_bits beside them, energies rounded to whole pJ,
 * cells null where they are not known; NULL when memory is out. */
json_t *costs_json(const costs *c);

#endif
