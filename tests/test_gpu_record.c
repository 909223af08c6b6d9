/* test_gpu_record.c - the newest record of a GPU (vectors/gpu/): every frame that the card drew in the machine's
 * arithmetic is drawn again by the CPU build of the same kernels, and must hash the same. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>
#include <dirent.h>
#include <inttypes.h>
#include <jansson.h>
#include <stdlib.h>
#include <string.h>

#include "outcome.h"
#include "reference.h"

static const char directory[] = "vectors/gpu";

/* Records begin with the date, so that the last by name is the newest. */
static void newest_record(char *path, size_t size)
{
    char newest[256] = "";
    DIR *records = opendir(directory);
    assert_non_null(records);
    for (struct dirent *entry; (entry = readdir(records));)
        if (strstr(entry->d_name, ".json") && strcmp(entry->d_name, newest) > 0)
            snprintf(newest, sizeof newest, "%s", entry->d_name);
    closedir(records);
    assert_true(newest[0]);
    snprintf(path, size, "%s/%s", directory, newest);
}

static json_t *open_record(void)
{
    char path[512];
    json_error_t error;
    newest_record(path, sizeof path);
    json_t *root = json_load_file(path, 0, &error);
    if (!root)
        fail_msg("%s:%d: %s", path, error.line, error.text);
    print_message("%s: %s\n", path, json_string_value(json_object_get(root, "gpu")));
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

static void test_newest(void **state)
{
    (void)state;
    json_t *root = open_record();
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

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_newest)};
    return cmocka_run_group_tests_name("gpu record", tests, NULL, NULL);
}
