/* memory.h - what lies behind the memory bus: a fixed latency, or open-page DRAM (docs/timing.md, section 8). One
 * piece of C for every model of time: whoever arbitrates calls memory_grant() for each transaction, in the order of
 * grants. */
#ifndef VODR_MEMORY_H
#define VODR_MEMORY_H

#include "vodr.h"

enum { MEMORY_MAX_BANKS = 64 };

typedef struct memory {
    const vodr_machine *machine;
    int32_t bus_bits;                   /* logarithm of mem_bus_bytes */
    int64_t free_cycle;                 /* the bus can take a grant from this cycle on */
    int64_t open_row[MEMORY_MAX_BANKS]; /* -1: closed */
    int64_t next_refresh;
    uint64_t busy_cycles;                /* the bus moved data */
    uint64_t row_cycles, refresh_cycles; /* it was held for a row to close and open, for a refresh */
} memory;

memory memory_of(const vodr_machine *machine);

/* Cycles that the bus needs to move so many bytes. */
static inline int64_t memory_beats(const memory *m, int64_t bytes)
{
    return (bytes + m->machine->mem_bus_bytes - 1) >> m->bus_bits;
}

/* DRAM: cycles from a grant until its row is open and no refresh is under way. */
int64_t memory_open_row(memory *m, int64_t cycle, int64_t address);

/* Grants a transaction in `cycle`, at least free_cycle. Returns the cycle in which its last data move. */
static inline int64_t memory_grant(memory *m, int64_t cycle, int64_t address, int64_t bytes, bool write)
{
    const vodr_machine *p = m->machine;
    bool dram = p->memory == VODR_MEMORY_DRAM;
    int64_t beats = memory_beats(m, bytes);
    m->free_cycle = cycle + beats + (dram ? memory_open_row(m, cycle, address) : 0);
    m->busy_cycles += (uint64_t)beats;
    return m->free_cycle - 1 + (write ? 0 : dram ? p->dram_tcas_cycles : p->mem_latency_cycles);
}

#endif
