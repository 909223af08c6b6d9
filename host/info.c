/* info.c - `vodr info`: what a volume file holds, and how to look at it. */
#include "commands.h"
#include "json.h"
#include "orientation.h"
#include "suggest.h"
#include "view_options.h"
#include "volume.h"

#include <inttypes.h>
#include <stdio.h>

enum { PARTS = 16, BAR_CHARS = 50 };

/* The share of the voxels, 0 to 1, in a part of the range. */
static double share(const histogram *h, int part)
{
    return histogram_share(h, part, part + 1);
}

static void print_text(const volume *v, const histogram *h, const suggestion *s)
{
    char words[64];
    orientation_words(v, words, sizeof words);
    printf("file         %s\nformat       %s\n", v->path, v->format);
    printf("voxels       %" PRId32 "x%" PRId32 "x%" PRId32 "\n", v->dims_vox[0], v->dims_vox[1], v->dims_vox[2]);
    printf("type         %s\n", volume_type_name(v->type));
    printf("spacing      %.9g %.9g %.9g\n", v->spacing[0], v->spacing[1], v->spacing[2]);
    printf("orientation  %s\n", words);
    printf("range        %.17g to %.17g%s\n", v->min, v->max, volume_is_ct(v) ? " (CT, Hounsfield units)" : "");
    printf("nonfinite    %" PRIu64 "%s\n", v->nonfinite,
           v->nonfinite ? " (NaN or infinite: drawn as the minimum)" : "");
    printf("suggested    --tf %s", s->transfer);
    if (s->lo < s->hi) /* all voxels may be alike */
        printf(" --window %.9g:%.9g", s->lo, s->hi);
    fputs("\n\n", stdout);
    double width = (v->max - v->min) / PARTS, largest = 0;
    for (int i = 0; i < PARTS; i++)
        largest = share(h, i) > largest ? share(h, i) : largest;
    for (int i = 0; i < PARTS; i++) {
        static const char bar[BAR_CHARS + 1] = "##################################################";
        int length = (int)(share(h, i) / largest * BAR_CHARS + 0.5);
        printf("%12.6g %6.2f %%%s%.*s\n", v->min + i * width, 100 * share(h, i), length ? " " : "", length, bar);
    }
}

static host_status print_json(const volume *v, const histogram *h, const suggestion *s, host_error *error)
{
    char words[64];
    orientation_words(v, words, sizeof words);
    json_t *counts = json_array();
    for (int i = 0; i < PARTS; i++)
        json_array_append_new(counts, json_integer((json_int_t)histogram_count(h, i, i + 1)));
    json_t *root = json_pack("{s:s, s:o, s:s, s:[i,i,i], s:s, s:[f,f,f], s:{s:[i,i,i], s:[i,i,i], s:s}, s:f, s:f, s:I, "
                             "s:b, s:s, s:[f,f], s:o}",
                             "schema", "vodr-info-1", "file", json_text(v->path), "format", v->format, "dims",
                             v->dims_vox[0], v->dims_vox[1], v->dims_vox[2], "type", volume_type_name(v->type),
                             "spacing", v->spacing[0], v->spacing[1], v->spacing[2], "orientation", "axis", v->axis[0],
                             v->axis[1], v->axis[2], "sign", v->sign[0], v->sign[1], v->sign[2], "words", words, "min",
                             v->min, "max", v->max, "nonfinite", (json_int_t)v->nonfinite, "ct", volume_is_ct(v), "tf",
                             s->transfer, "window", s->lo, s->hi, "histogram", counts);
    if (!root)
        return host_fail(error, HOST_ENVIRONMENT, "%s: no memory for the JSON text", v->path);
    json_dumpf(root, stdout, JSON_INDENT(2));
    putchar('\n');
    json_decref(root);
    return HOST_OK;
}

static host_status print_volume(const volume *v, bool json, host_error *error)
{
    suggestion s;
    histogram h;
    histogram_of(v, &h);
    host_status status = suggest(v, &h, &s, error);
    if (status != HOST_OK)
        return status;
    if (json)
        return print_json(v, &h, &s, error);
    print_text(v, &h, &s);
    return HOST_OK;
}

static host_status set_json(void *target, const option *o, const char *value, host_error *error)
{
    (void)o, (void)value, (void)error;
    *(bool *)target = true;
    return HOST_OK;
}

static const option info_rows[] = {{"json", 0, NULL, false, set_json, "print JSON"}};
static const option_table info_options = {"Output:", info_rows, 1};

static host_status info_run(int argc, char **argv, host_error *error)
{
    volume_options options = {0};
    bool json = false, help;
    const char *operands[OPTION_OPERANDS];
    void *const targets[] = {&options, &json};
    volume v;
    host_status status = options_parse(&command_info, argc, argv, targets, operands, &help, error);
    if (status != HOST_OK || help)
        return status;
    status = volume_open(operands[0], &options, &v, error);
    if (status != HOST_OK)
        return status;
    status = print_volume(&v, json, error);
    volume_close(&v);
    return status;
}

const command command_info = {
    .name = "info",
    .operands = {"VOLUME"},
    .required = 1,
    .summary = "what a volume file holds: size, type, orientation, values",
    .example = "  vodr info head.nii.gz\n  vodr info raw.bin --dims 256x256x113 --type uint16 --endian big --json",
    .tables = {&option_volume, &info_options},
    .run = info_run,
};
