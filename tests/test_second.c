/* test_second.c - libvodr against the second implementation: every byte of the frame, every counter, every refusal.
 * Arguments: [CASES [FIRST_SEED]]; a failing case is drawn again by `test_second 1 SEED`. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "outcome.h"
#include "second.h"
#include "suite.h"

static bool agree(test_case *c, FILE *file)
{
    static const vodr_options programs[] = {{.threads = 1, .path = VODR_PATH_FAST},
                                            {.threads = 1, .path = VODR_PATH_BLOCKS}};
    vodr_machine machine = c->machine;
    machine.traversal = (int32_t)rng_int(&c->random, VODR_TRAVERSAL_WHOLE, VODR_TRAVERSAL_TILE);
    case_organise(c, &machine);
    if (rng_one_in(&c->random, 8)) {
        case_spoil(c, &machine);
    }
    case_multiply(c, &machine);
    outcome second = {0};
    second.status = second_render(&machine, &c->input, &c->table, &c->view, &second.frame, &second.counters);
    bool same = true;
    for (int i = 0; i < 2; i++) {
        outcome first;
        outcome_draw(c, &machine, &programs[i], &first);
        same &= outcome_same_frame(file, &first, &second);
        same &= outcome_same_counters(file, &first, &second);
        outcome_free(&first);
    }
    outcome_free(&second);
    if (!same) {
        case_print(file, c, &machine);
    }
    return same;
}

static void test_random_cases(void **state)
{
    assert_int_equal(suite_run(*state, agree), 0);
}

int main(int argc, char **argv)
{
    suite options;
    if (!suite_options(argc, argv, &options)) {
        return 2;
    }
    const struct CMUnitTest tests[] = {cmocka_unit_test_prestate(test_random_cases, &options)};
    return cmocka_run_group_tests_name("second", tests, NULL, NULL) == 0 ? 0 : 1;
}
