/* test_frames.c - the golden frames of vectors/frames.txt are drawn again, fast, block by block and clocked: frame,
 * counters and cycles are what they were.
 *
 *   test_frames            compares
 *   test_frames --write    prints what the file has to be (make vectors) */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "bench.h"
#include "cycle_stats.h"
#include "digest.h"
#include "phantom.h"
#include "spline.h"
#include "stats.h"
#include "views.h"

static const char path[] = "vectors/frames.txt";

enum { N = PHANTOM_SIDE_VOX, VOXELS = N * N * N };

/* A frame: what is drawn, how the camera stands, and what differs from each named machine. */
typedef struct golden {
    const char *name;
    phantom_kind kind;
    views_camera camera;
    const char *settings;
} golden;

/* Looking along an axis, aslant, from within, from close by; larger and smaller than the screen. */
static const golden frames[] = {
    {"head-front", PHANTOM_HEAD, {{1, 0, 0, 0}, false, 0, 1, 1, 48, 48, 48}, ""},
    {"head-side-under", PHANTOM_HEAD, {{1, 0, 1, 0}, false, 0, 4, 3, 70, 60, 40}, "blend=under"},
    {"head-aslant-mip", PHANTOM_HEAD, {{4, 1, -2, 1}, false, 0, 1, 1, 64, 64, 64}, "blend=mip filter=nearest"},
    {"head-near", PHANTOM_HEAD, {{5, -1, 2, 0}, true, 60, 3, 2, 72, 56, 48}, "cache_bytes=2048"},
    {"head-within", PHANTOM_HEAD, {{3, 1, 1, 0}, true, 24, 4, 1, 48, 48, 33}, "blend=under kill_transparent=1"},
    {"vessels-top", PHANTOM_VESSELS, {{1, 1, 0, 0}, false, 0, 1, 1, 48, 48, 48}, "skip_empty=1 brick=8"},
    {"vessels-aslant-16",
     PHANTOM_VESSELS,
     {{7, 2, 3, -1}, false, 0, 5, 4, 80, 80, 60},
     "fb_bits=16 tf_bits=16 density_bits=12 weight_bits=12"},
    {"vessels-near-dram", PHANTOM_VESSELS, {{2, 0, 1, 1}, true, 90, 1, 1, 50, 50, 50}, "memory=dram brick=10"},
    {"head-cardinal", PHANTOM_HEAD, {{4, 1, -2, 1}, false, 0, 3, 2, 56, 56, 48}, "filter=cardinal brick=8"},
    {"vessels-bspline",
     PHANTOM_VESSELS,
     {{5, -1, 2, 0}, true, 60, 3, 2, 56, 56, 48},
     "filter=bspline density_bits=12 fb_bits=16 tf_bits=16 brick=8"},
};

static void append(char **text, const char *format, ...) __attribute__((format(printf, 2, 3)));

static void append(char **text, const char *format, ...)
{
    va_list arguments;
    char *before = *text, piece[512];
    va_start(arguments, format);
    vsnprintf(piece, sizeof piece, format, arguments);
    va_end(arguments);
    *text = malloc(strlen(before) + strlen(piece) + 1);
    assert_non_null(*text);
    strcpy(*text, before);
    strcat(*text, piece);
    free(before);
}

/* NAME=NUMBER of each counter, or OBJECT.NAME of what lies in it. */
static void append_counters(char **text, const char *of, json_t *counters)
{
    const char *name;
    json_t *value;
    assert_non_null(counters);
    json_object_foreach(counters, name, value)
    {
        char inner[128];
        snprintf(inner, sizeof inner, "%s%s", of, name);
        if (json_is_object(value)) {
            strcat(inner, ".");
            append_counters(text, inner, json_incref(value));
        } else if (json_is_integer(value)) {
            append(text, " %s=%lld", inner, (long long)json_integer_value(value));
        }
    }
    json_decref(counters);
}

/* A frame by a machine as a line. */
static void draw_golden(const golden *g, const char *machine_name, vodr_path way, char **text)
{
    static uint16_t voxels[VOXELS];
    static vodr_rgba entries[1 << 12];
    const vodr_options options = {.cycles = true, .threads = 1, .path = way};
    vodr_volume input = {.dims_vox = {N, N, N}, .voxel_bytes = 2, .voxels = voxels};
    vodr_machine machine;
    vodr_view view;
    vodr_frame frame;
    vodr_counters counters;
    vodr_error error;
    host_error why;
    char hex[DIGEST_CHARS];
    assert_int_equal(vodr_machine_named(machine_name, &machine, &error), VODR_OK);
    if (bench_set(&machine, g->settings, &error) != VODR_OK)
        fail_msg("%s", error.text);
    phantom_fill(g->kind, machine.density_bits, voxels);
    if (machine.filter >= VODR_FILTER_CARDINAL) /* the border of two voxels of a machine with little memory */
        machine.texture_memory_bytes *= 4;
    if (machine.filter == VODR_FILTER_BSPLINE) {
        static int16_t coefficients[VOXELS];
        assert_int_equal(spline_coefficients(&input, machine.density_bits, coefficients, &why), HOST_OK);
        input.voxels = coefficients;
    }
    const vodr_table table = {.entries = entries, .count = (size_t)1 << machine.density_bits};
    phantom_table(g->kind, machine.tf_bits, table.count, entries);
    assert_true(views_of_camera(&g->camera, input.dims_vox, &view));
    if (vodr_render(&machine, &input, &table, &view, &options, &frame, &counters, &error) != VODR_OK)
        fail_msg("%s on %s: %s", g->name, machine_name, error.text);
    assert_int_equal(digest_frame(&frame, hex, &why), HOST_OK);
    vodr_frame_free(&frame);
    append(text, "frame %s machine=%s %s%ssha256=%s", g->name, machine_name, g->settings, *g->settings ? " " : "", hex);
    append_counters(text, "", stats_counters(&counters));
    append_counters(text, "cycles.", cycle_stats_blocks(&counters.cycles));
    append_counters(text, "stalls.", cycle_stats_stalls(&counters.cycles));
    append(text, "\n");
}

static char *draw_all(vodr_path way)
{
    const char *name;
    char *text = strdup(
        "# Golden frames (docs/vectors.md): `make vectors` writes them, tests/test_frames.c draws them again.\n");
    for (size_t i = 0; i < sizeof frames / sizeof *frames; i++)
        for (size_t m = 0; (name = vodr_machine_name(m)) != NULL; m++)
            draw_golden(&frames[i], name, way, &text);
    return text;
}

/* Tells the first line that differs. */
static void compare(vodr_path way)
{
    FILE *file = fopen(path, "r");
    char *text = draw_all(way), line[8192];
    assert_non_null(file);
    for (const char *at = text; *at; at += strlen(line)) {
        if (!fgets(line, sizeof line, file))
            fail_msg("%s ends where there must be: %.*s", path, (int)strcspn(at, "\n"), at);
        if (strncmp(at, line, strlen(line)) != 0)
            fail_msg("%s has\n  %s  and there must be\n  %.*s", path, line, (int)strcspn(at, "\n"), at);
    }
    assert_null(fgets(line, sizeof line, file));
    fclose(file);
    free(text);
}

static void drawn_fast(void **state)
{
    (void)state;
    compare(VODR_PATH_FAST);
}

static void drawn_block_by_block(void **state)
{
    (void)state;
    compare(VODR_PATH_BLOCKS);
}

static void drawn_clocked(void **state)
{
    (void)state;
    compare(VODR_PATH_CLOCKED);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(drawn_fast), cmocka_unit_test(drawn_block_by_block),
                                       cmocka_unit_test(drawn_clocked)};
    if (argc == 2 && strcmp(argv[1], "--write") == 0) {
        char *text = draw_all(VODR_PATH_FAST);
        fputs(text, stdout);
        free(text);
        return 0;
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}
