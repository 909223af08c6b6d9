/* test_bins.c - functional coverage: the frames that the tests draw meet every bin of tests/lib/bins_table.h. Frames
 * are those of test_clocked, of any machine, and those of test_cosim, which the Verilog draws too, from seed 1 on.
 *   test_bins [--table]    --table: prints the bins for docs/table-coverage.md, with the frames that met each */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "bins.h"

enum { FRAMES = 200, KINDS = 2 };

/* Frames that met each bin: of any machine, and of those in Verilog. */
typedef struct tally {
    int frames[KINDS];
} tally;

typedef void machine_function(test_case *c, vodr_machine *machine);

static bool draw(uint64_t seed, machine_function *make, int kind, tally *bins)
{
    test_case c;
    vodr_machine m;
    vodr_error error;
    bool *seen = calloc((size_t)bins_count(), sizeof *seen), good = seen && case_make(seed, &c);
    if (good) {
        make(&c, &m);
        /* One that cannot be built for its volume is none of test_cosim's either. */
        good = bins_draw(&c, &m, seen, &error) != VODR_NO_MEMORY;
        case_free(&c);
    }
    for (int i = 0; good && i < bins_count(); i++) {
        bins[i].frames[kind] += seen[i];
    }
    free(seen);
    return good;
}

static tally *draw_all(void)
{
    static machine_function *const makers[KINDS] = {case_any_machine, case_verilog_machine};
    tally *bins = calloc((size_t)bins_count(), sizeof *bins);
    bool good = bins != NULL;
    for (uint64_t seed = 1; good && seed <= FRAMES; seed++) {
        for (int kind = 0; good && kind < KINDS; kind++) {
            good = draw(seed, makers[kind], kind, bins);
        }
    }
    if (good) {
        return bins;
    }
    free(bins);
    return NULL;
}

static void test_bins(void **state)
{
    tally *bins = *state;
    int empty = 0;
    for (int i = 0; i < bins_count(); i++) {
        if (bins[i].frames[0] + bins[i].frames[1] == 0) {
            fprintf(stderr, "no frame meets: %s: %s\n", bins_group(i), bins_name(i));
            empty++;
        }
    }
    assert_int_equal(empty, 0);
}

/* A name stands for one bin. */
static void test_names(void **state)
{
    (void)state;
    for (int i = 0; i < bins_count(); i++) {
        for (int j = 0; j < i; j++) {
            assert_true(strcmp(bins_name(i), bins_name(j)) != 0 || strcmp(bins_group(i), bins_group(j)) != 0);
        }
    }
}

static void print_table(const tally *bins)
{
    int filled = 0;
    for (int i = 0; i < bins_count(); i++) {
        filled += bins[i].frames[0] + bins[i].frames[1] > 0;
    }
    printf("%d of %d bins are met.\n\n", filled, bins_count());
    printf("| group | bin | frames of any machine, of %d | frames in Verilog, of %d |\n", FRAMES, FRAMES);
    printf("| --- | --- | ---: | ---: |\n");
    for (int i = 0; i < bins_count(); i++) {
        printf("| %s | %s | %d | %d |\n", bins_group(i), bins_name(i), bins[i].frames[0], bins[i].frames[1]);
    }
}

int main(int argc, char **argv)
{
    if (argc > 2 || (argc == 2 && strcmp(argv[1], "--table") != 0)) {
        fprintf(stderr, "usage: test_bins [--table]\n");
        return 2;
    }
    tally *bins = draw_all();
    if (!bins) {
        fprintf(stderr, "test_bins: no memory\n");
        return 1;
    }
    if (argc == 2) {
        print_table(bins);
        free(bins);
        return 0;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate(test_bins, bins),
        cmocka_unit_test(test_names),
    };
    int failed = cmocka_run_group_tests_name("bins", tests, NULL, NULL);
    free(bins);
    return failed == 0 ? 0 : 1;
}
