/* compare.c - `vodr compare`: how far two PNG pictures are apart. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "difference.h"
#include "json.h"
#include "text.h"

typedef struct compare_options {
    double tolerance; /* 8-bit levels */
    const char *diff; /* NULL: none */
    bool json;
} compare_options;

static host_status set_tolerance(void *target, const option *o, const char *value, host_error *error)
{
    if (!text_number(value, 0, 255, &((compare_options *)target)->tolerance))
        return option_refuse(o, value, "a number of 8-bit levels from 0 to 255", error);
    return HOST_OK;
}

static host_status set_diff(void *target, const option *o, const char *value, host_error *error)
{
    (void)o, (void)error;
    ((compare_options *)target)->diff = value;
    return HOST_OK;
}

static host_status set_json(void *target, const option *o, const char *value, host_error *error)
{
    (void)o, (void)value, (void)error;
    ((compare_options *)target)->json = true;
    return HOST_OK;
}

static const option rows[] = {
    {"tolerance", 0, "LEVELS", false, set_tolerance, "greatest error allowed, 8-bit levels, 0 to 255 (0)"},
    {"diff", 0, "OUT.png", false, set_diff, "absolute differences, amplified so that the greatest is white"},
    {"json", 0, NULL, false, set_json, "JSON on standard output"},
};
static const option_table table = {"Options:", rows, sizeof rows / sizeof *rows};

static host_status print_json(const difference *d, host_error *error)
{
    json_t *first = json_null();
    if (!d->equal)
        first = json_pack("{s:i, s:i, s:s, s:f, s:f}", "x", d->first_x, "y", d->first_y, "channel", d->first_channel,
                          "a", d->first_a, "b", d->first_b);
    json_t *root = json_pack("{s:s, s:f, s:f, s:o, s:f, s:o}", "schema", "vodr-compare-1", "max_error", d->max_error,
                             "rmse", d->rmse, "psnr", d->equal ? json_null() : json_real(d->psnr_db), "ssim", d->ssim,
                             "first_difference", first);
    if (!root)
        return host_fail(error, HOST_ENVIRONMENT, "no memory");
    json_dumpf(root, stdout, JSON_INDENT(2) | JSON_REAL_PRECISION(17));
    putchar('\n');
    json_decref(root);
    return HOST_OK;
}

static void print_lines(const difference *d)
{
    printf("max error   %g levels of 255\n", d->max_error);
    printf("rmse        %g\n", d->rmse);
    if (d->equal)
        puts("psnr        equal");
    else
        printf("psnr        %.3f dB\n", d->psnr_db);
    printf("ssim        %.6f\n", d->ssim);
    if (!d->equal)
        printf("first       x %d, y %d, channel %s: %g, %g\n", d->first_x, d->first_y, d->first_channel, d->first_a,
               d->first_b);
}

static host_status write_picture(void *context, output *o, host_error *error)
{
    return image_write_png(o, context, &(image_style){.alpha = false}, error);
}

static host_status write_diff(const char *path, const image *a, const image *b, host_error *error)
{
    vodr_frame frame;
    host_status status = difference_picture(a, b, &frame, error);
    if (status != HOST_OK)
        return status;
    status = output_write(path, write_picture, &frame, error);
    free(frame.pixels);
    return status;
}

static host_status compare(const char *const *paths, const image *a, const image *b, const compare_options *options,
                           host_error *error)
{
    difference d;
    if (a->width_px != b->width_px || a->height_px != b->height_px)
        return host_fail(error, HOST_BAD_INPUT, "'%s' is %dx%d pixels but '%s' is %dx%d", paths[0], a->width_px,
                         a->height_px, paths[1], b->width_px, b->height_px);
    host_status status = difference_measure(a, b, &d, error);
    if (status == HOST_OK && options->diff)
        status = write_diff(options->diff, a, b, error);
    if (status != HOST_OK)
        return status;
    if (options->json)
        status = print_json(&d, error);
    else
        print_lines(&d);
    return status == HOST_OK && d.max_error > options->tolerance ? HOST_DIFFERENT : status;
}

static host_status run(int argc, char **argv, host_error *error)
{
    compare_options options = {0};
    void *const targets[] = {&options};
    const char *paths[OPTION_OPERANDS];
    bool help;
    image a = {0}, b = {0};
    host_status status = options_parse(&command_compare, argc, argv, targets, paths, &help, error);
    if (status != HOST_OK || help)
        return status;
    if (options.diff)
        status = output_check(options.diff, error);
    if (status == HOST_OK)
        status = image_read_png(paths[0], &a, error);
    if (status == HOST_OK)
        status = image_read_png(paths[1], &b, error);
    if (status == HOST_OK)
        status = compare(paths, &a, &b, &options, error);
    image_free(&a);
    image_free(&b);
    return status;
}

const command command_compare = {
    .name = "compare",
    .operands = {"A.png", "B.png"},
    .required = 2,
    .summary = "how far two pictures are apart; exit code 1 when over the tolerance",
    .example = "  vodr compare new.png golden.png --tolerance 1 --diff where.png",
    .tables = {&table},
    .run = run,
};
