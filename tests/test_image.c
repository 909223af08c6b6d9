/* test_image.c - PNG written and read back, raw bytes, the digest, and outputs that appear whole or not at all. */
#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <cmocka.h>

#include "digest.h"
#include "image.h"

static char directory[] = "/tmp/vodr-image-XXXXXX";
static char path[64];

static int set_up(void **state)
{
    (void)state;
    if (!mkdtemp(directory))
        return -1;
    snprintf(path, sizeof path, "%s/picture.png", directory);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    unlink(path);
    return rmdir(directory);
}

static int files_in_directory(void)
{
    DIR *d = opendir(directory);
    int count = 0;
    for (struct dirent *entry; (entry = readdir(d)) != NULL;)
        count += entry->d_name[0] != '.' || strlen(entry->d_name) > 2;
    closedir(d);
    return count;
}

static void write_and_read(const vodr_frame *frame, const image_style *style, image *picture)
{
    output o;
    host_error error;
    assert_int_equal(output_open(&o, path, &error), HOST_OK);
    assert_int_equal(image_write_png(&o, frame, style, &error), HOST_OK);
    assert_int_equal(output_close(&o, &error), HOST_OK);
    assert_int_equal(output_commit(&o, &error), HOST_OK);
    output_discard(&o);
    assert_int_equal(files_in_directory(), 1);
    assert_int_equal(image_read_png(path, picture, &error), HOST_OK);
    assert_int_equal(picture->width_px, frame->width_px);
    assert_int_equal(picture->height_px, frame->height_px);
}

static void test_over_background_8(void **state)
{
    (void)state;
    uint8_t pixels[] = {0, 0, 0, 0, 255, 255, 255, 255, 100, 50, 0, 128, 10, 20, 30, 255};
    vodr_frame frame = {2, 2, 8, pixels, sizeof pixels};
    image picture;
    write_and_read(&frame, &(image_style){.background = {200, 0, 255}}, &picture);
    assert_false(picture.has_alpha);
    /* 100 + 200*127/255 = 199.6; 50; 255*127/255 = 127 */
    const uint16_t expected[] = {200, 0, 255, 255, 255, 255, 255, 255, 200, 50, 127, 255, 10, 20, 30, 255};
    for (int i = 0; i < 16; i++)
        assert_int_equal(picture.rgba[i], expected[i] * 257);
    image_free(&picture);
}

static void test_straight_alpha_16(void **state)
{
    (void)state;
    uint16_t pixels[] = {1000, 0, 3, 2000, 0, 0, 0, 0, 65535, 65534, 1, 65535};
    vodr_frame frame = {3, 1, 16, pixels, sizeof pixels};
    image picture;
    write_and_read(&frame, &(image_style){.alpha = true}, &picture);
    assert_true(picture.has_alpha);
    /* 1000*65535/2000 = 32767.5; 3*65535/2000 = 98.3 */
    const uint16_t expected[] = {32768, 0, 98, 2000, 0, 0, 0, 0, 65535, 65534, 1, 65535};
    assert_memory_equal(picture.rgba, expected, sizeof expected);
    image_free(&picture);
}

static void test_raw_and_digest(void **state)
{
    (void)state;
    uint16_t pixels[] = {0x0102, 0x0304, 0x0506, 0x0708};
    vodr_frame frame = {1, 1, 16, pixels, sizeof pixels};
    uint8_t bytes[8];
    assert_int_equal(image_raw_row_bytes(&frame), 8);
    image_raw_row(&frame, 0, bytes);
    assert_memory_equal(bytes, "\2\1\4\3\6\5\10\7", 8);
    uint8_t abcd[] = "abcd";
    char hex[DIGEST_CHARS];
    vodr_frame small = {1, 1, 8, abcd, 4};
    assert_int_equal(digest_frame(&small, hex, NULL), HOST_OK);
    assert_string_equal(hex, "88d4266fd4e6338d13b845fcf289579d209c897823b9217da3e161936f031589");
}

static void test_nothing_half_written(void **state)
{
    (void)state;
    output o;
    assert_int_equal(output_open(&o, path, NULL), HOST_OK);
    fputs("half", o.file);
    output_discard(&o);
    assert_int_equal(files_in_directory(), 1); /* what the tests before left, unchanged */
    image picture;
    assert_int_equal(image_read_png(path, &picture, NULL), HOST_OK);
    image_free(&picture);
    assert_int_equal(output_open(&o, "/dev/full", NULL), HOST_OK);
    fputs("lost", o.file);
    assert_int_equal(output_close(&o, NULL), HOST_ENVIRONMENT);
    output_discard(&o);
}

static void test_unwritable(void **state)
{
    (void)state;
    host_error error;
    static const char *const paths[] = {"", "/", "/no/such/directory/x", "/dev/null/x", "/tmp/"};
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        assert_int_equal(output_check(paths[i], &error), HOST_ENVIRONMENT);
        assert_non_null(strstr(error.text, paths[i]));
    }
    assert_int_equal(output_check(path, &error), HOST_OK);
    assert_int_equal(output_check("/dev/null", &error), HOST_OK);
}

/* A link is followed, not replaced. */
static void test_link(void **state)
{
    (void)state;
    char link_path[80];
    struct stat info;
    output o;
    snprintf(link_path, sizeof link_path, "%s/link", directory);
    assert_int_equal(symlink(path, link_path), 0);
    assert_int_equal(output_open(&o, link_path, NULL), HOST_OK);
    fputs("12345", o.file);
    assert_int_equal(output_close(&o, NULL), HOST_OK);
    assert_int_equal(output_commit(&o, NULL), HOST_OK);
    output_discard(&o);
    assert_int_equal(lstat(link_path, &info), 0);
    assert_true(S_ISLNK(info.st_mode));
    assert_int_equal(stat(path, &info), 0);
    assert_int_equal(info.st_size, 5);
    unlink(link_path);
}

/* Every proper prefix of a PNG, and files that are none, are refused in one sentence. */
static void test_bad_png(void **state)
{
    (void)state;
    uint8_t pixels[64] = {0}, bytes[512];
    vodr_frame frame = {4, 4, 8, pixels, sizeof pixels};
    image picture;
    host_error error;
    write_and_read(&frame, &(image_style){.alpha = true}, &picture);
    image_free(&picture);
    FILE *file = fopen(path, "rb");
    size_t size = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    assert_true(size < sizeof bytes);
    for (size_t n = 0; n < size; n++) {
        file = fopen(path, "wb");
        fwrite(bytes, 1, n, file);
        fclose(file);
        assert_int_equal(image_read_png(path, &picture, &error), HOST_BAD_INPUT);
        assert_non_null(strstr(error.text, path));
        assert_null(picture.rgba);
    }
    assert_int_equal(image_read_png("/tmp", &picture, &error), HOST_BAD_INPUT);
    assert_int_equal(image_read_png("/no/such/file", &picture, &error), HOST_BAD_INPUT);
}

static void put_number(uint8_t bytes[4], uint32_t number)
{
    for (int i = 0; i < 4; i++)
        bytes[i] = (uint8_t)(number >> (24 - 8 * i));
}

static void refused_at_once(const uint8_t *bytes, size_t size, const char *part)
{
    image picture;
    host_error error;
    FILE *file = fopen(path, "wb");
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    fclose(file);
    assert_int_equal(image_read_png(path, &picture, &error), HOST_BAD_INPUT);
    if (!strstr(error.text, part))
        fail_msg("'%s' lacks '%s'", error.text, part);
}

/* A header that names more pixels, and a chunk that names more bytes, than the file can hold. Neither takes memory. */
static void test_png_bombs(void **state)
{
    (void)state;
    uint8_t bytes[64] = "\x89PNG\r\n\x1a\n\0\0\0\rIHDR";
    put_number(bytes + 16, 32767);
    put_number(bytes + 20, 32767);
    memcpy(bytes + 24, (const uint8_t[]){8, 6, 0, 0, 0}, 5);
    put_number(bytes + 29, (uint32_t)crc32(0, bytes + 12, 17));
    memcpy(bytes + 33, "\0\0\0\4IDAT", 8);
    refused_at_once(bytes, sizeof bytes, "too short");
    put_number(bytes + 16, 4);
    put_number(bytes + 20, 4);
    put_number(bytes + 29, (uint32_t)crc32(0, bytes + 12, 17));
    memcpy(bytes + 33, "\x48\0\0\0sPLT", 8);
    refused_at_once(bytes, sizeof bytes, "Read Error");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_over_background_8), cmocka_unit_test(test_straight_alpha_16),
        cmocka_unit_test(test_raw_and_digest),    cmocka_unit_test(test_nothing_half_written),
        cmocka_unit_test(test_unwritable),        cmocka_unit_test(test_link),
        cmocka_unit_test(test_bad_png),           cmocka_unit_test(test_png_bombs),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
