/* test_cells.c - a machine's cells are those of the rows that have its blocks' parameters, and of no others; what rows
 * do not name is what the Verilog has by itself. */
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cells.h"
#include "cosim.h"
#include "modules.h"
#include "text.h"
#include "unit.h"

static const char blocks[] = "# the machine paper-16\n"
                             "volume_divider | 1000 word bits | 1 | 0\n"
                             "slice_generator | 10 | 2\n"
                             "rasterizer | 2000 word bits | 3\n"
                             "\n"
                             "texture_unit | 20 | 4 | 9 | 9 | a to b\n"
                             "alpha_blender | 30 | 5\n"
                             "pixel_cache | 40 | 6\n"
                             "frame_buffer|50|7\n"
                             "vodr_top | 60 | 8\n"
                             "pixel_cache WAYS=8  CACHE_BYTES=8192 | 70 | 16\n";

static cell_table table_of(const char *text)
{
    cell_table table = {0};
    host_error error;
    assert_int_equal(cell_table_parse(text, "test", &table, &error), HOST_OK);
    return table;
}

static void check(const cell_table *table, const char *machine, int64_t cells, int64_t flip_flops)
{
    const vodr_machine m = unit_machine(machine);
    cell_counts c;
    assert_int_equal(cells_of(table, &m, &c), cells != 0);
    if (!cells)
        return;
    assert_int_equal(c.cells, cells);
    assert_int_equal(c.word_bits, 3000);
    assert_int_equal(c.flip_flops, flip_flops);
}

static void test_sums(void **state)
{
    (void)state;
    host_error error;
    cell_table table = table_of(blocks);
    check(&table, "", 210, 36);
    check(&table, "traversal=tile slice_setup_cycles=9 memory=dram filter=nearest", 210, 36); /* registers */
    check(&table, "ways=8 cache_bytes=8192", 240, 46);
    check(&table, "ways=8", 0, 0);
    check(&table, "cache_bytes=8192", 0, 0);
    check(&table, "line_px=8x2", 0, 0);
    check(&table, "skip_empty=1", 0, 0);
    check(&table, "double_buffer=0", 0, 0);
    check(&table, "traversal=whole", 0, 0);
    check(&table, "pipelines=2", 0, 0); /* the Verilog refuses these */
    check(&table, "brick_setup_cycles=28", 0, 0);
    assert_int_equal(cell_table_parse("volume_divider EMPTY_BRICKS=4096 | 1000 word bits | 0\n"
                                      "pixel_cache | 41 | 6\n",
                                      "more", &table, &error),
                     HOST_OK);
    check(&table, "", 211, 36);
    check(&table, "skip_empty=1", 211, 35);
    cell_table_free(&table);
}

static void test_named_machines(void **state)
{
    (void)state;
    host_error error;
    cell_table table;
    assert_int_equal(cell_table_open(NULL, &table, &error), HOST_OK);
    const char *name;
    for (size_t i = 0; (name = vodr_machine_name(i)) != NULL; i++) {
        vodr_machine m;
        vodr_error reason;
        cell_counts c;
        assert_int_equal(vodr_machine_named(name, &m, &reason), VODR_OK);
        assert_true(cells_of(&table, &m, &c));
        assert_true(c.cells > 10000 && c.word_bits > 10000 && c.flip_flops > 1000);
    }
    cell_table_free(&table);
}

static void test_wrong_rows(void **state)
{
    (void)state;
    static const char *const wrong[][2] = {
        {"alpha | 1 | 2", "there is no module 'alpha'"},
        {" | 1 | 2", "there is no module ''"},
        {"pixel_cache WAYS | 1 | 2", "'WAYS' is not of the form NAME=VALUE"},
        {"pixel_cache WAYS=x | 1 | 2", "'WAYS=x' is not of the form NAME=VALUE"},
        {"pixel_cache WAYS=-1 | 1 | 2", "'WAYS=-1' is not of the form NAME=VALUE"},
        {"pixel_cache FB_BYTES=1 | 1 | 2", "pixel_cache has no parameter 'FB_BYTES'"},
        {"vodr_top FB_BITS=8 | 1 | 2", "vodr_top has no parameter 'FB_BITS'"},
        {"pixel_cache", "is not of the form MODULE"},
        {"pixel_cache | 1", "is not of the form MODULE"},
        {"pixel_cache | -1 | 2", "is not of the form MODULE"},
        {"pixel_cache | 1 word | 2", "is not of the form MODULE"},
        {"pixel_cache | 1 | 2.5", "is not of the form MODULE"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        cell_table table = {0};
        host_error error;
        char text[256];
        snprintf(text, sizeof text, "# comment\nalpha_blender | 1 | 2\n%s\n", wrong[i][0]);
        assert_int_equal(cell_table_parse(text, "test", &table, &error), HOST_BAD_INPUT);
        assert_non_null(strstr(error.text, wrong[i][1]));
        assert_ptr_equal(strstr(error.text, "test:3: "), error.text);
        cell_table_free(&table);
    }
}

/* ---- the Verilog's own values ---- */

/* A parameter of the machine by its name in capitals. */
static int64_t machine_value(const char *name, const vodr_machine *m)
{
    size_t count;
    const vodr_parameter *p = vodr_parameters(&count);
    for (size_t i = 0; i < count; i++) {
        size_t n = 0;
        while (p[i].name[n] && toupper((unsigned char)p[i].name[n]) == name[n])
            n++;
        if (!p[i].name[n] && !isupper((unsigned char)name[n]) && name[n] != '_') {
            int32_t value;
            memcpy(&value, (const char *)m + p[i].offset, sizeof value);
            return value;
        }
    }
    fail_msg("there is no parameter like %s", name);
    return 0;
}

/* The value after the '=' of a parameter: a number, a default of hw/ or half of it, or another parameter. */
static int64_t own_value(const char *text, const vodr_machine *m)
{
    static const char standard[] = "`VODR_DEFAULT_";
    int64_t value;
    char name[64];
    if (isdigit((unsigned char)*text))
        return strtoll(text, NULL, 10);
    if (strncmp(text, standard, sizeof standard - 1) == 0) {
        const char *end = text + strcspn(text, ",\n");
        value = machine_value(text + sizeof standard - 1, m);
        return end - text > 3 && memcmp(end - 3, "/ 2", 3) == 0 ? value / 2 : value;
    }
    snprintf(name, sizeof name, "%.*s", (int)strspn(text, "ABCDEFGHIJKLMNOPQRSTUVWXYZ_"), text);
    assert_true(rtl_machine_parameter(m, name, &value));
    return value;
}

static void test_verilog(void **state)
{
    (void)state;
    const vodr_machine m = vodr_machine_default();
    int compared = 0;
    for (int block = 0; block < VODR_BLOCK_COUNT; block++) {
        const char *const *names = rtl_module_of((vodr_block)block)->parameters;
        char path[256], *text = NULL;
        host_error error;
        snprintf(path, sizeof path, VODR_ROOT "/rtl/%s.v", signals_of((vodr_block)block)->name);
        assert_int_equal(text_read(path, "Verilog", &text, &error), HOST_OK);
        for (; *names; names++) {
            char wanted[96];
            int64_t value;
            snprintf(wanted, sizeof wanted, "parameter %s ", *names);
            const char *at = strstr(text, wanted);
            assert_non_null(at);
            at = strchr(at, '=') + 2;
            assert_true(rtl_machine_parameter(&m, *names, &value));
            if (own_value(at, &m) != value)
                fail_msg("%s: %s is not %lld by itself", path, *names, (long long)value);
            compared++;
        }
        free(text);
    }
    assert_true(compared > 25);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sums),
        cmocka_unit_test(test_named_machines),
        cmocka_unit_test(test_wrong_rows),
        cmocka_unit_test(test_verilog),
    };
    return cmocka_run_group_tests_name("cells", tests, NULL, NULL);
}
