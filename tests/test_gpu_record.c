/* test_gpu_record.c - the newest records of a GPU (vectors/gpu/). Every frame that the card drew in the machine's
 * arithmetic is drawn again by the CPU build of the same kernels, and must hash the same; every maximum must have as
 * many samples and, but for the last bits of floats, the same sum. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>
#include <dirent.h>
#include <inttypes.h>
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mip_case.h"
#include "outcome.h"

static const char directory[] = "vectors/gpu";

/* Whether the record has results of a kind. */
static bool holds(const json_t *root, const char *kind)
{
    size_t i;
    json_t *result;
    json_array_foreach(json_object_get(root, "results"), i, result)
    {
        const char *have = json_string_value(json_object_get(result, "result"));
        if (have && strcmp(have, kind) == 0)
            return true;
    }
    return false;
}

static json_t *load(const char *name)
{
    char path[512];
    json_error_t error;
    snprintf(path, sizeof path, "%s/%s", directory, name);
    json_t *root = json_load_file(path, 0, &error);
    if (!root)
        fail_msg("%s:%d: %s", path, error.line, error.text);
    return root;
}

/* The newest of the records that have results of a kind: records begin with the date. */
static json_t *newest_record(const char *kind)
{
    char newest[256] = "";
    json_t *root = NULL;
    DIR *records = opendir(directory);
    assert_non_null(records);
    for (struct dirent *entry; (entry = readdir(records));) {
        if (!strstr(entry->d_name, ".json") || strcmp(entry->d_name, newest) <= 0)
            continue;
        json_t *other = load(entry->d_name);
        if (holds(other, kind)) {
            json_decref(root);
            root = other;
            snprintf(newest, sizeof newest, "%s", entry->d_name);
        } else
            json_decref(other);
    }
    closedir(records);
    if (!root)
        fail_msg("%s has no record with a result %s", directory, kind);
    print_message("%s/%s: %s\n", directory, newest, json_string_value(json_object_get(root, "gpu")));
    return root;
}

static uint64_t number(const json_t *result, const char *name)
{
    const json_t *value = json_object_get(result, name);
    if (!json_is_integer(value))
        fail_msg("the record has no %s", name);
    return (uint64_t)json_integer_value(value);
}

/* Continues the hash by the frame of a case, and adds what was fetched. */
static void draw(uint64_t seed, uint64_t *hash, uint64_t *samples)
{
    test_case c;
    outcome o = {0};
    reference *r;
    reference_stats stats;
    assert_true(case_make(seed, &c));
    reference_volume v = {.type = c.input.voxel_bytes == 1 ? REFERENCE_UINT8 : REFERENCE_UINT16,
                          .voxels = c.input.voxels};
    memcpy(v.dims_vox, c.input.dims_vox, sizeof v.dims_vox);
    assert_int_equal(reference_open(&(reference_options){REFERENCE_CPU, 1, VODR_SIMD_BEST}, &v, &r, NULL),
                     REFERENCE_OK);
    assert_int_equal(reference_fixed(r, &c.machine, c.input.map, &c.table, &c.view, &o.frame, &stats, NULL),
                     REFERENCE_OK);
    *hash = outcome_hash(*hash, &o);
    *samples += stats.samples;
    reference_close(r);
    outcome_free(&o);
    case_free(&c);
}

/* The GPU's frames were the C model's, and are the CPU's. */
static void check_matrix(const json_t *result)
{
    const uint64_t frames = number(result, "fixed_frames"), want = number(result, "fixed_samples");
    uint64_t hash = OUTCOME_HASH_START, samples = 0;
    char text[17];
    assert_int_equal(number(result, "fixed_differ"), 0);
    assert_int_equal(number(result, "accel_differ"), 0);
    for (uint64_t i = 0; i < frames; i++)
        draw(i + 1, &hash, &samples);
    snprintf(text, sizeof text, "%016" PRIx64, hash);
    print_message("%" PRIu64 " frames, hash %s\n", frames, text);
    if (strcmp(text, json_string_value(json_object_get(result, "fixed_hash"))) != 0)
        fail_msg("%" PRIu64 " frames hash to %s here and to %s on the card: where test_reference passes, the cases are "
                 "others since the record was made, and scripts/gpu-record has to make a new one",
                 frames, text, json_string_value(json_object_get(result, "fixed_hash")));
    assert_int_equal(samples, want);
}

static void test_frames(void **state)
{
    (void)state;
    json_t *root = newest_record("matrix");
    uint64_t most = 0;
    size_t i;
    json_t *result;
    json_array_foreach(json_object_get(root, "results"), i, result)
    {
        const char *kind = json_string_value(json_object_get(result, "result"));
        if (!kind || strcmp(kind, "matrix") != 0)
            continue;
        most = number(result, "fixed_frames") > most ? number(result, "fixed_frames") : most;
        check_matrix(result);
    }
    assert_true(most >= 500);
    json_decref(root);
}

/* ---- the maximum ---- */

/* Which samples there are is the same everywhere. Which of them a bound leaves out hangs on the last bit of a float
 * here and there, and in `best` also on how many rays go together. */
static void check_samples(const json_t *result, const mip_tally *t)
{
    assert_int_equal(number(result, "none_samples"), t->samples[REFERENCE_ACCEL_NONE]);
    for (int accel = REFERENCE_ACCEL_BLOCK; accel <= REFERENCE_ACCEL_SEED; accel++) {
        char name[32];
        snprintf(name, sizeof name, "%s_samples", mip_accel_name((reference_accel)accel));
        const double card = (double)number(result, name), ours = (double)t->samples[accel];
        if (!(fabs(card - ours) <= 1e-5 * ours))
            fail_msg("%s: %.0f on the card, %.0f here", name, card, ours);
    }
}

/* Every case drawn by every --accel on the card was that of `none`; each sum is ours. */
static void check_maxima(const json_t *result)
{
    const reference_options options = {REFERENCE_CPU, 1, VODR_SIMD_BEST};
    const json_t *sums = json_object_get(result, "sums");
    const uint64_t cases = number(result, "cases");
    mip_tally t = {0};
    assert_int_equal(number(result, "differ"), 0);
    assert_true(cases >= 200);
    if (sums)
        assert_int_equal(json_array_size(sums), cases);
    for (uint64_t i = 0; i < cases; i++) {
        mip_case c;
        const double card = json_number_value(json_array_get(sums, i));
        assert_true(mip_case_make(i + 1, &c) && mip_case_hold(&c, &options, stderr, &t));
        mip_case_free(&c);
        if (sums && !(fabs(card - t.sum) <= 1e-5 * (1 + fabs(t.sum))))
            fail_msg("case %" PRIu64 ": the maxima add up to %.9g on the card and to %.9g here", i + 1, card, t.sum);
    }
    assert_int_equal(number(result, "frames"), t.frames);
    assert_int_equal(t.differ, 0);
    check_samples(result, &t);
}

static void test_maxima(void **state)
{
    (void)state;
    json_t *root = newest_record("mip_matrix");
    size_t i;
    json_t *result;
    json_array_foreach(json_object_get(root, "results"), i, result)
    {
        const char *kind = json_string_value(json_object_get(result, "result"));
        if (kind && strcmp(kind, "mip_matrix") == 0)
            check_maxima(result);
    }
    json_decref(root);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_frames), cmocka_unit_test(test_maxima)};
    return cmocka_run_group_tests_name("gpu record", tests, NULL, NULL);
}
