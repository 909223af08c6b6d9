/* test_no_memory.c - every allocation of a frame fails in turn, on every path: the frame is refused with a sentence,
 * nothing is left in it, nothing leaks (which the sanitized build sees), and without a failure it is drawn as ever. The
 * linker puts the functions below in the place of the library's (--wrap, in the Makefile).
 * Arguments: [CASES [FIRST_SEED]]; a failing case is drawn again by `test_no_memory 1 SEED`. */
#include <errno.h>
#include <inttypes.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "outcome.h"
#include "suite.h"

enum { DEFAULT_CASES = 12 };

/* ---- what fails ---- */

/* Calls until one fails; below 0 all succeed. Static, since whoever allocates knows nothing of it. */
static atomic_long calls_left = -1;

static bool fails(void)
{
    return atomic_load(&calls_left) >= 0 && atomic_fetch_sub(&calls_left, 1) == 0;
}

/* Whether a failure that was asked for has come to pass, which ends it. */
static bool has_failed(void)
{
    return atomic_exchange(&calls_left, -1) < 0;
}

#define WRAP(type, name, failure, parameters, arguments)                                                               \
    type __real_##name parameters;                                                                                     \
    type __wrap_##name parameters;                                                                                     \
    type __wrap_##name parameters                                                                                      \
    {                                                                                                                  \
        return fails() ? failure : __real_##name arguments;                                                            \
    }
WRAP(void *, malloc, NULL, (size_t size), (size))
WRAP(void *, calloc, NULL, (size_t count, size_t size), (count, size))
WRAP(void *, realloc, NULL, (void *old, size_t size), (old, size))
WRAP(int, posix_memalign, ENOMEM, (void **made, size_t alignment, size_t size), (made, alignment, size))
WRAP(int, pthread_mutex_init, ENOMEM, (pthread_mutex_t * lock, const pthread_mutexattr_t *how), (lock, how))
WRAP(int, pthread_cond_init, ENOMEM, (pthread_cond_t * changed, const pthread_condattr_t *how), (changed, how))

/* A thread that cannot be made is none that is missed: this one always fails while another call is yet to. */
int __real_pthread_create(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *);
int __wrap_pthread_create(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *);
int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *how, void *(*run)(void *), void *argument)
{
    bool odd = atomic_load(&calls_left) % 2 == 1;
    return odd ? EAGAIN : __real_pthread_create(thread, how, run, argument);
}

/* ---- frames ---- */

static bool is_empty(const outcome *o)
{
    static const vodr_frame no_frame;
    static const vodr_counters no_counters;
    return memcmp(&o->frame, &no_frame, sizeof no_frame) == 0 &&
           memcmp(&o->counters, &no_counters, sizeof no_counters) == 0;
}

/* Draws with the n-th call failing, n = 0, 1, ..., until there are no more: not in so many frames in a row, since how
 * many calls there are may depend on which thread comes first. */
static bool survives(test_case *c, const vodr_machine *m, const vodr_options *options, int patience, FILE *file)
{
    outcome expected, drawn;
    outcome_draw(c, m, options, &expected);
    bool good = expected.status == VODR_OK;
    int without = 0;
    for (long n = 0; good && without < patience; n++) {
        atomic_store(&calls_left, n);
        outcome_draw(c, m, options, &drawn);
        bool failed = has_failed();
        without = failed ? 0 : without + 1;
        good = failed ? drawn.status == VODR_NO_MEMORY && strstr(drawn.error.text, "no memory") && is_empty(&drawn)
                      : drawn.status == VODR_OK && outcome_same(file, &expected, &drawn);
        if (!good) {
            fprintf(file, "  path %d, %d threads, call %ld: %s\n", options->path, options->threads, n,
                    drawn.error.text);
        }
        outcome_free(&drawn);
    }
    outcome_free(&expected);
    return good;
}

/* A frame of rows enough that a thread without any is given some of another's, which takes memory too. */
static void test_shared_rows(void **state)
{
    (void)state;
    enum { SIDE = 96 };
    static uint8_t voxels[SIDE * SIDE * SIDE];
    const vodr_options options = {.threads = 4};
    vodr_machine m = vodr_machine_default();
    test_case c;
    assert_true(case_make(1, &c));
    vodr_rgba entries[256] = {{.a = 1}};
    c.table = (vodr_table){.entries = entries, .count = 256};
    c.input = (vodr_volume){.dims_vox = {SIDE, SIDE, SIDE}, .voxel_bytes = 1, .voxels = voxels};
    c.view = (vodr_view){.width_px = SIDE,
                         .height_px = SIDE,
                         .slices = SIDE,
                         .footprint = 1 << VODR_FOOTPRINT_BITS,
                         .base = {1 << 23, 1 << 23, 1 << 23},
                         .step_u = {1 << 24, 0, 0},
                         .step_v = {0, 1 << 24, 0},
                         .step_s = {0, 0, 1 << 24}};
    assert_true(survives(&c, &m, &options, 16, stderr));
    case_free(&c);
}

/* Nobody has to want the sentence. */
static void test_no_sentence(void **state)
{
    (void)state;
    test_case c;
    vodr_status status = VODR_NO_MEMORY;
    assert_true(case_make(1, &c));
    for (long n = 0; status != VODR_OK; n++) {
        vodr_frame frame;
        vodr_counters counters;
        const vodr_options options = {.threads = 2};
        atomic_store(&calls_left, n);
        status = vodr_render(&c.machine, &c.input, &c.table, &c.view, &options, &frame, &counters, NULL);
        assert_int_equal(status, has_failed() ? VODR_NO_MEMORY : VODR_OK);
        vodr_frame_free(&frame);
    }
    case_free(&c);
}

static bool case_survives(test_case *c, FILE *file)
{
    static const vodr_options programs[] = {
        {.threads = 1, .path = VODR_PATH_BLOCKS, .cycles = true},
        {.threads = 1, .path = VODR_PATH_FAST},
        {.threads = 3, .path = VODR_PATH_FAST, .cycles = true},
        {.threads = 1, .path = VODR_PATH_CLOCKED, .cycles = true},
    };
    vodr_machine m;
    bool good = true;
    case_any_machine(c, &m);
    for (size_t i = 0; good && i < sizeof programs / sizeof *programs; i++) {
        good = survives(c, &m, &programs[i], 1, file);
    }
    if (!good) {
        case_print(file, c, &m);
    }
    return good;
}

static void test_frames(void **state)
{
    assert_int_equal(suite_run(*state, case_survives), 0);
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
        cmocka_unit_test_prestate(test_frames, &options),
        cmocka_unit_test(test_shared_rows),
        cmocka_unit_test(test_no_sentence),
    };
    return cmocka_run_group_tests_name("no memory", tests, NULL, NULL) == 0 ? 0 : 1;
}
