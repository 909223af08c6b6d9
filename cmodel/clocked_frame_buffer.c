/* clocked_frame_buffer.c - the memory bus, clocked: grants fills before writes before loads, and hands on what comes
 * from memory when it comes (docs/timing.md, section 8). It has a port for each pipeline (section 14). */
#include <stdlib.h>
#include <string.h>

#include "clocked_blocks.h"
#include "layout.h"
#include "memory.h"
#include "ring.h"

/* A fill or a write that waits for its grant; a write's bytes are in its port's slot of its number. */
typedef struct waiting {
    int32_t port, bytes;
    int64_t address;
} waiting;

/* What was read and comes: beats in the cycles up to and with `last`. */
typedef struct coming {
    int64_t first, last;
    const uint8_t *data;
    int64_t bytes;
    bool fill;
} coming;

RING(waiting_ring, waiting)
RING(coming_ring, coming)

/* A pipeline's. */
typedef struct bus_port {
    coming_ring coming;
    int64_t filled;     /* fills granted */
    uint8_t *fill_data; /* a ring of lines */
    int64_t written, taken;
    uint8_t *write_data;
    load_port load; /* underway while valid */
    bool load_asks; /* for its next burst, since the cycle before */
    int64_t load_done_bytes;
    uint8_t *load_data[2]; /* of this load and of the one before, whose data may be on their way */
    int load_slot;
} bus_port;

typedef struct bus_state {
    const vodr_machine *machine;
    storage *storage;
    memory bus;
    int32_t line_bytes;
    int64_t now, refresh_until, row_until; /* what the bus waits for since its last grant, */
    int64_t address, bytes;                /* and what that moves after */
    bool is_write;
    int32_t served;                    /* which was this port's */
    waiting_ring fills, writes, loads; /* of all ports, in the order in which they came; loads: their next bursts */
    int64_t fill_slots;                /* lines that can be on their way to a port */
    int64_t write_slots, write_slot_bytes;
    int32_t port_count;
    bus_port ports[];
} bus_state;

/* Grants the bus; returns the cycle of the last data. */
static int64_t grant(bus_state *s, const waiting *w, bool write)
{
    uint64_t refresh = s->bus.refresh_cycles, row = s->bus.row_cycles;
    int64_t last = memory_grant(&s->bus, s->now, w->address, w->bytes, write);
    s->refresh_until = s->now + (int64_t)(s->bus.refresh_cycles - refresh);
    s->row_until = s->refresh_until + (int64_t)(s->bus.row_cycles - row);
    s->address = w->address;
    s->bytes = w->bytes;
    s->is_write = write;
    s->served = w->port;
    return last;
}

static void grant_fill(bus_state *s)
{
    waiting w = *waiting_ring_front(&s->fills);
    bus_port *p = &s->ports[w.port];
    uint8_t *data = p->fill_data + p->filled++ % s->fill_slots * s->line_bytes;
    int64_t last = grant(s, &w, false);
    waiting_ring_pop(&s->fills);
    storage_read(s->storage, w.address, w.bytes, data);
    coming_ring_push(&p->coming, (coming){last, last, data, w.bytes, true});
}

/* Returns whose it was. */
static int32_t grant_write(bus_state *s)
{
    waiting w = *waiting_ring_front(&s->writes);
    bus_port *p = &s->ports[w.port];
    grant(s, &w, true);
    waiting_ring_pop(&s->writes);
    storage_write(s->storage, w.address, w.bytes, p->write_data + p->written++ % s->write_slots * s->write_slot_bytes);
    return w.port;
}

/* One burst of a brick; returns the port whose last one it was, or -1. */
static int32_t grant_load(bus_state *s)
{
    waiting w = *waiting_ring_front(&s->loads);
    bus_port *p = &s->ports[w.port];
    int64_t last = grant(s, &w, false);
    waiting_ring_pop(&s->loads);
    const uint8_t *data = p->load_data[p->load_slot] + p->load_done_bytes;
    coming_ring_push(&p->coming, (coming){last - memory_beats(&s->bus, w.bytes) + 1, last, data, w.bytes, false});
    p->load_done_bytes += w.bytes;
    p->load.valid = p->load_asks = p->load_done_bytes < p->load.bytes;
    return p->load.valid ? -1 : w.port;
}

static void take_load(bus_state *s, bus_port *p, const load_port *load)
{
    p->load = *load;
    p->load_asks = true;
    p->load_done_bytes = 0;
    p->load_slot = !p->load_slot;
    storage_read(s->storage, load->address, load->bytes, p->load_data[p->load_slot]);
}

static void ask_burst(bus_state *s, int32_t port)
{
    bus_port *p = &s->ports[port];
    int64_t rest = p->load.bytes - p->load_done_bytes, burst = s->machine->texture_burst_bytes;
    waiting_ring_push(&s->loads,
                      (waiting){port, (int32_t)(rest < burst ? rest : burst), p->load.address + p->load_done_bytes});
    p->load_asks = false;
}

static void take_write(bus_state *s, int32_t port, const write_port *w)
{
    bus_port *p = &s->ports[port];
    waiting_ring_push(&s->writes, (waiting){port, w->bytes, w->address});
    memcpy(p->write_data + p->taken++ % s->write_slots * s->write_slot_bytes, w->data, (size_t)w->bytes);
}

/* What was asked for in the cycle before. */
static void take(bus_state *s, int32_t port, const frame_buffer_in *in)
{
    bus_port *p = &s->ports[port];
    if (in->fill->valid)
        waiting_ring_push(&s->fills, (waiting){port, s->line_bytes, in->fill->address});
    if (in->write->valid)
        take_write(s, port, in->write);
    if (in->load->valid && !p->load.valid)
        take_load(s, p, in->load);
    if (p->load_asks)
        ask_burst(s, port);
}

/* What is seen of it in the next cycle. */
static void hand_on(const bus_state *s, bus_port *p, frame_buffer_out *out)
{
    if (!p->coming.count || coming_ring_front(&p->coming)->first > s->now + 1)
        return;
    coming *c = coming_ring_front(&p->coming);
    int64_t beat = s->machine->mem_bus_bytes, bytes = c->bytes < beat ? c->bytes : beat;
    if (c->fill) {
        out->filled.valid = true;
        memcpy(out->filled.data, c->data, (size_t)c->bytes);
    } else {
        out->load.data_valid = true;
        out->load.bytes = (int32_t)bytes;
        memcpy(out->load.data, c->data, (size_t)bytes);
        c->data += bytes;
        c->bytes -= bytes;
    }
    if (c->last == s->now + 1)
        coming_ring_pop(&p->coming);
}

/* The beat that moves for a port in this cycle. What is written lies in memory since its grant. */
static void move(const bus_state *s, int32_t port, beat_port *out)
{
    int64_t beat = s->machine->mem_bus_bytes, done = (s->now - s->row_until) * beat, left = s->bytes - done;
    out->valid = s->served == port && s->row_until <= s->now && s->now < s->bus.free_cycle;
    out->read = out->valid && !s->is_write;
    out->write = out->valid && s->is_write;
    out->address = s->address + done;
    out->bytes = (int32_t)(left < beat ? left : beat);
    if (out->write)
        storage_read(s->storage, out->address, out->bytes, out->data);
}

/* What the bus does for a port. */
static uint8_t status(const bus_state *s, int32_t port)
{
    return s->served != port            ? BLOCK_IDLE
           : s->now < s->refresh_until  ? BLOCK_STALLED + VODR_STALL_DRAM_REFRESH
           : s->now < s->row_until      ? BLOCK_STALLED + VODR_STALL_DRAM_ROW
           : s->now < s->bus.free_cycle ? BLOCK_BUSY
                                        : BLOCK_IDLE;
}

void clocked_frame_buffer_ports(void *state, const frame_buffer_in *const in[], frame_buffer_out *const out[])
{
    bus_state *s = state;
    for (int32_t i = 0; i < s->port_count; i++) {
        out[i]->filled.valid = out[i]->written.valid = out[i]->load.granted = out[i]->load.data_valid = false;
        take(s, i, in[i]);
    }
    bool is_free = s->bus.free_cycle <= s->now;
    if (is_free && s->fills.count) {
        grant_fill(s);
    } else if (is_free && s->writes.count) {
        out[grant_write(s)]->written.valid = true;
    } else if (is_free && s->loads.count) {
        int32_t done = grant_load(s);
        if (done >= 0)
            out[done]->load.granted = true;
    }
    for (int32_t i = 0; i < s->port_count; i++) {
        bus_port *p = &s->ports[i];
        hand_on(s, p, out[i]);
        move(s, i, &out[i]->memory);
        out[i]->load.ready = !p->load.valid;
        out[i]->report.status = status(s, i);
        out[i]->report.idle = !s->fills.count && !s->writes.count && !p->load.valid && !p->coming.count &&
                              s->bus.free_cycle <= s->now + 1;
    }
    s->now++;
}

static void clock(void *state, const frame_buffer_in *in, frame_buffer_out *out)
{
    clocked_frame_buffer_ports(state, &in, &out);
}

static void finish(void *state)
{
    bus_state *s = state;
    for (int32_t i = 0; i < s->port_count; i++) {
        bus_port *p = &s->ports[i];
        coming_ring_free(&p->coming);
        free(p->fill_data);
        free(p->write_data);
        free(p->load_data[0]);
        free(p->load_data[1]);
    }
    waiting_ring_free(&s->fills);
    waiting_ring_free(&s->writes);
    waiting_ring_free(&s->loads);
    free(s);
}

static bool make_port(const bus_state *s, bus_port *p)
{
    const vodr_machine *m = s->machine;
    p->fill_data = malloc((size_t)(s->fill_slots * s->line_bytes));
    p->write_data = malloc((size_t)(s->write_slots * s->write_slot_bytes));
    bool made = p->fill_data && p->write_data;
    for (int i = 0; i < 2 && m->traversal != VODR_TRAVERSAL_WHOLE; i++) {
        p->load_data[i] = malloc((size_t)s->storage->brick_room_bytes);
        made &= p->load_data[i] != NULL;
    }
    int64_t latency = m->memory == VODR_MEMORY_DRAM ? m->dram_tcas_cycles : m->mem_latency_cycles;
    return coming_ring_reserve(&p->coming, (size_t)latency + 2) && made;
}

bool clocked_frame_buffer(const block_setup *setup, frame_buffer_face *face, frame_buffer_out *reset)
{
    const vodr_machine *m = setup->machine;
    bool through = m->write_policy == VODR_WRITE_POLICY_THROUGH;
    size_t ports = (size_t)m->pipelines;
    bus_state *s = calloc(1, sizeof *s + ports * sizeof *s->ports);
    *face = (frame_buffer_face){.state = s, .clock = clock, .finish = finish};
    if (!s)
        return false;
    s->machine = m;
    s->storage = setup->storage;
    s->bus = memory_of(m);
    s->line_bytes = line_bytes(m);
    s->fill_slots = m->nonblocking ? m->nonblocking_misses : 1;
    s->write_slots = through ? m->write_fifo : 1;
    s->write_slot_bytes = through ? pixel_bytes(m) : s->line_bytes;
    s->port_count = m->pipelines;
    bool made = waiting_ring_reserve(&s->fills, ports * (size_t)s->fill_slots) &&
                waiting_ring_reserve(&s->writes, ports * (size_t)s->write_slots) &&
                waiting_ring_reserve(&s->loads, ports);
    for (size_t i = 0; i < ports; i++)
        made &= make_port(s, &s->ports[i]);
    *reset = (frame_buffer_out){.load.ready = true, .report.idle = true};
    return made;
}
