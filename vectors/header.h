/* header.h - the first line of vectors: what they are of, and what their columns are (docs/vectors.md). */
#ifndef VECTORS_HEADER_H
#define VECTORS_HEADER_H

#include "bench.h"
#include "vectors.h"

/* The line without its newline; NULL when there is no memory. free() it. Parameters come from a case's bench. */
char *header_text(const vectors_choice *choice, const bench *b);

/* Reads block, level, seed and machine. The rest must be what header_text() says, of the first case. */
vectors_status header_read(const char *line, vectors_choice *choice, vodr_error *error);

/* Writes the parameters in which a machine differs from another as `name=value`, `between` them. */
void header_put_machine(FILE *file, const vodr_machine *machine, const vodr_machine *from, char between);

#endif
