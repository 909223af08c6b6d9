/* fused_painter.c - draws bricks (fuses slice_generator, rasterizer, texture_unit and alpha_blender): repacks one, and
 * sends the fragments of each of its slices on in batches. */
#include "fused_painter.h"

#include <stdlib.h>
#include <string.h>

#include "cubic.h"
#include "error.h"
#include "rasterizer.h"
#include "slice_generator.h"

vodr_status fused_painter_start(fused_painter *p, const fused_scene *scene, vodr_error *error)
{
    memset(p, 0, sizeof *p);
    p->scene = scene;
    if (scene->sparse || scene->cubic)
        return VODR_OK;
    return fused_brick_start(&p->brick, scene->machine, scene->volume, scene->edge_vox, scene->kernels, error);
}

void fused_painter_finish(fused_painter *p)
{
    fused_brick_finish(&p->brick);
}

/* ---- the end of a batch: filter, classify, blend, mark ---- */

static void filter(fused_painter *p)
{
    const fused_kernels *k = p->scene->kernels;
    const fused_texture *t = &p->brick.texture;
    if (p->scene->sparse || p->scene->cubic) /* add_span() did */
        return;
    if (p->brick.linear)
        (p->brick.wide ? k->linear12 : k->linear8)(t, p->count, &p->batch);
    else
        (p->brick.wide ? k->nearest12 : k->nearest8)(t, p->count, &p->batch);
}

static void classify(fused_painter *p)
{
    fused_batch *batch = &p->batch;
    if (p->scene->table8)
        for (int32_t i = 0; i < p->count; i++)
            batch->colour8[i] = p->scene->table8[batch->density[i]];
    else
        for (int32_t i = 0; i < p->count; i++)
            batch->colour16[i] = p->scene->table16[batch->density[i]];
}

/* Blends the fragments from `from` on onto their row, and tells in batch.flag which wrote, but in `over`, where all do.
 */
static void blend(fused_painter *p, const band_row *row, int32_t from)
{
    const fused_kernels *k = p->scene->kernels;
    fused_batch *batch = &p->batch;
    const uint32_t *colour8 = batch->colour8 + from;
    const uint64_t *colour16 = batch->colour16 + from;
    size_t at = fused_band_at(p->band, row->x, row->y);
    uint32_t *pixels8 = (uint32_t *)p->band->pixels + at;
    uint64_t *pixels16 = (uint64_t *)p->band->pixels + at;
    bool narrow = p->scene->table8 != NULL;
    switch ((vodr_blend)p->scene->machine->blend) {
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
    default: k->mip(colour8, row->count, pixels8, batch->flag);
    }
}

static void mark(fused_painter *p, const band_row *row, int32_t from)
{
    const marks *m = &p->scene->marks;
    if (m->written)
        marks_set(marks_row(m, m->written, p->k, row->y), row->x, p->batch.flag, row->count);
    if (!m->alive)
        return;
    for (int32_t i = 0; i < row->count; i++)
        p->batch.flag[i] = !p->scene->texture->dead[p->batch.density[from + i]];
    marks_set(marks_row(m, m->alive, p->k, row->y), row->x, p->batch.flag, row->count);
}

static void flush(fused_painter *p)
{
    filter(p);
    classify(p);
    for (int32_t i = 0, from = 0; i < p->row_count; from += p->rows[i++].count) {
        blend(p, &p->rows[i], from);
        mark(p, &p->rows[i], from);
    }
    p->count = p->row_count = 0;
}

/* ---- the way into a batch: divide, slice, rasterize, address ---- */

/* Puts a span into the batch, in pieces where it is long: positions, or when sparse or cubic densities at once. */
static void add_span(fused_painter *p, const brick_slice *slice, const span *s, fused_row *row)
{
    for (int32_t x = s->x0, n; x < s->x1; x += n) {
        int32_t room = FUSED_BATCH - p->count;
        n = s->x1 - x < room ? s->x1 - x : room;
        const span piece = {.y = s->y, .x0 = x, .x1 = x + n};
        for (int c = 0; c < 3; c++)
            row->a[c] = (uint64_t)numerator_at(&slice->plane, c, x, s->y);
        if (p->scene->sparse || p->scene->cubic)
            texture_unit_filter(&p->scene->direct, slice, &piece, p->batch.density + p->count);
        else
            p->scene->kernels->address(&p->brick.texture, row, n, &p->batch, p->count);
        p->rows[p->row_count++] = (band_row){.y = s->y, .x = x, .count = n};
        p->count += n;
        if (p->count == FUSED_BATCH)
            flush(p);
    }
}

/* Whether every density of [min, max] is transparent; in mip, every one that a maximum in it can hide as well. */
static bool transparent(const fused_scene *s, int32_t min, int32_t max)
{
    return s->texture->transparent_to[s->machine->blend == VODR_BLEND_MIP ? 0 : min] >= max;
}

/* Whether a brick of a cubic filter has anything to show. */
static bool shows(const fused_scene *s, const vox_box *box)
{
    int32_t min, max;
    if (!s->droppable)
        return true;
    filter_bounds(s->machine, s->volume, box, &min, &max);
    return !transparent(s, min, max);
}

/* Repacks a brick that has fragments and sets the positions' origin; false when the brick can be dropped. */
static bool load(fused_painter *p, const vox_box *box, fused_row *row)
{
    const fused_scene *s = p->scene;
    int32_t min, max;
    fused_brick_load(&p->brick, box, &min, &max);
    if (s->droppable && transparent(s, min, max))
        return false;
    for (int c = 0; c < 3; c++) {
        int64_t voxel = (int64_t)1 << VODR_POSITION_BITS, half = p->brick.linear ? voxel / 2 : 0;
        row->start[c] = (uint32_t)(s->view->base[c] - half - p->brick.origin_vox[c] * voxel);
    }
    return true;
}

void fused_painter_draw(fused_painter *p, fused_band *band, const candidate *c)
{
    const fused_scene *s = p->scene;
    bool loaded = s->sparse;
    p->band = band;
    fused_row row = {.shift = s->view->shift};
    slice_generator slices =
        slice_generator_start(s->view, &c->box, c->k0, c->k1, s->machine->blend == VODR_BLEND_UNDER);
    brick_slice slice;
    while (slice_generator_next(&slices, &slice)) {
        rasterizer rows;
        span here;
        rasterizer_start(&rows, &slice, &c->bound);
        p->k = slice.k;
        for (int i = 0; i < 3; i++)
            row.step[i] = (uint64_t)slice.plane.step_u[i];
        while (rasterizer_next(&rows, &here)) {
            if (!loaded && !(s->cubic ? shows(s, &c->box) : load(p, &c->box, &row)))
                return;
            loaded = true;
            add_span(p, &slice, &here, &row);
        }
        if (p->count) /* the next slice blends onto the same pixels */
            flush(p);
    }
}
