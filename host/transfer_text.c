/* transfer_text.c - transfer functions as text: lines `value r g b a`, `# normalized` before the first of them where
 * values are 0 to 1 over the window; other `#` comments and empty lines are skipped. Lines `gradient g` part the points
 * of a function of value and gradient magnitude. */
#include "transfer_file.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "text.h"

/* Appends a point read from a line; `where` is "path:line". */
static host_status add_point(transfer *t, const char *line, const char *where, host_error *error)
{
    char field[5][64], shown[65], rest;
    double number[5];
    if (sscanf(line, "%63s %63s %63s %63s %63s %c", field[0], field[1], field[2], field[3], field[4], &rest) != 5) {
        snprintf(shown, sizeof shown, "%s", line);
        text_make_printable(shown);
        return host_fail(error, HOST_BAD_INPUT, "%s: '%s' is not of the form `value r g b a`", where, shown);
    }
    for (int i = 0; i < 5; i++) {
        bool unit = i > 0 || t->normalized;
        if (!text_number(field[i], unit ? 0 : -HUGE_VAL, unit ? 1 : HUGE_VAL, &number[i])) {
            text_make_printable(field[i]);
            return host_fail(error, HOST_BAD_INPUT, "%s: %s is '%s' but must be a number%s", where,
                             i ? (const char *[]){"r", "g", "b", "a"}[i - 1] : "value", field[i],
                             unit ? " from 0 to 1" : "");
        }
    }
    const size_t first = t->rows ? t->rows[t->row_count - 1].first : 0;
    if (t->count > first && number[0] <= t->points[t->count - 1].value)
        return host_fail(error, HOST_BAD_INPUT, "%s: value %s is not above the one before it", where, field[0]);
    transfer_point *grown = realloc(t->points, (t->count + 1) * sizeof *grown);
    if (!grown)
        return host_fail(error, HOST_ENVIRONMENT, "%s: no memory", where);
    t->points = grown;
    t->points[t->count++] = (transfer_point){number[0], number[1], number[2], number[3], number[4]};
    if (t->rows)
        t->rows[t->row_count - 1].count++;
    return HOST_OK;
}

/* A row without points says nothing. */
static host_status end_row(const transfer *t, const char *where, host_error *error)
{
    const transfer_row *row = t->rows ? &t->rows[t->row_count - 1] : NULL;
    if (row && row->count == 0)
        return host_fail(error, HOST_BAD_INPUT,
                         "%s: gradient %g has no point, at least one line `value r g b a` is needed", where,
                         row->gradient);
    return HOST_OK;
}

/* Begins the points at a gradient magnitude. */
static host_status add_row(transfer *t, char *number, const char *where, host_error *error)
{
    double gradient;
    if (!text_number(number, 0, DBL_MAX, &gradient)) {
        text_make_printable(number);
        return host_fail(error, HOST_BAD_INPUT, "%s: gradient is '%s' but must be a number from 0", where, number);
    }
    if (t->count && !t->rows)
        return host_fail(error, HOST_BAD_INPUT, "%s: `gradient` must come before the first point", where);
    host_status status = end_row(t, where, error);
    if (status != HOST_OK)
        return status;
    if (t->rows && gradient <= t->rows[t->row_count - 1].gradient)
        return host_fail(error, HOST_BAD_INPUT, "%s: gradient %s is not above the one before it", where, number);
    transfer_row *grown = realloc(t->rows, (t->row_count + 1) * sizeof *grown);
    if (!grown)
        return host_fail(error, HOST_ENVIRONMENT, "%s: no memory", where);
    t->rows = grown;
    t->rows[t->row_count++] = (transfer_row){.gradient = gradient, .first = t->count};
    return HOST_OK;
}

static host_status add_line(transfer *t, char *line, const char *where, host_error *error)
{
    char word[16], number[64], rest;
    line += strspn(line, " \t\r");
    if (*line == '\0')
        return HOST_OK;
    if (sscanf(line, "%15s %63s %c", word, number, &rest) == 2 && strcmp(word, "gradient") == 0)
        return add_row(t, number, where, error);
    if (*line != '#')
        return add_point(t, line, where, error);
    bool normalized = sscanf(line + 1, "%15s %c", word, &rest) == 1 && strcmp(word, "normalized") == 0;
    if (normalized && (t->count || t->rows))
        return host_fail(error, HOST_BAD_INPUT, "%s: `# normalized` must come before the first point", where);
    t->normalized = t->normalized || normalized;
    return HOST_OK;
}

host_status transfer_parse_text(char *text, const char *path, transfer *t, host_error *error)
{
    host_status status = HOST_OK;
    char where[512];
    for (int number = 1; status == HOST_OK && *text; number++) {
        size_t n = strcspn(text, "\n");
        char *next = text + n + (text[n] == '\n');
        text[n] = '\0';
        snprintf(where, sizeof where, "%s:%d", path, number);
        status = add_line(t, text, where, error);
        text = next;
    }
    if (status == HOST_OK && t->count == 0)
        return host_fail(error, HOST_BAD_INPUT, "%s: it holds no point, at least one line `value r g b a` is needed",
                         path);
    return status == HOST_OK ? end_row(t, path, error) : status;
}
