#include "memory.h"

#include "layout.h"

memory memory_of(const vodr_machine *machine)
{
    memory m = {
        .machine = machine, .bus_bits = log2_of(machine->mem_bus_bytes), .next_refresh = machine->dram_refresh_cycles};
    for (int i = 0; i < MEMORY_MAX_BANKS; i++)
        m.open_row[i] = -1;
    return m;
}

int64_t memory_open_row(memory *m, int64_t cycle, int64_t address)
{
    const vodr_machine *p = m->machine;
    int64_t wait = 0, row = address / p->dram_row_bytes, bank = row % p->dram_banks;
    if (p->dram_refresh_cycles && cycle >= m->next_refresh) {
        /* The bus was idle over earlier ones; the last of them may not be over. */
        int64_t late = (cycle - m->next_refresh) % p->dram_refresh_cycles;
        m->next_refresh = cycle - late + p->dram_refresh_cycles;
        wait = late < p->dram_trfc_cycles ? p->dram_trfc_cycles - late : 0;
        m->refresh_cycles += (uint64_t)wait;
        for (int i = 0; i < p->dram_banks; i++)
            m->open_row[i] = -1;
    }
    if (m->open_row[bank] != row) {
        int64_t open = (m->open_row[bank] >= 0 ? p->dram_trp_cycles : 0) + p->dram_trcd_cycles;
        m->row_cycles += (uint64_t)open;
        wait += open;
        m->open_row[bank] = row;
    }
    return wait;
}
