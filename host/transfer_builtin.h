/* transfer_builtin.h - the built-in transfer functions' control points. */
#ifndef HOST_TRANSFER_BUILTIN_H
#define HOST_TRANSFER_BUILTIN_H

#include "transfer.h"

typedef struct transfer_builtin transfer_builtin;

/* NULL if there is none of that name. */
const transfer_builtin *transfer_builtin_find(const char *name);

/* Fills *t; transfer_close() frees it. */
host_status transfer_builtin_open(const transfer_builtin *b, bool ct, transfer *t, host_error *error);

#endif
