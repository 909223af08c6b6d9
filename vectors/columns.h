/* columns.h - the columns of a line of vectors: rst, the ports of a block by their names in Verilog, first inputs, then
 * outputs; their values as text and back (docs/vectors.md). */
#ifndef VECTORS_COLUMNS_H
#define VECTORS_COLUMNS_H

#include "signals.h"

enum { COLUMNS_MOST = 80, COLUMN_DIGITS = 2 * PORT_LINE_BYTES };

typedef struct column {
    const char *name;
    int32_t width_bits, digits;
    const signal_port *port; /* NULL: rst, or what memory behind the frame buffer answers; */
    const signal_field *field;
} column;

typedef struct columns {
    const vodr_machine *machine;
    column at[COLUMNS_MOST];
    int32_t inputs, count; /* inputs are the first */
} columns;

enum { COLUMN_RST = 0 };

void columns_of(columns *c, vodr_block block, const vodr_machine *machine);

/* Writes a number's digits, highest first, without a final NUL; bytes from `known` on are 'x'. Returns their end. */
char *column_put(char *text, const uint8_t *value, int32_t width_bits, size_t known);

/* Writes a column of a port: `x` where it means nothing. Returns the end. */
char *column_put_field(char *text, const columns *c, const column *col, const void *in, const void *out);

/* Reads digits, of which `x` is one, 0 in the value. False when there are not exactly as many as the width has, one is
 * none, or the number is wider. A single `x` stands for as many as need be. */
bool column_get(const char *text, size_t length, int32_t width_bits, uint8_t *value, size_t bytes);

/* How many digits of text, from its end, are known; all of them: COLUMN_DIGITS or more. */
int32_t column_known(const char *text, size_t length);

#endif
