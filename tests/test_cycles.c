/* test_cycles.c - cycles from recurrences against the machine with every block clocked: the same total, the same busy,
 * stalled and idle of each block, the same stalls of each cause, and the same frame and counters, on random machines.
 * Arguments: [CASES [FIRST_SEED]]; a failing case is drawn again by `test_cycles 1 SEED`. */
#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "outcome.h"
#include "suite.h"

static const char *const block_names[VODR_BLOCK_COUNT] = {
    "volume_divider", "slice_generator", "rasterizer", "texture_unit", "alpha_blender", "pixel_cache", "frame_buffer"};
static const char *const stall_names[VODR_STALL_COUNT] = {"divider",  "slice",       "texture_load", "fragment_fifo",
                                                          "cache",    "hazard",      "write_back",   "fill",
                                                          "dram_row", "dram_refresh"};

/* Whether a figure is the same; else it is told. */
static bool same(FILE *file, const char *of, const char *what, uint64_t clocked, uint64_t other)
{
    if (clocked != other) {
        fprintf(file, "  %s %s: clocked %" PRIu64 ", recurrences %" PRIu64 "\n", of, what, clocked, other);
    }
    return clocked == other;
}

static bool same_cycles(FILE *file, const vodr_cycles *a, const vodr_cycles *b)
{
    bool good = same(file, "cycles", "total", a->total, b->total);
    for (int i = 0; i < VODR_BLOCK_COUNT; i++) {
        good &= same(file, block_names[i], "busy", a->blocks[i].busy, b->blocks[i].busy);
        good &= same(file, block_names[i], "stalled", a->blocks[i].stalled, b->blocks[i].stalled);
        good &= same(file, block_names[i], "idle", a->blocks[i].idle, b->blocks[i].idle);
    }
    for (int i = 0; i < VODR_STALL_COUNT; i++) {
        good &= same(file, "stalls", stall_names[i], a->stalls[i], b->stalls[i]);
    }
    return good;
}

/* Every block's cycles add up to the total, and each stall is in the block that waits. */
static bool add_up(FILE *file, const vodr_machine *m, const vodr_cycles *c)
{
    const uint64_t *s = c->stalls, hazards = s[VODR_STALL_HAZARD];
    const uint64_t door = s[VODR_STALL_TEXTURE_LOAD] + s[VODR_STALL_FRAGMENT_FIFO];
    const uint64_t stalled[VODR_BLOCK_COUNT] = {
        s[VODR_STALL_DIVIDER],
        s[VODR_STALL_SLICE],
        door,
        door,
        s[VODR_STALL_CACHE] + (m->nonblocking ? 0 : hazards),
        s[VODR_STALL_WRITE_BACK] + s[VODR_STALL_FILL] + (m->nonblocking ? hazards : 0),
        s[VODR_STALL_DRAM_ROW] + s[VODR_STALL_DRAM_REFRESH],
    };
    bool good = true;
    for (int i = 0; i < VODR_BLOCK_COUNT; i++) {
        const vodr_block_cycles *b = &c->blocks[i];
        good &= same(file, block_names[i], "stalled for its causes", b->stalled, stalled[i]);
        good &= same(file, block_names[i], "in sum", b->busy + b->stalled + b->idle, c->total);
        good &= same(file, block_names[i], "within the total", b->busy <= c->total && b->idle <= c->total, true);
    }
    return good;
}

static bool agree(test_case *c, FILE *file)
{
    static const vodr_options programs[] = {
        {.threads = 1, .path = VODR_PATH_BLOCKS, .cycles = true},
        {.threads = 1, .path = VODR_PATH_FAST, .cycles = true},
        {.threads = 2, .path = VODR_PATH_FAST, .cycles = true},
    };
    const vodr_options truth = {.threads = 1, .path = VODR_PATH_CLOCKED, .cycles = true};
    vodr_machine machine = c->machine;
    case_organise(c, &machine);
    machine.traversal = (int32_t)rng_int(&c->random, VODR_TRAVERSAL_WHOLE, VODR_TRAVERSAL_TILE);
    case_time(c, &machine);
    outcome clocked;
    outcome_draw(c, &machine, &truth, &clocked);
    bool good = clocked.status == VODR_OK && add_up(file, &machine, &clocked.counters.cycles);
    for (size_t i = 0; good && i < sizeof programs / sizeof *programs; i++) {
        outcome other;
        outcome_draw(c, &machine, &programs[i], &other);
        good = same_cycles(file, &clocked.counters.cycles, &other.counters.cycles);
        good &= outcome_same_frame(file, &clocked, &other);
        good &= outcome_same_counters(file, &clocked, &other);
        outcome_free(&other);
        if (!good) {
            fprintf(file, "  threads %d, path %d\n", programs[i].threads, programs[i].path);
        }
    }
    if (!good) {
        fprintf(file, "%s%s\n", clocked.status == VODR_OK ? "" : "  not drawn: ", clocked.error.text);
        case_print(file, c, &machine);
    }
    outcome_free(&clocked);
    return good;
}

static void test_random_machines(void **state)
{
    assert_int_equal(suite_run(*state, agree), 0);
}

int main(int argc, char **argv)
{
    suite options;
    if (!suite_options(argc, argv, &options)) {
        return 2;
    }
    const struct CMUnitTest tests[] = {cmocka_unit_test_prestate(test_random_machines, &options)};
    return cmocka_run_group_tests_name("cycles", tests, NULL, NULL) == 0 ? 0 : 1;
}
