/* fixed.c - a frame in the machine's own arithmetic (docs/architecture.md): inputs checked, the table converted, the
 * frame packed. */
#include <stdlib.h>
#include <string.h>

#include "state.h"

/* Section 6 of docs/architecture.md: a table's channel converted from tf_bits to fb_bits. */
static uint16_t convert_channel(uint16_t value, int32_t tf_bits, int32_t fb_bits)
{
    if (tf_bits == fb_bits)
        return value;
    return (uint16_t)(tf_bits == 8 ? value * 257 : (value + 128) / 257);
}

static reference_status check_table(const vodr_table *table, const vodr_machine *m, vodr_error *error)
{
    size_t count = (size_t)1 << m->density_bits;
    if (table->count != count)
        return reference_fail(error, REFERENCE_INVALID, "the table has %zu entries, must have %zu", table->count,
                              count);
    for (size_t i = 0; i < count; i++) {
        const vodr_rgba *e = &table->entries[i];
        if (e->a >> m->tf_bits || e->r > e->a || e->g > e->a || e->b > e->a)
            return reference_fail(error, REFERENCE_INVALID,
                                  "entry %zu of the table is %d %d %d %d, must be premultiplied, of %d bits a channel",
                                  i, e->r, e->g, e->b, e->a, m->tf_bits);
    }
    return REFERENCE_OK;
}

/* Sections 2 and 6: what is refused. */
static reference_status check_fixed(const reference *r, const vodr_machine *m, const uint16_t *map,
                                    const vodr_table *table, const vodr_view *view, vodr_error *error)
{
    if (r->volume.type == REFERENCE_FLOAT32)
        return reference_fail(error, REFERENCE_INVALID, "the machine's voxels are integers, not floats");
    if (r->volume.whole_vox[0])
        return reference_fail(error, REFERENCE_INVALID, "the machine draws a whole volume, not a part of one");
    if (m->filter == VODR_FILTER_BSPLINE && r->volume.type != REFERENCE_UINT16)
        return reference_fail(error, REFERENCE_INVALID,
                              "filter=bspline takes coefficients of 16 bits, not voxels of another width");
    if (r->volume.type == REFERENCE_UINT8 && !map && m->density_bits != 8)
        return reference_fail(error, REFERENCE_INVALID, "density_bits is %d, must be 8 for 8-bit voxels without a map",
                              m->density_bits);
    for (int i = 0; map && r->volume.type == REFERENCE_UINT8 && i < 256; i++)
        if (map[i] >> m->density_bits)
            return reference_fail(error, REFERENCE_INVALID, "entry %d of the map is %d, must be below 2^%d", i, map[i],
                                  m->density_bits);
    if (vodr_machine_check(m, error) != VODR_OK || vodr_view_check(view, r->volume.dims_vox, error) != VODR_OK)
        return REFERENCE_INVALID;
    return check_table(table, m, error);
}

static reference_status draw_fixed(reference *r, const kernel_fixed *f, vodr_frame *frame, reference_stats *stats,
                                   vodr_error *error)
{
    size_t count = (size_t)f->view.width_px * (size_t)f->view.height_px;
    vodr_rgba *pixels = malloc(count * sizeof *pixels);
    if (!pixels)
        return reference_fail(error, REFERENCE_NO_MEMORY, "no memory for %zu pixels", count);
    reference_status status = r->ops->fixed(r->state, f, pixels, stats, error);
    if (status == REFERENCE_OK)
        status = reference_frame_make(f->view.width_px, f->view.height_px, f->bits, frame, error);
    for (size_t i = 0; status == REFERENCE_OK && i < count; i++) {
        const uint16_t channels[4] = {pixels[i].r, pixels[i].g, pixels[i].b, pixels[i].a};
        for (size_t c = 0; c < 4; c++)
            reference_frame_set(frame, 4 * i + c, channels[c]);
    }
    free(pixels);
    return status;
}

reference_status reference_fixed(reference *r, const vodr_machine *m, const uint16_t *map, const vodr_table *table,
                                 const vodr_view *view, vodr_frame *frame, reference_stats *stats, vodr_error *error)
{
    *frame = (vodr_frame){0};
    *stats = (reference_stats){0};
    reference_status status = check_fixed(r, m, map, table, view, error);
    if (status != REFERENCE_OK)
        return status;
    double begin_ms = reference_now_ms();
    uint16_t identity[256];
    for (int i = 0; i < 256; i++)
        identity[i] = (uint16_t)i;
    vodr_rgba *entries = malloc(table->count * sizeof *entries);
    if (!entries)
        return reference_fail(error, REFERENCE_NO_MEMORY, "no memory for a table of %zu entries", table->count);
    for (size_t i = 0; i < table->count; i++) {
        const vodr_rgba *e = &table->entries[i];
        entries[i] =
            (vodr_rgba){convert_channel(e->r, m->tf_bits, m->fb_bits), convert_channel(e->g, m->tf_bits, m->fb_bits),
                        convert_channel(e->b, m->tf_bits, m->fb_bits), convert_channel(e->a, m->tf_bits, m->fb_bits)};
    }
    kernel_fixed f = {.view = *view,
                      .voxel_bytes = r->volume.type == REFERENCE_UINT8 ? 1 : 2,
                      .density_bits = m->density_bits,
                      .weight_bits = m->weight_bits,
                      .guard_bits = m->guard_bits,
                      .bits = m->fb_bits,
                      .blend = m->blend,
                      .filter = m->filter,
                      .voxels = r->volume.voxels,
                      .map = map ? map : identity,
                      .table = entries};
    memcpy(f.dims_vox, r->volume.dims_vox, sizeof f.dims_vox);
    stats->prepare_ms = reference_now_ms() - begin_ms;
    status = draw_fixed(r, &f, frame, stats, error);
    free(entries);
    return status;
}
