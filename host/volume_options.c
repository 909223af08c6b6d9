/* volume_options.c - the options of the command line that say how to read a volume. */
#include "volume_options.h"
#include "text.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

/* Integers from lo to VODR_MAX_DIM_VOX, each followed by its separator, the last by the end of the text. */
static bool read_integers(const char *text, const char *separators, int32_t lo, int32_t *values)
{
    for (size_t i = 0; i <= strlen(separators); i++) {
        char *end;
        size_t digits = strspn(text, "0123456789");
        if (digits == 0 || digits > 9)
            return false;
        values[i] = (int32_t)strtol(text, &end, 10);
        if (values[i] < lo || values[i] > VODR_MAX_DIM_VOX || *end != separators[i])
            return false;
        text = end + 1;
    }
    return true;
}

static host_status set_dims(volume_options *o, const char *value, host_error *error)
{
    int32_t dims[3];
    if (!read_integers(value, "xx", 1, dims))
        return host_fail(error, HOST_BAD_INPUT, "--dims '%s': must be XxYxZ, each from 1 to %d", value,
                         VODR_MAX_DIM_VOX);
    memcpy(o->dims_vox, dims, sizeof dims);
    return HOST_OK;
}

static host_status set_type(volume_options *o, const char *value, host_error *error)
{
    if (!volume_type_named(value, &o->type))
        return host_fail(error, HOST_BAD_INPUT,
                         "--type '%s': must be uint8, int8, uint16, int16, uint32, int32 or float32", value);
    return HOST_OK;
}

static host_status set_spacing(volume_options *o, const char *value, host_error *error)
{
    double spacing[3];
    bool valid = text_numbers(value, ',', 3, 3, spacing) == 3;
    for (int i = 0; valid && i < 3; i++)
        valid = spacing[i] >= DBL_MIN;
    if (!valid)
        return host_fail(error, HOST_BAD_INPUT, "--spacing '%s': must be X,Y,Z, each above 0", value);
    memcpy(o->spacing, spacing, sizeof spacing);
    return HOST_OK;
}

static host_status set_endian(volume_options *o, const char *value, host_error *error)
{
    o->big_endian = strcmp(value, "big") == 0;
    if (!o->big_endian && strcmp(value, "little") != 0)
        return host_fail(error, HOST_BAD_INPUT, "--endian '%s': must be little or big", value);
    return HOST_OK;
}

static host_status set_crop(volume_options *o, const char *value, host_error *error)
{
    int32_t ends[6];
    bool valid = read_integers(value, ":,:,:", 0, ends);
    for (int i = 0; valid && i < 3; i++)
        valid = ends[2 * i] < ends[2 * i + 1];
    if (!valid)
        return host_fail(error, HOST_BAD_INPUT, "--crop '%s': must be x0:x1,y0:y1,z0:z1 with 0 <= x0 < x1 <= %d", value,
                         VODR_MAX_DIM_VOX);
    o->crop = true;
    for (int i = 0; i < 3; i++) {
        o->crop_lo[i] = ends[2 * i];
        o->crop_hi[i] = ends[2 * i + 1];
    }
    return HOST_OK;
}

static host_status set_no_orient(volume_options *o, const char *value, host_error *error)
{
    if (value)
        return host_fail(error, HOST_BAD_INPUT, "--no-orient '%s': it takes no value", value);
    o->no_orient = true;
    return HOST_OK;
}

host_status volume_option(volume_options *o, const char *name, const char *value, bool *known, host_error *error)
{
    static const struct {
        const char *name;
        host_status (*set)(volume_options *o, const char *value, host_error *error);
    } options[] = {
        {"dims", set_dims},     {"type", set_type}, {"spacing", set_spacing},
        {"endian", set_endian}, {"crop", set_crop}, {"no-orient", set_no_orient},
    };
    for (size_t i = 0; i < sizeof options / sizeof *options; i++)
        if (strcmp(name, options[i].name) == 0) {
            *known = true;
            return options[i].set(o, value, error);
        }
    *known = false;
    return HOST_OK;
}
