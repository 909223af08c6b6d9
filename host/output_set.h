/* output_set.h - what a drawing command leaves: output files, checked before long work and written all or none, and how
 * often it draws. */
#ifndef HOST_OUTPUT_SET_H
#define HOST_OUTPUT_SET_H

#include "output.h"
#include "view_options.h"

enum { OUTPUT_SET_MOST = 4 };

typedef struct output_set {
    const char *const *option;         /* names of the options for files */
    int count;                         /* of them */
    const char *path[OUTPUT_SET_MOST]; /* NULL: not asked for */
    int repeat;
} output_set;

/* Set an option's path, and --repeat; `target` is an output_set. */
host_status output_set_path(void *target, const option *o, const char *value, host_error *error);
host_status output_set_repeat(void *target, const option *o, const char *value, host_error *error);

/* Whether all can be written, no two to one file, and none over what is read: `input` and the files of the options. */
host_status output_set_check(const output_set *s, const view_options *v, const char *input, host_error *error);

/* Calls write(context, i, ...) for each that was asked for, with the opened output; no file takes its place before all
 * are written. */
host_status output_set_write(const output_set *s, host_status (*write)(void *context, int i, output *o, host_error *),
                             void *context, host_error *error);

/* Whether standard output carries one of the files, so that a summary has no place there. */
bool output_set_takes_stdout(const output_set *s);

/* A line `written PATH` for each. */
void output_set_print(const output_set *s);

#endif
