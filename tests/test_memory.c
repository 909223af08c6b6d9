/* test_memory.c - what lies behind the memory bus, grant by grant, against docs/timing.md: a fixed latency; DRAM's rows
 * and refreshes. Last of all against the rules written down a second time, over random grants. */
#include <string.h>

#include "lib/unit.h"

#include "memory.h"

enum { READ = 0, WRITE = 1 };

/* What one grant must give: the cycle of its last data, the cycle from which the bus is free. */
static void grant(memory *m, int64_t cycle, int64_t address, int64_t bytes, bool write, int64_t last, int64_t free)
{
    assert_true(cycle >= m->free_cycle);
    assert_int_equal(memory_grant(m, cycle, address, bytes, write), last);
    assert_int_equal(m->free_cycle, free);
}

static void fixed_latency(void **state)
{
    (void)state;
    const vodr_machine machine = unit_machine("memory=fixed mem_latency_cycles=50 mem_bus_bytes=16");
    memory m = memory_of(&machine);
    grant(&m, 0, 0, 64, READ, 53, 4);
    grant(&m, 4, 4096, 64, READ, 57, 8); /* reads overlap: the bus is free once the beats are over */
    grant(&m, 8, 0, 64, WRITE, 11, 12);
    grant(&m, 100, 0, 1, READ, 150, 101);
    grant(&m, 101, 0, 17, WRITE, 102, 103);
    assert_int_equal(m.busy_cycles, 4 + 4 + 4 + 1 + 2);
    assert_int_equal(m.row_cycles + m.refresh_cycles, 0);
}

#define DRAM                                                                                                           \
    "memory=dram mem_bus_bytes=16 dram_banks=4 dram_row_bytes=256 dram_trcd_cycles=5 dram_tcas_cycles=7 "              \
    "dram_trp_cycles=11 dram_refresh_cycles=0 dram_trfc_cycles=30 "

static void rows(void **state)
{
    (void)state;
    const vodr_machine machine = unit_machine(DRAM);
    memory m = memory_of(&machine);
    grant(&m, 10, 0, 64, READ, 10 + 5 + 3 + 7, 10 + 5 + 4);  /* closed: tRCD */
    grant(&m, 19, 192, 64, READ, 19 + 3 + 7, 23);            /* the same row: nothing */
    grant(&m, 23, 256, 16, WRITE, 23 + 5, 23 + 5 + 1);       /* the next row lies in another bank, closed too */
    grant(&m, 29, 1024, 16, READ, 29 + 16 + 7, 29 + 16 + 1); /* row 4 of bank 0: row 0 closes, then it opens */
    grant(&m, 46, 256 + 255, 1, READ, 46 + 7, 47);           /* bank 1 kept its row */
    grant(&m, 47, 0, 16, WRITE, 47 + 16, 47 + 17);           /* and bank 0 has another now */
    grant(&m, 64, 240, 64, READ, 64 + 3 + 7, 68);            /* over a row's end: the first address alone counts */
    assert_int_equal(m.row_cycles, 5 + 5 + 16 + 16);
    assert_int_equal(m.busy_cycles, 4 + 4 + 1 + 1 + 1 + 1 + 4);
}

static void refresh(void **state)
{
    (void)state;
    vodr_machine machine = unit_machine(DRAM);
    machine.dram_refresh_cycles = 100;
    memory m = memory_of(&machine);
    grant(&m, 0, 0, 16, WRITE, 5, 6);
    grant(&m, 99, 0, 16, WRITE, 99, 100);               /* the cycle before the refresh */
    grant(&m, 100, 0, 16, WRITE, 100 + 35, 136);        /* all of tRFC, and the row was closed, so no tRP */
    grant(&m, 136, 0, 16, WRITE, 136, 137);             /* open again until the next */
    grant(&m, 229, 0, 16, WRITE, 229 + 1 + 5, 236);     /* the last cycle of the one at 200 */
    grant(&m, 330, 16, 16, WRITE, 330 + 5, 336);        /* just over: no wait, but the row was closed */
    grant(&m, 1010, 0, 16, WRITE, 1010 + 20 + 5, 1036); /* idle over several: only the last can be under way */
    grant(&m, 1099, 0, 16, WRITE, 1099, 1100);          /* and they keep their beat */
    grant(&m, 2099, 0, 16, WRITE, 2099 + 5, 2105);
    grant(&m, 2105, 0, 16, WRITE, 2105 + 25 + 5, 2136); /* the one at 2100 came while the bus moved data */
    assert_int_equal(m.refresh_cycles, 30 + 1 + 20 + 25);
    assert_int_equal(m.row_cycles, 7 * 5);
}

/* ---- the rules again, from what happened since the frame's start ---- */

typedef struct past {
    int64_t cycle, row;
} past;

/* Cycles that a grant waits: for the refresh that began last, and for its row. */
static int64_t wait_of(const vodr_machine *p, const past *before, int count, int64_t cycle, int64_t row)
{
    int64_t begun = p->dram_refresh_cycles ? cycle / p->dram_refresh_cycles * p->dram_refresh_cycles : 0;
    int64_t over = begun + p->dram_trfc_cycles, wait = begun && over > cycle ? over - cycle : 0;
    for (int i = count - 1; i >= 0 && before[i].cycle >= begun; i--)
        if (before[i].row % p->dram_banks == row % p->dram_banks)
            return wait + (before[i].row == row ? 0 : p->dram_trp_cycles + p->dram_trcd_cycles);
    return wait + p->dram_trcd_cycles;
}

static void random_grants(void **state)
{
    (void)state;
    enum { ROUNDS = 300, GRANTS = 400 };
    rng r = {5};
    for (int round = 0; round < ROUNDS; round++) {
        vodr_machine p = unit_machine(DRAM);
        p.dram_banks = 1 << rng_int(&r, 0, 6);
        p.dram_refresh_cycles = rng_one_in(&r, 3) ? 0 : (int32_t)rng_int(&r, 31, 400);
        memory m = memory_of(&p);
        past before[GRANTS];
        int64_t cycle = 0;
        for (int i = 0; i < GRANTS; i++) {
            int64_t address = rng_int(&r, 0, 8191), bytes = rng_int(&r, 1, 100), beats = (bytes + 15) / 16;
            bool write = rng_one_in(&r, 2);
            cycle += rng_one_in(&r, 10) ? rng_int(&r, 0, 900) : rng_int(&r, 0, 3);
            before[i] = (past){cycle, address / p.dram_row_bytes};
            int64_t data = cycle + wait_of(&p, before, i, cycle, before[i].row) + beats;
            grant(&m, cycle, address, bytes, write, data - 1 + (write ? 0 : p.dram_tcas_cycles), data);
            cycle = data;
        }
    }
}

static void what_contradicts_itself(void **state)
{
    (void)state;
    vodr_error error;
    vodr_machine m = unit_machine("dram_refresh_cycles=208 dram_trfc_cycles=208");
    assert_int_equal(vodr_machine_check(&m, &error), VODR_INVALID);
    assert_string_equal(error.text, "dram_trfc_cycles=208 must be below dram_refresh_cycles=208: a refresh would last "
                                    "until the next");
    m = unit_machine("dram_refresh_cycles=209 dram_trfc_cycles=208");
    assert_int_equal(vodr_machine_check(&m, &error), VODR_OK);
    m = unit_machine("dram_refresh_cycles=0 dram_trfc_cycles=65535");
    assert_int_equal(vodr_machine_check(&m, &error), VODR_OK);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fixed_latency),
        cmocka_unit_test(rows),
        cmocka_unit_test(refresh),
        cmocka_unit_test(random_grants),
        cmocka_unit_test(what_contradicts_itself),
    };
    return cmocka_run_group_tests_name("memory", tests, NULL, NULL);
}
