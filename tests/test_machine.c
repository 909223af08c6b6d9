/* test_machine.c - machine files, --set, the named machines, and which combinations can be built. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lib/unit.h"

static void assert_same(const vodr_machine *a, const vodr_machine *b)
{
    assert_memory_equal(a, b, sizeof *a);
}

static vodr_machine parse(const char *text)
{
    vodr_machine m;
    vodr_error error;
    if (vodr_machine_parse(text, "my.txt", &m, &error) != VODR_OK)
        fail_msg("%s", error.text);
    return m;
}

/* The sentence must be as given, and the machine must stay as it was. */
static void assert_parse_fails(const char *text, const char *sentence)
{
    vodr_machine before = unit_machine("ways=2 line_px=8x8"), m = before;
    vodr_error error;
    assert_int_equal(vodr_machine_parse(text, "my.txt", &m, &error), VODR_INVALID);
    assert_string_equal(error.text, sentence);
    assert_int_equal(vodr_machine_parse(text, "my.txt", &m, NULL), VODR_INVALID);
    assert_same(&m, &before);
}

static void assert_set_fails(const char *name, const char *value, const char *sentence)
{
    vodr_machine before = vodr_machine_default(), m = before;
    vodr_error error;
    assert_int_equal(vodr_machine_set(&m, name, value, &error), VODR_INVALID);
    assert_string_equal(error.text, sentence);
    assert_same(&m, &before);
}

static void files(void **state)
{
    (void)state;
    vodr_machine plain = vodr_machine_default(), two = unit_machine("ways=2 line_px=4x4 traversal=tile");
    vodr_machine empty = parse(""), comments = parse("# nothing\n\n   \t\n  # ways = 8\n#"), m;
    assert_same(&empty, &plain);
    assert_same(&comments, &plain);
    m = parse("ways = 2\nline_px = 4x4\ntraversal = tile\n");
    assert_same(&m, &two);
    m = parse("\n  ways=2 # two lines a set\n\tline_px\t=\t4x4   \ntraversal = tile# no final newline");
    assert_same(&m, &two);
    m = parse("ways = 2\r\nline_px = 4x4\r\n\r\n# comment\r\ntraversal = tile\r\n");
    assert_same(&m, &two);
}

static void wrong_files(void **state)
{
    (void)state;
    assert_parse_fails("\nways 2\n", "my.txt:2: 'ways 2' is not of the form name = value");
    assert_parse_fails("ways = 2\nways = 2", "my.txt:2: ways is set a second time");
    assert_parse_fails("ways = 2\nmodel = T", "my.txt:2: the machine has no parameter 'model' (`vodr machine show` "
                                              "lists them)");
    assert_parse_fails("ways = 2 4", "my.txt:1: ways is '2 4' but must be a power of two from 1 to 1024");
    assert_parse_fails("ways =", "my.txt:1: ways is '' but must be a power of two from 1 to 1024");
    assert_parse_fails("= 2", "my.txt:1: the machine has no parameter '' (`vodr machine show` lists them)");
    assert_parse_fails("ways = 2 = 2", "my.txt:1: ways is '2 = 2' but must be a power of two from 1 to 1024");
}

/* Lines may have 255 characters; a longer one is refused, comment or not. */
static void long_lines(void **state)
{
    (void)state;
    static char text[20000];
    memset(text, 'x', sizeof text);
    memcpy(text, "ways = 2 #", 10);
    text[255] = '\0';
    vodr_machine m = parse(text);
    assert_int_equal(m.ways, 2);
    text[255] = 'x';
    text[256] = '\n';
    text[257] = '\0';
    assert_parse_fails(text, "my.txt:1: the line has 256 characters, at most 255 are read");
    text[256] = 'x';
    text[257] = 'x';
    text[sizeof text - 1] = '\0';
    assert_parse_fails(text, "my.txt:1: the line has 19999 characters, at most 255 are read");
    memset(text, 'x', 200); /* names and values far too long are cut in the sentence, not written past it */
    text[200] = '=';
    text[201] = '\0';
    vodr_error error;
    assert_int_equal(vodr_machine_parse(text, "my.txt", &m, &error), VODR_INVALID);
    assert_non_null(strstr(error.text, "has no parameter 'xxxx"));
}

static void values_out_of_range(void **state)
{
    (void)state;
    assert_set_fails("ways", "3", "ways is '3' but must be a power of two from 1 to 1024");
    assert_set_fails("ways", "0", "ways is '0' but must be a power of two from 1 to 1024");
    assert_set_fails("ways", "-4", "ways is '-4' but must be a power of two from 1 to 1024");
    assert_set_fails("ways", "2048", "ways is '2048' but must be a power of two from 1 to 1024");
    assert_set_fails("ways", " 4", "ways is ' 4' but must be a power of two from 1 to 1024");
    assert_set_fails("ways", "4k", "ways is '4k' but must be a power of two from 1 to 1024");
    assert_set_fails("ways", "4.0", "ways is '4.0' but must be a power of two from 1 to 1024");
    assert_set_fails("ways", "+4", "ways is '+4' but must be a power of two from 1 to 1024");
    assert_set_fails("ways", "0x4", "ways is '0x4' but must be a power of two from 1 to 1024");
    assert_set_fails("ways", "4294967300", "ways is '4294967300' but must be a power of two from 1 to 1024");
    assert_set_fails("brick", "4097", "brick is '4097' but must be an integer from 0 to 4096");
    assert_set_fails("brick", "99999999999999999999",
                     "brick is '99999999999999999999' but must be an integer from 0 to 4096");
    assert_set_fails("density_bits", "10", "density_bits is '10' but must be one of 8,12");
    assert_set_fails("blend", "Over", "blend is 'Over' but must be one of over,under,mip");
    assert_set_fails("blend", "0", "blend is '0' but must be one of over,under,mip");
    assert_set_fails("line_px", "16", "line_px is '16' but must be WIDTHxHEIGHT, powers of two from 1 to 32");
    assert_set_fails("line_px", "16x", "line_px is '16x' but must be WIDTHxHEIGHT, powers of two from 1 to 32");
    assert_set_fails("line_px", "x16", "line_px is 'x16' but must be WIDTHxHEIGHT, powers of two from 1 to 32");
    assert_set_fails("line_px", "64x1", "line_px is '64x1' but must be WIDTHxHEIGHT, powers of two from 1 to 32");
    assert_set_fails("line_px", "4x4x4", "line_px is '4x4x4' but must be WIDTHxHEIGHT, powers of two from 1 to 32");
    assert_set_fails("line_px", "3x4", "line_px is '3x4' but must be WIDTHxHEIGHT, powers of two from 1 to 32");
    assert_set_fails("line_px", "0x4", "line_px is '0x4' but must be WIDTHxHEIGHT, powers of two from 1 to 32");
    assert_set_fails("line_px", "4x0", "line_px is '4x0' but must be WIDTHxHEIGHT, powers of two from 1 to 32");
    assert_set_fails("line_px", "4x64", "line_px is '4x64' but must be WIDTHxHEIGHT, powers of two from 1 to 32");
    assert_set_fails("line_px", "4x3", "line_px is '4x3' but must be WIDTHxHEIGHT, powers of two from 1 to 32");
    assert_set_fails("line_px", "00000000000000016x1",
                     "line_px is '00000000000000016x1' but must be WIDTHxHEIGHT, powers of two from 1 to 32");
    assert_set_fails("pipelines", "0", "pipelines is '0' but must be an integer from 1 to 16");
    assert_set_fails("texture_memory_bytes", "1",
                     "texture_memory_bytes is '1' but must be an integer from 64 to 1073741824");
    assert_set_fails("a\nb\x7f", "4", "the machine has no parameter 'a?b?' (`vodr machine show` lists them)");
    assert_set_fails("Ways", "4", "the machine has no parameter 'Ways' (`vodr machine show` lists them)");
}

/* Every value of every parameter can be set, read back, and set again. */
static void every_parameter_goes_round(void **state)
{
    (void)state;
    size_t count;
    const vodr_parameter *parameters = vodr_parameters(&count);
    assert_true(count > 20);
    for (size_t i = 0; i < count; i++) {
        const vodr_parameter *p = &parameters[i];
        char text[32], back[32];
        vodr_machine m = vodr_machine_default(), copy = m;
        vodr_machine_get(&m, p, text, sizeof text);
        assert_string_equal(text, p->fallback);
        for (int64_t value = p->lo; p->kind == VODR_KIND_RANGE || p->kind == VODR_KIND_POW2; value = p->hi) {
            snprintf(text, sizeof text, "%lld", (long long)value);
            assert_int_equal(vodr_machine_set(&m, p->name, text, NULL), VODR_OK);
            vodr_machine_get(&m, p, back, sizeof back);
            assert_string_equal(text, back);
            if (value == p->hi)
                break;
        }
        for (size_t n = 0; p->choices && p->choices[n]; n++) {
            assert_int_equal(vodr_machine_set(&m, p->name, p->choices[n], NULL), VODR_OK);
            vodr_machine_get(&m, p, back, sizeof back);
            assert_string_equal(p->choices[n], back);
        }
        /* Nothing but the field itself has changed. */
        size_t bytes = p->kind == VODR_KIND_SHAPE ? sizeof(vodr_shape) : sizeof(int32_t);
        memcpy((char *)&copy + p->offset, (const char *)&m + p->offset, bytes);
        assert_same(&copy, &m);
    }
}

static void named_machines(void **state)
{
    (void)state;
    static const char *const names[] = {"paper-16", "paper-32", "paper-general"};
    static const char *const settings[] = {"traversal=layer line_px=16x1", "traversal=layer line_px=32x1",
                                           "traversal=whole line_px=16x1"};
    const char *common = "cache_bytes=4096 ways=4 replacement=lru index=modulo fb_layout=tiled write_policy=back "
                         "clear_on_first_touch=0 kill_transparent=0 skip_empty=0 fb_bits=8 tf_bits=8 density_bits=8 "
                         "weight_bits=8 guard_bits=4 brick=0 brick_min=8 texture_memory_bytes=262144 "
                         "double_buffer=1 nonblocking=0 memory=fixed mem_latency_cycles=50 mem_bus_bytes=16 ";
    for (int i = 0; i < 3; i++) {
        char all[512];
        vodr_machine m;
        vodr_error error;
        snprintf(all, sizeof all, "%s%s", common, settings[i]);
        vodr_machine want = unit_machine(all);
        assert_int_equal(vodr_machine_named(names[i], &m, &error), VODR_OK);
        assert_same(&m, &want);
        assert_int_equal(vodr_machine_check(&m, &error), VODR_OK);
    }
    size_t count = 0, parameter_count;
    const vodr_parameter *parameters = vodr_parameters(&parameter_count);
    for (; vodr_machine_name(count); count++) {
        vodr_machine m;
        assert_true(count == 0 || strcmp(vodr_machine_name(count - 1), vodr_machine_name(count)) < 0);
        assert_non_null(vodr_machine_text(vodr_machine_name(count)));
        assert_int_equal(vodr_machine_named(vodr_machine_name(count), &m, NULL), VODR_OK);
        assert_int_equal(vodr_machine_check(&m, NULL), VODR_OK);
        /* They differ in organisation alone. */
        for (size_t i = 0; i < parameter_count; i++) {
            char value[32];
            vodr_machine_get(&m, &parameters[i], value, sizeof value);
            if (parameters[i].picture)
                assert_string_equal(value, parameters[i].fallback);
        }
    }
    assert_true(count >= 3);
    vodr_machine m;
    vodr_error error;
    assert_null(vodr_machine_text("paper"));
    assert_int_equal(vodr_machine_named("paper", &m, &error), VODR_INVALID);
    assert_non_null(strstr(error.text, "there is no machine 'paper'; the named machines are "));
    assert_non_null(strstr(error.text, "paper-16, paper-32, paper-general"));
}

static void assert_check_fails(vodr_machine m, const char *sentence)
{
    vodr_error error;
    assert_int_equal(vodr_machine_check(&m, &error), VODR_INVALID);
    assert_string_equal(error.text, sentence);
}

static void what_can_be_built(void **state)
{
    (void)state;
    vodr_machine m = unit_machine("cache_bytes=64 ways=1 line_px=16x1");
    assert_int_equal(vodr_machine_check(&m, NULL), VODR_OK);
    assert_check_fails(unit_machine("cache_bytes=64 ways=2 line_px=16x1"),
                       "cache_bytes=64 is not a multiple of a set: ways=2 lines of 64 bytes (line_px=16x1, fb_bits=8) "
                       "are 128 bytes");
    assert_check_fails(unit_machine("cache_bytes=64 ways=1 line_px=16x1 fb_bits=16"),
                       "cache_bytes=64 is not a multiple of a set: ways=1 lines of 128 bytes (line_px=16x1, "
                       "fb_bits=16) are 128 bytes");
    assert_check_fails(unit_machine("cache_bytes=64 ways=1024 line_px=32x32 fb_bits=16"),
                       "cache_bytes=64 is not a multiple of a set: ways=1024 lines of 8192 bytes (line_px=32x32, "
                       "fb_bits=16) are 8388608 bytes");
}

/* Machines that were not made by set() or parse() may hold anything. */
static void any_bytes_are_checked(void **state)
{
    (void)state;
    size_t count;
    const vodr_parameter *parameters = vodr_parameters(&count);
    static const int32_t wrong[] = {INT32_MIN, -1, 3000000, INT32_MAX};
    for (size_t i = 0; i < count; i++)
        for (size_t n = 0; n < sizeof wrong / sizeof *wrong; n++) {
            if (wrong[n] >= parameters[i].lo && wrong[n] <= parameters[i].hi && parameters[i].kind == VODR_KIND_RANGE)
                continue;
            vodr_machine m = vodr_machine_default();
            vodr_error error;
            memcpy((char *)&m + parameters[i].offset, &wrong[n], sizeof wrong[n]);
            assert_int_equal(vodr_machine_check(&m, &error), VODR_INVALID);
            assert_ptr_equal(strstr(error.text, parameters[i].name), error.text);
        }
    rng c = {71};
    for (int round = 0; round < 10000; round++) {
        vodr_machine m;
        for (size_t i = 0; i < sizeof m; i++)
            ((unsigned char *)&m)[i] = (unsigned char)rng_next(&c);
        assert_int_equal(vodr_machine_check(&m, NULL), VODR_INVALID);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files),
        cmocka_unit_test(wrong_files),
        cmocka_unit_test(long_lines),
        cmocka_unit_test(values_out_of_range),
        cmocka_unit_test(every_parameter_goes_round),
        cmocka_unit_test(named_machines),
        cmocka_unit_test(what_can_be_built),
        cmocka_unit_test(any_bytes_are_checked),
    };
    return cmocka_run_group_tests_name("machine", tests, NULL, NULL);
}
