/* csv.h - lines of comma-separated values (RFC 4180, but that no value holds a line break). */
#ifndef HOST_CSV_H
#define HOST_CSV_H

#include <stddef.h>
#include <stdio.h>

/* Writes a value, quoted where it holds a comma or a quotation mark; what is not printable becomes '?'. */
void csv_put(FILE *file, const char *value);

/* Parts a line in place, without its line break: fields[0 .. most-1] receive the values. Returns how many there are,
 * also where that is more than `most`. */
size_t csv_split(char *line, char **fields, size_t most);

#endif
