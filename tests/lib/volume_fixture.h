/* volume_fixture.h - for the tests of volumes: files in a directory of their own, and what must be read from them. */
#ifndef TEST_VOLUME_FIXTURE_H
#define TEST_VOLUME_FIXTURE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "volume.h"

/* The volume of most files here. */
enum { W = 5, H = 4, D = 3, COUNT = W * H * D };

typedef struct fixture {
    char directory[256];
    char path[512]; /* of the file that put() wrote last */
} fixture;

/* cmocka's set-up and tear-down of a group: *state is a fixture. */
int fixture_make(void **state);
int fixture_remove(void **state);

/* Writes a header as it is, then the data, zipped or not. Returns the path. */
const char *put(fixture *f, const char *name, const void *header, size_t header_bytes, const void *data, size_t bytes,
                bool zip);
const char *put_text(fixture *f, const char *name, const char *text, const void *data, size_t bytes);

/* The value of voxel i, one that every type can hold: 0 to 118, shuffled. */
double pattern(int i);

/* The pattern's COUNT voxels as bytes; returns how many bytes. float64 goes before type. */
size_t encode(volume_type type, bool big, bool float64, unsigned char *out);

/* Each fails the test when it is not so; options may be NULL. */
void open_ok(const char *path, const volume_options *options, volume *v);
void check_pattern(const char *path, const volume_options *options, volume_type type, const char *format);
void check_geometry(const char *path, const volume_options *options, const double spacing[3], const int axis[3],
                    const int sign[3]);

/* The file is bad input, and the one sentence about it holds `part`. */
void refused(const char *path, const volume_options *options, const char *part);

#endif
