/* transfer.c - transfer functions: built in or read from a text file, and the machine's table made from one. */
#include "transfer.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "text.h"
#include "transfer_builtin.h"

static double mix(double a, double b, double t)
{
    return a + (b - a) * t;
}

static double normalize(double value, double lo, double hi)
{
    return hi > lo ? (value - lo) / (hi - lo) : 0;
}

transfer_point transfer_at(const transfer *t, double value, double lo, double hi)
{
    double x = t->normalized ? normalize(value, lo, hi) : value;
    size_t above = 0;
    while (above < t->count && t->points[above].value <= x)
        above++;
    transfer_point at = t->points[above < t->count ? above : t->count - 1];
    if (above > 0 && above < t->count) {
        const transfer_point *p = &t->points[above - 1], *q = &t->points[above];
        double share = (x - p->value) / (q->value - p->value);
        at = (transfer_point){0, mix(p->r, q->r, share), mix(p->g, q->g, share), mix(p->b, q->b, share),
                              mix(p->a, q->a, share)};
    }
    at.value = value;
    return at;
}

/* What opacities are divided by so that the largest is 1. */
static double largest_opacity(const transfer *t)
{
    double largest = 0;
    for (size_t i = 0; i < t->count; i++)
        largest = fmax(largest, t->points[i].a);
    return largest > 0 ? largest : 1;
}

static uint16_t to_channel(double value, double full)
{
    return (uint16_t)floor(value * full + 0.5);
}

void transfer_table(const transfer *t, double lo, double hi, int density_bits, int tf_bits, double depth,
                    bool full_scale, vodr_rgba *entries)
{
    const int last = (1 << density_bits) - 1;
    const double full = tf_bits == 16 ? 65535 : 255;
    const double largest = full_scale && t->builtin ? largest_opacity(t) : 1;
    for (int i = 0; i <= last; i++) {
        transfer_point p = transfer_at(t, lo + (hi - lo) * i / last, lo, hi);
        double a = p.a / largest;
        if (depth != 1)
            a = 1 - pow(1 - a, depth);
        entries[i] = (vodr_rgba){to_channel(p.r * a, full), to_channel(p.g * a, full), to_channel(p.b * a, full),
                                 to_channel(a, full)};
    }
}

/* Appends a point read from a line; `where` is "path:line". */
static host_status add_point(transfer *t, const char *line, const char *where, host_error *error)
{
    char field[5][64], rest;
    double number[5];
    if (sscanf(line, "%63s %63s %63s %63s %63s %c", field[0], field[1], field[2], field[3], field[4], &rest) != 5)
        return host_fail(error, HOST_BAD_INPUT, "%s: '%.64s' is not of the form `value r g b a`", where, line);
    for (int i = 0; i < 5; i++) {
        bool unit = i > 0 || t->normalized;
        if (!text_number(field[i], unit ? 0 : -HUGE_VAL, unit ? 1 : HUGE_VAL, &number[i]))
            return host_fail(error, HOST_BAD_INPUT, "%s: %s is '%s' but must be a number%s", where,
                             i ? (const char *[]){"r", "g", "b", "a"}[i - 1] : "value", field[i],
                             unit ? " from 0 to 1" : "");
    }
    if (t->count && number[0] <= t->points[t->count - 1].value)
        return host_fail(error, HOST_BAD_INPUT, "%s: value %s is not above the one before it", where, field[0]);
    transfer_point *grown = realloc(t->points, (t->count + 1) * sizeof *grown);
    if (!grown)
        return host_fail(error, HOST_ENVIRONMENT, "%s: no memory", where);
    t->points = grown;
    t->points[t->count++] = (transfer_point){number[0], number[1], number[2], number[3], number[4]};
    return HOST_OK;
}

static host_status add_line(transfer *t, char *line, const char *where, host_error *error)
{
    line += strspn(line, " \t\r");
    if (*line == '\0')
        return HOST_OK;
    if (*line != '#')
        return add_point(t, line, where, error);
    char word[16], rest;
    bool normalized = sscanf(line + 1, "%15s %c", word, &rest) == 1 && strcmp(word, "normalized") == 0;
    if (normalized && t->count)
        return host_fail(error, HOST_BAD_INPUT, "%s: `# normalized` must come before the first point", where);
    t->normalized = t->normalized || normalized;
    return HOST_OK;
}

static host_status read_points(transfer *t, char *text, const char *path, host_error *error)
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
    return status;
}

host_status transfer_open(const char *name_or_path, bool ct, transfer *t, host_error *error)
{
    *t = (transfer){.name = name_or_path};
    const transfer_builtin *builtin = transfer_builtin_find(name_or_path);
    if (builtin)
        return transfer_builtin_open(builtin, ct, t, error);
    char *text;
    host_error reason;
    host_status status = text_read(name_or_path, "transfer function", &text, &reason);
    if (status != HOST_OK)
        return host_fail(error, status, "--tf: %.700s (built in are ramp, bone, skin-bone, vessels, mri)", reason.text);
    status = read_points(t, text, name_or_path, error);
    free(text);
    if (status != HOST_OK)
        transfer_close(t);
    return status;
}

void transfer_close(transfer *t)
{
    free(t->points);
    *t = (transfer){0};
}
