/* fuzz.h - what the fuzz targets share. Each target is one file with libFuzzer's LLVMFuzzerTestOneInput(). */
#ifndef TESTS_FUZZ_H
#define TESTS_FUZZ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "host.h"
#include "transfer.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* A file in memory with these bytes; returns its path, which lives until fuzz_close(). */
typedef struct fuzz_file {
    int descriptor;
    char path[64];
} fuzz_file;

void fuzz_open(fuzz_file *file, const uint8_t *data, size_t size);
void fuzz_close(fuzz_file *file);

/* The bytes as text; free() it. NULL where they hold a NUL, which no reader of text lets through. */
char *fuzz_text(const uint8_t *data, size_t size);

/* Ends the process when a promise is broken. */
void fuzz_check(bool holds, const char *promise);

/* A failure's code and its one sentence: bad input, one line of printable ASCII. */
void fuzz_refused(host_status status, const char *sentence);

/* A volume file: what was read is looked at whole and quantised, with and without a crop. */
void fuzz_volume(const uint8_t *data, size_t size);

/* A transfer function's text through `parse`; what is accepted must give sound tables. */
void fuzz_transfer(const uint8_t *data, size_t size,
                   host_status (*parse)(char *text, const char *path, transfer *t, host_error *error));

#endif
