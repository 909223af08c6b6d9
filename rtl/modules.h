/* modules.h - what our Verilog modules have beside clk, rst and the ports of signals.h (docs/cosimulation.md):
 * registers and parameters by name (registers.h), and a table that is written while rst is up. For those who have no
 * module to ask. */
#ifndef VODR_MODULES_H
#define VODR_MODULES_H

#include "vodr.h"

typedef struct module_register {
    const char *name;
    int32_t width_bits;
} module_register;

/* Ends are NULL. */
typedef struct rtl_module {
    const char *const *parameters;
    const module_register *registers;
    const char *table; /* of its inputs TABLE_write, TABLE_address, TABLE_data; NULL: it has none */
} rtl_module;

const rtl_module *rtl_module_of(vodr_block block);

/* Bits of an entry of its table. */
int32_t rtl_table_bits(vodr_block block, const vodr_machine *machine);

#endif
