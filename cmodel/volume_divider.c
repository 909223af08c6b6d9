/* volume_divider.c - brick size, brick order, empty bricks.
 *
 * Order: along a pixel, positions are monotone in k on every axis, so any nesting of three loops that each run in the
 * direction of that motion visits the bricks of every pixel in the order of its samples. In parallel views the
 * direction is the sign of step_s (the paper's cases 1 and 2); in perspective it is towards the eye's own brick from
 * both sides, and that brick last (case 3). */
#include "volume_divider.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "cubic.h"
#include "error.h"
#include "layout.h"
#include "voxels.h"

int32_t volume_divider_edge(const vodr_machine *m, const vodr_view *view)
{
    if (m->traversal == VODR_TRAVERSAL_WHOLE)
        return 0;
    if (m->brick)
        return m->brick;
    int64_t edge = ((int64_t)tile_px(m) << VODR_FOOTPRINT_BITS) / view->footprint;
    int64_t room = m->texture_memory_bytes / ((m->double_buffer ? 2 : 1) * density_bytes(m));
    int64_t border = 2 * filter_border_vox(m), fits = 0;
    while ((fits + 1 + border) * (fits + 1 + border) * (fits + 1 + border) <= room)
        fits++;
    if (edge > fits)
        edge = fits;
    return (int32_t)(edge > m->brick_min ? edge : m->brick_min);
}

vodr_status volume_divider_check(const vodr_machine *m, const int32_t dims_vox[3], int32_t edge_vox, vodr_error *error)
{
    int64_t bytes = density_bytes(m) * (m->double_buffer ? 2 : 1), border = 2 * filter_border_vox(m);
    for (int c = 0; c < 3; c++)
        bytes *= edge_vox + border < dims_vox[c] ? edge_vox + border : dims_vox[c];
    if (bytes <= m->texture_memory_bytes)
        return VODR_OK;
    return vodr_fail(error, VODR_INVALID,
                     "a brick of %" PRId32 " voxels (%s) needs %" PRId64
                     " bytes of texture memory with its border%s, but texture_memory_bytes is %" PRId32,
                     edge_vox, m->brick ? "brick" : "brick_min", bytes, m->double_buffer ? ", double-buffered" : "",
                     m->texture_memory_bytes);
}

/* The axis along which layers are stacked: the one the view looks along most, in voxels; of equals the last. */
static int dominant_axis(const vodr_view *v)
{
    int best = 0;
    int64_t largest = -1;
    for (int c = 0; c < 3; c++) {
        int64_t d = v->step_s[c];
        if (v->perspective) /* twice the direction through the middle of the frame */
            d = 2 * d + (v->width_px - 1) * v->step_u[c] + (v->height_px - 1) * v->step_v[c];
        d = d < 0 ? -d : d;
        if (d >= largest) {
            largest = d;
            best = c;
        }
    }
    return best;
}

/* Loops over z, y, x with the dominant axis outermost (layers) or innermost (columns). */
static void choose_nest(volume_divider *d, bool column)
{
    int dominant = dominant_axis(d->view), n = column ? 0 : 1;
    for (int c = 2; c >= 0; c--)
        if (c != dominant)
            d->nest[n++] = c;
    d->nest[column ? 2 : 0] = dominant;
}

int32_t volume_divider_eye(const volume_divider *d, int c)
{
    int64_t first_vox = d->drawn.lo[c], last_vox = d->drawn.hi[c] - 1;
    int64_t eye_vox = d->view->step_s[c] >= 0 ? last_vox : first_vox;
    if (d->view->perspective)
        eye_vox = d->view->base[c] >> VODR_POSITION_BITS;
    if (eye_vox < first_vox)
        return 0;
    return (int32_t)(((eye_vox < last_vox ? eye_vox : last_vox) - first_vox) / d->edge_vox[c]);
}

/* Up to the eye's brick from below, then down to it from above. */
static void fill_order(volume_divider *d, int c, bool front_to_back)
{
    int32_t count = d->bricks[c], eye = volume_divider_eye(d, c);
    for (int32_t i = 0; i < count; i++) {
        int32_t place = front_to_back ? count - 1 - i : i;
        d->order[c][i] = place < eye ? place : count - 1 + eye - place;
    }
}

static vox_box brick_box(const volume_divider *d, const int32_t first[3], const int32_t last[3])
{
    vox_box box;
    for (int c = 0; c < 3; c++) {
        int64_t hi = d->drawn.lo[c] + ((int64_t)last[c] + 1) * d->edge_vox[c];
        box.lo[c] = d->drawn.lo[c] + first[c] * d->edge_vox[c];
        box.hi[c] = (int32_t)(hi < d->drawn.hi[c] ? hi : d->drawn.hi[c]);
    }
    return box;
}

static size_t brick_number(const volume_divider *d, const int32_t i[3])
{
    return ((size_t)i[2] * d->bricks[1] + i[1]) * d->bricks[0] + i[0];
}

static void find_empty(volume_divider *d, const vodr_machine *m, const vodr_volume *volume,
                       const int32_t *transparent_to)
{
    int32_t i[3];
    for (i[2] = 0; i[2] < d->bricks[2]; i[2]++)
        for (i[1] = 0; i[1] < d->bricks[1]; i[1]++)
            for (i[0] = 0; i[0] < d->bricks[0]; i[0]++) {
                vox_box box = brick_box(d, i, i);
                int32_t min, max;
                filter_bounds(m, volume, &box, &min, &max);
                bool empty = transparent_to[m->blend == VODR_BLEND_MIP ? 0 : min] >= max;
                d->empty[brick_number(d, i)] = empty;
                d->empty_bricks += empty;
            }
}

vodr_status volume_divider_start(volume_divider *d, const vodr_machine *m, const vodr_volume *volume,
                                 const vodr_view *view, const int32_t edge_vox[3], const px_rect *window,
                                 const int32_t *transparent_to, vodr_error *error)
{
    *d = (volume_divider){.view = view,
                          .projection = projection_of(view, volume->dims_vox),
                          .drawn = voxels_drawn(volume),
                          .window = *window,
                          .tile_step = 1,
                          .setup_cycles = m->brick_setup_cycles};
    size_t total = 1;
    for (int c = 0; c < 3; c++) {
        d->edge_vox[c] = edge_vox[c];
        d->bricks[c] = ceil_div32(d->drawn.hi[c] - d->drawn.lo[c], edge_vox[c]);
        total *= (size_t)d->bricks[c];
    }
    d->tile_px = m->traversal == VODR_TRAVERSAL_TILE ? tile_px(m) : 0;
    choose_nest(d, m->traversal == VODR_TRAVERSAL_COLUMN);
    for (int c = 0; c < 3; c++) {
        d->order[c] = calloc((size_t)d->bricks[c], sizeof *d->order[c]);
        if (!d->order[c])
            return vodr_fail(error, VODR_NO_MEMORY, "no memory for the order of %" PRId32 " bricks", d->bricks[c]);
        fill_order(d, c, m->blend == VODR_BLEND_UNDER);
    }
    if (m->skip_empty) {
        d->empty = malloc(total);
        if (!d->empty)
            return vodr_fail(error, VODR_NO_MEMORY, "no memory for the empty bits of %zu bricks", total);
        find_empty(d, m, volume, transparent_to);
    }
    return VODR_OK;
}

void volume_divider_deal(volume_divider *d, const vodr_machine *m, int32_t pipeline)
{
    const int32_t height = d->view->height_px, rows = ceil_div32(height, FB_TILE_PX), count = m->pipelines;
    d->started = d->left = false;
    if (d->tile_px) {
        d->tile_first = pipeline;
        d->tile_step = count;
        return;
    }
    int32_t end = (pipeline + 1) * rows / count * FB_TILE_PX;
    d->window.y1 = end < height ? end : height;
    d->window.y0 = pipeline * rows / count * FB_TILE_PX;
}

/* The first or the next of the tiles that are drawn, in row-major order; false after the last. */
static bool next_tile(volume_divider *d)
{
    const px_rect *w = &d->window;
    int32_t width = d->tile_px ? d->tile_px : w->x1 - w->x0, height = d->tile_px ? d->tile_px : w->y1 - w->y0;
    int32_t number = d->started ? d->tile_at + d->tile_step : d->tile_first, columns = ceil_div32(w->x1 - w->x0, width);
    int32_t x = w->x0 + number % columns * width, y = w->y0 + number / columns * height;
    if (y >= w->y1)
        return false;
    d->started = true;
    d->tile_at = number;
    d->tile = (px_rect){x, y, x + width < w->x1 ? x + width : w->x1, y + height < w->y1 ? y + height : w->y1};
    d->at[0] = d->at[1] = d->at[2] = 0;
    return true;
}

/* Steps loop `level` on, with the loops inside it back at their start; false after the tile's last brick. */
static bool advance(volume_divider *d, int level)
{
    for (; level >= 0; level--) {
        for (int inner = level + 1; inner < 3; inner++)
            d->at[inner] = 0;
        if (++d->at[level] < d->bricks[d->nest[level]])
            return true;
    }
    return false;
}

/* The bricks that the loops inside `level` run over: a slab, a row, or one brick. */
static vox_box level_box(const volume_divider *d, int level, int32_t first[3])
{
    int32_t last[3];
    for (int l = 0; l < 3; l++) {
        int c = d->nest[l];
        first[c] = l <= level ? d->order[c][d->at[l]] : 0;
        last[c] = l <= level ? first[c] : d->bricks[c] - 1;
    }
    return brick_box(d, first, last);
}

/* Fills in the candidate where the loops stand and returns 3, or the level of the outermost loop that only just began
 * and whose bricks, a slab, a row or one, cannot show. */
static int propose(volume_divider *d, candidate *c)
{
    int level = d->at[2] ? 2 : d->at[1] ? 1 : 0;
    int32_t index[3];
    for (; level < 3; level++) {
        c->box = level_box(d, level, index);
        c->brick = brick_number(d, index);
        if (level == 2 && d->empty && d->empty[c->brick]) {
            d->work_cycles++;
            return level;
        }
        d->work_cycles += d->setup_cycles;
        if (!projection_bound(&d->projection, &c->box, &d->tile, &c->bound, &c->k0, &c->k1))
            return level;
    }
    return level;
}

bool volume_divider_next(volume_divider *d, candidate *c)
{
    if (!d->started)
        d->left = next_tile(d);
    else if (d->left)
        d->left = advance(d, 2) || next_tile(d);
    while (d->left) {
        int level = propose(d, c);
        if (level == 3)
            return true;
        d->left = advance(d, level) || next_tile(d);
    }
    return false;
}

static void *copy_of(const void *items, size_t bytes)
{
    void *copy = items ? malloc(bytes) : NULL;
    if (copy)
        memcpy(copy, items, bytes);
    return copy;
}

vodr_status volume_divider_split(volume_divider *d, int32_t y_px, volume_divider *other, vodr_error *error)
{
    size_t total = 1;
    bool good = true;
    *other = *d;
    for (int c = 0; c < 3; c++) {
        other->order[c] = copy_of(d->order[c], (size_t)d->bricks[c] * sizeof *d->order[c]);
        good &= other->order[c] != NULL;
        total *= (size_t)d->bricks[c];
    }
    other->empty = copy_of(d->empty, total);
    if (!good || (d->empty && !other->empty))
        return vodr_fail(error, VODR_NO_MEMORY, "no memory for the order of %zu bricks", total);
    other->window.y0 = other->tile.y0 = d->window.y1 = d->tile.y1 = y_px;
    return VODR_OK;
}

int64_t volume_divider_work(volume_divider *d)
{
    int64_t work = d->work_cycles;
    d->work_cycles = 0;
    return work;
}

double volume_divider_done(const volume_divider *d)
{
    double inner = 0, scale = 1;
    for (int l = 0; l < 3; l++) {
        scale /= d->bricks[d->nest[l]];
        inner += d->at[l] * scale;
    }
    if (!d->tile_px)
        return inner;
    const px_rect *w = &d->window;
    double rows = ceil_div32(w->y1 - w->y0, d->tile_px), columns = ceil_div32(w->x1 - w->x0, d->tile_px);
    return (d->tile_at + inner) / (rows * columns);
}

void volume_divider_finish(volume_divider *d)
{
    for (int c = 0; c < 3; c++)
        free(d->order[c]);
    free(d->empty);
    *d = (volume_divider){0};
}
