/* test_cycles.c - cycles from recurrences against the machine with every block clocked: the same total, the same busy,
 * stalled and idle of each block, the same stalls of each cause, and the same frame and counters, on random machines.
 * The recurrences are of one pipeline; several are held against them where they cannot meet at the bus.
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
static const char *const stall_names[VODR_STALL_COUNT] = {"divider",  "slice",        "texture_load", "fragment_fifo",
                                                          "cache",    "hazard",       "write_back",   "fill",
                                                          "dram_row", "dram_refresh", "texture_fetch"};

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
        door + s[VODR_STALL_TEXTURE_FETCH],
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

static void random_machine(test_case *c, vodr_machine *m)
{
    *m = c->machine;
    case_organise(c, m);
    m->traversal = (int32_t)rng_int(&c->random, VODR_TRAVERSAL_WHOLE, VODR_TRAVERSAL_TILE);
    case_time(c, m);
}

static bool tell(FILE *file, const test_case *c, const vodr_machine *m, const outcome *o)
{
    fprintf(file, "%s%s\n", o->status == VODR_OK ? "" : "  not drawn: ", o->error.text);
    case_print(file, c, m);
    return false;
}

static bool agree(test_case *c, FILE *file)
{
    static const vodr_options programs[] = {
        {.threads = 1, .path = VODR_PATH_BLOCKS, .cycles = true},
        {.threads = 1, .path = VODR_PATH_FAST, .cycles = true},
        {.threads = 2, .path = VODR_PATH_FAST, .cycles = true},
    };
    const vodr_options truth = {.threads = 1, .path = VODR_PATH_CLOCKED, .cycles = true};
    vodr_machine machine;
    random_machine(c, &machine);
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
    good = good || tell(file, c, &machine, &clocked);
    outcome_free(&clocked);
    return good;
}

static void test_random_machines(void **state)
{
    assert_int_equal(suite_run(*state, agree), 0);
}

/* ---- several pipelines ---- */

/* Frame and counters of several pipelines, with cycles and without. */
static bool several_agree(test_case *c, FILE *file)
{
    static const vodr_options programs[] = {
        {.threads = 1, .path = VODR_PATH_BLOCKS},
        {.threads = 1, .path = VODR_PATH_FAST},
        {.threads = 2, .path = VODR_PATH_FAST, .cycles = true},
    };
    const vodr_options truth = {.threads = 1, .path = VODR_PATH_CLOCKED, .cycles = true};
    vodr_machine machine;
    random_machine(c, &machine);
    machine.pipelines = (int32_t)rng_int(&c->random, 2, 5);
    outcome clocked;
    outcome_draw(c, &machine, &truth, &clocked);
    bool good = clocked.status == VODR_OK && add_up(file, &machine, &clocked.counters.cycles);
    for (size_t i = 0; good && i < sizeof programs / sizeof *programs; i++) {
        outcome other;
        outcome_draw(c, &machine, &programs[i], &other);
        good = !programs[i].cycles || same_cycles(file, &clocked.counters.cycles, &other.counters.cycles);
        good &= outcome_same_frame(file, &clocked, &other);
        good &= outcome_same_counters(file, &clocked, &other);
        outcome_free(&other);
    }
    good = good || tell(file, c, &machine, &clocked);
    outcome_free(&clocked);
    return good;
}

static void test_several_pipelines(void **state)
{
    assert_int_equal(suite_run(*state, several_agree), 0);
}

/* A frame of at most 32 rows is the last pipeline's alone, which takes the cycles that it takes without the others. */
static bool idle_ones_do_nothing(test_case *c, FILE *file)
{
    const vodr_options options = {.threads = 1, .cycles = true};
    vodr_machine machine;
    random_machine(c, &machine);
    machine.traversal = (int32_t)rng_int(&c->random, VODR_TRAVERSAL_WHOLE, VODR_TRAVERSAL_COLUMN);
    c->view.height_px = c->view.height_px < 32 ? c->view.height_px : 32;
    outcome alone, among;
    outcome_draw(c, &machine, &options, &alone);
    machine.pipelines = (int32_t)rng_int(&c->random, 2, 5);
    outcome_draw(c, &machine, &options, &among);
    bool good = alone.status == VODR_OK && same_cycles(file, &among.counters.cycles, &alone.counters.cycles);
    good = good && outcome_same_counters(file, &among, &alone) && outcome_same_frame(file, &among, &alone);
    good = good || tell(file, c, &machine, &among);
    outcome_free(&alone);
    outcome_free(&among);
    return good;
}

static void test_idle_pipelines(void **state)
{
    assert_int_equal(suite_run(*state, idle_ones_do_nothing), 0);
}

/* The rows of a frame from y0_px up to y1_px as a frame of their own. */
static vodr_view band_of(const vodr_view *v, int32_t y0_px, int32_t y1_px)
{
    vodr_view band = *v;
    band.height_px = y1_px - y0_px;
    for (int i = 0; i < 3; i++) {
        band.base[i] += y0_px * v->step_v[i];
    }
    return band;
}

/* Where no pipeline needs the bus, undivided and with nothing to be seen, the frame takes the cycles of the band that
 * takes the most, and the accounts are those of the first of these. */
static bool bands_are_frames(test_case *c, FILE *file)
{
    const vodr_options options = {.threads = 1, .cycles = true};
    const vodr_view view = c->view;
    vodr_machine machine;
    random_machine(c, &machine);
    machine.traversal = VODR_TRAVERSAL_WHOLE;
    machine.kill_transparent = 1;
    machine.skip_empty = 0;
    for (size_t i = 0; i < c->table.count; i++) {
        c->entries[i] = (vodr_rgba){0};
    }
    outcome whole, band;
    const int32_t pipelines = (int32_t)rng_int(&c->random, 2, 4), rows = (view.height_px + 31) / 32;
    machine.pipelines = pipelines;
    outcome_draw(c, &machine, &options, &whole);
    machine.pipelines = 1;
    vodr_cycles longest = {0};
    uint64_t fragments = 0;
    bool good = whole.status == VODR_OK;
    for (int32_t i = 0; good && i < pipelines; i++) {
        int32_t y0_px = i * rows / pipelines * 32, end_px = (i + 1) * rows / pipelines * 32;
        int32_t y1_px = end_px < view.height_px ? end_px : view.height_px;
        if (y0_px == y1_px) {
            continue;
        }
        c->view = band_of(&view, y0_px, y1_px);
        outcome_draw(c, &machine, &options, &band);
        good = band.status == VODR_OK;
        fragments += band.counters.fragments;
        if (band.counters.cycles.total > longest.total) {
            longest = band.counters.cycles;
        }
        outcome_free(&band);
    }
    c->view = view;
    good = good && same_cycles(file, &whole.counters.cycles, &longest) &&
           same(file, "fragments", "of all bands", whole.counters.fragments, fragments);
    good = good || tell(file, c, &machine, &whole);
    outcome_free(&whole);
    return good;
}

/* In perspective the divider reckons its bounds from the middle of the frame, which a band has elsewhere. */
static bool parallel_bands_are_frames(test_case *c, FILE *file)
{
    return c->view.perspective || bands_are_frames(c, file);
}

static void test_bands(void **state)
{
    assert_int_equal(suite_run(*state, parallel_bands_are_frames), 0);
}

int main(int argc, char **argv)
{
    suite options;
    if (!suite_options(argc, argv, &options)) {
        return 2;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate(test_random_machines, &options),
        cmocka_unit_test_prestate(test_several_pipelines, &options),
        cmocka_unit_test_prestate(test_idle_pipelines, &options),
        cmocka_unit_test_prestate(test_bands, &options),
    };
    return cmocka_run_group_tests_name("cycles", tests, NULL, NULL) == 0 ? 0 : 1;
}
