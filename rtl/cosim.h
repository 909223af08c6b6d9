/* cosim.h - draws a frame with some blocks in Verilog and the others in C (docs/cosimulation.md). */
#ifndef VODR_COSIM_H
#define VODR_COSIM_H

#include "library.h"

/* What a block in Verilog is held against. */
typedef enum cosim_compare {
    COSIM_CYCLES,       /* the block in C on the same inputs: every output in every cycle */
    COSIM_TRANSACTIONS, /* what a machine in C hands on at the same ports, in order, whenever that is */
} cosim_compare;

typedef struct cosim_options {
    const char *root, *build;            /* see rtl_source */
    bool replaced[VODR_BLOCK_COUNT];     /* which blocks are in Verilog, */
    const char *files[VODR_BLOCK_COUNT]; /* and from which file; NULL: ours */
    bool top;                            /* instead, all of them as one model, vodr_top.v */
    cosim_compare compare;               /* of blocks; vodr_top is held against cycles */
    const char *waveform;                /* where a difference leaves its waveform, without ".fst"; NULL: nowhere */
    void (*begin)(void *context); /* libraries are built and loaded, the first cycle comes; NULL: nobody is told */
    void *begin_context;
    void (*progress)(void *context, double done);
    void *progress_context;
    const vodr_observer *observer;
} cosim_options;

/* As vodr_render(), with counters->cycles. Inputs are those that vodr_render() takes. RTL_DIFFERS: the sentence says
 * cycle, block, port, what was expected and got, and the place in the picture. */
rtl_status cosim_render(const vodr_machine *machine, const vodr_volume *volume, const vodr_table *table,
                        const vodr_view *view, const cosim_options *options, vodr_frame *frame, vodr_counters *counters,
                        vodr_error *error);

/* Whether the Verilog of a block can be such a machine's; the sentence names the parameter, its value and the range. */
rtl_status cosim_check(vodr_block block, const vodr_machine *machine, vodr_error *error);

#endif
