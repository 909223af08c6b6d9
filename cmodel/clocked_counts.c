#include "clocked_counts.h"

#include <stdlib.h>

#include "layout.h"

static const px_rect nothing = {INT32_MAX, INT32_MAX, 0, 0};

bool clocked_counts_start(clocked_counts *c, const vodr_machine *machine, const px_rect *window,
                          const vodr_observer *observer, clocked_sums *sums)
{
    *c = (clocked_counts){
        .machine = machine, .window = *window, .observer = observer, .sums = sums, .last = -1, .covered = nothing};
    /* A visit before the door has a fragment in the FIFO, but for those that divider, generator and rasterizer hold. */
    return counted_visit_ring_reserve(&c->visits, (size_t)machine->fragment_fifo + 8);
}

/* ---- visits ---- */

/* What a visit's fragments are clipped to: in `tile` the tile that their bound lies in, else the pipeline's part. */
static void clip_of(const clocked_counts *c, const px_rect *bound, vodr_visit *v)
{
    const px_rect *w = &c->window;
    int32_t t = c->sums->n.tile_px;
    *v = (vodr_visit){.x0_px = w->x0, .y0_px = w->y0, .x1_px = w->x1, .y1_px = w->y1};
    if (c->machine->traversal != VODR_TRAVERSAL_TILE)
        return;
    v->x0_px = bound->x0 / t * t;
    v->y0_px = bound->y0 / t * t;
    v->x1_px = t < w->x1 - v->x0_px ? v->x0_px + t : w->x1;
    v->y1_px = t < w->y1 - v->y0_px ? v->y0_px + t : w->y1;
}

static void hand_on(clocked_counts *c, const brick_port *b)
{
    counted_visit v = {.first = 0};
    clip_of(c, &b->bound, &v.visit);
    v.visit.brick = b->brick;
    for (int i = 0; i < 3; i++) {
        v.visit.lo_vox[i] = b->box.lo[i];
        v.visit.hi_vox[i] = b->box.hi[i];
    }
    counted_visit_ring_push(&c->visits, v);
    c->sums->n.brick_visits++;
    c->sums->n.bricks += !c->sums->seen[b->brick];
    c->sums->seen[b->brick] = 1;
}

static void accept(clocked_counts *c, const fragment_port *f)
{
    px_rect *r = &c->covered;
    if (!c->visit_begun)
        counted_visit_ring_at(&c->visits, c->begun++)->first = c->accepted;
    c->sums->n.brick_slices += !c->slice_begun;
    c->visit_begun = c->slice_begun = true;
    r->x0 = f->x < r->x0 ? f->x : r->x0;
    r->x1 = f->x >= r->x1 ? f->x + 1 : r->x1;
    r->y0 = f->y < r->y0 ? f->y : r->y0;
    r->y1 = f->y >= r->y1 ? f->y + 1 : r->y1;
    c->sums->n.fragments++;
    c->accepted++;
}

static void end_visit(clocked_counts *c)
{
    const px_rect *r = &c->covered;
    int32_t limit = c->sums->n.tile_px;
    if (c->machine->traversal != VODR_TRAVERSAL_WHOLE)
        c->sums->n.brick_overflows += r->x1 - r->x0 > limit || r->y1 - r->y0 > limit;
    c->covered = nothing;
    c->visit_begun = false;
}

/* ---- what blocks do ---- */

static void draw(clocked_counts *c, const block_outs *before, const block_outs *after)
{
    if (after->volume_divider.brick.fresh)
        hand_on(c, &after->volume_divider.brick);
    if (before->slice_generator.slice.valid && before->rasterizer.slice.ready)
        c->slice_begun = false;
    if (before->rasterizer.fragment.valid && before->texture_unit.fragment.ready)
        accept(c, &before->rasterizer.fragment);
    if (after->rasterizer.fragment.visit_done)
        end_visit(c);
    if (before->texture_unit.load.valid && before->frame_buffer.load.ready)
        c->sums->n.texture_load_bytes += (uint64_t)before->texture_unit.load.bytes;
    if (after->texture_unit.fetch.valid)
        c->sums->n.texture_load_bytes +=
            (uint64_t)(density_bytes(c->machine) * filter_fetches(c->machine) / filter_fetch_cycles(c->machine));
}

/* A fragment goes from the pixel cache's door. */
static void go(clocked_counts *c, const look_up_port *l)
{
    const vodr_observer *o = c->observer;
    if (c->begun && counted_visit_ring_front(&c->visits)->first == c->gone) {
        if (o && o->visit)
            o->visit(o->context, &counted_visit_ring_front(&c->visits)->visit);
        counted_visit_ring_pop(&c->visits);
        c->begun--;
    }
    c->gone++;
    c->sums->n.killed_fragments += !l->valid;
    if (!l->valid)
        return;
    c->sums->n.hits += !l->miss;
    c->sums->n.misses += l->miss;
    c->sums->n.evictions += l->replaced;
    if (l->miss && o && o->miss)
        o->miss(o->context, l->x, l->y);
}

static void move_pixels(clocked_counts *c, const block_outs *before, const block_outs *after)
{
    const pixel_cache_out *cache = &after->pixel_cache;
    const blended_port *b = &after->alpha_blender.blended;
    if (before->pixel_cache.door.gone)
        go(c, &cache->look_up);
    c->sums->n.terminated_fragments += c->machine->blend == VODR_BLEND_UNDER && b->valid && !b->writes;
    if (cache->fill.valid)
        c->sums->n.fb_read_bytes += (uint64_t)line_bytes(c->machine);
    if (cache->write.valid)
        c->sums->n.fb_write_bytes += (uint64_t)cache->write.bytes;
    c->sums->n.writebacks += cache->write.valid && c->machine->write_policy == VODR_WRITE_POLICY_BACK;
    if (cache->pixel.valid) /* no blend is over as late */
        c->last = c->now + c->machine->blend_cycles - 1;
}

/* ---- accounts ---- */

static void account(clocked_counts *c, vodr_block block, uint8_t status)
{
    vodr_block_cycles *b = &c->cycles.blocks[block];
    if (status == BLOCK_IDLE)
        return;
    if (status == BLOCK_BUSY) {
        b->busy++;
        c->last = c->last > c->now ? c->last : c->now;
        return;
    }
    b->stalled++;
    /* A fragment that the texture unit does not accept keeps the rasterizer waiting as well: one cause, told once. */
    c->cycles.stalls[status - BLOCK_STALLED] += block != VODR_BLOCK_TEXTURE_UNIT;
}

/* Of a stalled rasterizer: while the texture unit fetches for the fragment before, that is the cause. */
static uint8_t rasterizer_status(const block_outs *o)
{
    const uint8_t status = o->rasterizer.report.status;
    const bool fetches = o->texture_unit.report.status == BLOCK_BUSY;
    return status >= BLOCK_STALLED && fetches ? BLOCK_STALLED + VODR_STALL_TEXTURE_FETCH : status;
}

void clocked_counts_cycle(clocked_counts *c, const block_outs *before, const block_outs *after)
{
    draw(c, before, after);
    move_pixels(c, before, after);
    account(c, VODR_BLOCK_VOLUME_DIVIDER, after->volume_divider.report.status);
    account(c, VODR_BLOCK_SLICE_GENERATOR, after->slice_generator.report.status);
    account(c, VODR_BLOCK_RASTERIZER, rasterizer_status(after));
    account(c, VODR_BLOCK_TEXTURE_UNIT, after->texture_unit.report.status);
    account(c, VODR_BLOCK_ALPHA_BLENDER, after->alpha_blender.report.status);
    account(c, VODR_BLOCK_PIXEL_CACHE, after->pixel_cache.report.status);
    account(c, VODR_BLOCK_FRAME_BUFFER, after->frame_buffer.report.status);
    c->now++;
}

vodr_cycles clocked_counts_close(const clocked_counts *c, int32_t pipelines)
{
    const clocked_counts *last = c;
    for (int32_t i = 1; i < pipelines; i++)
        last = c[i].last > last->last ? &c[i] : last;
    vodr_cycles n = last->cycles;
    n.total = (uint64_t)(last->last + 1);
    for (int32_t i = 0; i < pipelines; i++) {
        if (&c[i] == last)
            continue;
        n.blocks[VODR_BLOCK_FRAME_BUFFER].busy += c[i].cycles.blocks[VODR_BLOCK_FRAME_BUFFER].busy;
        n.blocks[VODR_BLOCK_FRAME_BUFFER].stalled += c[i].cycles.blocks[VODR_BLOCK_FRAME_BUFFER].stalled;
        n.stalls[VODR_STALL_DRAM_ROW] += c[i].cycles.stalls[VODR_STALL_DRAM_ROW];
        n.stalls[VODR_STALL_DRAM_REFRESH] += c[i].cycles.stalls[VODR_STALL_DRAM_REFRESH];
    }
    for (int i = 0; i < VODR_BLOCK_COUNT; i++)
        n.blocks[i].idle = n.total - n.blocks[i].busy - n.blocks[i].stalled;
    return n;
}

void clocked_counts_finish(clocked_counts *c)
{
    counted_visit_ring_free(&c->visits);
}
