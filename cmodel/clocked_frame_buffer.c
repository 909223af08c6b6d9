/* clocked_frame_buffer.c - the memory bus, clocked: fills before writes before loads. */
#include "clocked_machine.h"

static bool visible(const clocked *c, const transaction_ring *r)
{
    return r->count && transaction_ring_front(r)->raised < c->now;
}

static void fill_granted(clocked *c, int64_t done)
{
    for (size_t i = 0; i < c->tagged.count; i++) {
        fragment *f = fragment_ring_at(&c->tagged, i);
        if (f->reads && f->filled == CLOCKED_NEVER) {
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

void clock_frame_buffer(clocked *c)
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
