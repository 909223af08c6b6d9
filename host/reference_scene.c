/* reference_scene.c - a scene on the reference renderer: its voxels, transfer function and rays as reference/ takes
 * them. */
#include "reference_scene.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Fine enough for the 4,096 entries of a machine's table of 12-bit densities to be among the points sampled. */
enum { TABLE_COLUMNS = 4096, TABLE_ROWS = 65 };

host_status reference_scene_status(reference_status status)
{
    return status == REFERENCE_OK ? HOST_OK : status == REFERENCE_INVALID ? HOST_BAD_INPUT : HOST_ENVIRONMENT;
}

/* ---- voxels ---- */

/* Integers: counted from the least value on, so that they are unsigned, rise with their values - the greatest is that
 * of a maximum - and lose little where a float places them in a window. */
static int64_t base_of(const volume *v)
{
    return llround((v->min - v->inter) / v->slope);
}

static void make_rising(volume *v)
{
    const int64_t base = base_of(v);
    const int sign = v->slope < 0 ? -1 : 1;
    const bool narrow = volume_type_bytes(v->type) == 1;
    uint8_t *voxels_8 = v->voxels;
    uint16_t *voxels_16 = v->voxels;
    if (base == 0 && sign > 0)
        return;
    for (size_t i = 0, n = volume_count(v); i < n; i++) /* modulo 2^8 or 2^16, signed or not */
        if (narrow)
            voxels_8[i] = (uint8_t)(sign * (voxels_8[i] - base));
        else
            voxels_16[i] = (uint16_t)(sign * (voxels_16[i] - base));
}

/* A voxel and its float are as wide. */
static void make_floats(volume *v)
{
    unsigned char *place = v->voxels;
    for (size_t i = 0, n = volume_count(v); i < n; i++, place += sizeof(float)) {
        float value = (float)fmin(fmax(volume_value(v, i), -FLT_MAX), FLT_MAX);
        memcpy(place, &value, sizeof value);
    }
}

static bool is_narrow(const volume *v)
{
    return volume_type_bytes(v->type) < sizeof(float);
}

reference_volume reference_scene_store(volume *v)
{
    if (is_narrow(v))
        make_rising(v);
    else
        make_floats(v);
    v->quantised = true;
    const reference_voxel type[] = {[1] = REFERENCE_UINT8, [2] = REFERENCE_UINT16, [4] = REFERENCE_FLOAT32};
    return (reference_volume){.dims_vox = {v->dims_vox[0], v->dims_vox[1], v->dims_vox[2]},
                              .type = type[volume_type_bytes(v->type)],
                              .voxels = v->voxels};
}

/* ---- the job ---- */

static reference_camera camera_of(const scene *s, const reference_choice *c)
{
    double spacing_vox[3], finest = fmin(s->volume.spacing[0], fmin(s->volume.spacing[1], s->volume.spacing[2]));
    for (int a = 0; a < 3; a++)
        spacing_vox[a] = s->volume.spacing[a] / finest;
    if (c->method == REFERENCE_RAYCAST)
        return reference_camera_rays(&s->view, spacing_vox, c->step_vox);
    reference_camera slices = reference_camera_slices(&s->view);
    memcpy(slices.spacing_vox, spacing_vox, sizeof slices.spacing_vox);
    return slices;
}

reference_filter reference_scene_filter(const scene *s, const reference_choice *c)
{
    _Static_assert((int)VODR_FILTER_CARDINAL == REFERENCE_CARDINAL && (int)VODR_FILTER_BSPLINE == REFERENCE_BSPLINE,
                   "the machine's filters in their order");
    return reference_is_cubic(c->filter) ? c->filter : (reference_filter)s->machine.filter;
}

/* The scene's transfer function as a table of the job, for samples so many finest voxels long. */
static host_status fill_table(const scene *s, double depth_vox, double **entries, reference_table *table,
                              host_error *error)
{
    const transfer *t = &s->transfer;
    const bool mip = s->machine.blend == VODR_BLEND_MIP;
    table->columns = TABLE_COLUMNS;
    table->rows = t->row_count > 1 ? TABLE_ROWS : 1;
    if (t->rows && mip)
        return host_fail(error, HOST_BAD_INPUT,
                         "--tf: '%.512s' is of value and gradient magnitude, which does not go with blend=mip: it goes "
                         "with over and under",
                         t->name);
    table->rgba = *entries = malloc(4 * (size_t)table->rows * TABLE_COLUMNS * sizeof **entries);
    if (!*entries)
        return host_fail(error, HOST_ENVIRONMENT, "no memory for the transfer-function table");
    if (table->rows > 1)
        return transfer_sample_rows(t, s->window_lo, s->window_hi, TABLE_COLUMNS, TABLE_ROWS, depth_vox, *entries,
                                    &table->gradient_most, error);
    transfer_sample(t, s->window_lo, s->window_hi, TABLE_COLUMNS, mip ? 1 : depth_vox, mip, *entries);
    return HOST_OK;
}

host_status reference_scene_job(const scene *s, const reference_choice *c, double **table, reference_march_job *job,
                                host_error *error)
{
    const volume *v = &s->volume;
    const double scale = is_narrow(v) ? fabs(v->slope) : 1;
    const double offset = is_narrow(v) ? v->inter + v->slope * (double)base_of(v) : 0;
    const bool mip = s->machine.blend == VODR_BLEND_MIP;
    const double width = s->window_hi - s->window_lo;
    if (!isfinite(width))
        return host_fail(error, HOST_BAD_INPUT, "window %g:%g: must be finite", s->window_lo, s->window_hi);
    *job = (reference_march_job){
        .camera = camera_of(s, c),
        .numbers = c->numbers,
        .blend = mip ? REFERENCE_MIP : REFERENCE_OVER,
        .filter = reference_scene_filter(s, c),
        .shading = c->shading,
        .accel = c->accel,
        .theta = c->theta,
        .copies = c->copies,
        .block_vox = c->block_vox,
        .termination = c->termination < 1 ? c->termination : 2,
        .window_scale = width > 0 ? scale / width : 0,
        .window_offset = width > 0 ? (offset - s->window_lo) / width : 0,
    };
    return fill_table(s, c->method == REFERENCE_RAYCAST ? c->step_vox : s->depth_vox, table, &job->table, error);
}

static host_status open_fixed(scene *s, reference_volume *v, host_error *error)
{
    host_status status = scene_quantise(s, error);
    *v = (reference_volume){.type = s->densities.voxel_bytes == 1 ? REFERENCE_UINT8 : REFERENCE_UINT16,
                            .voxels = s->densities.voxels};
    memcpy(v->dims_vox, s->densities.dims_vox, sizeof v->dims_vox);
    return status;
}

host_status reference_scene_open(scene *s, const reference_choice *choice, int32_t threads, vodr_simd simd,
                                 reference_scene *r, host_error *error)
{
    *r = (reference_scene){.scene = s, .fixed = choice->fixed};
    const reference_options options = {choice->device, threads, simd};
    reference_volume v = {0};
    vodr_error reason;
    host_status status;
    if (choice->fixed) {
        status = open_fixed(s, &v, error);
    } else {
        v = reference_scene_store(&s->volume);
        status = reference_scene_job(s, choice, &r->table, &r->job, error);
    }
    if (status == HOST_OK) {
        status = reference_scene_status(reference_open(&options, &v, &r->renderer, &reason));
        if (status != HOST_OK)
            host_fail(error, status, "%s", reason.text);
    }
    if (status != HOST_OK)
        reference_scene_close(r);
    return status;
}

void reference_scene_close(reference_scene *r)
{
    reference_close(r->renderer);
    free(r->table);
    *r = (reference_scene){0};
}

/* ---- a frame ---- */

static reference_status draw_march(const reference_scene *r, vodr_frame *frame, reference_stats *stats,
                                   vodr_error *reason)
{
    const reference_camera *c = &r->job.camera;
    double *rgba = malloc(4 * (size_t)c->width_px * (size_t)c->height_px * sizeof *rgba);
    if (!rgba) {
        strcpy(reason->text, "no memory for the frame");
        return REFERENCE_NO_MEMORY;
    }
    reference_status status = reference_march(r->renderer, &r->job, rgba, stats, reason);
    if (status == REFERENCE_OK)
        status = reference_quantise(c, rgba, r->scene->machine.fb_bits, frame, reason);
    free(rgba);
    return status;
}

host_status reference_scene_draw(const reference_scene *r, vodr_frame *frame, reference_stats *stats, host_error *error)
{
    const scene *s = r->scene;
    vodr_error reason;
    reference_status status = r->fixed ? reference_fixed(r->renderer, &s->machine, s->densities.map, &s->table,
                                                         &s->view, frame, stats, &reason)
                                       : draw_march(r, frame, stats, &reason);
    if (status == REFERENCE_OK)
        return HOST_OK;
    return host_fail(error, reference_scene_status(status), "%s", reason.text);
}

static reference_status compare_usual(const reference_scene *r, double *rgba, size_t channels, double *psnr_db,
                                      vodr_error *reason)
{
    reference_stats stats;
    reference_march_job usual = r->job;
    double squares = 0;
    usual.accel = REFERENCE_ACCEL_BEST;
    reference_status status = reference_march(r->renderer, &r->job, rgba, &stats, reason);
    if (status == REFERENCE_OK)
        status = reference_march(r->renderer, &usual, rgba + channels, &stats, reason);
    for (size_t i = 0; status == REFERENCE_OK && i < channels; i++)
        squares += (rgba[i] - rgba[i + channels]) * (rgba[i] - rgba[i + channels]);
    *psnr_db = squares > 0 ? 10 * log10((double)channels / squares) : INFINITY;
    return status;
}

host_status reference_scene_psnr(const reference_scene *r, double *psnr_db, host_error *error)
{
    const size_t channels = 4 * (size_t)r->job.camera.width_px * (size_t)r->job.camera.height_px;
    double *rgba = malloc(2 * channels * sizeof *rgba);
    vodr_error reason;
    if (!rgba)
        return host_fail(error, HOST_ENVIRONMENT, "no memory for two frames");
    host_status status = reference_scene_status(compare_usual(r, rgba, channels, psnr_db, &reason));
    free(rgba);
    return status == HOST_OK ? status : host_fail(error, status, "%s", reason.text);
}
