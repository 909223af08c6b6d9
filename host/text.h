/* text.h - numbers from text, strictly, and small text files. */
#ifndef HOST_TEXT_H
#define HOST_TEXT_H

#include "host.h"

/* The whole of `text` as a decimal number within [lo, hi]: no blanks, no sign but '-', no infinity. *value is untouched
 * when it is not. */
bool text_integer(const char *text, int64_t lo, int64_t hi, int64_t *value);
bool text_number(const char *text, double lo, double hi, double *value);

/* Between `least` and `most` numbers separated by `separator`; returns how many, 0 when it does not parse. */
int text_numbers(const char *text, char separator, int least, int most, double *values);

/* Two integers from 1 to hi as "AxB". */
bool text_size(const char *text, int64_t hi, int32_t *a, int32_t *b);

/* Replaces what is not printable ASCII, for text from files in sentences. */
void text_make_printable(char *text);

/* Prints a line of a summary: a name, an integer with its thousands apart, and what follows it. */
void text_print_count(const char *name, uint64_t value, const char *after);

/* Reads a text file of at most 1 MiB, without NUL bytes; free() the text. `what` names it in error sentences. */
host_status text_read(const char *path, const char *what, char **text, host_error *error);

#endif
