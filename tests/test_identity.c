/* test_identity.c - division changes nothing: one case's frame is the same to the byte under every organisation, and
 * the counters keep what must hold between them. Arguments: [CASES [FIRST_SEED]]; a failing case is drawn again by
 * `test_identity 1 SEED`. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "outcome.h"
#include "suite.h"

enum { ORGANISATIONS = 8 };

/* Tells a rule that does not hold. */
static bool holds(FILE *file, bool rule, const char *text)
{
    if (!rule) {
        fprintf(file, "  does not hold: %s\n", text);
    }
    return rule;
}
#define HOLDS(rule) holds(file, rule, #rule)

static bool cache_counters_hold(FILE *file, const vodr_machine *m, const vodr_counters *n)
{
    uint64_t pixel_bytes = (uint64_t)m->fb_bits / 2;
    uint64_t line_bytes = (uint64_t)(m->line_px.width * m->line_px.height) * pixel_bytes;
    uint64_t lines = (uint64_t)m->cache_bytes / line_bytes * (uint64_t)m->pipelines;
    uint64_t accesses = n->fragments - n->killed_fragments;
    uint64_t written = accesses - n->terminated_fragments;
    bool good = HOLDS(n->hits + n->misses == accesses);
    good &= HOLDS(n->evictions <= n->misses && n->misses - n->evictions <= lines);
    good &= HOLDS(n->writebacks <= n->misses);
    good &= HOLDS(n->fb_read_bytes <= n->misses * line_bytes);
    good &= HOLDS(m->clear_on_first_touch || n->fb_read_bytes == n->misses * line_bytes);
    good &= HOLDS(m->kill_transparent || n->killed_fragments == 0);
    good &= HOLDS(m->blend == VODR_BLEND_UNDER || n->terminated_fragments == 0);
    if (m->write_policy == VODR_WRITE_POLICY_THROUGH) {
        good &= HOLDS(n->writebacks == 0);
        good &= HOLDS(m->blend == VODR_BLEND_MIP ? n->fb_write_bytes <= written * pixel_bytes
                                                 : n->fb_write_bytes == written * pixel_bytes);
    } else {
        good &= HOLDS(n->fb_write_bytes == n->writebacks * line_bytes);
        good &= HOLDS(m->blend != VODR_BLEND_OVER || n->writebacks == n->misses);
    }
    return good;
}

static bool brick_counters_hold(FILE *file, const vodr_machine *m, const vodr_counters *n)
{
    bool whole = m->traversal == VODR_TRAVERSAL_WHOLE;
    bool tile = m->traversal == VODR_TRAVERSAL_TILE;
    bool good = HOLDS(n->bricks <= n->brick_visits && n->brick_visits <= n->brick_slices);
    good &= HOLDS(n->brick_slices <= n->fragments);
    good &= HOLDS((n->fragments > 0) == (n->bricks > 0));
    good &= HOLDS(tile || m->pipelines > 1 || n->bricks == n->brick_visits);
    good &= HOLDS(tile || n->brick_visits <= n->bricks * (uint64_t)m->pipelines);
    good &= HOLDS(!whole || n->bricks + n->skipped_bricks <= 1);
    good &= HOLDS(!(whole || tile) || n->brick_overflows == 0);
    good &= HOLDS(n->brick_overflows <= n->brick_visits);
    good &= HOLDS(m->skip_empty || n->skipped_bricks == 0);
    good &= HOLDS(whole ? n->brick_vox == 0 : n->brick_vox >= 1);
    return good;
}

/* What two organisations of one picture must agree on. */
static bool counters_agree(FILE *file, const vodr_machine *ma, const vodr_counters *a, const vodr_machine *mb,
                           const vodr_counters *b)
{
    bool good = HOLDS(ma->skip_empty || a->fragments >= b->fragments);
    good &= HOLDS(mb->skip_empty || b->fragments >= a->fragments);
    if (ma->kill_transparent && mb->kill_transparent) {
        /* A brick that is skipped has none but transparent fragments. */
        good &= HOLDS(a->fragments - a->killed_fragments == b->fragments - b->killed_fragments);
        good &= HOLDS(a->terminated_fragments == b->terminated_fragments);
    } else if (!ma->skip_empty && !mb->skip_empty && !ma->kill_transparent && !mb->kill_transparent) {
        good &= HOLDS(a->terminated_fragments == b->terminated_fragments);
    }
    return good;
}

/* Draws one organisation by every program there is, with one thread and two; *o receives the outcome. */
static bool draw_steadily(FILE *file, const test_case *c, const vodr_machine *machine, outcome *o)
{
    static const vodr_options programs[] = {
        {.threads = 1, .path = VODR_PATH_FAST},
        {.threads = 2, .path = VODR_PATH_FAST},
        {.threads = 1, .path = VODR_PATH_FAST, .simd = VODR_SIMD_PORTABLE},
        {.threads = 2, .path = VODR_PATH_FAST, .simd = VODR_SIMD_AVX2},
        {.threads = 2, .path = VODR_PATH_BLOCKS},
    };
    const vodr_options blocks = {.threads = 1, .path = VODR_PATH_BLOCKS};
    outcome_draw(c, machine, &blocks, o);
    bool good = HOLDS(o->status == VODR_OK);
    for (size_t i = 0; good && i < sizeof programs / sizeof *programs; i++) {
        outcome other;
        outcome_draw(c, machine, &programs[i], &other);
        good &= outcome_same_frame(file, o, &other);
        good &= outcome_same_counters(file, o, &other);
        outcome_free(&other);
        if (!good) {
            fprintf(file, "  threads %d, path %d, simd %d\n", programs[i].threads, programs[i].path, programs[i].simd);
        }
    }
    good = good && cache_counters_hold(file, machine, &o->counters) && brick_counters_hold(file, machine, &o->counters);
    if (!good) {
        case_print(file, c, machine);
    }
    return good;
}

static bool division_changes_nothing(test_case *c, FILE *file)
{
    vodr_machine machines[ORGANISATIONS];
    outcome outcomes[ORGANISATIONS] = {0};
    bool good = true;
    for (int i = 0; good && i < ORGANISATIONS; i++) {
        machines[i] = c->machine;
        machines[i].traversal = i % 4;
        case_organise(c, &machines[i]);
        case_multiply(c, &machines[i]);
        good = draw_steadily(file, c, &machines[i], &outcomes[i]);
        for (int j = 0; good && j < i; j++) {
            good = outcome_same_frame(file, &outcomes[i], &outcomes[j]);
            good &= counters_agree(file, &machines[i], &outcomes[i].counters, &machines[j], &outcomes[j].counters);
            if (!good) {
                case_print(file, c, &machines[i]);
                case_print(file, c, &machines[j]);
            }
        }
    }
    for (int i = 0; i < ORGANISATIONS; i++) {
        outcome_free(&outcomes[i]);
    }
    return good;
}

/* Tile order with a cache that holds just one tile of 32x32 pixels misses once a line; so does a cache for all lines.
 */
static bool tile_order_is_compulsory(test_case *c, FILE *file)
{
    vodr_machine tile = c->machine;
    tile.traversal = VODR_TRAVERSAL_TILE;
    tile.cache_bytes = 32 * 32 * (c->machine.fb_bits / 2);
    tile.kill_transparent = (int32_t)rng_int(&c->random, 0, 1);
    tile.replacement = (int32_t)rng_int(&c->random, VODR_REPLACEMENT_LRU, VODR_REPLACEMENT_FIFO);
    case_multiply(c, &tile);
    vodr_machine ample = tile;
    ample.traversal = VODR_TRAVERSAL_WHOLE;
    ample.cache_bytes = 1 << 20;
    const vodr_options options = {.threads = 1};
    outcome a, b;
    outcome_draw(c, &tile, &options, &a);
    outcome_draw(c, &ample, &options, &b);
    bool good = HOLDS(a.status == VODR_OK && b.status == VODR_OK && a.counters.misses == b.counters.misses);
    good &= HOLDS(b.counters.evictions == 0);
    good &= outcome_same_frame(file, &a, &b);
    if (!good) {
        case_print(file, c, &tile);
    }
    outcome_free(&a);
    outcome_free(&b);
    return good;
}

/* The organisation of every named machine draws a case's picture as paper-16 does; those whose bricks leave no room for
 * a cubic filter's border, with more texture memory. */
static bool named_machines_draw_the_same(test_case *c, FILE *file)
{
    const vodr_options options = {.threads = 1};
    size_t count;
    const vodr_parameter *parameters = vodr_parameters(&count);
    outcome expected = {0};
    bool good = true;
    outcome_draw(c, &c->machine, &options, &expected);
    for (size_t i = 0; good && vodr_machine_name(i); i++) {
        vodr_machine machine;
        outcome o = {0};
        good = HOLDS(vodr_machine_named(vodr_machine_name(i), &machine, NULL) == VODR_OK);
        for (size_t p = 0; p < count; p++) {
            char value[32];
            vodr_machine_get(&c->machine, &parameters[p], value, sizeof value);
            if (parameters[p].picture)
                good &= HOLDS(vodr_machine_set(&machine, parameters[p].name, value, NULL) == VODR_OK);
        }
        bool cubic = machine.filter == VODR_FILTER_CARDINAL || machine.filter == VODR_FILTER_BSPLINE;
        machine.texture_memory_bytes *= cubic ? 4 : 1;
        outcome_draw(c, &machine, &options, &o);
        good = good && HOLDS(o.status == VODR_OK) && outcome_same_frame(file, &expected, &o);
        if (!good) {
            fprintf(file, "  %s: %s\n", vodr_machine_name(i), o.error.text);
            case_print(file, c, &machine);
        }
        outcome_free(&o);
    }
    outcome_free(&expected);
    return good;
}

static void test_named_machines_draw_the_same(void **state)
{
    assert_int_equal(suite_run(*state, named_machines_draw_the_same), 0);
}

static void test_division_changes_nothing(void **state)
{
    assert_int_equal(suite_run(*state, division_changes_nothing), 0);
}

static void test_tile_order_is_compulsory(void **state)
{
    assert_int_equal(suite_run(*state, tile_order_is_compulsory), 0);
}

int main(int argc, char **argv)
{
    suite options;
    if (!suite_options(argc, argv, &options)) {
        return 2;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate(test_division_changes_nothing, &options),
        cmocka_unit_test_prestate(test_tile_order_is_compulsory, &options),
        cmocka_unit_test_prestate(test_named_machines_draw_the_same, &options),
    };
    return cmocka_run_group_tests_name("identity", tests, NULL, NULL) == 0 ? 0 : 1;
}
