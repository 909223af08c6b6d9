/* transfer.c - transfer functions: built in or read from a file, and the machine's table made from one. */
#include "transfer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "text.h"
#include "transfer_builtin.h"
#include "transfer_file.h"

static double mix(double a, double b, double t)
{
    return t < 1 ? a + (b - a) * t : b;
}

static double normalize(double value, double lo, double hi)
{
    return hi > lo ? (value - lo) / (hi - lo) : 0;
}

/* How many of `count` ascending values, `stride` bytes apart, are below x. A value at a point belongs to the way that
 * ends there, as in VTK. */
static size_t count_below(const double *values, size_t stride, size_t count, double x)
{
    size_t lo = 0, hi = count;
    while (lo < hi) {
        size_t middle = lo + (hi - lo) / 2;
        if (*(const double *)((const char *)values + middle * stride) < x)
            lo = middle + 1;
        else
            hi = middle;
    }
    return lo;
}

/* Where between two values a third lies, 0 to 1, whatever their size. */
static double share_of(double value, double from, double to)
{
    return isfinite(to - from) ? (value - from) / (to - from) : (value / 2 - from / 2) / (to / 2 - from / 2);
}

static transfer_point point_at(const transfer *t, double x)
{
    size_t above = count_below(&t->points[0].value, sizeof *t->points, t->count, x);
    if (above == 0 || above == t->count)
        return t->points[above ? above - 1 : 0];
    const transfer_point *p = &t->points[above - 1], *q = &t->points[above];
    double share = share_of(x, p->value, q->value), rgb[3];
    colour_between(t->space, (const double[]){p->r, p->g, p->b}, (const double[]){q->r, q->g, q->b}, share, rgb);
    return (transfer_point){x, rgb[0], rgb[1], rgb[2], mix(p->a, q->a, share)};
}

/* The way from p to q in VTK's manner: moved to the midpoint, steepened by the sharpness, then a cubic with the slope
 * that the sharpness leaves. Near 0 and 1 the sharpness means linear and a step. */
static double bend(const transfer_opacity *p, const transfer_opacity *q, double share)
{
    double midpoint = fmin(fmax(p->midpoint, 0.00001), 0.99999);
    double s = share < midpoint ? 0.5 * share / midpoint : 0.5 + 0.5 * (share - midpoint) / (1 - midpoint);
    if (p->sharpness > 0.99)
        return s < 0.5 ? p->a : q->a;
    if (p->sharpness < 0.01)
        return mix(p->a, q->a, s);
    double power = 1 + 10 * p->sharpness;
    s = s < 0.5 ? 0.5 * pow(2 * s, power) : 1 - 0.5 * pow(2 * (1 - s), power);
    double slope = (1 - p->sharpness) * (q->a - p->a);
    double cubic = mix(p->a, q->a, s * s * (3 - 2 * s)) + slope * s * (1 - s) * (1 - 2 * s);
    return fmin(fmax(cubic, fmin(p->a, q->a)), fmax(p->a, q->a));
}

static double opacity_at(const transfer *t, double x)
{
    size_t above = count_below(&t->opacities[0].value, sizeof *t->opacities, t->opacity_count, x);
    if (above == 0 || above == t->opacity_count)
        return t->opacities[above ? above - 1 : 0].a;
    const transfer_opacity *p = &t->opacities[above - 1], *q = &t->opacities[above];
    return bend(p, q, share_of(x, p->value, q->value));
}

transfer_point transfer_at(const transfer *t, double value, double lo, double hi)
{
    double x = t->normalized ? normalize(value, lo, hi) : value;
    transfer_point at = point_at(t, x);
    if (t->opacities)
        at.a = opacity_at(t, x);
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

/* Entry i of last + 1; `largest` divides the opacity. */
static void sample_at(const transfer *t, double lo, double hi, int i, int last, double depth, double largest,
                      double rgba[4])
{
    transfer_point p = transfer_at(t, lo + (hi - lo) * i / last, lo, hi);
    double a = p.a / largest;
    if (depth != 1)
        a = 1 - pow(1 - a, depth);
    rgba[0] = p.r * a;
    rgba[1] = p.g * a;
    rgba[2] = p.b * a;
    rgba[3] = a;
}

void transfer_table(const transfer *t, double lo, double hi, int density_bits, int tf_bits, double depth,
                    bool full_scale, vodr_rgba *entries)
{
    const int last = (1 << density_bits) - 1;
    const double full = tf_bits == 16 ? 65535 : 255;
    const double largest = full_scale && t->builtin ? largest_opacity(t) : 1;
    for (int i = 0; i <= last; i++) {
        double rgba[4];
        sample_at(t, lo, hi, i, last, depth, largest, rgba);
        entries[i] = (vodr_rgba){to_channel(rgba[0], full), to_channel(rgba[1], full), to_channel(rgba[2], full),
                                 to_channel(rgba[3], full)};
    }
}

void transfer_sample(const transfer *t, double lo, double hi, int count, double depth, bool full_scale, double *rgba)
{
    const double largest = full_scale && t->builtin ? largest_opacity(t) : 1;
    for (int i = 0; i < count; i++)
        sample_at(t, lo, hi, i, count - 1, depth, largest, rgba + 4 * (size_t)i);
}

/* A row as a function of values alone; it shares the points. */
static transfer row_of(const transfer *t, const transfer_row *row)
{
    transfer one = *t;
    one.points += row->first;
    one.count = row->count;
    one.rows = NULL;
    one.row_count = 0;
    return one;
}

/* Adds `share` of a row's samples. */
static void add_row(const transfer *t, size_t i, double lo, double hi, int count, double depth, double share,
                    double *scratch, double *rgba)
{
    const transfer row = row_of(t, &t->rows[i]);
    transfer_sample(&row, lo, hi, count, depth, false, scratch);
    for (size_t e = 0; e < 4 * (size_t)count; e++)
        rgba[e] += share * scratch[e];
}

host_status transfer_sample_rows(const transfer *t, double lo, double hi, int count, int row_count, double depth,
                                 double *rgba, double *most, host_error *error)
{
    const double last = t->rows[t->row_count - 1].gradient;
    const size_t entries = 4 * (size_t)count;
    double *scratch = malloc(entries * sizeof *scratch);
    if (!scratch)
        return host_fail(error, HOST_ENVIRONMENT, "no memory for the transfer-function table");
    memset(rgba, 0, (size_t)row_count * entries * sizeof *rgba);
    for (int j = 0; j < row_count; j++, rgba += entries) {
        const double gradient = last * ((double)j / (row_count - 1));
        size_t above = count_below(&t->rows[0].gradient, sizeof *t->rows, t->row_count, gradient);
        const double *from = above ? &t->rows[above - 1].gradient : NULL;
        const double share = from ? share_of(gradient, *from, t->rows[above].gradient) : 1;
        add_row(t, above, lo, hi, count, depth, share, scratch, rgba);
        if (share < 1)
            add_row(t, above - 1, lo, hi, count, depth, 1 - share, scratch, rgba);
    }
    free(scratch);
    *most = t->normalized || hi <= lo ? last : last / (hi - lo);
    return HOST_OK;
}

/* A colour map in JSON is an object or a list; no line of the text form begins like one. */
static bool is_json(const char *text)
{
    text += strspn(text, " \t\r\n");
    return *text == '{' || *text == '[';
}

static host_status open_file(const char *path, transfer *t, host_error *error)
{
    char *text;
    host_error reason;
    host_status status = text_read(path, "transfer function", &text, &reason);
    if (status != HOST_OK)
        return host_fail(error, status, "--tf: %.700s (built in are ramp, bone, skin-bone, vessels, mri)", reason.text);
    status = is_json(text) ? transfer_parse_paraview(text, path, t, error) : transfer_parse_text(text, path, t, error);
    free(text);
    if (status != HOST_OK)
        transfer_close(t);
    return status;
}

host_status transfer_open_rows(const char *name_or_path, bool ct, transfer *t, host_error *error)
{
    *t = (transfer){.name = name_or_path};
    const transfer_builtin *builtin = transfer_builtin_find(name_or_path);
    return builtin ? transfer_builtin_open(builtin, ct, t, error) : open_file(name_or_path, t, error);
}

host_status transfer_open(const char *name_or_path, bool ct, transfer *t, host_error *error)
{
    host_status status = transfer_open_rows(name_or_path, ct, t, error);
    if (status != HOST_OK || !t->rows)
        return status;
    transfer_close(t);
    return host_fail(error, HOST_BAD_INPUT,
                     "--tf: '%.512s' is of value and gradient magnitude, the machine's tables of values alone: it goes "
                     "with `vodr reference --numbers float`, double and texture",
                     name_or_path);
}

void transfer_close(transfer *t)
{
    free(t->points);
    free(t->opacities);
    free(t->rows);
    *t = (transfer){0};
}
