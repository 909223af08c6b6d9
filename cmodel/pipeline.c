/* pipeline.c - joins the blocks, down Figure 2 of the paper: divider, slice generator, rasterizer, texture unit, alpha
 * blender, pixel cache, frame buffer. One fragment after the other, in the order the machine draws them. */
#include "pipeline.h"

#include <stdlib.h>

#include "error.h"
#include "layout.h"
#include "rasterizer.h"
#include "slice_generator.h"
#include "voxels.h"

/* What one visit covers. */
typedef struct footprint {
    px_rect px;
    uint64_t slices;
} footprint;

static void read_line(void *context, int64_t line, vodr_rgba *pixels)
{
    frame_buffer_read_line(&((pipeline *)context)->memory, line, pixels);
}

static void write_line(void *context, int64_t line, const vodr_rgba *pixels)
{
    pipeline *p = context;
    frame_buffer_write_line(&p->memory, line, pixels);
    if (p->clock && p->flushing)
        cycles_flush_line(p->clock, line);
}

static int32_t count_bits(uint32_t bits)
{
    return __builtin_popcount(bits);
}

/* Which of a run's fragments wrote their pixel, as the picture's marks tell. */
static uint32_t written_by_marks(pipeline *p, int32_t k, int32_t y, int32_t x, int32_t count)
{
    if (!p->marks || !p->marks->written)
        return (uint32_t)((UINT64_C(1) << count) - 1);
    uint32_t written = marks_get(marks_row(p->marks, p->marks->written, k, y), x, count);
    if (p->machine->blend == VODR_BLEND_UNDER)
        p->counters.terminated_fragments += (uint64_t)(count - count_bits(written));
    return written;
}

/* The last access as the clock sees it; bit i of `written`: whether fragment i of its run wrote. */
static cycle_access last_access(const pixel_cache *c, int64_t line, uint32_t written)
{
    return (cycle_access){.line = (int32_t)line,
                          .victim = (int32_t)c->victim,
                          .written = written,
                          .miss = c->missed,
                          .reads = c->missed && c->read,
                          .evicts = c->missed && c->evicted_dirty};
}

/* Tells the clock of pixels [x0, x1) of a row: all hit, but the first, of which `first` tells. */
static void clock_pixels(pipeline *p, int32_t y, int32_t x0, int32_t x1, const cycle_access *first)
{
    if (!p->clock || x0 == x1)
        return;
    if (first->miss || p->cache.through)
        cycles_run(p->clock, x0, y, x1 - x0, first);
    else
        cycles_hits(p->clock, x0, y, x1 - x0, false);
}

static void observe_miss(const pipeline *p, int32_t x, int32_t y)
{
    if (p->observer && p->observer->miss)
        p->observer->miss(p->observer->context, x, y);
}

/* Blends a run; the bits of the pixels written. Which ones they are matters to a write-through cache's clock alone:
 * else only how many bits are set does. */
static uint32_t blend_pixels(pipeline *p, const vodr_rgba *source, int32_t count, vodr_rgba *pixels)
{
    uint64_t *terminated = &p->counters.terminated_fragments;
    if (!p->clock || p->machine->write_policy != VODR_WRITE_POLICY_THROUGH)
        return (uint32_t)((UINT64_C(1) << alpha_blender_run(&p->blender, source, count, pixels, terminated)) - 1);
    uint32_t written = 0;
    for (int32_t i = 0; i < count; i++)
        written |= (uint32_t)alpha_blender_run(&p->blender, source + i, 1, pixels + i, terminated) << i;
    return written;
}

/* The fragments [from, to) of a span: one line, none of them dead. */
static void blend_run(pipeline *p, int32_t k, const span *s, int32_t from, int32_t to)
{
    int32_t x = s->x0 + from, count = to - from;
    uint32_t written;
    int64_t line = line_in_row(&p->memory.layout, p->line_row, x);
    int32_t offset = p->picture ? line_offset(&p->memory.layout, x, s->y) : 0;
    vodr_rgba *pixels = pixel_cache_access(&p->cache, line, count);
    if (p->cache.missed)
        observe_miss(p, x, s->y);
    if (p->picture) {
        pixels += offset;
        written = blend_pixels(p, p->fragments + from, count, pixels);
    } else {
        written = written_by_marks(p, k, s->y, x, count);
    }
    const cycle_access access = last_access(&p->cache, line, written);
    clock_pixels(p, s->y, x, x + count, &access);
    if (!written)
        return;
    pixel_cache_written(&p->cache);
    if (p->machine->write_policy == VODR_WRITE_POLICY_THROUGH)
        frame_buffer_write_pixels(&p->memory, line, offset, pixels, count, count_bits(written));
}

/* Where the line ends that holds pixel x, cut to the span. */
static inline int32_t run_end(int32_t line_w_bits, const span *s, int32_t x)
{
    int32_t end = ((x >> line_w_bits) + 1) << line_w_bits;
    return end < s->x1 ? end : s->x1;
}

static void shade_span(pipeline *p, const brick_slice *slice, const span *s)
{
    texture_unit_filter(&p->texture, slice, s, p->densities);
    for (int32_t i = 0; i < s->x1 - s->x0; i++)
        p->fragments[i] = p->texture.colours[p->densities[i]];
}

/* Which of the fragments [from, to), at most 32, are alive; the first is bit 0. */
static uint32_t living(const pipeline *p, int32_t k, const span *s, int32_t from, int32_t to)
{
    if (!p->picture)
        return marks_get(marks_row(p->marks, p->marks->alive, k, s->y), s->x0 + from, to - from);
    uint32_t alive = 0;
    for (int32_t i = from; i < to; i++)
        alive |= (uint32_t)!p->texture.dead[p->densities[i]] << (i - from);
    return alive;
}

/* Drops the dead fragments of [from, to), a line's, and blends the runs between them. */
static void blend_living(pipeline *p, int32_t k, const span *s, int32_t from, int32_t to)
{
    uint32_t alive = living(p, k, s, from, to);
    p->counters.killed_fragments += (uint64_t)(to - from - count_bits(alive));
    for (int32_t begin = from, end; begin < to; begin = end) {
        bool lives = alive >> (begin - from) & 1;
        for (end = begin + 1; end < to && (alive >> (end - from) & 1) == lives; end++)
            ;
        if (lives)
            blend_run(p, k, s, begin, end);
        else if (p->clock)
            cycles_hits(p->clock, s->x0 + begin, s->y, end - begin, true);
    }
}

/* Where nothing but lines matters: no picture, and each fragment writes its pixel back. */
static void count_span(pipeline *p, const span *s)
{
    const fb_layout layout = p->memory.layout;
    const int64_t row = p->line_row;
    const int32_t width_bits = layout.line_w_bits;
    cycle_access first = {0};
    int32_t told_to = s->x0;
    for (int32_t x = s->x0, end; x < s->x1; x = end) {
        int64_t line = line_in_row(&layout, row, x);
        end = run_end(width_bits, s, x);
        if (!pixel_cache_hit(&p->cache, line, end - x)) {
            clock_pixels(p, s->y, told_to, x, &first);
            pixel_cache_access(&p->cache, line, end - x);
            observe_miss(p, x, s->y);
            first = last_access(&p->cache, line, 0);
            told_to = x;
        }
        pixel_cache_written(&p->cache);
    }
    clock_pixels(p, s->y, told_to, s->x1, &first);
}

static void draw_span(pipeline *p, const brick_slice *slice, const span *s)
{
    int32_t count = s->x1 - s->x0;
    p->counters.fragments += (uint64_t)count;
    p->line_row = line_row(&p->memory.layout, s->y);
    if (p->texture.whole)
        p->counters.texture_load_bytes += texture_unit_fetched(&p->texture, count);
    if (p->lines_only) {
        count_span(p, s);
        return;
    }
    if (p->picture)
        shade_span(p, slice, s);
    for (int32_t from = 0, to; from < count; from = to) {
        to = run_end(p->memory.layout.line_w_bits, s, s->x0 + from) - s->x0;
        if (p->machine->kill_transparent)
            blend_living(p, slice->k, s, from, to);
        else
            blend_run(p, slice->k, s, from, to);
    }
}

static void grow(px_rect *r, const span *s)
{
    r->x0 = s->x0 < r->x0 ? s->x0 : r->x0;
    r->x1 = s->x1 > r->x1 ? s->x1 : r->x1;
    r->y0 = s->y < r->y0 ? s->y : r->y0;
    r->y1 = s->y >= r->y1 ? s->y + 1 : r->y1;
}

/* Cycles of the divider since the visit before. */
static int64_t divider_work(pipeline *p)
{
    int64_t work = volume_divider_work(&p->divider) + p->probe_cycles;
    p->probe_cycles = 0;
    return work;
}

/* A visit with `slices` slices before the one that has its first fragment. */
static void clock_visit(pipeline *p, const candidate *c, int64_t load_bytes, int32_t slices)
{
    cycle_visit visit = {.load_bytes = load_bytes};
    visit.load_address = (int64_t)c->brick * brick_room_bytes(p->machine, p->divider.edge_vox);
    visit.work_cycles = divider_work(p);
    cycles_visit(p->clock, &visit);
    for (int32_t i = 0; i < slices; i++) {
        cycles_slice(p->clock);
        cycles_rows(p->clock, p->leading_rows[i]);
    }
    cycles_slice(p->clock);
}

/* A candidate becomes a visit at its first fragment. */
static void begin_visit(pipeline *p, const candidate *c, int32_t slices)
{
    p->counters.brick_visits++;
    p->counters.bricks += !p->seen[c->brick];
    p->seen[c->brick] = 1;
    uint64_t load_bytes = texture_unit_load(&p->texture, c->brick, &c->box);
    p->counters.texture_load_bytes += load_bytes;
    if (p->clock)
        clock_visit(p, c, (int64_t)load_bytes, slices);
    if (!p->observer || !p->observer->visit)
        return;
    const px_rect *clip = &p->divider.tile;
    vodr_visit visit = {.brick = c->brick, .x0_px = clip->x0, .y0_px = clip->y0, .x1_px = clip->x1, .y1_px = clip->y1};
    for (int i = 0; i < 3; i++) {
        visit.lo_vox[i] = c->box.lo[i];
        visit.hi_vox[i] = c->box.hi[i];
    }
    p->observer->visit(p->observer->context, &visit);
}

/* Draws a slice; `index` slices of the candidate came before. */
static void draw_slice(pipeline *p, const candidate *c, const brick_slice *slice, int32_t index, footprint *covered)
{
    rasterizer rows;
    rasterizer_start(&rows, slice, &c->bound);
    int32_t first_row = rows.bound.y0, next_row = first_row;
    bool visited = covered->slices > 0, any = false;
    if (visited && p->clock)
        cycles_slice(p->clock);
    for (span s; rasterizer_next(&rows, &s); any = true) {
        if (!any && !visited) {
            p->probe_cycles += s.y + 1 - first_row;
            begin_visit(p, c, index);
        }
        if (p->clock)
            cycles_rows(p->clock, s.y - next_row);
        next_row = s.y + 1;
        grow(&covered->px, &s);
        draw_span(p, slice, &s);
    }
    int32_t rest = rows.bound.y1 - next_row;
    if (p->clock && (visited || any))
        cycles_rows(p->clock, rest);
    if (p->clock && !visited && !any) {
        p->leading_rows[index] = rest;
        p->probe_cycles += rest ? rest : 1;
    }
    covered->slices += any;
}

static void draw_candidate(pipeline *p, const candidate *c)
{
    slice_generator slices =
        slice_generator_start(p->view, &c->box, c->k0, c->k1, p->machine->blend == VODR_BLEND_UNDER);
    footprint covered = {.px = {INT32_MAX, INT32_MAX, 0, 0}};
    brick_slice slice;
    for (int32_t index = 0; slice_generator_next(&slices, &slice); index++)
        draw_slice(p, c, &slice, index, &covered);
    p->counters.brick_slices += covered.slices;
    int32_t limit = p->counters.tile_px;
    if (covered.slices && p->counters.brick_vox)
        p->counters.brick_overflows += covered.px.x1 - covered.px.x0 > limit || covered.px.y1 - covered.px.y0 > limit;
}

static vodr_status check_volume(const vodr_volume *v, const vodr_machine *m, vodr_error *error)
{
    for (int c = 0; c < 3; c++)
        if (v->dims_vox[c] < 1 || v->dims_vox[c] > VODR_MAX_DIM_VOX)
            return vodr_fail(error, VODR_INVALID, "the volume is %dx%dx%d voxels but must have 1 to %d a side",
                             v->dims_vox[0], v->dims_vox[1], v->dims_vox[2], VODR_MAX_DIM_VOX);
    const vox_box drawn = voxels_drawn(v);
    for (int c = 0; c < 3; c++)
        if (drawn.lo[c] < 0 || drawn.hi[c] <= drawn.lo[c] || drawn.hi[c] > v->dims_vox[c])
            return vodr_fail(error, VODR_INVALID, "%d to %d is to be drawn along %c but must lie within 0 to %d",
                             drawn.lo[c], drawn.hi[c], 'x' + c, v->dims_vox[c]);
    if (v->voxel_bytes != 1 && v->voxel_bytes != 2)
        return vodr_fail(error, VODR_INVALID, "voxel_bytes is %d but must be 1 or 2", v->voxel_bytes);
    if (m->filter == VODR_FILTER_BSPLINE && v->voxel_bytes != 2)
        return vodr_fail(error, VODR_INVALID,
                         "voxel_bytes is %d but must be 2: filter=bspline takes coefficients of 16 bits, not densities",
                         v->voxel_bytes);
    if (v->voxel_bytes == 1 && !v->map && m->density_bits != 8)
        return vodr_fail(error, VODR_INVALID, "8-bit voxels without a map need density_bits=8, not %d",
                         m->density_bits);
    for (int i = 0; v->voxel_bytes == 1 && v->map && i < 256; i++)
        if (v->map[i] >> m->density_bits)
            return vodr_fail(error, VODR_INVALID, "map entry %d is %d but must be below %d", i, v->map[i],
                             1 << m->density_bits);
    return VODR_OK;
}

vodr_status pipeline_check(const vodr_machine *m, const vodr_volume *volume, const vodr_view *view, vodr_error *error)
{
    vodr_status status = vodr_machine_check(m, error);
    if (status == VODR_OK)
        status = check_volume(volume, m, error);
    if (status == VODR_OK)
        status = vodr_view_check(view, volume->dims_vox, error);
    return status;
}

static vodr_status start_blocks(pipeline *p, const vodr_volume *volume, const vodr_table *table, vodr_error *error)
{
    const vodr_machine *m = p->machine;
    px_rect window = {0, 0, p->view->width_px, p->view->height_px};
    p->blender = alpha_blender_of(m);
    vodr_status status = texture_unit_start(&p->texture, m, volume, table, p->view, error);
    int32_t edge = volume_divider_edge(m, p->view);
    const int32_t *edges = edge ? (const int32_t[3]){edge, edge, edge} : volume->dims_vox;
    if (status == VODR_OK && edge)
        status = volume_divider_check(m, volume->dims_vox, edge, error);
    if (status == VODR_OK)
        status =
            volume_divider_start(&p->divider, m, volume, p->view, edges, &window, p->texture.transparent_to, error);
    if (status == VODR_OK)
        volume_divider_deal(&p->divider, m, p->turn);
    if (status == VODR_OK && p->picture)
        status = texture_unit_reserve(&p->texture, edge, error);
    p->counters.brick_vox = edge;
    if (status == VODR_OK)
        status = frame_buffer_start(&p->memory, m, p->view, p->picture, error);
    cache_memory behind = {.context = p, .read_line = read_line, .write_line = write_line};
    if (status == VODR_OK)
        status = pixel_cache_start(&p->cache, m, p->memory.layout.lines, p->picture, behind, error);
    return status;
}

vodr_status pipeline_start(pipeline *p, const vodr_machine *machine, const vodr_volume *volume, const vodr_table *table,
                           const vodr_view *view, bool picture, bool clock, vodr_error *error)
{
    *p = (pipeline){.machine = machine, .view = view, .picture = picture};
    p->lines_only = !picture && machine->blend == VODR_BLEND_OVER && !machine->kill_transparent &&
                    machine->write_policy == VODR_WRITE_POLICY_BACK;
    vodr_status status = pipeline_check(machine, volume, view, error);
    if (status == VODR_OK)
        status = start_blocks(p, volume, table, error);
    if (status != VODR_OK)
        return status;
    size_t width = (size_t)view->width_px, bricks = 1;
    for (int c = 0; c < 3; c++)
        bricks *= (size_t)p->divider.bricks[c];
    p->densities = malloc(width * sizeof *p->densities);
    p->fragments = malloc(width * sizeof *p->fragments);
    p->seen = calloc(bricks, 1);
    if (clock) {
        p->clock = cycles_start(machine, view);
        p->leading_rows = malloc((size_t)view->slices * sizeof *p->leading_rows);
    }
    if (!p->densities || !p->fragments || !p->seen || (clock && (!p->clock || !p->leading_rows)))
        return vodr_fail(error, VODR_NO_MEMORY, "no memory for the bookkeeping of %zu bricks", bricks);
    p->counters.tile_px = tile_px(machine);
    return VODR_OK;
}

static void gather_counters(pipeline *p)
{
    vodr_counters *n = &p->counters;
    n->hits = p->cache.hits;
    n->misses = p->cache.misses;
    n->evictions = p->cache.evictions;
    n->writebacks = p->cache.writebacks;
    n->fb_read_bytes = p->memory.read_bytes;
    n->fb_write_bytes = p->memory.write_bytes;
    n->skipped_bricks = p->divider.empty_bricks;
}

/* The next pipeline's part, before a cache and texture memory of its own; false when all have drawn theirs. */
static bool take_turn(pipeline *p)
{
    if (p->turn + 1 == p->machine->pipelines)
        return false;
    pixel_cache_empty(&p->cache);
    texture_unit_empty(&p->texture);
    volume_divider_deal(&p->divider, p->machine, ++p->turn);
    return true;
}

bool pipeline_step(pipeline *p)
{
    candidate c;
    if (volume_divider_next(&p->divider, &c)) {
        draw_candidate(p, &c);
        return true;
    }
    p->flushing = true;
    pixel_cache_flush(&p->cache);
    if (take_turn(p))
        return true;
    gather_counters(p);
    if (p->clock)
        p->failed = !cycles_finish(p->clock, divider_work(p), &p->counters.cycles);
    return false;
}

double pipeline_done(const pipeline *p)
{
    return (p->turn + volume_divider_done(&p->divider)) / p->machine->pipelines;
}

vodr_status pipeline_readout(const pipeline *p, vodr_frame *frame, vodr_error *error)
{
    const vodr_rgba *readout = p->machine->blend == VODR_BLEND_MIP ? p->texture.readout : NULL;
    return frame_buffer_readout(&p->memory, p->machine, readout, frame, error);
}

void pipeline_finish(pipeline *p)
{
    free(p->densities);
    free(p->fragments);
    free(p->seen);
    free(p->leading_rows);
    cycles_free(p->clock);
    pixel_cache_finish(&p->cache);
    frame_buffer_finish(&p->memory);
    volume_divider_finish(&p->divider);
    texture_unit_finish(&p->texture);
}
