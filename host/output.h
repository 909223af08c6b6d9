/* output.h - output files that appear whole or not at all.
 *
 * A regular file is written beside its target under another name and takes its place in output_commit(); a device, a
 * pipe or the program's own standard output is written straight away. */
#ifndef HOST_OUTPUT_H
#define HOST_OUTPUT_H

#include <stdio.h>

#include "host.h"

typedef struct output {
    FILE *file;      /* NULL once closed */
    char *path;      /* as given, for error sentences */
    char *target;    /* what is replaced: path with its links followed; NULL when written straight away */
    char *temporary; /* NULL when written straight away, and after output_commit() */
} output;

/* Whether `path` can be written, before long work; leaves nothing behind. HOST_ENVIRONMENT when not. */
host_status output_check(const char *path, host_error *error);

/* HOST_BAD_INPUT when `path` is the regular file `input`, which a command reads: it would be replaced. NULL, or a name
 * that is no file, is no input. */
host_status output_spare(const char *path, const char *input, host_error *error);

/* Whether writing to `path` writes to the program's standard output. */
bool output_is_stdout(const char *path);

/* An all-zero output may be discarded. */
host_status output_open(output *o, const char *path, host_error *error);

/* Writes all data; HOST_ENVIRONMENT when any write to o->file has failed. The target is not touched yet. */
host_status output_close(output *o, host_error *error);

/* Puts a closed output in its place. */
host_status output_commit(output *o, host_error *error);

/* A whole output: opened, filled by write(context, ...), closed, put in its place. */
host_status output_write(const char *path, host_status (*write)(void *context, output *o, host_error *error),
                         void *context, host_error *error);

/* Frees everything, removes what was not committed. To be called after success too. */
void output_discard(output *o);

#endif
