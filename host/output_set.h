/* output_set.h - the output files of a command: checked before long work, then written all or none. */
#ifndef HOST_OUTPUT_SET_H
#define HOST_OUTPUT_SET_H

#include "output.h"
#include "view_options.h"

enum { OUTPUT_SET_MOST = 4 };

/* A command's options for output files, and the paths given for them. */
typedef struct output_set {
    const char *const *option; /* their names */
    int count;                 /* at most OUTPUT_SET_MOST */
    const char **path;         /* NULL: not asked for */
} output_set;

/* The path of the option of that name. */
void output_set_path(const output_set *s, const char *name, const char *path);

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
