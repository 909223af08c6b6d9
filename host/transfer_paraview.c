/* transfer_paraview.c - transfer functions as ParaView exports its colour maps: JSON, an object or a list of them (the
 * first counts), with "ColorSpace", "HSVWrap", "RGBPoints" (x r g b ...) and "Points" (x y midpoint sharpness ...). */
#include "transfer_file.h"

#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "text.h"

/* What a colour map without opacities gets: as of the built-in ramp, from the first colour to the last. */
static const double ramp_opacity = 0.05;

/* The file and colour map read, for sentences. */
typedef struct preset {
    const char *path;
    const json_t *object;
} preset;

static host_status refuse(const preset *p, const char *field, const char *fault, host_error *error)
{
    return host_fail(error, HOST_BAD_INPUT, "%s: \"%s\" %s", p->path, field, fault);
}

/* The quadruples of a field into *out, freshly allocated. x may be anything finite, the rest is from 0 to 1; x must
 * ascend. */
static host_status read_quadruples(const preset *p, const char *field, double (**out)[4], size_t *count,
                                   host_error *error)
{
    const json_t *array = json_object_get(p->object, field);
    size_t size = json_array_size(array);
    if (!json_is_array(array) || size == 0 || size % 4)
        return refuse(p, field, "must be a list of one or more times 4 numbers", error);
    *out = malloc(size * sizeof(double));
    if (!*out)
        return host_fail(error, HOST_ENVIRONMENT, "%s: no memory", p->path);
    *count = size / 4;
    for (size_t i = 0; i < size; i++) {
        const json_t *element = json_array_get(array, i);
        double number = json_number_value(element), before = i >= 4 ? (*out)[i / 4 - 1][0] : -INFINITY;
        if (!json_is_number(element))
            return host_fail(error, HOST_BAD_INPUT, "%s: element %zu of \"%s\" is no number", p->path, i, field);
        if (i % 4 == 0 && number <= before)
            return host_fail(error, HOST_BAD_INPUT, "%s: element %zu of \"%s\" is x = %g, not above the %g before it",
                             p->path, i, field, number, before);
        if (i % 4 && !(number >= 0 && number <= 1))
            return host_fail(error, HOST_BAD_INPUT, "%s: element %zu of \"%s\" is %g, must be 0 to 1", p->path, i,
                             field, number);
        (*out)[i / 4][i % 4] = number;
    }
    return HOST_OK;
}

static host_status read_colours(const preset *p, transfer *t, host_error *error)
{
    double(*xrgb)[4] = NULL;
    if (json_object_get(p->object, "IndexedColors"))
        return refuse(p, "IndexedColors", "is for categories, must be \"RGBPoints\"", error);
    host_status status = read_quadruples(p, "RGBPoints", &xrgb, &t->count, error);
    if (status == HOST_OK && !(t->points = malloc(t->count * sizeof *t->points)))
        status = host_fail(error, HOST_ENVIRONMENT, "%s: no memory", p->path);
    for (size_t i = 0; status == HOST_OK && i < t->count; i++)
        t->points[i] = (transfer_point){xrgb[i][0], xrgb[i][1], xrgb[i][2], xrgb[i][3], 0};
    free(xrgb);
    return status;
}

static host_status make_ramp(const preset *p, transfer *t, host_error *error)
{
    t->opacity_count = t->count > 1 ? 2 : 1;
    t->opacities = malloc(t->opacity_count * sizeof *t->opacities);
    if (!t->opacities)
        return host_fail(error, HOST_ENVIRONMENT, "%s: no memory", p->path);
    t->opacities[0] = (transfer_opacity){t->points[0].value, 0, 0.5, 0};
    t->opacities[t->opacity_count - 1] = (transfer_opacity){t->points[t->count - 1].value, ramp_opacity, 0.5, 0};
    return HOST_OK;
}

static host_status read_opacities(const preset *p, transfer *t, host_error *error)
{
    double(*xyms)[4] = NULL;
    if (!json_object_get(p->object, "Points"))
        return make_ramp(p, t, error);
    host_status status = read_quadruples(p, "Points", &xyms, &t->opacity_count, error);
    if (status == HOST_OK && !(t->opacities = malloc(t->opacity_count * sizeof *t->opacities)))
        status = host_fail(error, HOST_ENVIRONMENT, "%s: no memory", p->path);
    for (size_t i = 0; status == HOST_OK && i < t->opacity_count; i++)
        t->opacities[i] = (transfer_opacity){xyms[i][0], xyms[i][1], xyms[i][2], xyms[i][3]};
    free(xyms);
    return status;
}

/* true and false, or a number as ParaView writes it; absent is false. */
static host_status read_flag(const preset *p, const char *field, bool *flag, host_error *error)
{
    const json_t *value = json_object_get(p->object, field);
    if (value && !json_is_boolean(value) && !json_is_number(value))
        return refuse(p, field, "must be true, false, 1 or 0", error);
    *flag = json_is_true(value) || json_number_value(value) != 0;
    return HOST_OK;
}

static host_status read_space(const preset *p, transfer *t, host_error *error)
{
    static const struct {
        const char *name;
        colour_space space;
    } spaces[] = {{"RGB", COLOUR_RGB}, {"HSV", COLOUR_HSV}, {"Lab", COLOUR_LAB}, {"Diverging", COLOUR_DIVERGING}};
    const json_t *value = json_object_get(p->object, "ColorSpace");
    const char *name = value ? json_string_value(value) : "RGB";
    bool wrap = false, log_scale = false, found = false;
    host_status status = read_flag(p, "HSVWrap", &wrap, error);
    if (status == HOST_OK)
        status = read_flag(p, "UseLogScale", &log_scale, error);
    if (status == HOST_OK)
        status = read_flag(p, "Normalized", &t->normalized, error);
    if (status != HOST_OK)
        return status;
    if (log_scale)
        return refuse(p, "UseLogScale", "is not supported, must be false", error);
    for (size_t i = 0; name && i < sizeof spaces / sizeof *spaces; i++)
        if (strcmp(name, spaces[i].name) == 0) {
            t->space = spaces[i].space;
            found = true;
        }
    if (t->space == COLOUR_HSV && wrap)
        t->space = COLOUR_HSV_WRAPPED;
    return found ? HOST_OK : refuse(p, "ColorSpace", "must be \"RGB\", \"HSV\", \"Lab\" or \"Diverging\"", error);
}

static host_status read_preset(const preset *p, transfer *t, host_error *error)
{
    if (!json_is_object(p->object))
        return host_fail(error, HOST_BAD_INPUT, "%s: must be a colour map of ParaView, or a list of them", p->path);
    host_status status = read_space(p, t, error);
    if (status == HOST_OK)
        status = read_colours(p, t, error);
    return status == HOST_OK ? read_opacities(p, t, error) : status;
}

host_status transfer_parse_paraview(char *text, const char *path, transfer *t, host_error *error)
{
    json_error_t fault;
    json_t *root = json_loads(text, JSON_REJECT_DUPLICATES, &fault);
    if (!root) {
        text_make_printable(fault.text);
        return host_fail(error, HOST_BAD_INPUT, "%s:%d: is no valid JSON: %s", path, fault.line, fault.text);
    }
    preset p = {path, json_is_array(root) ? json_array_get(root, 0) : root};
    host_status status = read_preset(&p, t, error);
    json_decref(root);
    return status;
}
