/* test_pairwise.c - frames with all blocks in Verilog over every pair of values of any two parameters that the Verilog
 * has, as registers or at elaboration (docs/cosimulation.md): the same bytes, counters, cycles and stalls as in C. The
 * rows are found greedily, the same on every machine; each needs libraries of its own.
 *   test_pairwise [ROWS]    the first so many rows (2); 0: all */
#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "cosim.h"
#include "outcome.h"

enum { MAX_VALUES = 4, CANDIDATES = 200, PATIENCE = 40, SEED = 5 };

/* A parameter and the values that it takes: its ends where they fit a small machine, and something between. */
typedef struct axis {
    const char *name, *values[MAX_VALUES];
} axis;

static const axis axes[] = {
    {"blend", {"over", "under", "mip"}},
    {"filter", {"nearest", "linear"}},
    {"density_bits", {"8", "12"}},
    {"weight_bits", {"1", "8", "12"}},
    {"guard_bits", {"0", "4", "6"}},
    {"tf_bits", {"8", "16"}},
    {"fb_bits", {"8", "16"}},
    {"traversal", {"whole", "layer", "column", "tile"}},
    {"brick", {"0", "5"}},
    {"double_buffer", {"0", "1"}},
    {"skip_empty", {"0", "1"}},
    {"brick_setup_cycles", {"29", "40"}},
    {"slice_setup_cycles", {"1", "8"}},
    {"texture_latency_cycles", {"3", "20"}},
    {"fragment_fifo", {"1", "32"}},
    {"kill_transparent", {"0", "1"}},
    {"blend_cycles", {"3", "4", "11"}},
    {"cache_bytes", {"1024", "4096"}},
    {"ways", {"1", "4"}},
    {"line_px", {"16x1", "4x4", "2x1"}},
    {"index", {"modulo", "xor"}},
    {"replacement", {"lru", "fifo", "random"}},
    {"write_policy", {"back", "through"}},
    {"clear_on_first_touch", {"0", "1"}},
    {"nonblocking", {"0", "1"}},
    {"nonblocking_fifo", {"1", "64"}},
    {"nonblocking_misses", {"1", "8"}},
    {"write_fifo", {"1", "16"}},
    {"fb_layout", {"linear", "tiled"}},
    {"memory", {"fixed", "dram"}},
    {"mem_latency_cycles", {"3", "50"}},
    {"mem_bus_bytes", {"1", "16", "64"}},
    {"texture_burst_bytes", {"16", "256"}},
    {"dram_banks", {"1", "8"}},
    {"dram_row_bytes", {"64", "2048"}},
    {"dram_trcd_cycles", {"1", "12"}},
    {"dram_tcas_cycles", {"3", "12"}},
    {"dram_trp_cycles", {"1", "12"}},
    {"dram_refresh_cycles", {"0", "300"}},
    {"dram_trfc_cycles", {"1", "50"}},
};

enum { AXES = sizeof axes / sizeof *axes };

typedef struct row {
    uint8_t value[AXES];
} row;

/* Pairs of values that a row had. */
typedef bool pairs[AXES][AXES][MAX_VALUES][MAX_VALUES];

static long wanted_rows = 2;

/* ---- rows ---- */

static void machine_of(const row *r, vodr_machine *m)
{
    vodr_error error;
    assert_int_equal(vodr_machine_named("paper-16", m, &error), VODR_OK);
    for (int i = 0; i < AXES; i++) {
        if (vodr_machine_set(m, axes[i].name, axes[i].values[r->value[i]], &error) != VODR_OK) {
            fail_msg("%s", error.text);
        }
    }
}

static int values_of(int i)
{
    int count = 0;
    while (count < MAX_VALUES && axes[i].values[count]) {
        count++;
    }
    return count;
}

static int mark(pairs seen, const row *r, bool keep)
{
    int fresh = 0;
    for (int i = 0; i < AXES; i++)
        for (int j = i + 1; j < AXES; j++) {
            bool *pair = &seen[i][j][r->value[i]][r->value[j]];
            fresh += !*pair;
            *pair |= keep;
        }
    return fresh;
}

static int left(pairs seen)
{
    int count = 0;
    for (int i = 0; i < AXES; i++)
        for (int j = i + 1; j < AXES; j++)
            for (int a = 0; a < values_of(i); a++)
                for (int b = 0; b < values_of(j); b++) {
                    count += !seen[i][j][a][b];
                }
    return count;
}

/* Of some random rows that can be built, the one with the most pairs that no row had yet. */
static bool next_row(rng *random, pairs seen, row *best)
{
    int most = 0;
    for (int n = 0; n < CANDIDATES * PATIENCE && (n < CANDIDATES || !most); n++) {
        row r;
        vodr_machine m;
        vodr_error error;
        for (int i = 0; i < AXES; i++) {
            r.value[i] = (uint8_t)rng_int(random, 0, values_of(i) - 1);
        }
        machine_of(&r, &m);
        int fresh = vodr_machine_check(&m, &error) == VODR_OK ? mark(seen, &r, false) : 0;
        if (fresh > most) {
            most = fresh;
            *best = r;
        }
    }
    return most > 0;
}

/* ---- frames ---- */

/* The case's view on voxels and colours of the machine's widths. */
static void fill_scene(test_case *c, const vodr_machine *m, uint16_t *voxels)
{
    size_t count = (size_t)1 << m->density_bits, size = 1;
    for (int i = 0; i < 3; i++) {
        size *= (size_t)c->input.dims_vox[i];
    }
    for (size_t i = 0; i < size; i++) {
        voxels[i] = (uint16_t)rng_int(&c->random, 0, (int64_t)count - 1);
    }
    c->input.voxel_bytes = 2;
    c->input.voxels = voxels;
    c->input.map = NULL;
    c->entries = realloc(c->entries, count * sizeof *c->entries);
    assert_non_null(c->entries);
    for (size_t i = 0; i < count; i++) {
        uint16_t a = i < count / 4 ? 0 : (uint16_t)rng_int(&c->random, 0, m->tf_bits == 16 ? 65535 : 255);
        c->entries[i] = (vodr_rgba){a / 2, a, (uint16_t)rng_int(&c->random, 0, a), a};
    }
    c->table = (vodr_table){c->entries, count};
}

static void draw_row(const row *r, uint64_t seed)
{
    enum { MOST_VOXELS = 70 * 70 * 70 };
    test_case c;
    vodr_machine m;
    outcome in_c, in_verilog = {0};
    cosim_options options = {.root = VODR_ROOT, .build = VODR_BUILD};
    machine_of(r, &m);
    uint16_t *voxels = malloc(MOST_VOXELS * sizeof *voxels);
    assert_non_null(voxels);
    do {
        assert_true(case_make(seed++, &c));
        fill_scene(&c, &m, voxels);
        outcome_draw(&c, &m, &(vodr_options){.threads = 1, .cycles = true}, &in_c);
        bool plain = in_c.status == VODR_OK && in_c.counters.fragments > 300 && in_c.counters.cycles.total < 300000;
        if (plain) {
            break;
        }
        outcome_free(&in_c);
        case_free(&c);
    } while (true);
    for (int b = 0; b < VODR_BLOCK_COUNT; b++) {
        options.replaced[b] = true;
    }
    rtl_status status = cosim_render(&m, &c.input, &c.table, &c.view, &options, &in_verilog.frame, &in_verilog.counters,
                                     &in_verilog.error);
    if (status != RTL_OK) {
        case_print(stderr, &c, &m);
        fail_msg("%s", in_verilog.error.text);
    }
    assert_true(outcome_same(stderr, &in_c, &in_verilog));
    outcome_free(&in_c);
    outcome_free(&in_verilog);
    case_free(&c);
    free(voxels);
}

static void test_pairs(void **state)
{
    (void)state;
    static pairs seen;
    rng random = {SEED};
    row r;
    int all = left(seen);
    long rows = 0;
    for (; (wanted_rows == 0 || rows < wanted_rows) && next_row(&random, seen, &r); rows++) {
        mark(seen, &r, true);
        draw_row(&r, (uint64_t)rows * 100 + 1);
    }
    printf("%ld frames: %d of %d pairs\n", rows, all - left(seen), all);
    assert_true(wanted_rows != 0 || left(seen) == 0);
}

int main(int argc, char **argv)
{
    char *end = NULL;
    if (argc > 1) {
        wanted_rows = strtol(argv[1], &end, 10);
    }
    if (argc > 2 || (end && (*end || end == argv[1])) || wanted_rows < 0) {
        fprintf(stderr, "usage: test_pairwise [ROWS], 0 for all\n");
        return 2;
    }
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_pairs)};
    return cmocka_run_group_tests_name("pairwise", tests, NULL, NULL) == 0 ? 0 : 1;
}
