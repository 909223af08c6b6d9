/* suite.c - one loop over random cases. */
#include "suite.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>

enum { TOLD_CASES = 3 };

static bool read_number(const char *text, uint64_t *number)
{
    char *end;
    errno = 0;
    *number = strtoull(text, &end, 10);
    return *text >= '0' && *text <= '9' && *end == '\0' && errno == 0;
}

bool suite_options(int argc, char **argv, suite *s)
{
    *s = (suite){.cases = 500, .first_seed = 1};
    bool good = argc <= 3;
    good = good && (argc < 2 || (read_number(argv[1], &s->cases) && s->cases >= 1));
    good = good && (argc < 3 || read_number(argv[2], &s->first_seed));
    if (!good) {
        fprintf(stderr, "usage: %s [CASES [FIRST_SEED]], CASES at least 1, both decimal numbers below 2^64\n", argv[0]);
    }
    return good;
}

uint64_t suite_run(const suite *s, bool (*check)(test_case *c, FILE *file))
{
    FILE *quiet = fopen("/dev/null", "w");
    uint64_t failed = quiet ? 0 : 1;
    for (uint64_t i = 0; quiet && i < s->cases; i++) {
        test_case c;
        bool good =
            case_make(s->first_seed + i, &c) && case_widen(&c) && check(&c, failed < TOLD_CASES ? stderr : quiet);
        failed += !good;
        case_free(&c);
    }
    if (failed > 0) {
        fprintf(stderr, "%" PRIu64 " of %" PRIu64 " cases failed\n", failed, s->cases);
    }
    if (quiet) {
        fclose(quiet);
    }
    return failed;
}
