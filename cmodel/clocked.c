/* clocked.c - joins the blocks as pipeline.c does, but cycle by cycle. Whatever a block registers carries the cycle in
 * which it did, and the others see it from the next one on: so the order in which blocks are clocked within a cycle
 * does not matter. */
#include "clocked.h"

#include <stdlib.h>

#include "alpha_blender.h"
#include "error.h"
#include "frame_buffer.h"
#include "layout.h"
#include "memory.h"
#include "pixel_cache.h"
#include "rasterizer.h"
#include "ring.h"
#include "slice_generator.h"
#include "texture_unit.h"
#include "volume_divider.h"

enum { VISITS = 8 };

static const int64_t NEVER = INT64_MAX;

/* A brick on its way from the divider to the slice generator and the texture unit's loader. */
typedef struct brick_visit {
    candidate brick;
    int64_t work_cycles, load_bytes, load_address;
    int64_t divided, loaded, drained; /* cycles; NEVER: not yet */
} brick_visit;

/* Divider to slice generator, slice generator to rasterizer: one register. */
typedef struct link {
    bool full;
    int64_t pushed, popped;
} link;

/* A fragment between rasterizer and data stage. */
typedef struct fragment {
    int32_t x, y, k;
    int64_t cycle; /* accepted; later looked up */
    bool dead, miss, reads, evicts, writes;
    int64_t line, victim;
    int64_t filled; /* last data of its line; NEVER */
    bool evicted;   /* its victim left for the write buffer */
    vodr_rgba colour;
} fragment;

typedef struct transaction {
    int64_t raised, address, bytes, line, entry;
} transaction;

typedef struct blend_stage {
    int32_t x, y;
    int64_t cycle;
} blend_stage;

RING(fragment_ring, fragment)
RING(transaction_ring, transaction)
RING(release_ring, int64_t)

typedef struct clocked {
    const vodr_machine *m;
    const vodr_view *view;
    int64_t now, last;
    vodr_counters counters;
    vodr_cycles n;
    bool failed;

    /* what the blocks do, apart from when */
    volume_divider divider;
    texture_unit texture;
    texture_unit books; /* which brick lies in which buffer, at the time of the divider's search */
    alpha_blender blender;
    pixel_cache cache;
    frame_buffer pixels;
    uint8_t *seen;

    /* volume divider: works, then pushes */
    brick_visit visits[VISITS];   /* by number */
    int64_t found, pushed, drawn; /* numbers: searched for, pushed, taken by the slice generator; -1 */
    int64_t work_left;
    bool last_found; /* no visit follows */
    link bricks;

    /* slice generator */
    slice_generator slices;
    bool generating, slice_ready;
    int64_t setup_left;
    brick_slice next_slice, slice;
    int64_t slice_visit, drawn_slice_visit;
    link slice_link;

    /* rasterizer */
    rasterizer rows;
    brick_slice raster_slice;
    bool rastering, have_span;
    span current;
    int32_t next_row, done_px;
    px_rect covered;
    uint64_t covered_slices;
    bool slice_has_fragments;

    /* texture unit and its loader */
    int64_t accepted, load_visit, load_bytes, load_raised, load_grant;
    bool load_wanted, visit_accepted;
    uint16_t density;

    /* alpha blender and pixel cache */
    fragment_ring door, tagged;
    int64_t popped, last_pop, tags, reads, last_read;
    int64_t miss_tags, miss_reads, last_miss_read;
    enum { IDLE, EVICT, FILL } miss; /* of the head of `tagged` */
    int64_t miss_cycle;              /* EVICT: it was looked up; FILL: its victim left */
    blend_stage *stages;             /* the last blend_cycles reads, a ring */
    bool write_pending;
    int64_t write_granted;
    transaction departures[VISITS]; /* write-backs granted last: line, and the cycle in `raised` */
    int64_t departure_count;
    release_ring releases; /* of the write FIFO's entries, in order; NEVER: still waiting */
    int64_t entries, flush_next;

    memory memory;
    transaction_ring fill_requests, write_requests;
} clocked;

static void happened(clocked *c)
{
    c->last = c->now > c->last ? c->now : c->last;
}

static void busy(clocked *c, vodr_block block)
{
    c->n.blocks[block].busy++;
    happened(c);
}

static brick_visit *visit_at(clocked *c, int64_t number)
{
    return &c->visits[number & (VISITS - 1)];
}

static bool can_push(const clocked *c, const link *l)
{
    return !l->full && l->popped < c->now;
}

static bool can_pop(const clocked *c, const link *l)
{
    return l->full && l->pushed < c->now;
}

/* ---- volume divider ---- */

/* Rows of a slice that are looked at: all, or up to the first that has a fragment. */
static int64_t probe_slice(const brick_slice *slice, const px_rect *bound, bool *found)
{
    rasterizer rows;
    span s;
    rasterizer_start(&rows, slice, bound);
    int32_t first = rows.y;
    *found = rasterizer_next(&rows, &s);
    return *found ? s.y + 1 - first : rows.bound.y1 - first;
}

/* Looks for the next brick with a fragment; the work is done at once here and takes its cycles afterwards. */
static void search(clocked *c)
{
    brick_visit v = {.divided = NEVER, .loaded = NEVER, .drained = NEVER};
    bool found = false;
    while (!found && volume_divider_next(&c->divider, &v.brick)) {
        slice_generator slices =
            slice_generator_start(c->view, &v.brick.box, v.brick.k0, v.brick.k1, c->m->blend == VODR_BLEND_UNDER);
        brick_slice slice;
        v.work_cycles += c->m->brick_setup_cycles;
        while (!found && slice_generator_next(&slices, &slice))
            v.work_cycles += probe_slice(&slice, &v.brick.bound, &found);
    }
    c->work_left = v.work_cycles;
    c->last_found = !found;
    if (!found)
        return;
    int64_t bytes = density_bytes(c->m), burst = c->m->texture_burst_bytes;
    for (int i = 0; i < 3; i++)
        bytes *= c->divider.edge_vox[i] + 2 * filter_border_vox(c->m);
    v.load_address =
        c->pixels.layout.lines * line_bytes(c->m) + (int64_t)v.brick.brick * ((bytes + burst - 1) / burst * burst);
    v.load_bytes = (int64_t)texture_unit_load(&c->books, v.brick.brick, &v.brick.box);
    c->counters.texture_load_bytes += (uint64_t)v.load_bytes;
    *visit_at(c, ++c->found) = v;
}

static void clock_divider(clocked *c)
{
    if (c->work_left) {
        c->work_left--;
        busy(c, VODR_BLOCK_VOLUME_DIVIDER);
    } else if (!c->last_found) {
        if (!can_push(c, &c->bricks)) {
            c->n.stalls[VODR_STALL_DIVIDER]++;
            return;
        }
        c->bricks.full = true;
        c->bricks.pushed = c->now;
        visit_at(c, ++c->pushed)->divided = c->now;
        busy(c, VODR_BLOCK_VOLUME_DIVIDER);
        search(c);
    }
}

/* ---- slice generator ---- */

static void clock_slices(clocked *c)
{
    if (c->generating && c->setup_left) {
        c->setup_left--;
        busy(c, VODR_BLOCK_SLICE_GENERATOR);
    } else if (c->generating) {
        if (!can_push(c, &c->slice_link)) {
            c->n.stalls[VODR_STALL_SLICE]++;
            return;
        }
        c->slice = c->next_slice;
        c->slice_visit = c->drawn;
        c->slice_link.full = true;
        c->slice_link.pushed = c->now;
        c->setup_left = c->m->slice_setup_cycles;
        c->generating = slice_generator_next(&c->slices, &c->next_slice);
        busy(c, VODR_BLOCK_SLICE_GENERATOR);
    } else if (can_pop(c, &c->bricks)) {
        const candidate *b = &visit_at(c, ++c->drawn)->brick;
        c->bricks.full = false;
        c->bricks.popped = c->now;
        c->slices = slice_generator_start(c->view, &b->box, b->k0, b->k1, c->m->blend == VODR_BLEND_UNDER);
        c->generating = slice_generator_next(&c->slices, &c->next_slice);
        c->setup_left = c->m->slice_setup_cycles;
        busy(c, VODR_BLOCK_SLICE_GENERATOR);
    }
}

/* ---- rasterizer, and the texture unit's door ---- */

static void begin_visit(clocked *c, int64_t number)
{
    const candidate *b = &visit_at(c, number)->brick;
    c->counters.brick_visits++;
    c->counters.bricks += !c->seen[b->brick];
    c->seen[b->brick] = 1;
}

static void end_visit(clocked *c)
{
    int32_t limit = tile_px(c->m);
    c->counters.brick_slices += c->covered_slices;
    if (c->m->traversal != VODR_TRAVERSAL_WHOLE)
        c->counters.brick_overflows += c->covered.x1 - c->covered.x0 > limit || c->covered.y1 - c->covered.y0 > limit;
}

static bool is_last_fragment(clocked *c, const span *s)
{
    /* Whether anything of the visit follows: ask the blocks themselves. */
    if (c->done_px + 1 < s->x1 - s->x0)
        return false;
    rasterizer rows = c->rows;
    span next;
    if (rasterizer_next(&rows, &next))
        return false;
    const candidate *b = &visit_at(c, c->drawn_slice_visit)->brick;
    bool reverse = c->m->blend == VODR_BLEND_UNDER;
    slice_generator rest = slice_generator_start(c->view, &b->box, b->k0, b->k1, reverse);
    brick_slice slice;
    while (slice_generator_next(&rest, &slice)) {
        if (reverse ? slice.k >= c->rows.slice->k : slice.k <= c->rows.slice->k)
            continue;
        bool found;
        probe_slice(&slice, &b->bound, &found);
        if (found)
            return false;
    }
    return true;
}

/* Where a fragment's density comes from: the functional texture unit, loaded with its brick. */
static fragment shade(clocked *c, int64_t number, const brick_slice *slice, const span *s)
{
    const candidate *b = &visit_at(c, number)->brick;
    span one = {.y = s->y, .x0 = s->x0 + c->done_px, .x1 = s->x0 + c->done_px + 1};
    for (int i = 0; i < 3; i++)
        one.a[i] = s->a[i] + c->done_px * slice->plane.step_u[i];
    if (!c->visit_accepted)
        texture_unit_load(&c->texture, b->brick, &b->box);
    c->counters.texture_load_bytes += texture_unit_fetched(&c->texture, 1);
    texture_unit_filter(&c->texture, slice, &one, &c->density);
    return (fragment){.x = one.x0,
                      .y = one.y,
                      .k = slice->k,
                      .cycle = c->now,
                      .dead = c->texture.dead[c->density],
                      .colour = c->texture.colours[c->density]};
}

static void cover(clocked *c, const span *s)
{
    px_rect *r = &c->covered;
    r->x0 = s->x0 < r->x0 ? s->x0 : r->x0;
    r->x1 = s->x1 > r->x1 ? s->x1 : r->x1;
    r->y0 = s->y < r->y0 ? s->y : r->y0;
    r->y1 = s->y >= r->y1 ? s->y + 1 : r->y1;
}

/* Offers the fragment at hand to the texture unit. */
static void offer(clocked *c)
{
    int64_t number = c->drawn_slice_visit, inside = c->accepted - c->popped + (c->last_pop == c->now);
    brick_visit *v = visit_at(c, number);
    if (!c->visit_accepted && v->loaded >= c->now) {
        c->n.stalls[VODR_STALL_TEXTURE_LOAD]++;
        return;
    }
    /* Fetches from external memory hold as many fragments more as they take cycles. */
    int64_t room = c->m->fragment_fifo + (c->m->traversal == VODR_TRAVERSAL_WHOLE ? c->m->mem_latency_cycles : 0);
    if (inside >= room) {
        c->n.stalls[VODR_STALL_FRAGMENT_FIFO]++;
        return;
    }
    if (!c->visit_accepted)
        begin_visit(c, number);
    bool last = is_last_fragment(c, &c->current);
    c->failed |= !fragment_ring_push(&c->door, shade(c, number, c->rows.slice, &c->current));
    c->visit_accepted = true;
    c->counters.fragments++;
    c->accepted++;
    if (!c->slice_has_fragments) {
        c->slice_has_fragments = true;
        c->covered_slices++;
    }
    busy(c, VODR_BLOCK_RASTERIZER);
    busy(c, VODR_BLOCK_TEXTURE_UNIT);
    if (++c->done_px == c->current.x1 - c->current.x0) {
        cover(c, &c->current);
        c->next_row = c->current.y + 1;
        c->done_px = 0;
        c->have_span = rasterizer_next(&c->rows, &c->current);
    }
    if (last) {
        v->drained = c->now;
        end_visit(c);
    }
}

static void clock_rasterizer(clocked *c)
{
    if (c->rastering) {
        if (c->have_span && c->next_row == c->current.y) {
            offer(c);
        } else {
            c->next_row++;
            busy(c, VODR_BLOCK_RASTERIZER);
        }
        c->rastering = c->next_row < c->rows.bound.y1;
    } else if (can_pop(c, &c->slice_link)) {
        if (c->drawn_slice_visit != c->slice_visit) {
            c->drawn_slice_visit = c->slice_visit;
            c->visit_accepted = false;
            c->covered = (px_rect){INT32_MAX, INT32_MAX, 0, 0};
            c->covered_slices = 0;
        }
        c->slice_link.full = false;
        c->slice_link.popped = c->now;
        c->raster_slice = c->slice;
        rasterizer_start(&c->rows, &c->raster_slice, &visit_at(c, c->slice_visit)->brick.bound);
        c->next_row = c->rows.y;
        c->done_px = 0;
        c->slice_has_fragments = false;
        c->have_span = rasterizer_next(&c->rows, &c->current);
        c->rastering = c->next_row < c->rows.bound.y1;
        busy(c, VODR_BLOCK_RASTERIZER);
    }
}

/* ---- texture unit: its loader ---- */

static void clock_loader(clocked *c)
{
    if (c->load_visit > c->pushed || c->load_wanted)
        return;
    brick_visit *v = visit_at(c, c->load_visit);
    int64_t before = c->load_visit - (c->m->double_buffer ? 2 : 1);
    if (v->divided >= c->now || c->load_grant >= c->now)
        return;
    if (v->load_bytes == 0) {
        v->loaded = v->divided;
        c->load_visit++;
        clock_loader(c);
    } else if (before < 0 || visit_at(c, before)->drained < c->now) {
        c->load_wanted = true;
        c->load_raised = c->now;
    }
}

/* ---- alpha blender and pixel cache ---- */

static bool blending(const clocked *c, int32_t x, int32_t y)
{
    int64_t window = c->m->blend_cycles;
    for (int64_t n = c->reads - 1; n >= 0 && n >= c->reads - window; n--) {
        const blend_stage *s = &c->stages[n % window];
        if (s->x == x && s->y == y && s->cycle + window > c->now)
            return true;
    }
    return false;
}

/* A pixel is read from the cache and enters the blender. */
static void read_pixel(clocked *c, const fragment *f)
{
    int64_t window = c->m->blend_cycles;
    c->stages[c->reads++ % window] = (blend_stage){f->x, f->y, c->now};
    c->last_read = c->now;
    busy(c, VODR_BLOCK_PIXEL_CACHE);
    c->last = c->last > c->now + window - 1 ? c->last : c->now + window - 1;
    if (f->miss) {
        c->miss_reads++;
        c->last_miss_read = c->now;
    }
    if (c->m->write_policy != VODR_WRITE_POLICY_THROUGH)
        return;
    c->failed |= !release_ring_push(&c->releases, f->writes ? NEVER : c->now + window);
    if (f->writes)
        c->failed |= !transaction_ring_push(&c->write_requests, (transaction){.raised = c->now + window,
                                                                              .address = f->line * line_bytes(c->m),
                                                                              .bytes = pixel_bytes(c->m),
                                                                              .line = -1,
                                                                              .entry = c->entries});
    c->entries++;
}

/* Looks a fragment up and blends it: what it does to tags and pixels, apart from when. */
static void look_up(clocked *c, fragment *f)
{
    pixel_cache *cache = &c->cache;
    int32_t offset = line_offset(&c->pixels.layout, f->x, f->y);
    f->line = line_number(&c->pixels.layout, f->x, f->y);
    vodr_rgba *pixel = pixel_cache_access(cache, f->line, 1) + offset;
    f->miss = cache->missed;
    f->reads = f->miss && cache->read;
    f->evicts = f->miss && cache->evicted_dirty;
    f->victim = cache->victim;
    f->filled = NEVER;
    f->cycle = c->now;
    f->writes = alpha_blender_run(&c->blender, &f->colour, 1, pixel, &c->counters.terminated_fragments) > 0;
    if (!f->writes)
        return;
    pixel_cache_written(cache);
    if (c->m->write_policy == VODR_WRITE_POLICY_THROUGH)
        frame_buffer_write_pixels(&c->pixels, f->line, offset, pixel, 1, 1);
}

/* Entries of the write FIFO that are taken. */
static bool write_fifo_full(const clocked *c)
{
    if (c->m->write_policy != VODR_WRITE_POLICY_THROUGH || c->tags < c->m->write_fifo)
        return false;
    int64_t number = c->tags - c->m->write_fifo;
    return number >= c->entries || *release_ring_at(&c->releases, (size_t)number) >= c->now;
}

/* Whether a line is on its way out, so that reading it would give old pixels. */
static bool leaving(const clocked *c, int64_t line)
{
    for (size_t i = 0; i < c->tagged.count; i++) {
        const fragment *f = fragment_ring_at(&c->tagged, i);
        if (f->evicts && !f->evicted && f->victim == line)
            return true;
    }
    for (size_t i = 0; i < c->write_requests.count; i++)
        if (transaction_ring_at(&c->write_requests, i)->line == line)
            return true;
    for (int64_t n = c->departure_count - 1; n >= 0 && n >= c->departure_count - VISITS; n--)
        if (c->departures[n % VISITS].line == line && c->departures[n % VISITS].raised >= c->now)
            return true;
    return false;
}

/* Whether a non-blocking cache has to leave a fragment waiting before its tags. */
static bool tags_blocked(clocked *c, const fragment *f)
{
    int64_t line = line_number(&c->pixels.layout, f->x, f->y), read_before = c->reads - (c->last_read == c->now);
    if (c->tags - read_before >= c->m->nonblocking_fifo)
        return true;
    if (c->cache.where[line] >= 0)
        return false;
    int64_t misses_before = c->miss_reads - (c->miss_reads > 0 && c->last_miss_read == c->now);
    return c->miss_tags - misses_before >= c->m->nonblocking_misses || leaving(c, line);
}

static void push_fill(clocked *c, const fragment *f, int64_t raised)
{
    c->failed |= !transaction_ring_push(&c->fill_requests, (transaction){.raised = raised,
                                                                         .address = f->line * line_bytes(c->m),
                                                                         .bytes = line_bytes(c->m),
                                                                         .line = f->line});
}

/* The alpha blender takes the next fragment, and the cache looks it up. */
static void clock_blender(clocked *c)
{
    int64_t latency = c->m->texture_latency_cycles;
    latency += c->m->traversal == VODR_TRAVERSAL_WHOLE ? c->m->mem_latency_cycles : 0;
    if (!c->door.count || fragment_ring_front(&c->door)->cycle + latency > c->now)
        return;
    fragment f = *fragment_ring_front(&c->door);
    bool blocking = !c->m->nonblocking;
    /* A blocking cache works on one access at a time: `tagged` holds the miss under way. */
    if (blocking && (c->tagged.count || (c->reads && c->last_read == c->now))) {
        c->n.stalls[VODR_STALL_CACHE]++;
        return;
    }
    if (!f.dead && (write_fifo_full(c) || (!blocking && tags_blocked(c, &f)))) {
        c->n.stalls[VODR_STALL_CACHE]++;
        return;
    }
    if (!f.dead && blocking && blending(c, f.x, f.y)) {
        c->n.stalls[VODR_STALL_HAZARD]++;
        return;
    }
    fragment_ring_pop(&c->door);
    c->popped++;
    c->last_pop = c->now;
    busy(c, VODR_BLOCK_ALPHA_BLENDER);
    if (f.dead) {
        c->counters.killed_fragments++;
        return;
    }
    look_up(c, &f);
    c->tags++;
    if (blocking && !f.miss) {
        read_pixel(c, &f);
        return;
    }
    c->miss_tags += f.miss;
    if (!blocking && f.reads)
        push_fill(c, &f, c->now + 1);
    c->failed |= !fragment_ring_push(&c->tagged, f);
}

/* The victim of the head of `tagged` moves to the write buffer, if it may. */
static bool evict(clocked *c, fragment *f)
{
    if (!f->evicts)
        return true;
    if (c->write_pending || c->write_granted >= c->now || c->last_read + c->m->blend_cycles > c->now)
        return false;
    c->write_pending = true;
    f->evicted = true;
    c->failed |= !transaction_ring_push(&c->write_requests, (transaction){.raised = c->now,
                                                                          .address = f->victim * line_bytes(c->m),
                                                                          .bytes = line_bytes(c->m),
                                                                          .line = f->victim});
    return true;
}

/* A blocking cache: the one miss under way. */
static void clock_miss(clocked *c, fragment *f)
{
    if (f->cycle >= c->now)
        return;
    if (c->miss == IDLE)
        c->miss = EVICT;
    if (c->miss == EVICT) {
        if (!evict(c, f)) {
            c->n.stalls[VODR_STALL_WRITE_BACK]++;
            return;
        }
        c->miss = FILL;
        if (f->reads)
            push_fill(c, f, c->now);
        else
            f->filled = c->now;
    }
    if (f->filled >= c->now) {
        c->n.stalls[VODR_STALL_FILL]++;
        return;
    }
    read_pixel(c, f);
    c->miss = IDLE;
    fragment_ring_pop(&c->tagged);
}

/* A non-blocking cache: the fragment at the head of its FIFO. */
static void clock_data(clocked *c, fragment *f)
{
    if (f->cycle >= c->now)
        return;
    if (c->miss == IDLE && blending(c, f->x, f->y)) {
        c->n.stalls[VODR_STALL_HAZARD]++;
        return;
    }
    if (f->miss && c->miss == IDLE)
        c->miss = EVICT;
    if (c->miss == EVICT) {
        bool moved = evict(c, f);
        c->miss = moved ? FILL : EVICT;
        if (f->evicts) { /* the line is overwritten from the next cycle on */
            c->n.stalls[VODR_STALL_WRITE_BACK]++;
            return;
        }
    }
    if (f->reads && f->filled >= c->now) {
        c->n.stalls[VODR_STALL_FILL]++;
        return;
    }
    read_pixel(c, f);
    c->miss = IDLE;
    fragment_ring_pop(&c->tagged);
}

static void clock_cache(clocked *c)
{
    if (!c->tagged.count)
        return;
    if (c->m->nonblocking)
        clock_data(c, fragment_ring_front(&c->tagged));
    else
        clock_miss(c, fragment_ring_front(&c->tagged));
}

/* ---- the bus ---- */

static bool visible(const clocked *c, const transaction_ring *r)
{
    return r->count && transaction_ring_front(r)->raised < c->now;
}

static void fill_granted(clocked *c, int64_t done)
{
    for (size_t i = 0; i < c->tagged.count; i++) {
        fragment *f = fragment_ring_at(&c->tagged, i);
        if (f->reads && f->filled == NEVER) {
            f->filled = done;
            break;
        }
    }
    transaction_ring_pop(&c->fill_requests);
}

static void write_granted(clocked *c, const transaction *t)
{
    if (t->line >= 0) {
        c->write_pending = false;
        c->write_granted = c->now;
        c->departures[c->departure_count++ % VISITS] = (transaction){.line = t->line, .raised = c->now};
    } else {
        *release_ring_at(&c->releases, (size_t)t->entry) = c->now;
    }
    transaction_ring_pop(&c->write_requests);
}

static void load_granted(clocked *c, int64_t done, int64_t bytes)
{
    brick_visit *v = visit_at(c, c->load_visit);
    c->load_bytes += bytes;
    c->load_grant = c->load_raised = c->now;
    if (c->load_bytes < v->load_bytes)
        return;
    v->loaded = done;
    c->load_bytes = 0;
    c->load_wanted = false;
    c->load_visit++;
}

static void clock_bus(clocked *c)
{
    if (c->memory.free_cycle > c->now)
        return;
    if (visible(c, &c->fill_requests)) {
        const transaction *t = transaction_ring_front(&c->fill_requests);
        fill_granted(c, memory_grant(&c->memory, c->now, t->address, t->bytes, false));
    } else if (visible(c, &c->write_requests)) {
        transaction t = *transaction_ring_front(&c->write_requests);
        int64_t done = memory_grant(&c->memory, c->now, t.address, t.bytes, true);
        c->last = done > c->last ? done : c->last;
        write_granted(c, &t);
    } else if (c->load_wanted && c->load_raised < c->now) {
        const brick_visit *v = visit_at(c, c->load_visit);
        int64_t bytes = v->load_bytes - c->load_bytes;
        bytes = bytes < c->m->texture_burst_bytes ? bytes : c->m->texture_burst_bytes;
        load_granted(c, memory_grant(&c->memory, c->now, v->load_address + c->load_bytes, bytes, false), bytes);
    }
}

/* ---- the frame ---- */

/* Everything drawn, nothing on its way; the divider may still be looking for more bricks in vain. */
static bool drained(const clocked *c)
{
    return c->last_found && c->drawn == c->found && !c->generating && !c->slice_link.full && !c->rastering &&
           !c->door.count && !c->tagged.count;
}

/* The flush: dirty lines leave one after the other. False when there is none left. */
static bool clock_flush(clocked *c)
{
    int64_t lines = (int64_t)c->cache.sets * c->cache.ways;
    while (c->flush_next < lines && !c->cache.lines[c->flush_next].dirty)
        c->flush_next++;
    if (c->flush_next == lines)
        return false;
    fragment f = {.evicts = true, .victim = c->cache.lines[c->flush_next].number};
    if (evict(c, &f))
        c->flush_next++;
    return true;
}

static void run(clocked *c)
{
    bool going = true;
    search(c);
    for (c->now = 0; going && !c->failed; c->now++) {
        clock_divider(c);
        clock_slices(c);
        clock_rasterizer(c);
        clock_loader(c);
        clock_blender(c);
        clock_cache(c);
        going = !drained(c) || clock_flush(c) || c->write_requests.count || c->work_left;
        clock_bus(c);
    }
}

static void set_block(vodr_cycles *n, vodr_block block, uint64_t stalled)
{
    n->blocks[block].stalled = stalled;
    n->blocks[block].idle = n->total - n->blocks[block].busy - stalled;
}

static void gather(clocked *c)
{
    vodr_cycles *n = &c->n;
    uint64_t *stalls = n->stalls;
    bool blocking = !c->m->nonblocking;
    n->total = (uint64_t)(c->last + 1);
    stalls[VODR_STALL_DRAM_ROW] = c->memory.row_cycles;
    stalls[VODR_STALL_DRAM_REFRESH] = c->memory.refresh_cycles;
    n->blocks[VODR_BLOCK_FRAME_BUFFER].busy = c->memory.busy_cycles;
    uint64_t door = stalls[VODR_STALL_TEXTURE_LOAD] + stalls[VODR_STALL_FRAGMENT_FIFO];
    set_block(n, VODR_BLOCK_VOLUME_DIVIDER, stalls[VODR_STALL_DIVIDER]);
    set_block(n, VODR_BLOCK_SLICE_GENERATOR, stalls[VODR_STALL_SLICE]);
    set_block(n, VODR_BLOCK_RASTERIZER, door);
    set_block(n, VODR_BLOCK_TEXTURE_UNIT, door);
    set_block(n, VODR_BLOCK_ALPHA_BLENDER, stalls[VODR_STALL_CACHE] + (blocking ? stalls[VODR_STALL_HAZARD] : 0));
    set_block(n, VODR_BLOCK_PIXEL_CACHE,
              stalls[VODR_STALL_WRITE_BACK] + stalls[VODR_STALL_FILL] + (blocking ? 0 : stalls[VODR_STALL_HAZARD]));
    set_block(n, VODR_BLOCK_FRAME_BUFFER, stalls[VODR_STALL_DRAM_ROW] + stalls[VODR_STALL_DRAM_REFRESH]);
    pixel_cache_flush(&c->cache);
    vodr_counters *out = &c->counters;
    out->hits = c->cache.hits;
    out->misses = c->cache.misses;
    out->evictions = c->cache.evictions;
    out->writebacks = c->cache.writebacks;
    out->fb_read_bytes = c->pixels.read_bytes;
    out->fb_write_bytes = c->pixels.write_bytes;
    out->skipped_bricks = c->divider.empty_bricks;
    out->cycles = *n;
}

static void read_line(void *context, int64_t line, vodr_rgba *pixels)
{
    frame_buffer_read_line(context, line, pixels);
}

static void write_line(void *context, int64_t line, const vodr_rgba *pixels)
{
    frame_buffer_write_line(context, line, pixels);
}

static vodr_status start(clocked *c, const vodr_volume *volume, const vodr_table *table, vodr_error *error)
{
    const vodr_machine *m = c->m;
    px_rect window = {0, 0, c->view->width_px, c->view->height_px};
    int32_t edge = volume_divider_edge(m, c->view);
    const int32_t edges[3] = {edge ? edge : volume->dims_vox[0], edge ? edge : volume->dims_vox[1],
                              edge ? edge : volume->dims_vox[2]};
    c->blender = alpha_blender_of(m);
    c->counters.tile_px = tile_px(m);
    c->counters.brick_vox = edge;
    vodr_status status = texture_unit_start(&c->texture, m, volume, table, c->view, error);
    c->books = c->texture;
    if (status == VODR_OK && edge)
        status = volume_divider_check(m, volume->dims_vox, edge, error);
    if (status == VODR_OK)
        status =
            volume_divider_start(&c->divider, m, volume, c->view, edges, &window, c->texture.transparent_to, error);
    if (status == VODR_OK)
        status = texture_unit_reserve(&c->texture, edge, error);
    if (status == VODR_OK)
        status = frame_buffer_start(&c->pixels, m, c->view, true, error);
    cache_memory behind = {.context = &c->pixels, .read_line = read_line, .write_line = write_line};
    if (status == VODR_OK)
        status = pixel_cache_start(&c->cache, m, c->pixels.layout.lines, true, behind, error);
    if (status != VODR_OK)
        return status;
    size_t bricks = 1;
    for (int i = 0; i < 3; i++)
        bricks *= (size_t)c->divider.bricks[i];
    c->seen = calloc(bricks, 1);
    c->stages = calloc((size_t)m->blend_cycles, sizeof *c->stages);
    return c->seen && c->stages ? VODR_OK : vodr_fail(error, VODR_NO_MEMORY, "no memory for the bookkeeping of bricks");
}

static void finish(clocked *c)
{
    free(c->seen);
    free(c->stages);
    fragment_ring_free(&c->door);
    fragment_ring_free(&c->tagged);
    transaction_ring_free(&c->fill_requests);
    transaction_ring_free(&c->write_requests);
    release_ring_free(&c->releases);
    pixel_cache_finish(&c->cache);
    frame_buffer_finish(&c->pixels);
    volume_divider_finish(&c->divider);
    texture_unit_finish(&c->texture);
}

vodr_status clocked_render(const vodr_machine *machine, const vodr_volume *volume, const vodr_table *table,
                           const vodr_view *view, vodr_frame *frame, vodr_counters *counters, vodr_error *error)
{
    clocked *c = calloc(1, sizeof *c);
    if (!c)
        return vodr_fail(error, VODR_NO_MEMORY, "no memory for the clocked machine");
    c->m = machine;
    c->view = view;
    c->memory = memory_of(machine);
    c->last = c->found = c->pushed = c->drawn = c->drawn_slice_visit = c->slice_visit = -1;
    c->bricks.popped = c->slice_link.popped = c->load_grant = c->write_granted = c->last_pop = -1;
    c->last_miss_read = -1;
    c->last_read = -machine->blend_cycles;
    vodr_status status = start(c, volume, table, error);
    if (status == VODR_OK) {
        run(c);
        gather(c);
        status = frame_buffer_readout(&c->pixels, machine, machine->blend == VODR_BLEND_MIP ? c->texture.readout : NULL,
                                      frame, error);
    }
    if (status == VODR_OK && c->failed)
        status = vodr_fail(error, VODR_NO_MEMORY, "no memory for what is under way");
    if (status == VODR_OK)
        *counters = c->counters;
    else
        vodr_frame_free(frame);
    finish(c);
    free(c);
    return status;
}
