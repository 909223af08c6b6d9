/* lockstep.c - runs the lock-step benches.
 *   lockstep [--transactions N] [--seed S] [BLOCK]...    20,000 transactions a machine of every block, from seed 1
 *   lockstep lerp                                        arithmetic alone, of all operands; without a name it is run
 * too A bench that differs prints its seed, and `lockstep --transactions N --seed S BLOCK` draws it again first. */
#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "bench.h"

enum { EPISODE_TRANSACTIONS = 5000 };

static const block_bench *const benches[] = {&bench_volume_divider, &bench_slice_generator, &bench_rasterizer,
                                             &bench_texture_unit,   &bench_alpha_blender,   &bench_pixel_cache,
                                             &bench_frame_buffer};

static const struct CMUnitTest exhaustive[] = {{.name = "lerp", .test_func = lockstep_lerp}};

enum { EXHAUSTIVE = sizeof exhaustive / sizeof *exhaustive };
enum { BENCHES = sizeof benches / sizeof *benches };

static uint64_t transactions = 20000, first_seed = 1;

uint64_t bench_bits(rng *random, int32_t bits)
{
    uint64_t all = bits < 64 ? ((uint64_t)1 << bits) - 1 : UINT64_MAX;
    switch (rng_int(random, 0, 7)) {
    case 0: return 0;
    case 1: return all;
    case 2: return 1;
    case 3: return (all >> 1) + 1;
    default: return rng_next(random) & all;
    }
}

/* ---- one episode ---- */

static void set_machine(const char *settings, vodr_machine *m)
{
    char text[256], *rest = text, *word;
    vodr_error error;
    snprintf(text, sizeof text, "%s", settings);
    assert_int_equal(vodr_machine_named("paper-16", m, &error), VODR_OK);
    while ((word = strtok_r(rest, " ", &rest)) != NULL) {
        char *value = strchr(word, '=');
        *value++ = '\0';
        if (vodr_machine_set(m, word, value, &error) != VODR_OK) {
            fail_msg("%s", error.text);
        }
    }
}

static void begin(const block_bench *what, const char *settings, uint64_t seed, bench *b)
{
    vodr_error error;
    const rtl_source source = {.root = VODR_ROOT, .build = VODR_BUILD};
    *b = (bench){.seed = seed, .random = {seed}};
    assert_true(case_make(seed, &b->scene));
    set_machine(settings, &b->machine);
    if (what->draw) {
        what->draw(&b->random, &b->machine);
    }
    if (what->look) {
        what->look(&b->random, &b->scene);
    }
    b->scene.table.count = (size_t)1 << b->machine.density_bits;
    b->scene.entries = realloc(b->scene.entries, b->scene.table.count * sizeof *b->scene.entries);
    b->scene.table.entries = b->scene.entries;
    size_t clear = rng_one_in(&b->random, 2) ? (size_t)rng_int(&b->random, 0, (int64_t)b->scene.table.count) : 0;
    for (size_t i = 0; i < b->scene.table.count; i++) {
        uint16_t a = (uint16_t)bench_bits(&b->random, b->machine.tf_bits);
        uint16_t c = (uint16_t)rng_int(&b->random, 0, a);
        b->scene.entries[i] = i < clear ? (vodr_rgba){0, 0, 0, 0} : (vodr_rgba){c, a, (uint16_t)(c / 2), a};
    }
    if (clocked_start(&b->whole, &b->machine, &b->scene.input, &b->scene.table, &b->scene.view, NULL, &error) !=
        VODR_OK) {
        fail_msg("%s", error.text);
    }
    b->faces = clocked_faces(b->whole);
    b->reset = clocked_reset(b->whole);
    if (lockstep_open(&b->pair, &source, what->block, clocked_setup(b->whole), b->faces, b->reset, &error) != RTL_OK) {
        fail_msg("%s", error.text);
    }
}

static void end(bench *b)
{
    lockstep_close(&b->pair, b->faces);
    clocked_free(b->whole);
    case_free(&b->scene);
}

/* Up to `count` transactions; *count is then how many there were. */
static bool run_episode(const block_bench *what, const char *settings, uint64_t seed, uint64_t *count, uint64_t *cycles)
{
    bench b;
    begin(what, settings, seed, &b);
    what->traffic(&b, *count);
    const difference d = b.pair.first;
    *cycles += b.cycles;
    *count -= b.left;
    end(&b);
    if (!d.found) {
        return true;
    }
    fprintf(stderr,
            "%s, machine paper-16 %s: cycle %" PRIu64 ", port %s: expected %s, got %s; again: --seed %" PRIu64 " %s\n",
            signals_of(what->block)->name, settings, b.cycles, d.field->name, d.expected, d.got, seed,
            signals_of(what->block)->name);
    return false;
}

/* ---- tests ---- */

static void test_block(void **state)
{
    const block_bench *what = *state;
    bool good = true;
    for (const char *const *m = what->machines; *m; m++) {
        uint64_t cycles = 0, done = 0;
        for (uint64_t seed = first_seed; good && done < transactions; seed++) {
            uint64_t left = transactions - done, count = left < EPISODE_TRANSACTIONS ? left : EPISODE_TRANSACTIONS;
            good = run_episode(what, *m, seed, &count, &cycles);
            done += count;
        }
        printf("%s, paper-16 %s: %" PRIu64 " transactions in %" PRIu64 " cycles\n", signals_of(what->block)->name, *m,
               done, cycles);
    }
    assert_true(good);
}

static bool named(const char *name, int argc, char **argv, int first)
{
    bool found = first >= argc;
    for (int i = first; i < argc; i++) {
        found |= strcmp(argv[i], name) == 0;
    }
    return found;
}

int main(int argc, char **argv)
{
    struct CMUnitTest tests[BENCHES + EXHAUSTIVE];
    size_t count = 0;
    int first = 1;
    for (; first + 1 < argc && strncmp(argv[first], "--", 2) == 0; first += 2) {
        char *end;
        uint64_t number = strtoull(argv[first + 1], &end, 10);
        bool known = strcmp(argv[first], "--transactions") == 0 || strcmp(argv[first], "--seed") == 0;
        if (!known || *end || end == argv[first + 1]) {
            fprintf(stderr, "usage: lockstep [--transactions N] [--seed S] [BLOCK]...\n");
            return 2;
        }
        *(argv[first][2] == 's' ? &first_seed : &transactions) = number;
    }
    for (size_t i = 0; i < BENCHES; i++) {
        const char *name = signals_of(benches[i]->block)->name;
        if (named(name, argc, argv, first)) {
            tests[count++] =
                (struct CMUnitTest){.name = name, .test_func = test_block, .initial_state = (void *)benches[i]};
        }
    }
    for (size_t i = 0; i < EXHAUSTIVE; i++) {
        if (named(exhaustive[i].name, argc, argv, first)) {
            tests[count++] = exhaustive[i];
        }
    }
    if (!count) {
        fprintf(stderr, "lockstep: there is no such block\n");
        return 2;
    }
    return _cmocka_run_group_tests("lockstep", tests, count, NULL, NULL) == 0 ? 0 : 1;
}
