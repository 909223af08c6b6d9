/* volume_fixture.c - for the tests of volumes: files in a directory of their own, and what must be read from them. */
#include "volume_fixture.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

int fixture_make(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    const char *parent = getenv("TMPDIR");
    snprintf(f->directory, sizeof f->directory, "%s/vodr-volume-XXXXXX", parent ? parent : "/tmp");
    *state = f;
    return mkdtemp(f->directory) ? 0 : -1;
}

int fixture_remove(void **state)
{
    fixture *f = *state;
    DIR *directory = opendir(f->directory);
    for (struct dirent *entry; directory && (entry = readdir(directory));) {
        snprintf(f->path, sizeof f->path, "%s/%.200s", f->directory, entry->d_name);
        unlink(f->path);
    }
    closedir(directory);
    rmdir(f->directory);
    free(f);
    return 0;
}

const char *put(fixture *f, const char *name, const void *header, size_t header_bytes, const void *data, size_t bytes,
                bool zip)
{
    snprintf(f->path, sizeof f->path, "%s/%s", f->directory, name);
    FILE *file = fopen(f->path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(header, 1, header_bytes, file), header_bytes);
    if (!zip)
        assert_int_equal(fwrite(data, 1, bytes, file), bytes);
    fclose(file);
    if (zip) {
        gzFile stream = gzopen(f->path, "ab");
        assert_int_equal(gzwrite(stream, data, (unsigned)bytes), bytes);
        gzclose(stream);
    }
    return f->path;
}

const char *put_text(fixture *f, const char *name, const char *text, const void *data, size_t bytes)
{
    return put(f, name, text, strlen(text), data, bytes, false);
}

double pattern(int i)
{
    return (i * 37) % COUNT * 2;
}

size_t encode(volume_type type, bool big, bool float64, unsigned char *out)
{
    size_t bytes = float64 ? 8 : volume_type_bytes(type);
    for (int i = 0; i < COUNT; i++) {
        double wide = pattern(i);
        float single = (float)wide;
        uint32_t number = (uint32_t)wide;
        uint64_t bits = number;
        if (float64)
            memcpy(&bits, &wide, 8);
        else if (type == VOLUME_FLOAT32)
            memcpy(&number, &single, 4), bits = number;
        for (size_t b = 0; b < bytes; b++)
            out[(size_t)i * bytes + b] = (unsigned char)(bits >> 8 * (big ? bytes - 1 - b : b));
    }
    return COUNT * bytes;
}

void open_ok(const char *path, const volume_options *options, volume *v)
{
    host_error error = {""};
    volume_options none = {0};
    if (volume_open(path, options ? options : &none, v, &error) != HOST_OK)
        fail_msg("%s", error.text);
}

void check_pattern(const char *path, const volume_options *options, volume_type type, const char *format)
{
    volume v;
    open_ok(path, options, &v);
    assert_int_equal(v.dims_vox[0], W);
    assert_int_equal(v.dims_vox[1], H);
    assert_int_equal(v.dims_vox[2], D);
    assert_int_equal(v.type, type);
    assert_string_equal(v.format, format);
    for (int i = 0; i < COUNT; i++)
        assert_true(volume_value(&v, (size_t)i) == pattern(i));
    assert_true(v.min == 0 && v.max == 2 * (COUNT - 1) && v.nonfinite == 0);
    volume_close(&v);
}

void refused(const char *path, const volume_options *options, const char *part)
{
    volume v;
    host_error error = {""};
    volume_options none = {0};
    assert_int_equal(volume_open(path, options ? options : &none, &v, &error), HOST_BAD_INPUT);
    if (!strstr(error.text, part))
        fail_msg("'%s' lacks '%s'", error.text, part);
    assert_null(strchr(error.text, '\n'));
    assert_null(v.voxels);
}

void check_geometry(const char *path, const volume_options *options, const double spacing[3], const int axis[3],
                    const int sign[3])
{
    volume v;
    open_ok(path, options, &v);
    for (int i = 0; i < 3; i++) {
        assert_true(fabs(v.spacing[i] - spacing[i]) < 1e-5);
        assert_int_equal(v.axis[i], axis[i]);
        assert_int_equal(v.sign[i], sign[i]);
    }
    volume_close(&v);
}
