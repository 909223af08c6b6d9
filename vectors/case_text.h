/* case_text.h - the lines that set a case up: its machine, view and volume, and what follows from them for the Verilog,
 * its registers and table (docs/vectors.md). */
#ifndef VECTORS_CASE_TEXT_H
#define VECTORS_CASE_TEXT_H

#include "bench.h"
#include "vectors.h"

/* Writes the lines of a bench before its first cycle. False when there is no memory. */
bool case_text_put(FILE *file, const char *name, uint64_t seed, const vectors_choice *choice, const bench *b);

/* The next line, without its newline; NULL at the end of the file. */
typedef const char *case_text_source(void *context);

/* Reads them, the first of which is at hand, and makes the bench, to be closed after any outcome. */
vectors_status case_text_get(const char *first, case_text_source *next, void *context, const vectors_choice *choice,
                             bench *b, vodr_error *error);

#endif
