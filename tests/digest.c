/* digest.c - one FNV-1a hash over the frames and counters of every 50 random cases, to hold builds against each other:
 * compilers, optimisation levels and sanitizers must print the same lines. Arguments: [CASES [FIRST_SEED]]. */
#include <inttypes.h>

#include "outcome.h"
#include "suite.h"

enum { CASES_A_LINE = 50 };

static bool add_case(uint64_t seed, uint64_t *hash)
{
    test_case c;
    outcome o = {0};
    bool made = case_make(seed, &c);
    for (int32_t traversal = 0; made && traversal <= VODR_TRAVERSAL_TILE; traversal++) {
        vodr_machine machine = c.machine;
        machine.traversal = traversal;
        case_organise(&c, &machine);
        case_multiply(&c, &machine);
        const vodr_options options = {.threads = 1 + (int32_t)(seed % 2),
                                      .path = rng_one_in(&c.random, 2) ? VODR_PATH_FAST : VODR_PATH_BLOCKS};
        outcome_draw(&c, &machine, &options, &o);
        made = o.status == VODR_OK;
        *hash = outcome_hash(*hash, &o);
        outcome_free(&o);
    }
    case_free(&c);
    return made;
}

int main(int argc, char **argv)
{
    suite s;
    if (!suite_options(argc, argv, &s)) {
        return 2;
    }
    uint64_t hash = OUTCOME_HASH_START;
    for (uint64_t i = 0; i < s.cases; i++) {
        if (!add_case(s.first_seed + i, &hash)) {
            fprintf(stderr, "case %" PRIu64 " was not drawn\n", s.first_seed + i);
            return 1;
        }
        if ((i + 1) % CASES_A_LINE == 0 || i + 1 == s.cases) {
            printf("%" PRIu64 " %016" PRIx64 "\n", i + 1, hash);
        }
    }
    return 0;
}
