/* generate.c - writes vectors: cases of made-up traffic, as the block in C meets it. */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "bench.h"
#include "case_text.h"
#include "error.h"
#include "header.h"
#include "replay.h"

/* Looks on as the traffic clocks the block. */
typedef struct recorder {
    replay replay;
    block_faces inner; /* the block, in its place */
    FILE *file;
    uint64_t cycles, most;
    bool enough;
    const char *illegal; /* what the traffic did that it must not */
    char *line;
} recorder;

static void put_line(recorder *r, bool rst, const void *in)
{
    char *end = replay_line(&r->replay, rst, in, r->line);
    *end++ = '\n';
    fwrite(r->line, 1, (size_t)(end - r->line), r->file);
}

/* Inputs are written before the block may look at them, outputs after. */
#define RECORD(NAME, name)                                                                                             \
    static void record_##name(void *state, const name##_in *in, name##_out *out)                                       \
    {                                                                                                                  \
        recorder *r = state;                                                                                           \
        if (r->enough)                                                                                                 \
            return;                                                                                                    \
        r->illegal = replay_before(&r->replay, in);                                                                    \
        if (!r->illegal)                                                                                               \
            r->inner.name.clock(r->inner.name.state, in, out);                                                         \
        replay_after(&r->replay, out);                                                                                 \
        put_line(r, false, in);                                                                                        \
        r->enough = r->illegal || ++r->cycles == r->most;                                                              \
    }
BENCH_BLOCKS(RECORD)

/* Puts the recorder into the block's place, or the block back into it. */
static void look_on(recorder *r, bench *b, vodr_block block, bool begin)
{
#define SWAP(NAME, name)                                                                                               \
    if (block == VODR_BLOCK_##NAME && begin) {                                                                         \
        r->inner.name = b->faces->name;                                                                                \
        b->faces->name = (name##_face){.state = r, .clock = record_##name};                                            \
    } else if (block == VODR_BLOCK_##NAME) {                                                                           \
        b->faces->name = r->inner.name;                                                                                \
    }
    BENCH_BLOCKS(SWAP)
}

static vectors_status run_case(const block_bench *what, bench *b, const char *name, FILE *file, uint64_t *cycles,
                               vodr_error *error)
{
    recorder r = {.file = file, .most = what->case_cycles, .line = malloc(REPLAY_LINE)};
    if (!replay_start(&r.replay, b, what) || !r.line) {
        vodr_fail(error, VODR_NO_MEMORY, "no memory for a case");
    } else {
        put_line(&r, true, NULL);
        look_on(&r, b, what->block, true);
        b->differs = &r.enough;
        what->traffic(b, r.most);
        look_on(&r, b, what->block, false);
    }
    bool made = r.line && r.replay.rules;
    if (r.illegal)
        vodr_fail(error, VODR_INVALID, "%s, %s, cycle %" PRIu64 ": the traffic is not legal: %s",
                  signals_of(what->block)->name, name, r.cycles, r.illegal);
    *cycles += r.cycles;
    replay_end(&r.replay);
    free(r.line);
    return r.illegal ? VECTORS_INVALID : made ? VECTORS_OK : VECTORS_ENVIRONMENT;
}

/* Of a name, so that a case does not depend on which others there are. */
static uint64_t seed_of(uint64_t seed, const char *name)
{
    rng r = {seed};
    for (uint64_t hash = rng_next(&r); *name; name++) {
        r.state = hash ^ (uint8_t)*name;
        hash = rng_next(&r);
    }
    return rng_next(&r);
}

/* Opens the bench of a case; NULL for its header when it fails. */
static vectors_status open_case(const vectors_choice *choice, uint64_t seed, bench *b, char **header, vodr_error *error)
{
    vodr_status status = bench_open(b, bench_of(choice->block), &choice->machine, seed, error);
    *header = status == VODR_OK ? header_text(choice, b) : NULL;
    if (status == VODR_INVALID)
        return VECTORS_INVALID;
    if (status == VODR_OK && *header)
        return VECTORS_OK;
    vodr_fail(error, VODR_NO_MEMORY, "no memory for a case");
    return VECTORS_ENVIRONMENT;
}

vectors_status vectors_generate(const vectors_choice *choice, FILE *file, vodr_error *error)
{
    const block_bench *what = bench_of(choice->block);
    uint64_t cycles = 0, cases = 0, wanted = what->level_cycles[choice->level - 1];
    vectors_status status = VECTORS_OK;
    char *header = NULL;
    for (uint64_t i = 0; status == VECTORS_OK && cycles < wanted && !ferror(file); i++) {
        char name[32], *own;
        bench *b = malloc(sizeof *b);
        if (!b)
            return VECTORS_ENVIRONMENT;
        snprintf(name, sizeof name, "random-%" PRIu64, i);
        uint64_t seed = seed_of(choice->seed, name);
        status = open_case(choice, seed, b, &own, error);
        if (status == VECTORS_OK && !header)
            fprintf(file, "%s\n", header = strdup(own));
        /* All cases are of one module. */
        if (status == VECTORS_OK && header && strcmp(header, own) == 0) {
            cases++;
            status = case_text_put(file, name, seed, choice, b) ? run_case(what, b, name, file, &cycles, error)
                                                                : VECTORS_ENVIRONMENT;
        }
        free(own);
        bench_close(b);
        free(b);
    }
    free(header);
    if (status == VECTORS_OK)
        fprintf(file, "end %" PRIu64 "\n", cases + cycles); /* reset is a line, too */
    return status;
}
