/* fused_band.c - one band (fuses volume_divider, slice_generator, rasterizer, texture_unit and alpha_blender): bricks
 * in visibility order, each repacked, its slices drawn in batches. A band is one thread's alone, so every pixel meets
 * its fragments in the machine's order. */
#include "fused_band.h"

#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "rasterizer.h"
#include "slice_generator.h"
#include "volume_divider.h"

vodr_status fused_band_start(fused_band *b, const fused_scene *scene, vodr_error *error)
{
    memset(b, 0, sizeof *b);
    b->scene = scene;
    b->stride_px = (size_t)scene->view->width_px + FUSED_LANES;
    if (scene->sparse)
        return VODR_OK;
    return fused_brick_start(&b->brick, scene->machine, scene->volume, scene->edge_vox, scene->kernels, error);
}

void fused_band_finish(fused_band *b)
{
    fused_brick_finish(&b->brick);
}

/* ---- the end of a batch: filter, classify, blend, mark ---- */

static void filter(fused_band *b)
{
    const fused_kernels *k = b->scene->kernels;
    const fused_texture *t = &b->brick.texture;
    if (b->scene->sparse) /* add_span() did */
        return;
    if (b->brick.linear)
        (b->brick.wide ? k->linear12 : k->linear8)(t, b->count, &b->batch);
    else
        (b->brick.wide ? k->nearest12 : k->nearest8)(t, b->count, &b->batch);
}

static void classify(fused_band *b)
{
    fused_batch *batch = &b->batch;
    if (b->scene->table8)
        for (int32_t i = 0; i < b->count; i++)
            batch->colour8[i] = b->scene->table8[batch->density[i]];
    else
        for (int32_t i = 0; i < b->count; i++)
            batch->colour16[i] = b->scene->table16[batch->density[i]];
}

/* Blends the fragments from `from` on onto their row, and tells in batch.flag which wrote, but in `over`, where all do.
 */
static void blend(fused_band *b, const band_row *row, int32_t from)
{
    const fused_kernels *k = b->scene->kernels;
    fused_batch *batch = &b->batch;
    const uint32_t *colour8 = batch->colour8 + from;
    const uint64_t *colour16 = batch->colour16 + from;
    size_t at = (size_t)(row->y - b->px.y0) * b->stride_px + (size_t)row->x;
    uint32_t *pixels8 = (uint32_t *)b->pixels + at;
    uint64_t *pixels16 = (uint64_t *)b->pixels + at;
    bool narrow = b->scene->table8 != NULL;
    switch ((vodr_blend)b->scene->machine->blend) {
    case VODR_BLEND_OVER:
        if (narrow)
            k->over8(colour8, row->count, pixels8);
        else
            k->over16(colour16, row->count, pixels16);
        break;
    case VODR_BLEND_UNDER:
        if (narrow)
            k->under8(colour8, row->count, pixels8, batch->flag);
        else
            k->under16(colour16, row->count, pixels16, batch->flag);
        break;
    case VODR_BLEND_MIP: k->mip(colour8, row->count, pixels8, batch->flag);
    }
}

static void mark(fused_band *b, const band_row *row, int32_t from)
{
    const marks *m = &b->scene->marks;
    if (m->written)
        marks_set(marks_row(m, m->written, b->k, row->y), row->x, b->batch.flag, row->count);
    if (!m->alive)
        return;
    for (int32_t i = 0; i < row->count; i++)
        b->batch.flag[i] = !b->scene->texture->dead[b->batch.density[from + i]];
    marks_set(marks_row(m, m->alive, b->k, row->y), row->x, b->batch.flag, row->count);
}

static void flush(fused_band *b)
{
    filter(b);
    classify(b);
    for (int32_t i = 0, from = 0; i < b->row_count; from += b->rows[i++].count) {
        blend(b, &b->rows[i], from);
        mark(b, &b->rows[i], from);
    }
    b->count = b->row_count = 0;
}

/* ---- the way into a batch: divide, slice, rasterize, address ---- */

/* Puts a span into the batch, in pieces where it is long: positions, or when sparse densities at once. */
static void add_span(fused_band *b, const brick_slice *slice, const span *s, fused_row *row)
{
    for (int32_t x = s->x0, n; x < s->x1; x += n) {
        int32_t room = FUSED_BATCH - b->count;
        n = s->x1 - x < room ? s->x1 - x : room;
        const span piece = {.y = s->y, .x0 = x, .x1 = x + n};
        for (int c = 0; c < 3; c++)
            row->a[c] = (uint64_t)numerator_at(&slice->plane, c, x, s->y);
        if (b->scene->sparse)
            texture_unit_filter(&b->scene->direct, slice, &piece, b->batch.density + b->count);
        else
            b->scene->kernels->address(&b->brick.texture, row, n, &b->batch, b->count);
        b->rows[b->row_count++] = (band_row){.y = s->y, .x = x, .count = n};
        b->count += n;
        if (b->count == FUSED_BATCH)
            flush(b);
    }
}

/* Whether every density of [min, max] is transparent; in mip, every one that a maximum in it can hide as well. */
static bool transparent(const fused_scene *s, int32_t min, int32_t max)
{
    return s->texture->transparent_to[s->machine->blend == VODR_BLEND_MIP ? 0 : min] >= max;
}

/* Repacks a brick that has fragments and sets the positions' origin; false when the brick can be dropped. */
static bool load(fused_band *b, const vox_box *box, fused_row *row)
{
    const fused_scene *s = b->scene;
    int32_t min, max;
    fused_brick_load(&b->brick, box, &min, &max);
    if (s->droppable && transparent(s, min, max))
        return false;
    for (int c = 0; c < 3; c++) {
        int64_t voxel = (int64_t)1 << VODR_POSITION_BITS, half = b->brick.linear ? voxel / 2 : 0;
        row->start[c] = (uint32_t)(s->view->base[c] - half - b->brick.origin_vox[c] * voxel);
    }
    return true;
}

static void draw_candidate(fused_band *b, const candidate *c)
{
    const fused_scene *s = b->scene;
    bool loaded = s->sparse;
    fused_row row = {.shift = s->view->shift};
    slice_generator slices =
        slice_generator_start(s->view, &c->box, c->k0, c->k1, s->machine->blend == VODR_BLEND_UNDER);
    brick_slice slice;
    while (slice_generator_next(&slices, &slice)) {
        rasterizer rows;
        span here;
        rasterizer_start(&rows, &slice, &c->bound);
        b->k = slice.k;
        for (int i = 0; i < 3; i++)
            row.step[i] = (uint64_t)slice.plane.step_u[i];
        while (rasterizer_next(&rows, &here)) {
            if (!loaded && !load(b, &c->box, &row))
                return;
            loaded = true;
            add_span(b, &slice, &here, &row);
        }
        if (b->count) /* the next slice blends onto the same pixels */
            flush(b);
    }
}

/* ---- the band ---- */

/* A row of mip's tokens as colours. */
static void read_out(const fused_scene *s, const uint32_t *tokens, void *pixels)
{
    for (int32_t x = 0; x < s->frame->width_px; x++) {
        const vodr_rgba nothing = {0}, *c = &nothing;
        if (tokens[x] & FUSED_TOUCHED)
            c = &s->texture->readout[tokens[x] & (FUSED_TOUCHED - 1)];
        const uint16_t channels[4] = {c->r, c->g, c->b, c->a};
        for (int i = 0; i < 4; i++) {
            if (s->frame->bits == 16)
                ((uint16_t *)pixels)[4 * x + i] = channels[i];
            else
                ((uint8_t *)pixels)[4 * x + i] = (uint8_t)channels[i];
        }
    }
}

static void store(const fused_band *b, size_t pixel_bytes)
{
    const vodr_frame *f = b->scene->frame;
    size_t row_bytes = (size_t)f->width_px * (size_t)f->bits / 2;
    for (int32_t y = b->px.y0; y < b->px.y1; y++) {
        const uint8_t *from = (const uint8_t *)b->pixels + (size_t)(y - b->px.y0) * b->stride_px * pixel_bytes;
        uint8_t *to = (uint8_t *)f->pixels + (size_t)y * row_bytes;
        if (b->scene->machine->blend == VODR_BLEND_MIP)
            read_out(b->scene, (const uint32_t *)(const void *)from, to);
        else
            memcpy(to, from, row_bytes);
    }
}

vodr_status fused_band_draw(fused_band *b, int32_t y0_px, int32_t y1_px, vodr_error *error)
{
    const fused_scene *s = b->scene;
    size_t pixel_bytes = s->table8 ? sizeof(uint32_t) : sizeof(uint64_t);
    size_t bytes = b->stride_px * (size_t)(y1_px - y0_px) * pixel_bytes;
    b->px = (px_rect){0, y0_px, s->view->width_px, y1_px};
    b->pixels = calloc(bytes, 1);
    if (!b->pixels)
        return vodr_fail(error, VODR_NO_MEMORY, "no memory for a band of %zu bytes", bytes);
    volume_divider d;
    vodr_status status = volume_divider_start(&d, &s->walk, s->volume, s->view, s->edge_vox, &b->px, NULL, error);
    candidate c;
    while (status == VODR_OK && volume_divider_next(&d, &c))
        draw_candidate(b, &c);
    volume_divider_finish(&d);
    if (status == VODR_OK)
        store(b, pixel_bytes);
    free(b->pixels);
    return status;
}
