/* top.h - the whole machine as one model, vodr_top.v, in the place of all seven blocks. Of what blocks register it
 * shows what counters listen to and nothing else. */
#ifndef VODR_TOP_H
#define VODR_TOP_H

#include "clocked.h"
#include "lockstep.h"

typedef struct top {
    rtl_block rtl;
    clocked *machine;
    block_faces inner;                          /* the C blocks, in their places */
    int32_t first_output[VODR_BLOCK_COUNT + 1]; /* the first of each block's outputs */
    difference first;
    vodr_block block; /* that differs */
} top;

/* Puts vodr_top into a machine before its first cycle. To be closed on success, before the machine is freed. */
rtl_status top_open(top *t, const rtl_source *source, clocked *machine, vodr_error *error);
void top_close(top *t);

/* As clocked_step(). */
bool top_step(top *t);

/* Compares what it shows with what the blocks in C have registered after as many cycles, and after the last cycle what
 * both have left in memory; the first difference is told in t->first and t->block. */
void top_compare(top *t, const clocked *expected);
void top_end(top *t, const clocked *expected);

#endif
