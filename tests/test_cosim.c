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

/* ---- drawing ---- */

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
    vodr_machine m;
    outcome in_c, in_verilog;
    case_verilog_machine(c, &m);
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
