/* test_transfer.c - transfer functions: text files, built-in functions, and the table made from one. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "transfer.h"

/* A new file of that text; `path` is a template of mkstemp(). */
static void write_text(const char *text, char *path)
{
    int descriptor = mkstemp(path);
    assert_true(descriptor >= 0);
    FILE *file = fdopen(descriptor, "w");
    fputs(text, file);
    fclose(file);
}

/* Opens `text` as a transfer-function file. */
static host_status open_text(const char *text, transfer *t, host_error *error)
{
    char path[] = "/tmp/vodr-transfer-XXXXXX";
    write_text(text, path);
    host_status status = transfer_open(path, false, t, error);
    unlink(path);
    return status;
}

static void test_text_file(void **state)
{
    (void)state;
    transfer t;
    host_error error;
    assert_int_equal(open_text("# a comment\n\n-100 0 0 0 0\r\n  300 1 0.5 0 0.8\n", &t, &error), HOST_OK);
    assert_false(t.normalized);
    assert_int_equal(t.count, 2);
    transfer_point p = transfer_at(&t, 100, 0, 1);
    assert_true(fabs(p.r - 0.5) < 1e-12 && fabs(p.g - 0.25) < 1e-12 && p.b == 0 && fabs(p.a - 0.4) < 1e-12);
    assert_true(transfer_at(&t, -1e9, 0, 1).a == 0);
    assert_true(transfer_at(&t, 1e9, 0, 1).a == 0.8);
    transfer_close(&t);
}

static void test_normalized_file(void **state)
{
    (void)state;
    transfer t;
    host_error error;
    assert_int_equal(open_text("# normalized\n0 1 1 1 0\n1 1 1 1 1\n", &t, &error), HOST_OK);
    assert_true(t.normalized);
    assert_true(transfer_at(&t, 15, 10, 20).a == 0.5);
    assert_true(transfer_at(&t, 7, 7, 7).a == 0);
    transfer_close(&t);
}

/* Two rows: at 0 nothing, at 8 and beyond the first red, then green. */
static void test_rows(void **state)
{
    (void)state;
    enum { COUNT = 3, ROWS = 5 };
    static const char text[] = "# by magnitude\ngradient 2\n0 0 0 1 0\n  gradient 8 \r\n 0 1 0 0 1\n10 0 1 0 0.5\n";
    double rgba[ROWS][COUNT][4], most;
    transfer t;
    host_error error;
    char path[] = "/tmp/vodr-transfer-XXXXXX";
    write_text(text, path);
    assert_int_equal(transfer_open_rows(path, false, &t, &error), HOST_OK);
    unlink(path);
    assert_int_equal(t.row_count, 2);
    assert_int_equal(transfer_sample_rows(&t, 0, 10, COUNT, ROWS, 1, &rgba[0][0][0], &most, &error), HOST_OK);
    assert_true(most == 0.8);
    /* Rows are at 0, 2, 4, 6 and 8; values 0, 5, 10. */
    static const double share[ROWS] = {0, 0, 1.0 / 3, 2.0 / 3, 1};
    static const double last[COUNT][4] = {{1, 0, 0, 1}, {0.375, 0.375, 0, 0.75}, {0, 0.5, 0, 0.5}};
    for (int j = 0; j < ROWS; j++)
        for (int i = 0; i < COUNT; i++)
            for (int c = 0; c < 4; c++)
                assert_true(fabs(rgba[j][i][c] - share[j] * last[i][c]) < 1e-12);
    /* Two voxels deep. */
    assert_int_equal(transfer_sample_rows(&t, 0, 10, COUNT, ROWS, 2, &rgba[0][0][0], &most, &error), HOST_OK);
    assert_true(fabs(rgba[4][2][3] - 0.75) < 1e-12);
    transfer_close(&t);
}

static void test_bad_files(void **state)
{
    (void)state;
    static const struct {
        const char *text, *words;
    } cases[] = {
        {"", "no point"},
        {"# normalized\n", "no point"},
        {"1 0 0 0\n", ":1: '1 0 0 0' is not of the form"},
        {"1 0 0 0 0 0\n", "not of the form"},
        {"1 0 0 0 x\n", "a is 'x' but must be a number from 0 to 1"},
        {"1 0 1.5 0 0\n", "g is '1.5'"},
        {"1 0 0 0 nan\n", "a is 'nan'"},
        {"inf 0 0 0 0\n", "value is 'inf' but must be a number"},
        {"1 0 0 0 0\n1 0 0 0 1\n", ":2: value 1 is not above"},
        {"1 0 0 0 0\n# normalized\n", ":2: `# normalized` must come before"},
        {"# normalized\n2 0 0 0 0\n", "value is '2' but must be a number from 0 to 1"},
        {"3 0 0 0 0\n1 0 0 0 1\n", ":2: value 1 is not above"},
        {"gradient 0\n", "no point"},
        {"1 0 0 0 0\ngradient 1\n1 0 0 0 0\n", ":2: `gradient` must come before the first point"},
        {"gradient 1\n# normalized\n1 0 0 0 0\n", ":2: `# normalized` must come before"},
        {"gradient -1\n1 0 0 0 0\n", ":1: gradient is '-1' but must be a number from 0"},
        {"gradient inf\n1 0 0 0 0\n", ":1: gradient is 'inf'"},
        {"gradient\n1 0 0 0 0\n", ":1: 'gradient' is not of the form"},
        {"gradient 1 2\n1 0 0 0 0\n", ":1: 'gradient 1 2' is not of the form"},
        {"gradient 0\ngradient 1\n1 0 0 0 0\n", ":2: gradient 0 has no point"},
        {"gradient 0\n1 0 0 0 0\ngradient 1\n", ": gradient 1 has no point"},
        {"gradient 1\n1 0 0 0 0\ngradient 1\n1 0 0 0 0\n", ":3: gradient 1 is not above"},
        {"gradient 0\n1 0 0 0 0\n1 0 0 0 0\n", ":3: value 1 is not above"},
        {"gradient 0\n1 0 0 0 0\ngradient 1\n0 0 0 0 0\n", "is of value and gradient magnitude"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        transfer t;
        host_error error;
        assert_int_equal(open_text(cases[i].text, &t, &error), HOST_BAD_INPUT);
        if (!strstr(error.text, cases[i].words))
            fail_msg("\"%s\" gave \"%s\"", cases[i].text, error.text);
    }
}

static void test_unknown_name(void **state)
{
    (void)state;
    transfer t;
    host_error error;
    assert_int_equal(transfer_open("no-such-function", false, &t, &error), HOST_BAD_INPUT);
    assert_non_null(strstr(error.text, "no-such-function"));
    assert_non_null(strstr(error.text, "skin-bone"));
    assert_int_equal(transfer_open("/", false, &t, &error), HOST_BAD_INPUT);
}

static void test_ramp(void **state)
{
    (void)state;
    transfer t;
    vodr_rgba entries[256];
    assert_int_equal(transfer_open("ramp", false, &t, NULL), HOST_OK);
    transfer_table(&t, 0, 255, 8, 8, 1, false, entries);
    for (int i = 0; i < 256; i++) {
        assert_int_equal(entries[i].a, (int)floor(0.05 * i + 0.5));
        assert_int_equal(entries[i].r, entries[i].a);
    }
    transfer_table(&t, 0, 255, 8, 8, 1, true, entries);
    for (int i = 0; i < 256; i++)
        assert_int_equal(entries[i].a, i);
    transfer_close(&t);
}

/* Two slices of depth 1 let through what one of depth 2 does. */
static void test_opacity_correction(void **state)
{
    (void)state;
    transfer t;
    static vodr_rgba one[4096], two[4096];
    assert_int_equal(transfer_open("bone", false, &t, NULL), HOST_OK);
    transfer_table(&t, 0, 1, 12, 16, 1, false, one);
    transfer_table(&t, 0, 1, 12, 16, 2, false, two);
    for (int i = 0; i < 4096; i++) {
        double through = 1 - one[i].a / 65535.0;
        assert_true(fabs(two[i].a / 65535.0 - (1 - through * through)) < 3e-5);
    }
    transfer_close(&t);
}

/* Of every built-in function, for CT and not: premultiplied, and clear at the window's bottom. */
static void test_builtins(void **state)
{
    (void)state;
    static vodr_rgba entries[4096];
    for (const char *const *name = transfer_names(); *name; name++)
        for (int ct = 0; ct < 2; ct++) {
            transfer t;
            assert_int_equal(transfer_open(*name, ct, &t, NULL), HOST_OK);
            assert_true(t.builtin);
            double lo = ct && t.has_ct_window ? t.ct_lo : 0, hi = ct && t.has_ct_window ? t.ct_hi : 1;
            assert_true(lo < hi);
            transfer_table(&t, lo, hi, 12, 16, 1.5, false, entries);
            assert_int_equal(entries[0].a, 0);
            assert_true(entries[4095].a > 0);
            for (int i = 0; i < 4096; i++)
                assert_true(entries[i].r <= entries[i].a && entries[i].g <= entries[i].a &&
                            entries[i].b <= entries[i].a);
            for (size_t i = 1; i < t.count; i++)
                assert_true(t.points[i - 1].value < t.points[i].value);
            transfer_table(&t, lo, hi, 12, 16, 1, true, entries);
            assert_int_equal(entries[4095].a, 65535);
            transfer_close(&t);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_text_file),          cmocka_unit_test(test_normalized_file), cmocka_unit_test(test_rows),
        cmocka_unit_test(test_bad_files),          cmocka_unit_test(test_unknown_name),    cmocka_unit_test(test_ramp),
        cmocka_unit_test(test_opacity_correction), cmocka_unit_test(test_builtins),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
