/* clocked_pixel_cache.c - the pixel cache, clocked: evictions, fills and, behind a non-blocking cache's tags, the data
 * stage. */
#include "clocked_machine.h"

/* A pixel is read from the cache and enters the blender. */
void clocked_read_pixel(clocked *c, const fragment *f)
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
    c->failed |= !release_ring_push(&c->releases, f->writes ? CLOCKED_NEVER : c->now + window);
    if (f->writes)
        c->failed |= !transaction_ring_push(&c->write_requests, (transaction){.raised = c->now + window,
                                                                              .address = f->line * line_bytes(c->m),
                                                                              .bytes = pixel_bytes(c->m),
                                                                              .line = -1,
                                                                              .entry = c->entries});
    c->entries++;
}

void clocked_push_fill(clocked *c, const fragment *f, int64_t raised)
{
    c->failed |= !transaction_ring_push(&c->fill_requests, (transaction){.raised = raised,
                                                                         .address = f->line * line_bytes(c->m),
                                                                         .bytes = line_bytes(c->m),
                                                                         .line = f->line});
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
            clocked_push_fill(c, f, c->now);
        else
            f->filled = c->now;
    }
    if (f->filled >= c->now) {
        c->n.stalls[VODR_STALL_FILL]++;
        return;
    }
    clocked_read_pixel(c, f);
    c->miss = IDLE;
    fragment_ring_pop(&c->tagged);
}

/* A non-blocking cache: the fragment at the head of its FIFO. */
static void clock_data(clocked *c, fragment *f)
{
    if (f->cycle >= c->now)
        return;
    if (c->miss == IDLE && clocked_blending(c, f->x, f->y)) {
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
    clocked_read_pixel(c, f);
    c->miss = IDLE;
    fragment_ring_pop(&c->tagged);
}

void clock_pixel_cache(clocked *c)
{
    if (!c->tagged.count)
        return;
    if (c->m->nonblocking)
        clock_data(c, fragment_ring_front(&c->tagged));
    else
        clock_miss(c, fragment_ring_front(&c->tagged));
}

/* The flush: dirty lines leave one after the other. False when there is none left. */
bool clock_flush(clocked *c)
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
