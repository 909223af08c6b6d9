/* staged.c - scenes made in memory, as scene_open_stored() makes them of files. */
#include "staged.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ideal.h"
#include "unit.h"

static void check(host_status status, const host_error *error)
{
    if (status != HOST_OK)
        fail_msg("%s", error->text);
}

void staged_open(scene *s, volume *v, const char *transfer_name, const char *machine, const camera *eye)
{
    host_error error;
    const bool ct = volume_is_ct(v);
    *s = (scene){.machine_name = "made", .machine = unit_machine(machine), .volume = *v, .camera = *eye};
    check(transfer_open(transfer_name, ct, &s->transfer, &error), &error);
    scene_window(&(view_options){0}, &s->transfer, ct, v->min, v->max, &s->window_lo, &s->window_hi);
    check(camera_view(eye, v, &s->view, &s->depth_vox, &error), &error);
    *v = (volume){0};
}

double *staged_ideal(const scene *s)
{
    size_t count = volume_count(&s->volume);
    float *values = malloc(count * sizeof *values);
    double *rgba = malloc(4 * (size_t)s->view.width_px * (size_t)s->view.height_px * sizeof *rgba);
    assert_true(values && rgba);
    for (size_t i = 0; i < count; i++)
        values[i] = (float)volume_value(&s->volume, i);
    ideal_scene ideal = {.values = values,
                         .view = &s->view,
                         .transfer = &s->transfer,
                         .window_lo = s->window_lo,
                         .window_hi = s->window_hi,
                         .depth_vox = s->depth_vox};
    memcpy(ideal.dims_vox, s->volume.dims_vox, sizeof ideal.dims_vox);
    ideal_render(&ideal, rgba);
    free(values);
    return rgba;
}

double staged_psnr(const double *a, const double *b, size_t channels)
{
    double squares = 0;
    for (size_t i = 0; i < channels; i++)
        squares += (a[i] - b[i]) * (a[i] - b[i]);
    return squares > 0 ? -10 * log10(squares / (double)channels) : 999;
}
