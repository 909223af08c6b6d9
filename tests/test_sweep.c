/* test_sweep.c - the parts of a sweep by themselves: points, fronts against brute force, rows, claims between
 * processes; and costs against figures worked out by hand from docs/sweep.md. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "costs.h"
#include "csv.h"
#include "sweep_end.h"
#include "unit.h"

/* ---- points ---- */

static void test_plan(void **state)
{
    (void)state;
    sweep_plan p = {0};
    host_error error;
    assert_int_equal(sweep_plan_over(&p, "ways=1,2,4", &error), HOST_OK);
    assert_int_equal(sweep_plan_over(&p, "crop=0:1,0:1,0:1;0:2,0:2,0:2", &error), HOST_OK);
    assert_int_equal(sweep_plan_over(&p, "view=orbit:4:10", &error), HOST_OK);
    assert_int_equal(sweep_plan_over(&p, "density_bits=8,12", &error), HOST_OK);
    assert_int_equal(sweep_plan_close(&p, &error), HOST_OK);
    assert_int_equal(p.points, 48);
    assert_string_equal(sweep_plan_value(&p, 2, 2), "90,10");
    assert_string_equal(sweep_plan_value(&p, 0, 47), "4");
    assert_string_equal(sweep_plan_value(&p, 3, 1), "12");
    /* Every point has its turn once; the crop changes once, the density once within each. */
    bool seen[48] = {false};
    int crops = 0, densities = 0;
    for (uint64_t turn = 0; turn < 48; turn++) {
        uint64_t point = sweep_plan_turn(&p, turn);
        assert_true(point < 48 && !seen[point]);
        seen[point] = true;
        if (turn) {
            uint64_t last = sweep_plan_turn(&p, turn - 1);
            crops += strcmp(sweep_plan_value(&p, 1, point), sweep_plan_value(&p, 1, last)) != 0;
            densities += strcmp(sweep_plan_value(&p, 3, point), sweep_plan_value(&p, 3, last)) != 0;
        }
    }
    assert_int_equal(crops, 1);
    assert_int_equal(densities, 3);
    sweep_plan_free(&p);
}

/* ---- rows ---- */

static void test_csv(void **state)
{
    (void)state;
    static const char *const values[] = {"", "plain", "a,b", "say \"so\"", "\"", ",", "", "last, \"quoted\""};
    enum { VALUES = sizeof values / sizeof *values };
    char *line, *fields[VALUES];
    size_t size;
    FILE *file = open_memstream(&line, &size);
    assert_non_null(file);
    for (size_t i = 0; i < VALUES; i++) {
        if (i)
            putc(',', file);
        csv_put(file, values[i]);
    }
    fclose(file);
    assert_int_equal(csv_split(line, fields, VALUES), VALUES);
    for (size_t i = 0; i < VALUES; i++)
        assert_string_equal(fields[i], values[i]);
    free(line);
    char broken[] = "1,\"a\"b,c";
    assert_int_not_equal(csv_split(broken, fields, VALUES), 3);
}

/* ---- fronts ---- */

static bool is_beaten(const double *values, size_t points, const sweep_objectives *o, size_t i)
{
    for (size_t j = 0; j < points; j++) {
        bool as_good = true, better = false;
        for (size_t k = 0; k < o->count; k++) {
            double a = values[j * o->count + k], b = values[i * o->count + k];
            as_good = as_good && (o->largest[k] ? a >= b : a <= b);
            better = better || a != b;
        }
        if (as_good && better)
            return true;
    }
    return false;
}

static void test_front(void **state)
{
    (void)state;
    enum { MOST = 200 };
    static double values[MOST * SWEEP_OBJECTIVES];
    rng c = {7};
    for (int round = 0; round < 400; round++) {
        sweep_objectives o = {.count = (size_t)rng_int(&c, 1, 5)};
        const size_t points = (size_t)rng_int(&c, 0, MOST);
        const int64_t levels = rng_int(&c, 2, 31);
        bool marks[MOST];
        host_error error;
        for (size_t k = 0; k < o.count; k++)
            o.largest[k] = rng_one_in(&c, 2);
        for (size_t i = 0; i < points * o.count; i++)
            values[i] = rng_one_in(&c, 40) ? NAN : (double)rng_int(&c, -3, levels);
        assert_int_equal(sweep_front(values, points, &o, marks, &error), HOST_OK);
        for (size_t i = 0; i < points; i++) {
            bool missing = false;
            for (size_t k = 0; k < o.count; k++)
                missing = missing || isnan(values[i * o.count + k]);
            assert_int_equal(marks[i], !missing && !is_beaten(values, points, &o, i));
        }
    }
}

/* ---- files ---- */

static host_status open_one(sweep_file *f, const char *path, const sweep_plan *p, const char *head, host_error *error)
{
    return sweep_file_open(f, path, strdup(head), strdup("point,text\n"), 2, p, 0, error);
}

static void draw_in_child(const char *path, const sweep_plan *p, bool dies)
{
    sweep_file f;
    host_error error;
    uint64_t point;
    bool more = true, good = open_one(&f, path, p, "# {}\n", &error) == HOST_OK;
    for (int i = 0; good && more; i++) {
        char line[32];
        good = sweep_file_claim(&f, &point, &more, &error) == HOST_OK;
        if (dies && i == 3)
            _exit(0);                                            /* with a claim, as if killed */
        nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL); /* another's chance to draw the same point */
        snprintf(line, sizeof line, "%d,x\n", (int)point);
        if (good && more)
            good = sweep_file_append(&f, point, line, &error) == HOST_OK;
    }
    _exit(good ? 0 : 1);
}

/* Each point is written once, whoever dies in between. */
static void test_claims(void **state)
{
    (void)state;
    enum { CHILDREN = 4, POINTS = 60 };
    char path[] = "/tmp/vodr-test-sweep-XXXXXX";
    host_error error;
    sweep_plan p = {.axis_count = 1, .axes = {{.names = 1, .count = POINTS}}};
    assert_int_equal(sweep_plan_close(&p, &error), HOST_OK);
    close(mkstemp(path));
    for (int i = 0; i < CHILDREN; i++)
        if (fork() == 0)
            draw_in_child(path, &p, i == 1);
    for (int i = 0; i < CHILDREN; i++) {
        int status;
        wait(&status);
        assert_int_equal(status, 0);
    }
    sweep_file f;
    assert_int_equal(open_one(&f, path, &p, "# {}\n", &error), HOST_OK);
    assert_int_equal(f.found, POINTS);
    assert_int_equal(f.read_bytes - f.rows_at, 10 * 4 + 50 * 5);
    sweep_file_close(&f);
    assert_int_equal(open_one(&f, path, &p, "# {\"other\"}\n", &error), HOST_BAD_INPUT);
    sweep_file_close(&f);
    unlink(path);
}

/* ---- costs ---- */

static cost_tables tables_of(const char *energy)
{
    cost_tables tables = {0};
    host_error error;
    assert_int_equal(energy_parse(energy, "test", &tables.energy, &error), HOST_OK);
    return tables;
}

static void test_bits(void **state)
{
    (void)state;
    const vodr_view v = {.width_px = 100, .height_px = 64, .slices = 1};
    const vodr_counters none = {0};
    const cost_tables e = tables_of("");
    vodr_machine m = unit_machine("line_px=16x1 cache_bytes=4096 ways=4 texture_memory_bytes=1000 fragment_fifo=32");
    costs c = costs_of(&m, &v, &none, &e);
    assert_int_equal(c.cache_data_bits, 32768);
    /* 64 lines in 16 sets; 4x2 tiles of 64 lines: 512 numbers, 32 a set: 5 bits, valid, dirty, 2 of age. */
    assert_int_equal(c.cache_tag_bits, 64 * (5 + 1 + 1 + 2));
    assert_int_equal(c.texture_bits, 8000);
    assert_int_equal(c.table_bits, 256 * 32);
    /* 32 fragments of 32 + 7 + 6 bits; a line and its number in the write buffer. */
    assert_int_equal(c.fifo_bits, 32 * 45 + 512 + 9);
    assert_int_equal(c.touch_bits, 0);
    assert_int_equal(costs_onchip_bits(&c), 32768 + 576 + 8000 + 8192 + 1961);
    m = unit_machine(
        "line_px=4x4 ways=1 replacement=random write_policy=through clear_on_first_touch=1 fb_layout=linear "
        "write_fifo=3 traversal=whole mem_latency_cycles=10 nonblocking=1 nonblocking_fifo=5 "
        "nonblocking_misses=2 fb_bits=16");
    c = costs_of(&m, &v, &none, &e);
    /* 25x16 lines, 32 sets: 13 a set. 64 bits a pixel. */
    assert_int_equal(c.cache_tag_bits, 32 * (4 + 1) + 16);
    assert_int_equal(c.texture_bits, 0);
    assert_int_equal(c.touch_bits, 400);
    assert_int_equal(c.fifo_bits, (32 + 10 + 5) * 77 + 2 * 9 + 3 * 77);
    m.pipelines = 3;
    c = costs_of(&m, &v, &none, &e);
    assert_int_equal(c.cache_data_bits, 3 * 32768);
    assert_int_equal(c.cache_tag_bits, 3 * (32 * (4 + 1) + 16));
    assert_int_equal(c.table_bits, 3 * 256 * 64);
    assert_int_equal(c.touch_bits, 400);
    assert_int_equal(c.fifo_bits, 3 * ((32 + 10 + 5) * 77 + 2 * 9 + 3 * 77));
}

static void test_energy(void **state)
{
    (void)state;
    const vodr_view v = {.width_px = 32, .height_px = 32, .slices = 1};
    const vodr_counters n = {.fragments = 100,
                             .killed_fragments = 20,
                             .hits = 70,
                             .misses = 10,
                             .fb_read_bytes = 640,
                             .fb_write_bytes = 320,
                             .texture_load_bytes = 800};
    vodr_machine m = unit_machine("cache_bytes=8192 texture_memory_bytes=32768 ways=4 line_px=16x1");
    cost_tables e = tables_of("# only memory\nadd|0\n multiply | 0\nsram_word | 8 | x\ndram_byte|2\n");
    costs c = costs_of(&m, &v, &n, &e);
    assert_int_equal(costs_offchip_bytes(&c), 1760);
    assert_true(c.offchip_pj == 3520);
    /* 80 reads and 80 writes of 4 bytes, lines in and out; 1 pJ a byte. Then 4 tags of 1+1+1+2 bits from 80 bytes. */
    assert_true(fabs(c.cache_pj - (640 + 960 + 80 * 2.5 * sqrt(80.0 / 8192))) < 1e-9);
    assert_true(c.texture_pj == 2 * (800 + 800));
    assert_true(fabs(c.table_pj - 400 * sqrt(1024.0 / 8192)) < 1e-9);
    assert_true(c.arithmetic_pj == 0);
    m.pipelines = 4; /* as many accesses, of memories as large */
    costs four = costs_of(&m, &v, &n, &e);
    assert_true(costs_energy_pj(&four) == costs_energy_pj(&c) && four.texture_bits == 4 * c.texture_bits);
    e = tables_of("add | 8\nmultiply | 0\n");
    c = costs_of(&m, &v, &n, &e);
    /* An addition of n bits is n pJ: 3 positions of 43, 7 interpolations of 2*12; blends of 4*(2*16 + 8). */
    assert_true(c.arithmetic_pj == 100 * (129 + 168) + 80 * 160);
    e = tables_of("add | 0\nmultiply | 64\n");
    c = costs_of(&m, &v, &n, &e);
    assert_true(c.arithmetic_pj == 100 * 7 * 12 * 8 + 80 * 4 * 64);
    static const char *const wrong[] = {"add", "sum | 1", "add | x", "add | -1", "add | 1\nadd | 2"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        host_error error;
        assert_int_equal(energy_parse(wrong[i], "test", &e.energy, &error), HOST_BAD_INPUT);
        assert_non_null(strstr(error.text, i == 4 ? "test:2" : "test:1"));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_plan),   cmocka_unit_test(test_csv),  cmocka_unit_test(test_front),
        cmocka_unit_test(test_claims), cmocka_unit_test(test_bits), cmocka_unit_test(test_energy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
