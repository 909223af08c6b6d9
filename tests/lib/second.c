/* second.c - docs/architecture.md, sections 2 to 5 and 10: positions, bricks and their order, visits, counters. */
#include "second.h"

#include <stdlib.h>

#include "second_cache.h"
#include "second_texture.h"

__extension__ typedef __int128 wide;

enum { MOST_PIPELINES = 16 };

/* A sample inside the volume. Sorted by its first six fields, fragments are in the machine's order. */
typedef struct fragment {
    int32_t pipeline;
    int32_t tile; /* place of its screen tile; 0 where the traversal has none */
    int32_t rank; /* place of its brick in visiting order */
    int32_t step; /* place of its slice */
    int32_t y, x;
    int32_t brick; /* number of its brick: (l*bricks_y + j)*bricks_x + i */
    uint32_t density;
} fragment;

typedef struct scene {
    const vodr_machine *machine;
    const vodr_volume *volume;
    const vodr_table *table;
    const vodr_view *view;
    vodr_counters *counters;
    vodr_rgba *converted;
    int64_t tile_px;                        /* T */
    int64_t border, density_bytes, buffers; /* buffers: of texture memory */
    int64_t edge[3], bricks[3];             /* a brick's edges and the number of bricks, along each axis */
    int32_t *rank;                          /* of each brick */
    bool *skipped;                          /* of each brick: skip_empty left it out */
    fragment *fragments;
    size_t count;
    second_pixel *pixels;
    second_cache caches[MOST_PIPELINES];
} scene;

static int64_t least(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

static int64_t most(int64_t a, int64_t b)
{
    return a > b ? a : b;
}

static wide magnitude(wide a)
{
    return a < 0 ? -a : a;
}

/* ---- bricks ---- */

static void choose_edge(scene *s)
{
    const vodr_machine *m = s->machine;
    int64_t cache_px = m->cache_bytes / (m->fb_bits / 2);
    while ((s->tile_px + 1) * (s->tile_px + 1) <= cache_px) {
        s->tile_px++;
    }
    if (m->traversal == VODR_TRAVERSAL_TILE && m->pipelines > 1) {
        int64_t side = most(m->line_px.width, m->line_px.height);
        s->tile_px = most(s->tile_px / side * side, side);
    }
    int64_t fitting = 0; /* F */
    for (int64_t side = 1 + 2 * s->border;
         side * side * side * s->density_bytes * s->buffers <= m->texture_memory_bytes; side++) {
        fitting++;
    }
    int64_t on_screen = s->tile_px * (1 << 20) / s->view->footprint;
    int64_t n = m->brick != 0 ? m->brick : most(m->brick_min, least(on_screen, fitting));
    bool whole = m->traversal == VODR_TRAVERSAL_WHOLE;
    for (int c = 0; c < 3; c++) {
        int64_t size = s->volume->dims_vox[c];
        s->edge[c] = whole ? size : n;
        s->bricks[c] = (size + s->edge[c] - 1) / s->edge[c];
    }
    s->counters->brick_vox = whole ? 0 : (int32_t)n;
    s->counters->tile_px = (int32_t)s->tile_px;
}

static bool brick_fits(const scene *s)
{
    wide bytes = s->density_bytes * s->buffers;
    for (int c = 0; c < 3; c++) {
        bytes *= least(s->edge[c] + 2 * s->border, s->volume->dims_vox[c]);
    }
    return s->machine->traversal == VODR_TRAVERSAL_WHOLE || bytes <= s->machine->texture_memory_bytes;
}

/* The voxels of a brick grown by the border and cut to the volume: [lo, hi). */
static void grown_box(const scene *s, int64_t brick, int64_t lo[3], int64_t hi[3])
{
    const int64_t index[3] = {brick % s->bricks[0], brick / s->bricks[0] % s->bricks[1],
                              brick / s->bricks[0] / s->bricks[1]};
    for (int c = 0; c < 3; c++) {
        lo[c] = most(index[c] * s->edge[c] - s->border, 0);
        hi[c] = least((index[c] + 1) * s->edge[c] + s->border, s->volume->dims_vox[c]);
    }
}

static bool brick_is_transparent(const scene *s, int64_t brick)
{
    int64_t lo[3], hi[3], min = INT64_MAX, max = INT64_MIN;
    grown_box(s, brick, lo, hi);
    for (int64_t z = lo[2]; z < hi[2]; z++) {
        for (int64_t y = lo[1]; y < hi[1]; y++) {
            for (int64_t x = lo[0]; x < hi[0]; x++) {
                int64_t density = second_density(s->machine, s->volume, x, y, z);
                min = least(min, density);
                max = most(max, density);
            }
        }
    }
    second_filter_bounds(s->machine, &min, &max);
    return second_transparent(s->machine, s->converted, (uint32_t)min, (uint32_t)max);
}

/* ---- their order ---- */

static int64_t eye_brick(const scene *s, int c)
{
    int64_t voxel = s->view->base[c] >> 24;
    if (s->view->base[c] < 0) {
        return -1;
    }
    return voxel >= s->volume->dims_vox[c] ? s->bricks[c] : voxel / s->edge[c];
}

/* Fills `sequence` with the brick indices of axis c in visiting order. */
static void axis_sequence(const scene *s, int c, int64_t *sequence)
{
    int64_t n = s->bricks[c];
    int64_t count = 0;
    int64_t turn = s->view->step_s[c] >= 0 ? n : -1; /* ascending below it, then descending down to it, then itself */
    if (s->view->perspective) {
        turn = eye_brick(s, c);
    }
    for (int64_t i = 0; i < turn; i++) {
        sequence[count++] = i;
    }
    for (int64_t i = n - 1; i > turn; i--) {
        sequence[count++] = i;
    }
    if (turn >= 0 && turn < n) {
        sequence[count++] = turn;
    }
    for (int64_t i = 0; s->machine->blend == VODR_BLEND_UNDER && i < n / 2; i++) {
        int64_t other = sequence[n - 1 - i];
        sequence[n - 1 - i] = sequence[i];
        sequence[i] = other;
    }
}

static int dominant_axis(const vodr_view *v)
{
    int dominant = 0;
    wide largest = -1;
    for (int c = 0; c < 3; c++) {
        wide middle =
            (wide)2 * v->step_s[c] + (wide)(v->width_px - 1) * v->step_u[c] + (wide)(v->height_px - 1) * v->step_v[c];
        wide extent = magnitude(v->perspective ? middle : (wide)v->step_s[c]);
        if (extent >= largest) {
            largest = extent;
            dominant = c;
        }
    }
    return dominant;
}

/* The three axes from the outermost loop to the innermost. */
static void loop_axes(const scene *s, int axes[3])
{
    int dominant = dominant_axis(s->view);
    int count = 0;
    if (s->machine->traversal != VODR_TRAVERSAL_COLUMN) {
        axes[count++] = dominant;
    }
    for (int c = 2; c >= 0; c--) {
        if (c != dominant) {
            axes[count++] = c;
        }
    }
    if (s->machine->traversal == VODR_TRAVERSAL_COLUMN) {
        axes[count] = dominant;
    }
}

static vodr_status rank_bricks(scene *s)
{
    int64_t *sequence[3];
    bool made = true;
    for (int c = 0; c < 3; c++) {
        sequence[c] = calloc((size_t)s->bricks[c], sizeof **sequence);
        made = made && sequence[c];
    }
    for (int c = 0; made && c < 3; c++) {
        axis_sequence(s, c, sequence[c]);
    }
    int axes[3];
    loop_axes(s, axes);
    int32_t rank = 0;
    for (int64_t a = 0; made && a < s->bricks[axes[0]]; a++) {
        for (int64_t b = 0; b < s->bricks[axes[1]]; b++) {
            for (int64_t c = 0; c < s->bricks[axes[2]]; c++) {
                int64_t index[3];
                index[axes[0]] = sequence[axes[0]][a];
                index[axes[1]] = sequence[axes[1]][b];
                index[axes[2]] = sequence[axes[2]][c];
                s->rank[(index[2] * s->bricks[1] + index[1]) * s->bricks[0] + index[0]] = rank++;
            }
        }
    }
    for (int c = 0; c < 3; c++) {
        free(sequence[c]);
    }
    return made ? VODR_OK : VODR_NO_MEMORY;
}

/* ---- fragments ---- */

static void sample_position(const vodr_view *v, int32_t x, int32_t y, int32_t k, int64_t position[3])
{
    for (int c = 0; c < 3; c++) {
        wide a = (wide)x * v->step_u[c] + (wide)y * v->step_v[c];
        if (v->perspective) {
            wide z = ((wide)v->depth_first + (wide)k * v->depth_step) >> 16;
            a = z * (v->step_s[c] + a);
        } else {
            a += (wide)k * v->step_s[c];
        }
        position[c] = (int64_t)(v->base[c] + (a >> v->shift));
    }
}

/* The index of the brick of axis c whose half-open range holds the position; -1 outside the volume. */
static int64_t holding(const scene *s, int c, int64_t position)
{
    for (int64_t i = 0; i < s->bricks[c]; i++) {
        int64_t lo = i * s->edge[c];
        int64_t hi = least((i + 1) * s->edge[c], s->volume->dims_vox[c]);
        if (lo * (1 << 24) <= position && position < hi * (1 << 24)) {
            return i;
        }
    }
    return -1;
}

/* Whose part of the screen a pixel lies in. */
static int32_t pipeline_of(const scene *s, int32_t y, int32_t tile)
{
    int64_t count = s->machine->pipelines, rows = (s->view->height_px + 31) / 32;
    if (s->machine->traversal == VODR_TRAVERSAL_TILE) {
        return (int32_t)(tile % count);
    }
    int32_t p = 0;
    while (y >= 32 * ((p + 1) * rows / count)) {
        p++;
    }
    return p;
}

static void add_sample(scene *s, int32_t x, int32_t y, int32_t k)
{
    int64_t position[3], index[3];
    sample_position(s->view, x, y, k, position);
    for (int c = 0; c < 3; c++) {
        index[c] = holding(s, c, position[c]);
        if (index[c] < 0) {
            return;
        }
    }
    int32_t brick = (int32_t)((index[2] * s->bricks[1] + index[1]) * s->bricks[0] + index[0]);
    if (s->skipped[brick]) {
        return;
    }
    int32_t t = (int32_t)s->tile_px;
    int32_t tiles_x = (s->view->width_px + t - 1) / t;
    int32_t tile = s->machine->traversal == VODR_TRAVERSAL_TILE ? y / t * tiles_x + x / t : 0;
    s->fragments[s->count++] = (fragment){
        .pipeline = pipeline_of(s, y, tile),
        .tile = tile,
        .rank = s->rank[brick],
        .step = s->machine->blend == VODR_BLEND_UNDER ? s->view->slices - 1 - k : k,
        .y = y,
        .x = x,
        .brick = brick,
        .density = second_filter(s->machine, s->volume, position),
    };
}

static int by_order(const void *left, const void *right)
{
    const fragment *a = left, *b = right;
    const int32_t keys_a[] = {a->pipeline, a->tile, a->rank, a->step, a->y, a->x};
    const int32_t keys_b[] = {b->pipeline, b->tile, b->rank, b->step, b->y, b->x};
    for (int i = 0; i < 6; i++) {
        if (keys_a[i] != keys_b[i]) {
            return keys_a[i] < keys_b[i] ? -1 : 1;
        }
    }
    return 0;
}

static void collect_fragments(scene *s)
{
    for (int32_t k = 0; k < s->view->slices; k++) {
        for (int32_t y = 0; y < s->view->height_px; y++) {
            for (int32_t x = 0; x < s->view->width_px; x++) {
                add_sample(s, x, y, k);
            }
        }
    }
    qsort(s->fragments, s->count, sizeof *s->fragments, by_order);
}

/* ---- replay ---- */

static void load_texture(const scene *s, int32_t brick, int32_t held[2], int *previous)
{
    for (int i = 0; i < s->buffers; i++) {
        if (held[i] == brick) {
            *previous = i;
            return;
        }
    }
    int64_t lo[3], hi[3];
    grown_box(s, brick, lo, hi);
    s->counters->texture_load_bytes +=
        (uint64_t)((hi[0] - lo[0]) * (hi[1] - lo[1]) * (hi[2] - lo[2]) * s->density_bytes);
    *previous = s->buffers == 1 ? 0 : 1 - *previous;
    held[*previous] = brick;
}

/* Counts the visits, their slices, spans and texture loads. */
static vodr_status count_visits(const scene *s)
{
    bool whole = s->machine->traversal == VODR_TRAVERSAL_WHOLE;
    bool *seen = calloc((size_t)(s->bricks[0] * s->bricks[1] * s->bricks[2]), sizeof *seen);
    int32_t held[2] = {-1, -1};
    int32_t pipeline = 0;
    int previous = 0;
    for (size_t from = 0, to; seen && from < s->count; from = to) {
        const fragment *first = &s->fragments[from];
        if (first->pipeline != pipeline) {
            pipeline = first->pipeline;
            held[0] = held[1] = -1;
        }
        int32_t lo_x = first->x, hi_x = first->x, lo_y = first->y, hi_y = first->y, step = -1;
        for (to = from; to < s->count; to++) {
            const fragment *f = &s->fragments[to];
            if (f->pipeline != first->pipeline || f->tile != first->tile || f->brick != first->brick) {
                break;
            }
            lo_x = (int32_t)least(lo_x, f->x);
            hi_x = (int32_t)most(hi_x, f->x);
            lo_y = (int32_t)least(lo_y, f->y);
            hi_y = (int32_t)most(hi_y, f->y);
            s->counters->brick_slices += f->step != step;
            step = f->step;
        }
        s->counters->brick_visits++;
        s->counters->bricks += !seen[first->brick];
        seen[first->brick] = true;
        s->counters->brick_overflows += !whole && (hi_x - lo_x + 1 > s->tile_px || hi_y - lo_y + 1 > s->tile_px);
        if (!whole) {
            load_texture(s, first->brick, held, &previous);
        }
    }
    free(seen);
    return seen ? VODR_OK : VODR_NO_MEMORY;
}

static void draw_fragment(scene *s, const fragment *f)
{
    static const int64_t fetches[] = {1, 8, 64, 64}; /* nearest, linear, cardinal, bspline */
    const vodr_machine *m = s->machine;
    s->counters->fragments++;
    if (m->traversal == VODR_TRAVERSAL_WHOLE) {
        s->counters->texture_load_bytes += (uint64_t)(fetches[m->filter] * s->density_bytes);
    }
    if (m->kill_transparent && second_transparent(m, s->converted, f->density, f->density)) {
        s->counters->killed_fragments++;
        return;
    }
    bool terminated;
    second_pixel *pixel = &s->pixels[(int64_t)f->y * s->view->width_px + f->x];
    bool written = second_blend(m, s->converted, f->density, pixel, &terminated);
    s->counters->terminated_fragments += terminated;
    second_cache_access(&s->caches[f->pipeline], f->x, f->y, written, s->counters);
}

static vodr_status read_out(const scene *s, vodr_frame *frame)
{
    size_t count = (size_t)s->view->width_px * (size_t)s->view->height_px;
    bool bytes = s->machine->fb_bits == 8;
    *frame = (vodr_frame){.width_px = s->view->width_px,
                          .height_px = s->view->height_px,
                          .bits = s->machine->fb_bits,
                          .bytes = count * (bytes ? 4 : 8)};
    frame->pixels = calloc(1, frame->bytes);
    for (size_t i = 0; frame->pixels && i < count * 4; i++) {
        const second_pixel *pixel = &s->pixels[i / 4];
        uint32_t value = pixel->channel[i % 4];
        if (s->machine->blend == VODR_BLEND_MIP && pixel->written) {
            const vodr_rgba *entry = &s->converted[pixel->density];
            const uint32_t channels[4] = {entry->r, entry->g, entry->b, entry->a};
            value = channels[i % 4];
        }
        if (bytes) {
            ((uint8_t *)frame->pixels)[i] = (uint8_t)value;
        } else {
            ((uint16_t *)frame->pixels)[i] = (uint16_t)value;
        }
    }
    return frame->pixels ? VODR_OK : VODR_NO_MEMORY;
}

/* ---- the frame ---- */

static vodr_status allocate(scene *s)
{
    size_t pixels = (size_t)s->view->width_px * (size_t)s->view->height_px;
    size_t bricks = (size_t)(s->bricks[0] * s->bricks[1] * s->bricks[2]);
    s->converted = calloc(s->table->count, sizeof *s->converted);
    s->rank = calloc(bricks, sizeof *s->rank);
    s->skipped = calloc(bricks, sizeof *s->skipped);
    s->fragments = calloc(pixels * (size_t)s->view->slices, sizeof *s->fragments);
    s->pixels = calloc(pixels, sizeof *s->pixels);
    return s->converted && s->rank && s->skipped && s->fragments && s->pixels ? VODR_OK : VODR_NO_MEMORY;
}

static void prepare(scene *s)
{
    for (size_t i = 0; i < s->table->count; i++) {
        const vodr_rgba *entry = &s->table->entries[i];
        s->converted[i].r = (uint16_t)second_convert(s->machine, entry->r);
        s->converted[i].g = (uint16_t)second_convert(s->machine, entry->g);
        s->converted[i].b = (uint16_t)second_convert(s->machine, entry->b);
        s->converted[i].a = (uint16_t)second_convert(s->machine, entry->a);
    }
    int64_t bricks = s->bricks[0] * s->bricks[1] * s->bricks[2];
    for (int64_t brick = 0; s->machine->skip_empty && brick < bricks; brick++) {
        s->skipped[brick] = brick_is_transparent(s, brick);
        s->counters->skipped_bricks += s->skipped[brick];
    }
}

static vodr_status draw(scene *s, vodr_frame *frame)
{
    vodr_status status = allocate(s);
    if (status != VODR_OK) {
        return status;
    }
    prepare(s);
    status = rank_bricks(s);
    if (status != VODR_OK) {
        return status;
    }
    collect_fragments(s);
    status = count_visits(s);
    for (size_t i = 0; i < s->count; i++) {
        draw_fragment(s, &s->fragments[i]);
    }
    for (int i = 0; i < s->machine->pipelines; i++) {
        second_cache_flush(&s->caches[i], s->counters);
    }
    return status == VODR_OK ? read_out(s, frame) : status;
}

vodr_status second_render(const vodr_machine *machine, const vodr_volume *volume, const vodr_table *table,
                          const vodr_view *view, vodr_frame *frame, vodr_counters *counters)
{
    static const int64_t borders[] = {0, 1, 2, 2}; /* nearest, linear, cardinal, bspline */
    *frame = (vodr_frame){0};
    *counters = (vodr_counters){0};
    scene s = {.machine = machine,
               .volume = volume,
               .table = table,
               .view = view,
               .counters = counters,
               .border = borders[machine->filter],
               .density_bytes = machine->density_bits == 8 && machine->filter != VODR_FILTER_BSPLINE ? 1 : 2,
               .buffers = 1 + machine->double_buffer};
    choose_edge(&s);
    vodr_status status = VODR_OK;
    for (int i = 0; status == VODR_OK && i < machine->pipelines; i++) {
        status = second_cache_make(&s.caches[i], machine, view->width_px, view->height_px);
    }
    if (status == VODR_OK) {
        status = brick_fits(&s) ? draw(&s, frame) : VODR_INVALID;
    }
    for (int i = 0; i < MOST_PIPELINES; i++) {
        second_cache_free(&s.caches[i]);
    }
    free(s.converted);
    free(s.rank);
    free(s.skipped);
    free(s.fragments);
    free(s.pixels);
    if (status != VODR_OK) {
        *counters = (vodr_counters){0};
    }
    return status;
}
