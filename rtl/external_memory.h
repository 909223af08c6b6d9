/* external_memory.h - the memory behind the frame buffer's Verilog (docs/cosimulation.md): a beat a cycle, read beats
 * answered as many cycles later as the memory's latency leaves. When beats move is the frame buffer's matter. */
#ifndef VODR_EXTERNAL_MEMORY_H
#define VODR_EXTERNAL_MEMORY_H

#include "storage.h"

/* What the frame buffer asks for in a cycle. */
typedef struct memory_command {
    bool read, write;
    int64_t address;
    int32_t write_bytes; /* of the beat that mean something */
    const uint8_t *write_data;
} memory_command;

typedef struct external_memory {
    storage *storage;
    int32_t beat_bytes, delay;
    int64_t now;
    uint8_t *answers; /* a ring of `delay` beats, by the cycle in which they are due */
    uint8_t *brick;   /* the one that was read last, */
    int64_t held;     /* and its number; -1: none */
} external_memory;

/* Over what lies in memory, which outlives it. False when there is no memory. Finish in either case. */
bool external_memory_start(external_memory *m, const vodr_machine *machine, storage *behind);

/* The beat that is due in this cycle: mem_bus_bytes, until the next call. */
const uint8_t *external_memory_answer(const external_memory *m);

/* Takes what is asked for in this cycle, and goes on to the next. */
void external_memory_clock(external_memory *m, const memory_command *command);

void external_memory_finish(external_memory *m);

#endif
