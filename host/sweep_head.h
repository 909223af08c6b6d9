/* sweep_head.h - what a sweep's file begins with: JSON that repeats the sweep, each line behind a '#'. */
#ifndef HOST_SWEEP_HEAD_H
#define HOST_SWEEP_HEAD_H

#include "sweep_stage.h"

/* `repeats` is the command line that repeats it, without what changes no row. free() the text. */
host_status sweep_head(const sweep_stage *s, const char *repeats, char **text, host_error *error);

#endif
