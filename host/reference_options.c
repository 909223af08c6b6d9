/* reference_options.c - the options of `vodr reference` beyond the view, and which of them go together. */
#include "reference_options.h"

#include <string.h>

#include "text.h"

enum { FIXED = REFERENCE_TEXTURE + 1 }; /* of --numbers, behind those of floating point */

static const char *const devices[] = {[REFERENCE_CPU] = "cpu", [REFERENCE_CUDA] = "cuda", NULL};
static const char *const methods[] = {[REFERENCE_SLICES] = "slices", [REFERENCE_RAYCAST] = "raycast", NULL};
static const char *const numbers[] = {[REFERENCE_FLOAT] = "float",
                                      [REFERENCE_DOUBLE] = "double",
                                      [REFERENCE_TEXTURE] = "texture",
                                      [FIXED] = "fixed",
                                      NULL};
static const char *const accels[] = {[REFERENCE_ACCEL_NONE] = "none",
                                     [REFERENCE_ACCEL_BLOCK] = "block",
                                     [REFERENCE_ACCEL_BISECT] = "bisect",
                                     [REFERENCE_ACCEL_SEED] = "seed",
                                     [REFERENCE_ACCEL_BEST] = "best",
                                     [REFERENCE_ACCEL_RIVAL] = "rival",
                                     [REFERENCE_ACCEL_HULL] = "hull",
                                     [REFERENCE_ACCEL_ALIGNED] = "aligned",
                                     [REFERENCE_ACCEL_ALIGNED_BEST] = "aligned-best",
                                     [REFERENCE_ACCEL_ALIGNED_PAPER] = "aligned-paper",
                                     NULL};
static const char *const thetas[] = {[REFERENCE_THETA_BOX] = "box", [REFERENCE_THETA_PLANE] = "plane", NULL};
static const char *const filters[] = {[REFERENCE_NEAREST] = "nearest",
                                      [REFERENCE_LINEAR] = "linear",
                                      [REFERENCE_CARDINAL] = "cardinal",
                                      [REFERENCE_BSPLINE] = "bspline",
                                      NULL};
static const char *const shadings[] = {[REFERENCE_UNLIT] = "none", [REFERENCE_PHONG] = "phong", NULL};

static host_status set_device(void *target, const option *o, const char *value, host_error *error)
{
    int i;
    host_status status = option_word(o, value, devices, "cpu or cuda", &i, error);
    if (status == HOST_OK)
        ((reference_wish *)target)->choice.device = (reference_device)i;
    return status;
}

static host_status set_method(void *target, const option *o, const char *value, host_error *error)
{
    int i;
    host_status status = option_word(o, value, methods, "slices or raycast", &i, error);
    if (status == HOST_OK)
        ((reference_wish *)target)->choice.method = (reference_method)i;
    return status;
}

static host_status set_numbers(void *target, const option *o, const char *value, host_error *error)
{
    int i;
    reference_choice *c = &((reference_wish *)target)->choice;
    host_status status = option_word(o, value, numbers, "fixed, float, double or texture", &i, error);
    if (status != HOST_OK)
        return status;
    c->fixed = i == FIXED;
    c->numbers = c->fixed ? REFERENCE_FLOAT : (reference_numbers)i;
    return HOST_OK;
}

static host_status set_accel(void *target, const option *o, const char *value, host_error *error)
{
    int i;
    reference_wish *w = target;
    host_status status =
        option_word(o, value, accels,
                    "none, block, bisect, seed, best, rival, hull, aligned, aligned-best or aligned-paper", &i, error);
    if (status != HOST_OK)
        return status;
    w->choice.accel = (reference_accel)i;
    w->has_accel = true;
    return HOST_OK;
}

static host_status set_theta(void *target, const option *o, const char *value, host_error *error)
{
    int i;
    reference_wish *w = target;
    host_status status = option_word(o, value, thetas, "box or plane", &i, error);
    if (status != HOST_OK)
        return status;
    w->choice.theta = (reference_theta)i;
    w->has_theta = true;
    return HOST_OK;
}

static host_status set_copies(void *target, const option *o, const char *value, host_error *error)
{
    int64_t copies;
    if (!text_integer(value, 1, 3, &copies) || copies == 2)
        return option_refuse(o, value, "1 or 3", error);
    ((reference_wish *)target)->choice.copies = (int32_t)copies;
    return HOST_OK;
}

static host_status set_filter(void *target, const option *o, const char *value, host_error *error)
{
    int i;
    reference_wish *w = target;
    host_status status = option_word(o, value, filters, "nearest, linear, cardinal or bspline", &i, error);
    if (status != HOST_OK)
        return status;
    w->choice.filter = (reference_filter)i;
    w->machine_filter = filters[i];
    return HOST_OK;
}

static host_status set_shading(void *target, const option *o, const char *value, host_error *error)
{
    int i;
    reference_wish *w = target;
    host_status status = option_word(o, value, shadings, "none or phong", &i, error);
    if (status != HOST_OK)
        return status;
    w->choice.shading = (reference_shading)i;
    w->has_shading = true;
    return HOST_OK;
}

static host_status set_step(void *target, const option *o, const char *value, host_error *error)
{
    reference_wish *w = target;
    w->has_step = true;
    if (text_number(value, 0.01, 1000, &w->choice.step_vox))
        return HOST_OK;
    return option_refuse(o, value, "a number of finest voxels from 0.01 to 1000", error);
}

static host_status set_block(void *target, const option *o, const char *value, host_error *error)
{
    reference_wish *w = target;
    int64_t edge_vox;
    if (!text_integer(value, 2, VODR_MAX_DIM_VOX, &edge_vox))
        return option_refuse(o, value, "an integer from 2 to 32768", error);
    w->has_block = true;
    w->choice.block_vox = (int32_t)edge_vox;
    return HOST_OK;
}

static host_status set_termination(void *target, const option *o, const char *value, host_error *error)
{
    reference_wish *w = target;
    w->has_termination = true;
    if (text_number(value, 0.01, 1, &w->choice.termination))
        return HOST_OK;
    return option_refuse(o, value, "an opacity from 0.01 to 1", error);
}

static const option rows[] = {
    {"device", 0, "DEVICE", false, set_device, "cpu or cuda (cpu)"},
    {"method", 0, "METHOD", false, set_method,
     "slices or raycast; slices are where the machine samples\n"
     "(slices)"},
    {"numbers", 0, "NUMBERS", false, set_numbers,
     "fixed, float, double, texture (float)\n"
     "fixed is the machine's own, equal to `vodr render` to the\n"
     "byte; texture has weights of 8 bits, as a card's texture\n"
     "unit"},
    {"accel", 0, "ACCEL", false, set_accel,
     "none, block, bisect, seed, best, rival, hull, aligned,\n"
     "aligned-best, aligned-paper (best)\n"
     "how what does not show is passed over; the picture is\n"
     "the same; bisect and seed are of mip, rival and hull of\n"
     "cubic filters, which have none and best beside; aligned\n"
     "and aligned-best are none and best of bspline, reading\n"
     "memory in an order that suits the view; aligned-paper\n"
     "turns the picture for it and back, which rounds it"},
    {"theta", 0, "THETA", false, set_theta,
     "box or plane (box)\n"
     "what aligned-paper turns the picture for, neighbours on\n"
     "the volume's face or in the image"},
    {"copies", 0, "N", false, set_copies,
     "1 or 3 (3 where there is room)\n"
     "of the coefficients, for the aligned accels"},
    {"filter", 0, "FILTER", false, set_filter,
     "nearest, linear, cardinal, bspline (linear)\n"
     "cardinal and bspline weight 64 voxels, by Catmull and\n"
     "Rom's cubics through them and by B-splines"},
    {"step", 0, "VOXELS", false, set_step, "raycast: finest voxels between samples, 0.01 to 1000 (1)"},
    {"block", 0, "N", false, set_block, "edge of the blocks of --accel in voxels, 2 to 32768 (8)"},
    {"shading", 0, "SHADING", false, set_shading, "none or phong; phong is light from the eye (none)"},
    {"termination", 0, "OPACITY", false, set_termination,
     "a ray ends at this opacity, 0.01 to 1; 1: never (raycast\n"
     "0.998, slices 1)"},
};
const option_table option_reference = {"Reference:", rows, sizeof rows / sizeof *rows};

reference_wish reference_wish_default(void)
{
    return (reference_wish){.choice = {.accel = REFERENCE_ACCEL_BEST, .step_vox = 1, .block_vox = 8}};
}

/* ---- what goes together ---- */

static host_status refuse_fixed(const reference_wish *w, host_error *error)
{
    const char *given = w->has_accel && w->choice.accel != REFERENCE_ACCEL_NONE  ? "accel"
                        : w->has_shading && w->choice.shading != REFERENCE_UNLIT ? "shading"
                        : w->has_block                                           ? "block"
                        : w->has_termination                                     ? "termination"
                                                                                 : NULL;
    if (w->choice.method == REFERENCE_RAYCAST)
        return host_fail(error, HOST_BAD_INPUT,
                         "--method raycast has no --numbers fixed: it has float, double and texture");
    if (given)
        return host_fail(error, HOST_BAD_INPUT,
                         "--%s does not go with --numbers fixed, which draws as the machine does: it goes with float, "
                         "double and texture",
                         given);
    return HOST_OK;
}

static host_status refuse_cubic(const reference_wish *w, host_error *error)
{
    const reference_choice *c = &w->choice;
    const bool cubic = reference_is_cubic(c->filter);
    if (cubic && !c->fixed && c->numbers == REFERENCE_TEXTURE)
        return host_fail(
            error, HOST_BAD_INPUT,
            "--filter %s does not go with --numbers texture: cardinal and bspline go with fixed, float and "
            "double",
            filters[c->filter]);
    if (w->has_accel && !reference_accel_suits(c->accel, REFERENCE_MIP, cubic ? c->filter : REFERENCE_LINEAR))
        return host_fail(error, HOST_BAD_INPUT, "--accel %s does not go with filter=%s, which has %s", accels[c->accel],
                         filters[cubic ? c->filter : REFERENCE_LINEAR],
                         c->filter == REFERENCE_BSPLINE
                             ? "none, best, rival, hull, aligned, aligned-best, aligned-paper"
                         : cubic ? "none, best, rival, hull"
                                 : "none, block, bisect, seed, best");
    if (w->has_theta && c->accel != REFERENCE_ACCEL_ALIGNED_PAPER)
        return host_fail(error, HOST_BAD_INPUT, "--theta goes with --accel aligned-paper: no other turns the picture");
    if (c->copies != 0 && !reference_accel_is_aligned(c->accel))
        return host_fail(error, HOST_BAD_INPUT,
                         "--copies goes with --accel aligned, aligned-best and aligned-paper: no other has any");
    return HOST_OK;
}

static host_status refuse_view(const reference_wish *w, const view_options *v, host_error *error)
{
    vodr_machine machine;
    if (v->cycles || v->path != VODR_PATH_FAST)
        return host_fail(error, HOST_BAD_INPUT, "--%s is of the machine: `vodr render` has it, reference does not",
                         v->cycles ? "cycles" : "path");
    host_status status = view_options_machine(v, &machine, error);
    if (status == HOST_OK && machine.blend == VODR_BLEND_MIP && w->choice.shading == REFERENCE_PHONG)
        return host_fail(error, HOST_BAD_INPUT,
                         "--shading phong does not go with blend=mip: it goes with over and under");
    if (status == HOST_OK && machine.blend != VODR_BLEND_MIP &&
        !reference_accel_suits(w->choice.accel, REFERENCE_OVER, REFERENCE_LINEAR) &&
        !reference_is_cubic(w->choice.filter))
        return host_fail(error, HOST_BAD_INPUT, "--accel %s goes with blend=mip: over and under have none, block, best",
                         accels[w->choice.accel]);
    return status;
}

host_status reference_wish_settle(reference_wish *w, view_options *v, host_error *error)
{
    reference_choice *c = &w->choice;
    static const char filter[] = "filter";
    if (w->machine_filter) {
        host_status status = view_options_override(v, filter, filter, strlen(filter), w->machine_filter, error);
        if (status != HOST_OK)
            return status;
    }
    if (c->fixed) {
        host_status status = refuse_fixed(w, error);
        if (status != HOST_OK)
            return status;
        c->accel = REFERENCE_ACCEL_NONE;
    }
    vodr_machine machine;
    host_status known = view_options_machine(v, &machine, error);
    if (known != HOST_OK)
        return known;
    c->filter = (reference_filter)machine.filter;
    host_status cubic = refuse_cubic(w, error);
    if (cubic != HOST_OK)
        return cubic;
    if (w->has_step && c->method == REFERENCE_SLICES)
        return host_fail(error, HOST_BAD_INPUT,
                         "--step goes with --method raycast: slices are as far apart as --slices makes them");
    if (c->numbers == REFERENCE_DOUBLE && c->device == REFERENCE_CUDA)
        return host_fail(error, HOST_BAD_INPUT,
                         "--numbers double is drawn on --device cpu only: cuda has fixed, float "
                         "and texture");
    if (!w->has_termination)
        c->termination = c->method == REFERENCE_RAYCAST ? 0.998 : 1;
    return refuse_view(w, v, error);
}

/* ---- words ---- */

const char *reference_device_word(const reference_choice *c)
{
    return devices[c->device];
}

const char *reference_method_name(const reference_choice *c)
{
    return methods[c->method];
}

const char *reference_numbers_name(const reference_choice *c)
{
    return numbers[c->fixed ? (int)FIXED : (int)c->numbers];
}

const char *reference_accel_name(const reference_choice *c)
{
    return accels[c->accel];
}

const char *reference_filter_name(const reference_choice *c, const scene *s)
{
    return filters[reference_scene_filter(s, c)];
}

const char *reference_shading_name(const reference_choice *c)
{
    return shadings[c->shading];
}
