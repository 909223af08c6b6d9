/* registers.h - what a Verilog block is told beside its ports, by name (docs/cosimulation.md):
 * - registers: inputs that hold still for a frame. Those of hw/registers.txt, the machine's parameters by their own
 *   names, and what is derived from both once a frame;
 * - parameters of its module, in capitals: what widths and depths of memories follow from;
 * - the texture unit's and the divider's table, written while rst is up. */
#ifndef VODR_REGISTERS_H
#define VODR_REGISTERS_H

#include "clocked_blocks.h"

enum { RTL_TABLE_BYTES = 9 };

/* How many entries a frame gives the table of a block that has one (modules.h). */
int64_t rtl_table_entries(vodr_block block, const block_setup *setup);

/* An entry, lowest byte first: a colour, and above it whether it is dead; or whether a brick is left out. */
void rtl_table_entry(vodr_block block, const block_setup *setup, int64_t i, uint8_t entry[RTL_TABLE_BYTES]);

/* Everything a frame's registers are taken from. */
typedef struct rtl_registers rtl_registers;

/* Of a machine that was set up; NULL when there is no memory. To be freed by free(); outlives the setup. */
rtl_registers *rtl_registers_of(const block_setup *setup);

/* The machine. */
const vodr_machine *rtl_machine(const rtl_registers *r);

/* A register's value, negative ones in two's complement of 64 bits; false when there is no register of this name. */
bool rtl_register(const rtl_registers *r, const char *name, uint64_t *value);

/* A parameter's value; false when there is none of this name. */
bool rtl_parameter(const rtl_registers *r, const char *name, int64_t *value);

/* The same for no frame in particular: of memories whose size a frame decides, the smallest that is built. */
bool rtl_machine_parameter(const vodr_machine *machine, const char *name, int64_t *value);

#endif
