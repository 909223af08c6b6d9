/* view_options.c - the options that all drawing subcommands share: volume, view, machine, picture. */
#include "view_options.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "output.h"
#include "text.h"
#include "volume_options.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

static host_status set_view(void *target, const option *o, const char *value, host_error *error)
{
    camera *c = &((view_options *)target)->camera;
    double degrees[3] = {0};
    if (!text_numbers(value, ',', 2, 3, degrees) || fabs(degrees[0]) > 36000 || fabs(degrees[1]) > 90 ||
        fabs(degrees[2]) > 36000)
        return option_refuse(
            o, value, "AZ,EL or AZ,EL,ROLL in degrees, EL from -90 to 90, the others from -36000 to 36000", error);
    c->azimuth_deg = degrees[0];
    c->elevation_deg = degrees[1];
    c->roll_deg = degrees[2];
    return HOST_OK;
}

static host_status set_projection(void *target, const option *o, const char *value, host_error *error)
{
    static const char perspective[] = "perspective";
    camera *c = &((view_options *)target)->camera;
    const char *fov = value + strlen(perspective);
    c->perspective = strncmp(value, perspective, strlen(perspective)) == 0;
    if (!c->perspective && strcmp(value, "parallel") == 0)
        return HOST_OK;
    if (!c->perspective || (*fov && (*fov != ':' || !text_number(fov + 1, 1, 150, &c->fov_deg))))
        return option_refuse(o, value, "parallel, perspective or perspective:FOV with FOV from 1 to 150 degrees",
                             error);
    return HOST_OK;
}

static host_status set_zoom(void *target, const option *o, const char *value, host_error *error)
{
    if (!text_number(value, 1e-6, 1e6, &((view_options *)target)->camera.zoom))
        return option_refuse(o, value, "a number from 0.000001 to 1000000", error);
    return HOST_OK;
}

static host_status set_size(void *target, const option *o, const char *value, host_error *error)
{
    camera *c = &((view_options *)target)->camera;
    if (!text_size(value, VODR_MAX_SIZE_PX, &c->width_px, &c->height_px))
        return option_refuse(o, value, "WxH, each from 1 to 16384 pixels", error);
    return HOST_OK;
}

static host_status set_slices(void *target, const option *o, const char *value, host_error *error)
{
    int64_t slices;
    if (!text_integer(value, 1, VODR_MAX_SLICES, &slices))
        return option_refuse(o, value, "an integer from 1 to 16384", error);
    ((view_options *)target)->camera.slices = (int32_t)slices;
    return HOST_OK;
}

static host_status set_transfer(void *target, const option *o, const char *value, host_error *error)
{
    (void)o, (void)error;
    ((view_options *)target)->transfer = value;
    return HOST_OK;
}

static host_status set_window(void *target, const option *o, const char *value, host_error *error)
{
    view_options *v = target;
    double window[2];
    if (!text_numbers(value, ':', 2, 2, window) || window[0] >= window[1])
        return option_refuse(o, value, "LO:HI in the volume's values, LO below HI", error);
    v->has_window = true;
    v->window_lo = window[0];
    v->window_hi = window[1];
    return HOST_OK;
}

static host_status set_threads(void *target, const option *o, const char *value, host_error *error)
{
    int64_t threads;
    if (!text_integer(value, 0, 1024, &threads))
        return option_refuse(o, value, "an integer from 0 (all cores) to 1024", error);
    ((view_options *)target)->threads = (int32_t)threads;
    return HOST_OK;
}

static host_status set_path(void *target, const option *o, const char *value, host_error *error)
{
    static const char *const words[] = {
        [VODR_PATH_FAST] = "fast", [VODR_PATH_BLOCKS] = "blocks", [VODR_PATH_CLOCKED] = "clocked", NULL};
    int path;
    host_status status = option_word(o, value, words, "fast, blocks or clocked", &path, error);
    if (status == HOST_OK)
        ((view_options *)target)->path = (vodr_path)path;
    return status;
}

static host_status set_cycles(void *target, const option *o, const char *value, host_error *error)
{
    (void)o, (void)value, (void)error;
    ((view_options *)target)->cycles = true;
    return HOST_OK;
}

static host_status set_simd(void *target, const option *o, const char *value, host_error *error)
{
    static const char *const words[] = {[VODR_SIMD_BEST] = "best",
                                        [VODR_SIMD_PORTABLE] = "portable",
                                        [VODR_SIMD_AVX2] = "avx2",
                                        [VODR_SIMD_AVX512] = "avx512",
                                        NULL};
    int simd;
    host_status status = option_word(o, value, words, "best, portable, avx2 or avx512", &simd, error);
    if (status == HOST_OK)
        ((view_options *)target)->simd = (vodr_simd)simd;
    return status;
}

static host_status set_machine(void *target, const option *o, const char *value, host_error *error)
{
    (void)o, (void)error;
    ((view_options *)target)->machine = value;
    return HOST_OK;
}

host_status view_options_override(view_options *v, const char *name_of_option, const char *parameter, size_t n,
                                  const char *value, host_error *error)
{
    machine_override *grown = realloc(v->overrides, (v->override_count + 1) * sizeof *grown);
    char *name = strndup(parameter, n);
    if (grown)
        v->overrides = grown;
    if (!grown || !name) {
        free(name);
        return host_fail(error, HOST_ENVIRONMENT, "no memory for --%s", name_of_option);
    }
    v->overrides[v->override_count++] = (machine_override){name_of_option, name, value};
    return HOST_OK;
}

/* --blend, --filter, --traversal: the machine's parameter of that name. */
static host_status set_parameter(void *target, const option *o, const char *value, host_error *error)
{
    return view_options_override(target, o->name, o->name, strlen(o->name), value, error);
}

static host_status set_override(void *target, const option *o, const char *value, host_error *error)
{
    size_t n = strcspn(value, "=");
    if (n == 0 || value[n] == '\0')
        return option_refuse(o, value, "PARAM=VALUE (`vodr machine show paper-16` lists the parameters)", error);
    return view_options_override(target, o->name, value, n, value + n + 1, error);
}

static host_status set_energy(void *target, const option *o, const char *value, host_error *error)
{
    (void)o, (void)error;
    ((view_options *)target)->energy = value;
    return HOST_OK;
}

static host_status set_cells(void *target, const option *o, const char *value, host_error *error)
{
    (void)o, (void)error;
    ((view_options *)target)->cells = value;
    return HOST_OK;
}

static host_status set_background(void *target, const option *o, const char *value, host_error *error)
{
    uint8_t *background = ((view_options *)target)->style.background;
    if (strlen(value) != 6 || strspn(value, "0123456789abcdefABCDEF") != 6)
        return option_refuse(o, value, "RRGGBB, six hexadecimal digits", error);
    unsigned long rgb = strtoul(value, NULL, 16);
    for (int i = 0; i < 3; i++)
        background[i] = (uint8_t)(rgb >> (16 - 8 * i));
    return HOST_OK;
}

static host_status set_alpha(void *target, const option *o, const char *value, host_error *error)
{
    (void)o, (void)value, (void)error;
    ((view_options *)target)->style.alpha = true;
    return HOST_OK;
}

static host_status set_volume(void *target, const option *o, const char *value, host_error *error)
{
    bool known;
    return volume_option(target, o->name, value, &known, error);
}

static const option view_rows[] = {
    {"view", 0, "AZ,EL[,ROLL]", false, set_view, "where the eye is, degrees: a turntable (0,0: along -z, y up)"},
    {"projection", 0, "KIND[:FOV]", false, set_projection,
     "parallel, or perspective with a vertical field of view\n"
     "of 1 to 150 degrees (parallel; FOV 40)"},
    {"zoom", 0, "Z", false, set_zoom, "pixels that a finest voxel covers at the centre (1)"},
    {"size", 0, "WxH", false, set_size, "picture, 1 to 16384 pixels each (the volume's own, at most 512)"},
    {"slices", 0, "N", false, set_slices, "slices, 1 to 16384 (the volume's own depth, at most 512)"},
    {"tf", 0, "NAME|FILE", false, set_transfer,
     "transfer function: ramp, bone, skin-bone, vessels, mri,\n"
     "or a file: lines `value r g b a`, or a colour map that\n"
     "ParaView exported (ramp); reference: also one of value\n"
     "and gradient magnitude"},
    {"window", 0, "LO:HI", false, set_window,
     "values that become the least and the greatest density\n"
     "(the data's range; for CT in Hounsfield units the\n"
     "transfer function's own window)"},
    {"threads", 0, "N", false, set_threads, "threads to draw with, 0 = all cores (0)"},
    {"path", 0, "PATH", false, set_path,
     "fast, blocks, clocked: block by block, or cycle by cycle,\n"
     "on one thread (fast)"},
    {"cycles", 0, NULL, false, set_cycles, "count cycles too: each block's, and what it waits for"},
    {"simd", 0, "SET", false, set_simd,
     "instructions of the fast path: best, portable, avx2,\n"
     "avx512 (best)"},
};
const option_table option_view = {"View:", view_rows, COUNT(view_rows)};

static const option machine_rows[] = {
    {"machine", 0, "NAME|FILE", false, set_machine, "a named machine (`vodr machine list`) or a file (paper-16)"},
    {"set", 0, "PARAM=VALUE", true, set_override, "set a parameter of the machine; may be repeated"},
    {"blend", 0, "MODE", false, set_parameter, "over, under, mip; as --set blend=MODE (over)"},
    {"filter", 0, "FILTER", false, set_parameter,
     "nearest, linear, cardinal, bspline;\nas --set filter=FILTER (linear)"},
    {"traversal", 0, "ORDER", false, set_parameter,
     "whole, layer, column, tile; as --set traversal=ORDER\n"
     "(the machine's)"},
    {"energy", 0, "FILE", false, set_energy,
     "pJ of operations, for the costs among the statistics\n"
     "(as hw/energy.txt)"},
    {"cells", 0, "FILE", false, set_cells,
     "further rows of scripts/synth-row, for the costs\n"
     "(beside rtl/synthesis.txt)"},
};
const option_table option_machine = {"Machine:", machine_rows, COUNT(machine_rows)};

static const option volume_rows[] = {
    {"crop", 0, "x0:x1,y0:y1,z0:z1", false, set_volume, "draw these voxels only, in the file's axes (all)"},
    {"no-orient", 0, NULL, false, set_volume, "leave out the file's orientation"},
    {"dims", 0, "XxYxZ", false, set_volume, "raw file: voxels, x fastest"},
    {"type", 0, "TYPE", false, set_volume,
     "raw file: uint8, int8, uint16, int16, uint32, int32 or\n"
     "float32 (uint8)"},
    {"spacing", 0, "X,Y,Z", false, set_volume, "raw file: size of a voxel (1,1,1)"},
    {"endian", 0, "ORDER", false, set_volume, "raw file: little or big (little)"},
};
const option_table option_volume = {"Volume (NRRD, NIfTI, or raw with --dims):", volume_rows, COUNT(volume_rows)};

static const option picture_rows[] = {
    {"background", 0, "RRGGBB", false, set_background, "colour behind the picture (000000)"},
    {"alpha", 0, NULL, false, set_alpha, "keep the picture's transparency instead"},
};
const option_table option_picture = {"Picture:", picture_rows, COUNT(picture_rows)};

view_options view_options_default(void)
{
    return (view_options){.camera = camera_default(), .transfer = "ramp", .machine = "paper-16"};
}

void view_options_free(view_options *v)
{
    for (size_t i = 0; i < v->override_count; i++)
        free(v->overrides[i].parameter);
    free(v->overrides);
    v->overrides = NULL;
    v->override_count = 0;
}

host_status view_options_named_machine(const char *name, vodr_machine *machine, host_error *error)
{
    vodr_error reason;
    vodr_status status;
    char *text;
    if (!strchr(name, '/') && access(name, F_OK) != 0) {
        status = vodr_machine_named(name, machine, &reason);
    } else {
        host_status read = text_read(name, "machine file", &text, error);
        if (read != HOST_OK)
            return read;
        status = vodr_machine_parse(text, name, machine, &reason);
        free(text);
    }
    return status == VODR_OK ? HOST_OK : host_fail(error, HOST_BAD_INPUT, "--machine: %s", reason.text);
}

host_status view_options_output(const view_options *v, const char *input, const char *path, host_error *error)
{
    const char *const inputs[] = {input, v->transfer, v->machine, v->energy, v->cells};
    for (size_t i = 0; i < COUNT(inputs); i++) {
        host_status status = output_spare(path, inputs[i], error);
        if (status != HOST_OK)
            return status;
    }
    return output_check(path, error);
}

host_status view_options_overridden(const view_options *v, vodr_machine *machine, host_error *error)
{
    vodr_error reason;
    host_status status = view_options_named_machine(v->machine, machine, error);
    if (status != HOST_OK)
        return status;
    for (size_t i = 0; i < v->override_count; i++) {
        const machine_override *o = &v->overrides[i];
        if (vodr_machine_set(machine, o->parameter, o->value, &reason) != VODR_OK)
            return host_fail(error, HOST_BAD_INPUT, "--%s: %s", o->option, reason.text);
    }
    return HOST_OK;
}

host_status view_options_machine(const view_options *v, vodr_machine *machine, host_error *error)
{
    vodr_error reason;
    host_status status = view_options_overridden(v, machine, error);
    if (status == HOST_OK && vodr_machine_check(machine, &reason) != VODR_OK)
        return host_fail(error, HOST_BAD_INPUT, "%s", reason.text);
    return status;
}
