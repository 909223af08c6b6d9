#include "external_memory.h"

#include <stdlib.h>
#include <string.h>

/* Of a read's latency, cycles that the frame buffer's own registers take. */
enum { REGISTERS_CYCLES = 2 };

bool external_memory_start(external_memory *m, const vodr_machine *machine, storage *behind)
{
    int32_t latency = machine->memory == VODR_MEMORY_DRAM ? machine->dram_tcas_cycles : machine->mem_latency_cycles;
    *m = (external_memory){
        .storage = behind, .beat_bytes = machine->mem_bus_bytes, .delay = latency - REGISTERS_CYCLES, .held = -1};
    if (m->delay < 1)
        m->delay = 1;
    m->answers = calloc((size_t)m->delay, (size_t)m->beat_bytes);
    m->brick = calloc(1, (size_t)(behind->brick_room_bytes + m->beat_bytes));
    return m->answers && m->brick;
}

static uint8_t *due(const external_memory *m)
{
    return m->answers + m->now % m->delay * m->beat_bytes;
}

const uint8_t *external_memory_answer(const external_memory *m)
{
    return due(m);
}

static void read_beat(external_memory *m, int64_t address, uint8_t *data)
{
    const storage *s = m->storage;
    if (address < s->texture_base) {
        int64_t left = s->texture_base - address;
        storage_read(s, address, left < m->beat_bytes ? left : m->beat_bytes, data);
        return;
    }
    int64_t brick = (address - s->texture_base) / s->brick_room_bytes,
            first = s->texture_base + brick * s->brick_room_bytes;
    if (brick != m->held)
        storage_read(s, first, s->brick_room_bytes, m->brick);
    m->held = brick;
    memcpy(data, m->brick + (address - first), (size_t)m->beat_bytes);
}

void external_memory_clock(external_memory *m, const memory_command *command)
{
    if (command->read)
        read_beat(m, command->address, due(m));
    if (command->write)
        storage_write(m->storage, command->address, command->write_bytes, command->write_data);
    m->now++;
}

void external_memory_finish(external_memory *m)
{
    free(m->answers);
    free(m->brick);
    *m = (external_memory){0};
}
