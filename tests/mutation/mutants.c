/* mutants.c - runs mutants of a block, all in one model and chosen by an input, against its kept vectors, then in
 * lock-step with the block in C (docs/table-mutation.md).
 *   mutants VECTORS MODULE.v TRANSACTIONS N...    in lock-step so many transactions, for what vectors do not kill
 * MODULE.v is the block of the vectors' machine, with an input `mutant` beside its ports; 0 chooses none.
 *
 * Prints a line each: `N vectors LINE PORT`, `N lock-step SEED CYCLE PORT` or `N survives`. What is missing, or late,
 * is a difference like any other, since outputs are compared in every cycle. Exit code 1 when the block itself, as
 * mutant 0, differs: then nothing was shown. */
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench.h"
#include "header.h"
#include "lockstep.h"
#include "vector_file.h"

enum { EPISODE_TRANSACTIONS = 1000, FAILED = 1, USAGE = 2 };

typedef struct run {
    vectors_choice choice; /* whose machine all mutants are of */
    char *header;          /* the first line of its vectors */
    vector_file *vectors;
    rtl_source source;
    rtl_found found;
    uint64_t transactions;
    vodr_error error;
} run;

typedef enum verdict { SURVIVES, KILLED, BROKEN } verdict;

/* ---- checks ---- */

static verdict against_vectors(run *r, const char *module)
{
    rtl_library model;
    vector_difference first;
    if (rtl_module_open(&r->source, module, &model, &r->error) != RTL_OK)
        return BROKEN;
    vodr_rtl_port const *selector = rtl_library_port(&model, r->source.selector);
    if (!selector || selector->width_bits > 16 || selector->width_bits < 9) {
        rtl_library_close(&model);
        rtl_fail(&r->error, RTL_INVALID, "%s: the module has no input %s of 9 to 16 bits", r->source.file,
                 r->source.selector);
        return BROKEN;
    }
    const uint16_t selected = (uint16_t)r->source.selected;
    memcpy(selector->data, &selected, sizeof selected);
    bool replayed = vector_file_replay(r->vectors, &model, selected == 0, &first, &r->error);
    rtl_library_close(&model);
    if (first.line)
        printf("%" PRIu64 " vectors %" PRIu64 " %s\n", r->source.selected, first.line, first.name);
    return !replayed ? BROKEN : first.line ? KILLED : SURVIVES;
}

/* Traffic of a seed, of every other one with a volume and a frame as large as there can be. That of another module,
 * which has other sizes of memory, is none. *count is what is left to do. */
static verdict episode(run *r, const block_bench *what, uint64_t seed, uint64_t *count)
{
    bench *b = calloc(1, sizeof *b);
    lockstep *pair = calloc(1, sizeof *pair);
    verdict outcome = BROKEN;
    vodr_status (*const open)(bench *, const block_bench *, const vodr_machine *, uint64_t, vodr_error *) =
        what->large && seed % 2 == 0 ? bench_open_large : bench_open;
    bool opened = b && pair && open(b, what, &r->choice.machine, seed, &r->error) == VODR_OK;
    char *header = opened ? header_text(&r->choice, b) : NULL;
    if (header && strcmp(header, r->header) != 0) {
        outcome = SURVIVES;
    } else if (header &&
               lockstep_open(pair, &r->source, what->block, &b->setup, b->faces, b->reset, &r->error) == RTL_OK) {
        b->differs = &pair->first.found;
        uint64_t most = *count < EPISODE_TRANSACTIONS ? *count : EPISODE_TRANSACTIONS;
        what->traffic(b, most);
        *count -= most - b->left;
        outcome = pair->first.found ? KILLED : SURVIVES;
        if (outcome == KILLED)
            printf("%" PRIu64 " lock-step %" PRIu64 " %" PRIu64 " %s\n", r->source.selected, seed, b->cycles,
                   pair->first.field->name);
        lockstep_close(pair, b->faces);
    }
    free(header);
    if (b)
        bench_close(b);
    free(b);
    free(pair);
    return outcome;
}

static verdict in_lockstep(run *r)
{
    const block_bench *what = bench_of(r->choice.block);
    verdict outcome = SURVIVES;
    uint64_t left = r->transactions;
    for (uint64_t seed = 1; outcome == SURVIVES && left; seed++)
        outcome = episode(r, what, seed, &left);
    return outcome;
}

static verdict check(run *r, uint64_t mutant)
{
    r->source.selected = mutant;
    verdict outcome = against_vectors(r, signals_of(r->choice.block)->name);
    if (outcome == SURVIVES)
        outcome = in_lockstep(r);
    if (outcome == SURVIVES && mutant)
        printf("%" PRIu64 " survives\n", mutant);
    fflush(stdout);
    return outcome;
}

/* ---- the command ---- */

static bool number(const char *text, uint64_t most, uint64_t *value)
{
    char *end;
    errno = 0;
    *value = strtoull(text, &end, 10);
    return *text >= '0' && *text <= '9' && !*end && !errno && *value <= most;
}

static bool begin(run *r, const char *vectors)
{
    FILE *file = fopen(vectors, "r");
    size_t room = 0;
    ssize_t length = file ? getline(&r->header, &room, file) : -1;
    if (file)
        fclose(file);
    if (length <= 0) {
        rtl_fail(&r->error, RTL_INVALID, "%s cannot be read", vectors);
        return false;
    }
    r->header[strcspn(r->header, "\n")] = '\0';
    if (header_read(r->header, &r->choice, &r->error) != VECTORS_OK)
        return false;
    r->vectors = vector_file_read(vectors, &r->error);
    return r->vectors != NULL;
}

/* The block itself has to pass before any mutant is judged. */
static bool passes_unmutated(run *r)
{
    verdict outcome = check(r, 0);
    if (outcome == KILLED)
        rtl_fail(&r->error, RTL_DIFFERS, "%s differs without any mutation", r->source.file);
    return outcome == SURVIVES;
}

int main(int argc, char **argv)
{
    enum { MODULE = 2, TRANSACTIONS, MUTANTS };
    uint64_t mutant;
    run *r = calloc(1, sizeof *r);
    bool good = r && argc >= MUTANTS && number(argv[TRANSACTIONS], UINT64_MAX, &r->transactions);
    for (int i = MUTANTS; good && i < argc; i++)
        good = number(argv[i], 4095, &mutant);
    if (!good) {
        fprintf(stderr, "usage: mutants VECTORS MODULE.v TRANSACTIONS N... (scripts/mutation runs it)\n");
        free(r);
        return USAGE;
    }
    r->source = (rtl_source){
        .root = VODR_ROOT, .build = VODR_BUILD, .file = argv[MODULE], .found = &r->found, .selector = "mutant"};
    int status = !begin(r, argv[1]) ? USAGE : passes_unmutated(r) ? 0 : FAILED;
    for (int i = MUTANTS; !status && i < argc; i++) {
        number(argv[i], 4095, &mutant);
        status = check(r, mutant) == BROKEN ? FAILED : 0;
    }
    if (status)
        fprintf(stderr, "mutants: %s\n", r->error.text);
    vector_file_free(r->vectors);
    free(r->header);
    free(r);
    return status;
}
