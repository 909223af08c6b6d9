/* transfer_file.h - private to the transfer functions: what the files that hold one are parsed with. */
#ifndef HOST_TRANSFER_FILE_H
#define HOST_TRANSFER_FILE_H

#include "transfer.h"

/* Each fills the points of *t, and what belongs to them, from a file's text. `path` is for sentences. On failure *t may
 * be partly filled; transfer_close() either way. The text is changed. */
host_status transfer_parse_text(char *text, const char *path, transfer *t, host_error *error);
host_status transfer_parse_paraview(char *text, const char *path, transfer *t, host_error *error);

#endif
