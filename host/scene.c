/* scene.c - everything a frame is drawn from, made from the shared options: machine, volume, table, registers. */
#include "scene.h"

#include <stdlib.h>

static void choose_window(scene *s, const view_options *o, bool ct)
{
    s->window_lo = s->volume.min;
    s->window_hi = s->volume.max;
    if (ct && s->transfer.has_ct_window) {
        s->window_lo = s->transfer.ct_lo;
        s->window_hi = s->transfer.ct_hi;
    }
    if (o->has_window) {
        s->window_lo = o->window_lo;
        s->window_hi = o->window_hi;
    }
}

static host_status fill_table(scene *s, host_error *error)
{
    const vodr_machine *m = &s->machine;
    bool mip = m->blend == VODR_BLEND_MIP;
    s->table.count = (size_t)1 << m->density_bits;
    s->entries = malloc(s->table.count * sizeof *s->entries);
    if (!s->entries)
        return host_fail(error, HOST_ENVIRONMENT, "no memory for the transfer-function table");
    s->table.entries = s->entries;
    transfer_table(&s->transfer, s->window_lo, s->window_hi, m->density_bits, m->tf_bits, mip ? 1 : s->depth_vox, mip,
                   s->entries);
    return HOST_OK;
}

static host_status fill(scene *s, const char *path, const view_options *o, host_error *error)
{
    host_status status = view_options_machine(o, &s->machine, error);
    if (status == HOST_OK)
        status = energy_open(o->energy, &s->energy, error);
    if (status == HOST_OK)
        status = volume_open(path, &o->volume, &s->volume, error);
    if (status != HOST_OK)
        return status;
    bool ct = volume_is_ct(&s->volume);
    status = transfer_open(o->transfer, ct, &s->transfer, error);
    if (status != HOST_OK)
        return status;
    choose_window(s, o, ct);
    status = camera_view(&s->camera, &s->volume, &s->view, &s->depth_vox, error);
    if (status == HOST_OK)
        status = volume_quantise(&s->volume, s->window_lo, s->window_hi, s->machine.density_bits, &s->densities, error);
    return status == HOST_OK ? fill_table(s, error) : status;
}

host_status scene_open(const char *path, const view_options *options, scene *s, host_error *error)
{
    *s = (scene){.machine_name = options->machine, .camera = options->camera};
    host_status status = fill(s, path, options, error);
    if (status != HOST_OK) {
        scene_close(s);
        return status;
    }
    s->camera.width_px = s->view.width_px;
    s->camera.height_px = s->view.height_px;
    s->camera.slices = s->view.slices;
    return HOST_OK;
}

void scene_close(scene *s)
{
    free(s->entries);
    transfer_close(&s->transfer);
    volume_close(&s->volume);
}
