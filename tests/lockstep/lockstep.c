/* lockstep.c - runs the lock-step benches.
 *   lockstep [--transactions N] [--seed S] [--episode E] [BLOCK]...    20,000 transactions a machine of every block,
 * from seed 1; E, 1000, of them are of one seed lockstep lerp | blend                                arithmetic, of all
 * operands; run without a name, too
 *
 * A bench that differs prints its seed, and `lockstep --transactions N --seed S BLOCK` draws it again first. */
#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "bench.h"
#include "exhaustive.h"
#include "lockstep.h"
#include "modules.h"

enum { LARGE_ONE_IN = 4 };

static const struct CMUnitTest exhaustive[] = {{.name = "lerp", .test_func = lockstep_lerp},
                                               {.name = "blend", .test_func = lockstep_blend}};

enum { EXHAUSTIVE = sizeof exhaustive / sizeof *exhaustive };

static uint64_t transactions = 20000, first_seed = 1, episode_transactions = 1000;

/* ---- one episode ---- */

/* A block in C with its traffic, and the block in Verilog beside it. */
typedef struct episode {
    bench bench;
    lockstep pair;
} episode;

/* rtl/modules.c says which inputs a module has beside its ports. */
static void check_inputs(const rtl_block *block)
{
    const rtl_library *l = &block->library;
    const rtl_module *m = rtl_module_of(block->block);
    const char *const others[] = {"clk", "rst", "memory_read_data"};
    int32_t known = m->table ? 3 : 0, inputs = 0;
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        known += rtl_library_port(l, others[i]) != NULL;
    }
    const block_signals *s = signals_of(block->block);
    for (int32_t i = 0; i < s->count; i++) {
        known += s->ports[i].output ? 0 : s->ports[i].count;
    }
    for (const module_register *r = m->registers; r->name; r++) {
        const vodr_rtl_port *p = rtl_library_port(l, r->name);
        assert_true(p && !p->output && p->width_bits == r->width_bits);
        known++;
    }
    for (int32_t i = 0; i < l->model.port_count; i++) {
        inputs += !l->model.ports[i].output;
    }
    assert_int_equal(inputs, known);
}

/* The bench stops at the first difference. */
static void begin(const block_bench *what, const char *settings, bool large, uint64_t seed, rtl_found *found,
                  episode *e)
{
    vodr_error error;
    vodr_machine machine;
    const rtl_source source = {.root = VODR_ROOT, .build = VODR_BUILD, .seed = (uint32_t)seed, .found = found};
    bench *b = &e->bench;
    assert_int_equal(vodr_machine_named("paper-16", &machine, &error), VODR_OK);
    vodr_status (*const open)(bench *, const block_bench *, const vodr_machine *, uint64_t, vodr_error *) =
        large ? bench_open_large : bench_open;
    if (bench_set(&machine, settings, &error) != VODR_OK || open(b, what, &machine, seed, &error) != VODR_OK) {
        fail_msg("%s", error.text);
    }
    if (lockstep_open(&e->pair, &source, what->block, &b->setup, b->faces, b->reset, &error) != RTL_OK) {
        fail_msg("%s", error.text);
    }
    check_inputs(&e->pair.rtl);
    b->differs = &e->pair.first.found;
}

static void end(episode *e)
{
    lockstep_close(&e->pair, e->bench.faces);
    bench_close(&e->bench);
}

/* Up to `count` transactions; *count is then how many there were. */
static bool run_episode(const block_bench *what, const char *settings, bool large, uint64_t seed, rtl_found *found,
                        uint64_t *count, uint64_t *cycles)
{
    episode e;
    begin(what, settings, large, seed, found, &e);
    what->traffic(&e.bench, *count);
    const difference d = e.pair.first;
    uint64_t cycle = e.bench.cycles;
    *cycles += cycle;
    *count -= e.bench.left;
    end(&e);
    if (!d.found) {
        return true;
    }
    fprintf(stderr,
            "%s, machine paper-16 %s: cycle %" PRIu64 ", port %s: expected %s, got %s; again: --seed %" PRIu64 " %s\n",
            signals_of(what->block)->name, settings, cycle, d.field->name, d.expected, d.got, seed,
            signals_of(what->block)->name);
    return false;
}

/* ---- tests ---- */

static void test_block(void **state)
{
    const block_bench *what = *state;
    rtl_found found = {.asked = ""};
    bool good = true;
    for (const char *const *m = what->machines; *m; m++) {
        uint64_t cycles = 0, done = 0;
        for (uint64_t seed = first_seed; good && done < transactions; seed++) {
            uint64_t left = transactions - done, count = left < episode_transactions ? left : episode_transactions;
            bool large = what->large && seed % LARGE_ONE_IN == 2;
            good = run_episode(what, *m, large, seed, &found, &count, &cycles);
            done += count;
        }
        printf("%s, paper-16 %s: %" PRIu64 " transactions in %" PRIu64 " cycles\n", signals_of(what->block)->name, *m,
               done, cycles);
    }
    assert_true(good);
}

static bool named(const char *name, int argc, char **argv, int first)
{
    bool found = first >= argc;
    for (int i = first; i < argc; i++) {
        found |= strcmp(argv[i], name) == 0;
    }
    return found;
}

int main(int argc, char **argv)
{
    struct CMUnitTest tests[VODR_BLOCK_COUNT + EXHAUSTIVE];
    size_t count = 0;
    int first = 1;
    for (; first + 1 < argc && strncmp(argv[first], "--", 2) == 0; first += 2) {
        char *end;
        uint64_t number = strtoull(argv[first + 1], &end, 10);
        uint64_t *option = strcmp(argv[first], "--transactions") == 0 ? &transactions
                           : strcmp(argv[first], "--seed") == 0       ? &first_seed
                           : strcmp(argv[first], "--episode") == 0    ? &episode_transactions
                                                                      : NULL;
        if (!option || *end || end == argv[first + 1]) {
            fprintf(stderr, "usage: lockstep [--transactions N] [--seed S] [--episode E] [BLOCK]...\n");
            return 2;
        }
        *option = number;
    }
    for (int i = 0; i < VODR_BLOCK_COUNT; i++) {
        const block_bench *what = bench_of((vodr_block)i);
        const char *name = signals_of(what->block)->name;
        if (named(name, argc, argv, first)) {
            tests[count++] = (struct CMUnitTest){.name = name, .test_func = test_block, .initial_state = (void *)what};
        }
    }
    for (size_t i = 0; i < EXHAUSTIVE; i++) {
        if (named(exhaustive[i].name, argc, argv, first)) {
            tests[count++] = exhaustive[i];
        }
    }
    if (!count) {
        fprintf(stderr, "lockstep: there is no such block\n");
        return 2;
    }
    return _cmocka_run_group_tests("lockstep", tests, count, NULL, NULL) == 0 ? 0 : 1;
}
