/* text.c - numbers from text, strictly, and small text files. */
#include "text.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { NUMBER_CHARS = 64, FILE_BYTES = 1 << 20 };

bool text_integer(const char *text, int64_t lo, int64_t hi, int64_t *value)
{
    char *end;
    if (!isdigit((unsigned char)text[text[0] == '-']))
        return false;
    errno = 0;
    long long parsed = strtoll(text, &end, 10);
    if (errno || *end || parsed < lo || parsed > hi)
        return false;
    *value = parsed;
    return true;
}

bool text_number(const char *text, double lo, double hi, double *value)
{
    size_t n = strlen(text);
    if (n == 0 || strspn(text, "0123456789.eE+-") != n || text[0] == '+')
        return false;
    char *end;
    double parsed = strtod(text, &end);
    if (*end || !isfinite(parsed) || parsed < lo || parsed > hi)
        return false;
    *value = parsed;
    return true;
}

/* Copies the text before `separator` (or its end) and steps over it; NULL when it is too long for a number. */
static const char *next_field(const char *text, char separator, char field[NUMBER_CHARS])
{
    const char *end = strchr(text, separator);
    size_t n = end ? (size_t)(end - text) : strlen(text);
    if (n >= NUMBER_CHARS)
        return NULL;
    memcpy(field, text, n);
    field[n] = '\0';
    return text + n;
}

int text_numbers(const char *text, char separator, int least, int most, double *values)
{
    char field[NUMBER_CHARS];
    for (int count = 0; count < most; count++) {
        text = next_field(text, separator, field);
        if (!text || !text_number(field, -HUGE_VAL, HUGE_VAL, &values[count]))
            return 0;
        if (*text == '\0')
            return count + 1 >= least ? count + 1 : 0;
        text++;
    }
    return 0;
}

bool text_size(const char *text, int64_t hi, int32_t *a, int32_t *b)
{
    char field[NUMBER_CHARS];
    int64_t first, second;
    text = next_field(text, 'x', field);
    if (!text || *text != 'x' || !text_integer(field, 1, hi, &first) || !text_integer(text + 1, 1, hi, &second))
        return false;
    *a = (int32_t)first;
    *b = (int32_t)second;
    return true;
}

void text_make_printable(char *text)
{
    for (; *text; text++)
        if (*text < ' ' || *text > '~')
            *text = '?';
}

static host_status read_stream(FILE *file, const char *path, const char *what, char **text, host_error *error)
{
    char *buffer = malloc(FILE_BYTES + 1);
    if (!buffer)
        return host_fail(error, HOST_ENVIRONMENT, "no memory to read the %s '%s'", what, path);
    size_t n = fread(buffer, 1, FILE_BYTES + 1, file);
    const char *fault = NULL;
    if (ferror(file))
        fault = strerror(errno);
    else if (n > FILE_BYTES)
        fault = "it is longer than 1 MiB";
    else if (memchr(buffer, '\0', n))
        fault = "it is not a text file";
    if (fault) {
        free(buffer);
        return host_fail(error, HOST_BAD_INPUT, "cannot read the %s '%s': %s", what, path, fault);
    }
    buffer[n] = '\0';
    *text = buffer;
    return HOST_OK;
}

void text_print_count(const char *name, uint64_t value, const char *after)
{
    char digits[32], grouped[48];
    int n = snprintf(digits, sizeof digits, "%llu", (unsigned long long)value), out = 0;
    for (int i = 0; i < n; i++) {
        if (i && (n - i) % 3 == 0)
            grouped[out++] = ',';
        grouped[out++] = digits[i];
    }
    grouped[out] = '\0';
    printf("%-18s %18s%s\n", name, grouped, after);
}

host_status text_read(const char *path, const char *what, char **text, host_error *error)
{
    struct stat info;
    FILE *file = fopen(path, "r");
    if (!file)
        return host_fail(error, HOST_BAD_INPUT, "cannot open the %s '%s': %s", what, path, strerror(errno));
    host_status status;
    if (fstat(fileno(file), &info) == 0 && S_ISDIR(info.st_mode))
        status = host_fail(error, HOST_BAD_INPUT, "the %s '%s' is a directory", what, path);
    else
        status = read_stream(file, path, what, text, error);
    fclose(file);
    return status;
}
