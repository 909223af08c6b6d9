/* support.c - what the fuzz targets share: files in memory, and what must hold of volumes and transfer functions. */
#define _GNU_SOURCE /* memfd_create() */
#include "fuzz.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "volume.h"

void fuzz_check(bool holds, const char *promise)
{
    if (holds)
        return;
    fprintf(stderr, "broken: %s\n", promise);
    abort();
}

void fuzz_open(fuzz_file *file, const uint8_t *data, size_t size)
{
    file->descriptor = memfd_create("fuzz", 0);
    fuzz_check(file->descriptor >= 0 && write(file->descriptor, data, size) == (ssize_t)size, "a file can be written");
    snprintf(file->path, sizeof file->path, "/proc/self/fd/%d", file->descriptor);
}

void fuzz_close(fuzz_file *file)
{
    close(file->descriptor);
}

char *fuzz_text(const uint8_t *data, size_t size)
{
    return memchr(data, '\0', size) ? NULL : strndup((const char *)data, size);
}

void fuzz_refused(host_status status, const char *sentence)
{
    fuzz_check(status == HOST_BAD_INPUT, "bad input has the code of bad input");
    fuzz_check(sentence[0] != 0, "a failure has a sentence");
    for (const char *c = sentence; *c; c++)
        fuzz_check(*c >= 0x20 && *c <= 0x7e, "a sentence is one line of printable ASCII");
}

static void look_at(volume *v)
{
    host_error error = {""};
    vodr_volume densities;
    for (size_t i = 0, n = volume_count(v); i < n; i++) {
        double value = volume_value(v, i);
        fuzz_check(value >= v->min && value <= v->max, "values lie in the range");
    }
    int axes = (1 << v->axis[0]) + (1 << v->axis[1]) + (1 << v->axis[2]);
    fuzz_check(axes == 7, "the axes are a permutation");
    int bits = v->dims_vox[0] % 2 ? 8 : 12;
    fuzz_check(volume_quantise(v, v->min, v->max, bits, &densities, &error) == HOST_OK, "densities can be made");
}

void fuzz_volume(const uint8_t *data, size_t size)
{
    fuzz_file file;
    fuzz_open(&file, data, size);
    const volume_options options[] = {{.crop = false}, {.crop = true, .crop_hi = {1, 2, 1}, .no_orient = true}};
    for (int i = 0; i < 2; i++) {
        volume v;
        host_error error = {""};
        host_status status = volume_open(file.path, &options[i], &v, &error);
        if (status == HOST_OK)
            look_at(&v);
        else
            fuzz_refused(status, error.text);
        volume_close(&v);
    }
    fuzz_close(&file);
}

static void check_table(const transfer *t, double lo, double hi, double depth_vox)
{
    static vodr_rgba entries[4096];
    transfer_table(t, lo, hi, 12, 16, depth_vox, false, entries);
    for (int i = 0; i < 4096; i++)
        fuzz_check(entries[i].r <= entries[i].a && entries[i].g <= entries[i].a && entries[i].b <= entries[i].a,
                   "no colour exceeds its opacity");
    transfer_point p = transfer_at(t, lo + (hi - lo) / 3, lo, hi);
    fuzz_check(p.r >= 0 && p.r <= 1 && p.g >= 0 && p.g <= 1 && p.b >= 0 && p.b <= 1 && p.a >= 0 && p.a <= 1,
               "colours and opacities lie from 0 to 1");
}

static void check_rows(const transfer *t)
{
    enum { COUNT = 7, ROWS = 5 };
    double rgba[4 * COUNT * ROWS], most;
    host_error error;
    fuzz_check(transfer_sample_rows(t, 0, 255, COUNT, ROWS, 1, rgba, &most, &error) == HOST_OK && most > 0,
               "rows can be sampled");
    for (int i = 0; i < 4 * COUNT * ROWS; i++)
        fuzz_check(rgba[i] >= 0 && rgba[i] <= 1 + 1e-12, "samples lie from 0 to 1");
}

void fuzz_transfer(const uint8_t *data, size_t size,
                   host_status (*parse)(char *text, const char *path, transfer *t, host_error *error))
{
    char *text = fuzz_text(data, size);
    if (!text)
        return;
    transfer t = {.name = "fuzz"};
    host_error error = {""};
    host_status status = parse(text, "fuzz", &t, &error);
    if (status == HOST_OK && t.rows) {
        if (t.row_count > 1)
            check_rows(&t);
    } else if (status == HOST_OK) {
        check_table(&t, 0, 255, 1);
        check_table(&t, -1e300, 1e300, 0.5);
        double first = t.points[0].value, last = t.points[t.count - 1].value;
        if (isfinite(last - first))
            check_table(&t, first, last, 3);
    } else {
        fuzz_refused(status, error.text);
    }
    transfer_close(&t);
    free(text);
}
