/* cluster_scene.c - a scene whose voxels lie apart: each node reads of the file what it draws. */
#include "cluster_scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Voxels read at a time to find values, where nothing limits them. */
enum { SCAN_BYTES = 1 << 28 };

host_status cluster_scene_status(cluster_status status)
{
    return status == CLUSTER_OK ? HOST_OK : status == CLUSTER_INVALID ? HOST_BAD_INPUT : HOST_ENVIRONMENT;
}

static cluster_status failed(host_status status, const host_error *why, vodr_error *error)
{
    snprintf(error->text, sizeof error->text, "%.*s", (int)sizeof error->text - 1, why->text);
    return status == HOST_BAD_INPUT ? CLUSTER_INVALID : CLUSTER_ENVIRONMENT;
}

host_status cluster_scene_open(const char *path, const view_options *options, size_t memory_bytes, cluster_scene *s,
                               host_error *error)
{
    *s =
        (cluster_scene){.options = options->volume, .memory_bytes = memory_bytes, .least = INFINITY, .most = -INFINITY};
    return scene_open_header(path, options, &s->scene, error);
}

void cluster_scene_close(cluster_scene *s)
{
    scene_close(&s->scene);
    free(s->table);
}

/* Opens a box of the volume: of the file's crop, where there is one. */
static cluster_status open_box(const cluster_scene *s, const int32_t lo[3], const int32_t hi[3], volume *v,
                               vodr_error *error)
{
    volume_options o = s->options;
    host_error why;
    o.crop = true;
    for (int a = 0; a < 3; a++) {
        const int32_t begin = s->options.crop ? s->options.crop_lo[a] : 0;
        o.crop_lo[a] = begin + lo[a];
        o.crop_hi[a] = begin + hi[a];
    }
    host_status status = volume_open(s->scene.volume.path, &o, v, &why);
    return status == HOST_OK ? CLUSTER_OK : failed(status, &why, error);
}

/* ---- values ---- */

static float below(double value)
{
    const float near = (float)value;
    return (double)near > value ? nextafterf(near, -INFINITY) : near;
}

static float above(double value)
{
    return -below(-value);
}

/* The sub-volumes of the layers [first, end) from voxels whose layer 0 is z0 of the volume. */
static void scan_layers(const volume *v, const int32_t whole[3], int32_t z0, int32_t edge, int32_t first, int32_t end,
                        float *least, float *most)
{
    int32_t at[3];
    for (at[2] = first; at[2] < end; at[2]++)
        for (at[1] = 0; at[1] * edge < whole[1]; at[1]++)
            for (at[0] = 0; at[0] * edge < whole[0]; at[0]++) {
                int32_t lo[3], hi[3];
                double range[2];
                for (int a = 0; a < 3; a++) {
                    lo[a] = at[a] > 0 ? at[a] * edge - 1 : 0;
                    hi[a] = (at[a] + 1) * edge + 1 < whole[a] ? (at[a] + 1) * edge + 1 : whole[a];
                }
                lo[2] -= z0;
                hi[2] -= z0;
                volume_box_range(v, lo, hi, &range[0], &range[1]);
                *least++ = below(range[0]);
                *most++ = above(range[1]);
            }
}

static cluster_status scan(void *context, int32_t edge, int32_t first, int32_t end, float *least, float *most,
                           vodr_error *error)
{
    cluster_scene *s = context;
    const int32_t *whole = s->scene.volume.dims_vox;
    const size_t voxel = volume_type_bytes(s->scene.volume.type), plane = (size_t)whole[0] * (size_t)whole[1] * voxel;
    const size_t bytes = s->memory_bytes && s->memory_bytes < SCAN_BYTES ? s->memory_bytes : SCAN_BYTES;
    const size_t fit = bytes / plane > 2 ? (bytes / plane - 2) / (size_t)edge : 0;
    const int32_t step = fit < 1 ? 1 : fit > 32768 ? 32768 : (int32_t)fit;
    const size_t across = (size_t)((whole[0] + edge - 1) / edge) * (size_t)((whole[1] + edge - 1) / edge);
    for (int32_t l = first, next; l < end; l = next) {
        volume v;
        next = end - l > step ? l + step : end;
        const int32_t lo[3] = {0, 0, l > 0 ? l * edge - 1 : 0};
        const int32_t hi[3] = {whole[0], whole[1], (int64_t)next * edge + 1 < whole[2] ? next * edge + 1 : whole[2]};
        cluster_status status = open_box(s, lo, hi, &v, error);
        if (status != CLUSTER_OK)
            return status;
        if (v.nonfinite < volume_count(&v)) {
            s->least = fmin(s->least, v.min);
            s->most = fmax(s->most, v.max);
        }
        const size_t done = across * (size_t)(l - first);
        scan_layers(&v, whole, lo[2], edge, l, next, least + done, most + done);
        volume_close(&v);
    }
    return CLUSTER_OK;
}

/* ---- voxels ---- */

static void forget(void *context)
{
    cluster_scene *s = context;
    volume_close(&s->near);
}

static cluster_status expect(void *context, const int32_t lo[3], const int32_t hi[3], vodr_error *error)
{
    cluster_scene *s = context;
    memcpy(s->near_lo, lo, sizeof s->near_lo);
    return open_box(s, lo, hi, &s->near, error);
}

/* The voxels of a box, from those at hand or from the file. */
static cluster_status find_box(const cluster_scene *s, const int32_t lo[3], const int32_t hi[3], volume *v,
                               vodr_error *error)
{
    int32_t at[3], end[3];
    host_error why;
    if (!s->near.voxels)
        return open_box(s, lo, hi, v, error);
    for (int a = 0; a < 3; a++) {
        at[a] = lo[a] - s->near_lo[a];
        end[a] = hi[a] - s->near_lo[a];
    }
    host_status status = volume_cut(&s->near, at, end, v, &why);
    return status == HOST_OK ? CLUSTER_OK : failed(status, &why, error);
}

static void release(void *context, void *owner)
{
    (void)context;
    volume_close(owner);
    free(owner);
}

/* The densities that machines draw. */
static cluster_status load_densities(const cluster_scene *s, volume *v, reference_volume *out, vodr_error *error)
{
    const scene *all = &s->scene;
    vodr_volume made = {0};
    host_error why;
    host_status status = volume_quantise(v, all->window_lo, all->window_hi, all->machine.density_bits, &made, &why);
    *out = (reference_volume){.dims_vox = {v->dims_vox[0], v->dims_vox[1], v->dims_vox[2]},
                              .type = made.voxel_bytes == 1 ? REFERENCE_UINT8 : REFERENCE_UINT16,
                              .voxels = made.voxels};
    return status == HOST_OK ? CLUSTER_OK : failed(status, &why, error);
}

static cluster_status load(void *context, const int32_t lo[3], const int32_t hi[3], reference_volume *out, void **owner,
                           vodr_error *error)
{
    const cluster_scene *s = context;
    volume *v = malloc(sizeof *v);
    if (!v)
        return failed(HOST_ENVIRONMENT, &(host_error){"no memory for a volume"}, error);
    cluster_status status = find_box(s, lo, hi, v, error);
    if (status != CLUSTER_OK) {
        free(v);
        return status;
    }
    v->min = s->scene.volume.min; /* of the whole: what voxels are counted from */
    v->max = s->scene.volume.max;
    *owner = v;
    if (s->draws_machine)
        return load_densities(s, v, out, error);
    *out = reference_scene_store(v);
    return CLUSTER_OK;
}

cluster_source cluster_scene_source(cluster_scene *s)
{
    const volume *v = &s->scene.volume;
    return (cluster_source){.dims_vox = {v->dims_vox[0], v->dims_vox[1], v->dims_vox[2]},
                            .context = s,
                            .scan = scan,
                            .load = load,
                            .release = release,
                            .expect = expect,
                            .forget = forget,
                            .voxel_bytes = (int32_t)volume_type_bytes(v->type)};
}

/* What machines draw with. Volumes of bytes keep them, and share the map to densities. */
static host_status settle_machine(cluster_scene *s, host_error *error)
{
    scene *all = &s->scene;
    vodr_volume bytes = {0};
    host_status status = scene_table(&all->machine, &all->transfer, all->window_lo, all->window_hi, all->depth_vox,
                                     &all->entries, &all->table, error);
    if (status == HOST_OK && volume_type_bytes(all->volume.type) == 1)
        status =
            volume_quantise(&all->volume, all->window_lo, all->window_hi, all->machine.density_bits, &bytes, error);
    s->machine = (cluster_machine){all->machine, all->view, all->table, bytes.map};
    return status;
}

host_status cluster_scene_settle(cluster_scene *s, const view_options *options, const reference_choice *choice,
                                 host_error *error)
{
    volume *v = &s->scene.volume;
    v->min = s->least <= s->most ? s->least : 0;
    v->max = s->least <= s->most ? s->most : 0;
    host_status status = scene_settle(&s->scene, options, !choice->fixed && !s->draws_machine, error);
    if (status == HOST_OK && s->draws_machine)
        status = settle_machine(s, error);
    return status == HOST_OK ? reference_scene_job(&s->scene, choice, &s->table, &s->job, error) : status;
}

host_status cluster_scene_change(cluster_scene *s, const view_options *options, const char *function,
                                 const reference_choice *choice, host_error *error)
{
    view_options changed = *options;
    changed.transfer = function;
    transfer_close(&s->scene.transfer);
    s->scene.transfer = (struct transfer){0};
    free(s->table);
    s->table = NULL;
    return cluster_scene_settle(s, &changed, choice, error);
}
