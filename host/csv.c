/* csv.c - lines of comma-separated values. */
#include "csv.h"

#include <string.h>

static void put_character(FILE *file, char c)
{
    putc((unsigned char)c < ' ' || c == 0x7f ? '?' : c, file);
}

void csv_put(FILE *file, const char *value)
{
    const int quoted = value[strcspn(value, ",\"")] != '\0' || *value == '#';
    if (quoted)
        putc('"', file);
    for (; *value; value++) {
        if (*value == '"')
            putc('"', file);
        put_character(file, *value);
    }
    if (quoted)
        putc('"', file);
}

/* Takes the quotation marks off a value in place; returns what follows it. */
static char *unquote(char *value)
{
    char *out = value, *in = value + 1;
    for (; *in && (*in != '"' || in[1] == '"'); in++) {
        if (*in == '"')
            in++;
        *out++ = *in;
    }
    if (*in)
        in++;
    char *rest = in;
    *out = '\0';
    return rest;
}

size_t csv_split(char *line, char **fields, size_t most)
{
    size_t count = 0;
    for (char *at = line;; count++) {
        char *value = at, *end = *at == '"' ? unquote(at) : at + strcspn(at, ",");
        if (count < most)
            fields[count] = value;
        if (*end != ',')
            return *end ? most + 1 : count + 1;
        *end = '\0';
        at = end + 1;
    }
}
