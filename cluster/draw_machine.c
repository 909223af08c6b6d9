/* draw_machine.c - a node that is a machine of this project: its boxes by the hardware model, in cycles. */
#include <string.h>

#include "state.h"

/* The pixels of an area, as reference_march() gives them. */
static void copy_area(const vodr_frame *frame, rectangle area, double *rgba)
{
    const uint8_t *narrow = frame->pixels;
    const uint16_t *wide = frame->pixels;
    for (int32_t y = area.y0; y < area.y1; y++)
        for (int32_t x = area.x0; x < area.x1; x++)
            for (size_t c = 0; c < 4; c++) {
                const size_t at = 4 * ((size_t)y * (size_t)frame->width_px + (size_t)x) + c;
                *rgba++ = frame->bits == 16 ? wide[at] / 65535.0 : narrow[at] / 255.0;
            }
}

cluster_status draw_by_machine(const cluster_options *o, const brick *b, rectangle area, double *rgba,
                               cluster_share *share, vodr_error *error)
{
    const cluster_machine *m = o->machine;
    const reference_volume *held = &b->volume;
    const vodr_options how = {.threads = o->renderer.threads, .simd = o->renderer.simd, .cycles = true};
    vodr_volume v = {.voxel_bytes = held->type == REFERENCE_UINT8 ? 1 : 2, .voxels = held->voxels, .map = m->map};
    vodr_view view = m->view;
    vodr_frame frame;
    vodr_counters counters;
    memcpy(v.dims_vox, held->dims_vox, sizeof v.dims_vox);
    for (int a = 0; a < 3; a++) { /* the planes of the slices stay where they are */
        v.lo_vox[a] = b->lo_vox[a] - held->origin_vox[a];
        v.hi_vox[a] = b->hi_vox[a] - held->origin_vox[a];
        view.base[a] -= (int64_t)held->origin_vox[a] << VODR_POSITION_BITS;
    }
    vodr_status status = vodr_render(&m->machine, &v, &m->table, &view, &how, &frame, &counters, error);
    if (status != VODR_OK)
        return status == VODR_INVALID ? CLUSTER_INVALID : CLUSTER_ENVIRONMENT;
    copy_area(&frame, area, rgba);
    vodr_frame_free(&frame);
    share->samples += counters.fragments;
    share->cycles += counters.cycles.total;
    return CLUSTER_OK;
}
