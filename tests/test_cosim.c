/* test_cosim.c - frames with blocks in Verilog: the same bytes, counters, cycles and stalls as in C, whatever the view,
 * the registers and the mix of blocks; and a fault in one block's Verilog is found in every mix that has it.
 * Arguments: [CASES [FIRST_SEED]]; a failing case is drawn again by `test_cosim 1 SEED`. */
#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "cosim.h"
#include "outcome.h"
#include "suite.h"

enum { DEFAULT_CASES = 60, MIXES = 1 << VODR_BLOCK_COUNT, MIXES_SEED = 28 };

/* What the Verilog has as parameters: each line is a set of libraries. */
static const char *const machines[][4][2] = {
    {{NULL, NULL}},
    {{"line_px", "32x1"}},
    {{"traversal", "whole"}},
    {{"nonblocking", "1"}},
};

/* ---- drawing ---- */

static void set(vodr_machine *m, const char *name, const char *value)
{
    vodr_error error;
    if (vodr_machine_set(m, name, value, &error) != VODR_OK) {
        fail_msg("%s", error.text);
    }
}

static void set_number(vodr_machine *m, const char *name, int64_t value)
{
    char text[32];
    snprintf(text, sizeof text, "%" PRId64, value);
    set(m, name, text);
}

/* Draws what the Verilog has as registers, small so that what is full, late or in the way happens in small frames. */
static void draw_registers(rng *r, vodr_machine *m)
{
    static const char *const blends[] = {"over", "under", "mip"}, *const orders[] = {"layer", "column", "tile"},
                             *const replacements[] = {"lru", "fifo", "random"};
    set(m, "blend", blends[rng_int(r, 0, 2)]);
    set(m, "filter", rng_one_in(r, 3) ? "nearest" : "linear");
    if (m->traversal != VODR_TRAVERSAL_WHOLE) {
        set(m, "traversal", orders[rng_int(r, 0, 2)]);
    }
    set(m, "replacement", replacements[rng_int(r, 0, 2)]);
    set(m, "index", rng_one_in(r, 2) ? "xor" : "modulo");
    set(m, "fb_layout", rng_one_in(r, 2) ? "linear" : "tiled");
    set(m, "kill_transparent", rng_one_in(r, 3) ? "1" : "0");
    set_number(m, "brick_setup_cycles", rng_int(r, 32, 60));
    set_number(m, "slice_setup_cycles", rng_one_in(r, 4) ? 1 : rng_int(r, 1, 40));
    set_number(m, "texture_latency_cycles", rng_one_in(r, 4) ? 3 : rng_int(r, 3, 30));
    set(m, "memory", rng_one_in(r, 3) ? "dram" : "fixed");
    set_number(m, "dram_refresh_cycles", rng_one_in(r, 4) ? 0 : rng_int(r, 60, 2000));
    set_number(m, "dram_trfc_cycles", rng_int(r, 1, 50));
    set_number(m, "dram_tcas_cycles", rng_int(r, 3, 30));
    set_number(m, "texture_burst_bytes", 16 << rng_int(r, 0, 5));
}

static bool draw_c(test_case *c, const vodr_machine *m, outcome *o)
{
    const vodr_options options = {.threads = 1, .cycles = true};
    outcome_draw(c, m, &options, o);
    return o->status == VODR_OK;
}

static rtl_status draw_verilog(test_case *c, const vodr_machine *m, cosim_options *options, outcome *o)
{
    *o = (outcome){0};
    options->root = VODR_ROOT;
    options->build = VODR_BUILD;
    return cosim_render(m, &c->input, &c->table, &c->view, options, &o->frame, &o->counters, &o->error);
}

/* ---- random frames ---- */

static void random_blocks(rng *r, cosim_options *o)
{
    bool all = rng_one_in(r, 3);
    for (int b = 0; b < VODR_BLOCK_COUNT; b++) {
        o->replaced[b] = all || rng_one_in(r, 2);
    }
    o->compare = rng_one_in(r, 4) ? COSIM_TRANSACTIONS : COSIM_CYCLES;
    o->top = rng_one_in(r, 4);
}

static bool agree(test_case *c, FILE *file)
{
    cosim_options options = {.compare = COSIM_CYCLES};
    vodr_machine m = c->machine;
    outcome in_c, in_verilog;
    const char *const(*settings)[2] = machines[rng_int(&c->random, 0, 3)];
    /* Picture parameters of the case are widths in the Verilog: those of its table stay, others would be libraries. */
    vodr_machine_named("paper-16", &m, &(vodr_error){""});
    m.density_bits = c->machine.density_bits;
    m.tf_bits = c->machine.tf_bits;
    for (int i = 0; settings[i][0]; i++) {
        set(&m, settings[i][0], settings[i][1]);
    }
    draw_registers(&c->random, &m);
    random_blocks(&c->random, &options);
    if (!draw_c(c, &m, &in_c)) {
        return true; /* it cannot be built for this volume */
    }
    rtl_status status = draw_verilog(c, &m, &options, &in_verilog);
    bool good = status == RTL_OK && outcome_same(file, &in_c, &in_verilog);
    if (!good) {
        fprintf(file, "  %s\n", status == RTL_OK ? "Verilog and C differ" : in_verilog.error.text);
        case_print(file, c, &m);
    }
    outcome_free(&in_c);
    outcome_free(&in_verilog);
    return good;
}

static void test_random_frames(void **state)
{
    assert_int_equal(suite_run(*state, agree), 0);
}

/* ---- all mixes ---- */

/* A copy of a block's Verilog with one text in the place of another. */
static void write_fault(const char *block, const char *text, const char *fault, const char *path)
{
    char from[4096], line[1024];
    bool found = false;
    snprintf(from, sizeof from, "%s/rtl/%s.v", VODR_ROOT, block);
    FILE *in = fopen(from, "r"), *out = fopen(path, "w");
    assert_true(in && out);
    while (fgets(line, sizeof line, in)) {
        char *at = found ? NULL : strstr(line, text);
        if (at) {
            found = true;
            fprintf(out, "%.*s%s%s", (int)(at - line), line, fault, at + strlen(text));
        } else {
            fputs(line, out);
        }
    }
    assert_true(found);
    fclose(in);
    assert_int_equal(fclose(out), 0);
}

static void test_mixes(void **state)
{
    (void)state;
    static const char path[] = VODR_BUILD "/rtl-fault/alpha_blender.v";
    test_case c;
    vodr_machine m;
    outcome in_c;
    int found = 0;
    assert_int_equal(system("mkdir -p '" VODR_BUILD "/rtl-fault'"), 0);
    write_fault("alpha_blender", "<< (FB_BITS - 1)", "<< (FB_BITS - 2)", path);
    assert_true(case_make(MIXES_SEED, &c));
    assert_int_equal(vodr_machine_named("paper-16", &m, &(vodr_error){""}), VODR_OK);
    m.density_bits = c.machine.density_bits;
    m.tf_bits = c.machine.tf_bits;
    assert_true(draw_c(&c, &m, &in_c));
    assert_true(in_c.counters.fragments > 100);
    for (int mix = 0; mix < MIXES; mix++)
        for (int faulty = 0; faulty < 2; faulty++) {
            cosim_options options = {.compare = COSIM_CYCLES};
            outcome drawn;
            for (int b = 0; b < VODR_BLOCK_COUNT; b++) {
                options.replaced[b] = mix >> b & 1;
            }
            options.files[VODR_BLOCK_ALPHA_BLENDER] = faulty ? path : NULL;
            rtl_status status = draw_verilog(&c, &m, &options, &drawn);
            if (status == RTL_DIFFERS) {
                assert_non_null(strstr(drawn.error.text, "alpha_blender differs in cycle "));
                assert_true(faulty && (mix >> VODR_BLOCK_ALPHA_BLENDER & 1));
                found++;
            } else {
                assert_int_equal(status, RTL_OK);
                assert_true(outcome_same(stderr, &in_c, &drawn));
            }
            outcome_free(&drawn);
        }
    assert_int_equal(found, MIXES / 2);
    outcome_free(&in_c);
    case_free(&c);
}

int main(int argc, char **argv)
{
    suite options;
    if (!suite_options(argc, argv, &options)) {
        return 2;
    }
    if (argc < 2) {
        options.cases = DEFAULT_CASES;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate(test_random_frames, &options),
        cmocka_unit_test(test_mixes),
    };
    return cmocka_run_group_tests_name("cosim", tests, NULL, NULL) == 0 ? 0 : 1;
}
