/* energy.h - picojoules of the few operations that all others are reckoned from (hw/energy.txt). */
#ifndef HOST_ENERGY_H
#define HOST_ENERGY_H

#include <jansson.h>

#include "host.h"

typedef enum energy_term {
    ENERGY_ADD,       /* 8-bit integers */
    ENERGY_MULTIPLY,  /* 8-bit integers */
    ENERGY_SRAM_WORD, /* 64 bits of an 8 KiB memory on the chip */
    ENERGY_DRAM_BYTE, /* off the chip */
    ENERGY_TERMS,
} energy_term;

typedef struct energy_table {
    double pj[ENERGY_TERMS];
} energy_table;

/* The text of hw/energy.txt (generated). */
extern const char hw_energy_text[];

/* Reads a table's text: lines `name | pJ | ...`, '#' begins a comment line. What it does not name keeps the value of
 * hw/energy.txt. `where` names the text in sentences. */
host_status energy_parse(const char *text, const char *where, energy_table *table, host_error *error);

/* The table of `path`; NULL: hw/energy.txt. */
host_status energy_open(const char *path, energy_table *table, host_error *error);

/* {"add": pJ, ...}; NULL when memory is out. */
json_t *energy_json(const energy_table *table);

#endif
