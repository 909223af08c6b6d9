/* digest.c - one FNV-1a hash over the frames and counters of every 50 random cases, and one over the vectors of each
 * block, to hold builds against each other: compilers, optimisation levels and sanitizers must print the same lines.
 * Arguments: [CASES [FIRST_SEED]]. */
#include <inttypes.h>
#include <stdlib.h>

#include "outcome.h"
#include "suite.h"
#include "vectors.h"

enum { CASES_A_LINE = 50 };

static bool add_case(uint64_t seed, uint64_t *hash)
{
    test_case c;
    outcome o = {0};
    bool made = case_make(seed, &c) && case_widen(&c);
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

/* The vectors are checked, too. */
static bool add_vectors(vodr_block block)
{
    const vectors_choice choice = vectors_choice_default(block);
    char *text = NULL;
    size_t size = 0;
    uint64_t hash = OUTCOME_HASH_START, cycles;
    vodr_error error;
    FILE *file = open_memstream(&text, &size);
    bool good = file && vectors_generate(&choice, file, &error) == VECTORS_OK;
    good = file && fclose(file) == 0 && good;
    for (size_t i = 0; good && i < size; i++) {
        hash = (hash ^ (uint8_t)text[i]) * 0x100000001B3u;
    }
    file = good ? fmemopen(text, size, "r") : NULL;
    good = file && vectors_check(block, file, "vectors", &cycles, &error) == VECTORS_OK;
    if (file) {
        fclose(file);
    }
    free(text);
    printf("vectors %d %016" PRIx64 "\n", (int)block, hash);
    return good;
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
    for (int block = 0; block < VODR_BLOCK_COUNT; block++) {
        if (!add_vectors((vodr_block)block)) {
            fprintf(stderr, "vectors of block %d were not made\n", block);
            return 1;
        }
    }
    return 0;
}
