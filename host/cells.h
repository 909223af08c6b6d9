/* cells.h - what a machine's blocks take when they are synthesised: rows of rtl/synthesis.txt that have its parameters
 * (docs/sweep.md, "Costs"). */
#ifndef HOST_CELLS_H
#define HOST_CELLS_H

#include "host.h"
#include "vodr.h"

/* One module with one set of parameters. */
typedef struct cell_row {
    int module;       /* a block, or VODR_BLOCK_COUNT: vodr_top without its blocks */
    char *parameters; /* "NAME=VALUE NAME=VALUE"; those not named are the default machine's; owned */
    bool words;       /* count is of word bits, not of cells */
    int64_t count, flip_flops;
} cell_row;

/* Rows, of which a later one counts before an earlier one of the same parameters. */
typedef struct cell_table {
    cell_row *rows;
    size_t count;
} cell_table;

typedef struct cell_counts {
    int64_t cells;      /* of all blocks but those whose row is in word bits */
    int64_t word_bits;  /* of those */
    int64_t flip_flops; /* of all */
} cell_counts;

/* The text of rtl/synthesis.txt (generated). */
extern const char rtl_synthesis_text[];

/* Adds a text's rows, as scripts/synth-row prints them: `MODULE [NAME=VALUE]... | cells | flip-flops | ...`, '#' begins
 * a comment line, further fields are not read. `where` names the text in sentences. The table is to be freed also after
 * an error. */
host_status cell_table_parse(const char *text, const char *where, cell_table *table, host_error *error);

/* The rows of rtl/synthesis.txt, then, when path is not NULL, those of that file. */
host_status cell_table_open(const char *path, cell_table *table, host_error *error);
void cell_table_free(cell_table *table);

/* Sums over the blocks and vodr_top; false when a block has no row of the machine's parameters, or the Verilog refuses
 * the machine. A memory whose size a frame decides counts as the smallest that is built. */
bool cells_of(const cell_table *table, const vodr_machine *machine, cell_counts *counts);

#endif
