/* clocked_alpha_blender.c - the alpha blender, clocked: takes a fragment when the cache can look it up and no hazard
 * holds it. */
#include "clocked_machine.h"

bool clocked_blending(const clocked *c, int32_t x, int32_t y)
{
    int64_t window = c->m->blend_cycles;
    for (int64_t n = c->reads - 1; n >= 0 && n >= c->reads - window; n--) {
        const blend_stage *s = &c->stages[n % window];
        if (s->x == x && s->y == y && s->cycle + window > c->now)
            return true;
    }
    return false;
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
    f->filled = CLOCKED_NEVER;
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

/* The alpha blender takes the next fragment, and the cache looks it up. */
void clock_alpha_blender(clocked *c)
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
    if (!f.dead && blocking && clocked_blending(c, f.x, f.y)) {
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
        clocked_read_pixel(c, &f);
        return;
    }
    c->miss_tags += f.miss;
    if (!blocking && f.reads)
        clocked_push_fill(c, &f, c->now + 1);
    c->failed |= !fragment_ring_push(&c->tagged, f);
}
