/* signals.h - which ports a Verilog block has: the fields of cmodel/ports.h by the names and widths that they have in
 * Verilog (docs/cosimulation.md). One table serves the wires between C and Verilog, the comparison of both, and the
 * check of a module that somebody brings. */
#ifndef VODR_SIGNALS_H
#define VODR_SIGNALS_H

#include "blocks.h"

/* Widths that follow from the machine. */
enum { WIDTH_PIXEL = -1, WIDTH_LINE = -2, WIDTH_BEAT = -3 };

enum { SIGNAL_ALWAYS = -1, SIGNAL_WHOLE = -1 };

/* A field of a port's record. */
typedef struct signal_field {
    const char *name;
    int32_t width_bits; /* or a WIDTH_ */
    int16_t offset, bytes;
    int16_t when;   /* offset of the bool that must be up for the field to mean anything; SIGNAL_ALWAYS */
    int16_t length; /* offset of an int32_t: so many bytes of the field mean something; SIGNAL_WHOLE */
} signal_field;

/* A port as a block has it: some neighbouring fields of a record. */
typedef struct signal_port {
    const signal_field *fields;
    int32_t count;
    bool output;
    int32_t record; /* offset in the block's `out`; for an input, of the pointer to the record in its `in` */
} signal_port;

typedef struct block_signals {
    const char *name;
    const signal_port *ports;
    int32_t count;
} block_signals;

/* vodr_top: its outputs are records of block_outs, in the order of blocks. */
#define RTL_TOP ((vodr_block)VODR_BLOCK_COUNT)

/* Of a vodr_block, or RTL_TOP. */
const block_signals *signals_of(vodr_block block);

/* Where a block's record begins among all; of RTL_TOP, where the last one ends. */
int32_t rtl_top_record(vodr_block block);

/* A field's width in a machine, bits. */
int32_t signal_width(const signal_field *field, const vodr_machine *machine);

/* Bytes of a field that mean anything in a record. */
size_t signal_bytes(const signal_field *field, const vodr_machine *machine, const void *record);

/* A port's record in a block's `in` or `out`. */
const void *signal_record(const signal_port *port, const void *in, const void *out);

/* Whether a field of a record means anything now. */
static inline bool signal_counts(const signal_field *field, const void *record)
{
    return field->when == SIGNAL_ALWAYS || ((const bool *)record)[field->when];
}

#endif
