/* scene.c - everything a frame is drawn from, made from the shared options: machine, volume, table, registers. */
#include "scene.h"

#include <stdio.h>
#include <stdlib.h>

void scene_window(const view_options *o, const transfer *t, bool ct, double min, double max, double *lo, double *hi)
{
    const bool own = ct && t->has_ct_window;
    *lo = o->has_window ? o->window_lo : own ? t->ct_lo : min;
    *hi = o->has_window ? o->window_hi : own ? t->ct_hi : max;
}

host_status scene_table(const vodr_machine *m, const transfer *t, double lo, double hi, double depth_vox,
                        vodr_rgba **entries, vodr_table *made, host_error *error)
{
    const bool mip = m->blend == VODR_BLEND_MIP;
    const size_t count = (size_t)1 << m->density_bits;
    *entries = malloc(count * sizeof **entries);
    if (!*entries)
        return host_fail(error, HOST_ENVIRONMENT, "no memory for the transfer-function table");
    *made = (vodr_table){*entries, count};
    transfer_table(t, lo, hi, m->density_bits, m->tf_bits, mip ? 1 : depth_vox, mip, *entries);
    return HOST_OK;
}

static host_status fill(scene *s, const char *path, const view_options *o, bool voxels, host_error *error)
{
    host_status status = view_options_machine(o, &s->machine, error);
    if (status == HOST_OK)
        status = cost_tables_open(o->energy, o->cells, &s->tables, error);
    if (status == HOST_OK)
        status = voxels ? volume_open(path, &o->volume, &s->volume, error)
                        : volume_open_header(path, &o->volume, &s->volume, error);
    return status;
}

host_status scene_settle(scene *s, const view_options *o, bool rows, host_error *error)
{
    bool ct = volume_is_ct(&s->volume);
    host_status status = (rows ? transfer_open_rows : transfer_open)(o->transfer, ct, &s->transfer, error);
    if (status != HOST_OK)
        return status;
    scene_window(o, &s->transfer, ct, s->volume.min, s->volume.max, &s->window_lo, &s->window_hi);
    status = camera_view(&s->camera, &s->volume, &s->view, &s->depth_vox, error);
    if (status != HOST_OK)
        return status;
    s->camera.width_px = s->view.width_px;
    s->camera.height_px = s->view.height_px;
    s->camera.slices = s->view.slices;
    return HOST_OK;
}

host_status scene_open_stored(const char *path, const view_options *options, bool rows, scene *s, host_error *error)
{
    *s = (scene){.machine_name = options->machine, .camera = options->camera};
    host_status status = fill(s, path, options, true, error);
    if (status == HOST_OK)
        status = scene_settle(s, options, rows, error);
    if (status != HOST_OK)
        scene_close(s);
    return status;
}

host_status scene_open_header(const char *path, const view_options *options, scene *s, host_error *error)
{
    *s = (scene){.machine_name = options->machine, .camera = options->camera};
    host_status status = fill(s, path, options, false, error);
    if (status != HOST_OK)
        scene_close(s);
    return status;
}

host_status scene_quantise(scene *s, host_error *error)
{
    host_status status =
        volume_quantise(&s->volume, s->window_lo, s->window_hi, s->machine.density_bits, &s->densities, error);
    if (status == HOST_OK && s->machine.filter == VODR_FILTER_BSPLINE)
        status = volume_coefficients(&s->volume, s->machine.density_bits, &s->densities, error);
    if (status != HOST_OK)
        return status;
    return scene_table(&s->machine, &s->transfer, s->window_lo, s->window_hi, s->depth_vox, &s->entries, &s->table,
                       error);
}

host_status scene_open(const char *path, const view_options *options, scene *s, host_error *error)
{
    host_status status = scene_open_stored(path, options, false, s, error);
    if (status != HOST_OK)
        return status;
    status = scene_quantise(s, error);
    if (status != HOST_OK)
        scene_close(s);
    return status;
}

void scene_close(scene *s)
{
    free(s->entries);
    cost_tables_free(&s->tables);
    transfer_close(&s->transfer);
    volume_close(&s->volume);
}

void scene_print_volume(const scene *s)
{
    const volume *v = &s->volume;
    printf("volume             %s, %dx%dx%d %s\n", v->path, v->dims_vox[0], v->dims_vox[1], v->dims_vox[2],
           volume_type_name(v->type));
    printf("window, function   %g:%g, %s\n", s->window_lo, s->window_hi, s->transfer.name);
}
