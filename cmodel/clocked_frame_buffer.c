/* clocked_frame_buffer.c - the memory bus, clocked: grants fills before writes before loads, and hands on what comes
 * from memory when it comes (docs/timing.md, section 8). */
#include <stdlib.h>
#include <string.h>

#include "clocked_blocks.h"
#include "layout.h"
#include "memory.h"
#include "ring.h"

/* A write that waits for its grant; its bytes are in the slot of its number. */
typedef struct waiting_write {
    int64_t address;
    int32_t bytes;
} waiting_write;

/* What was read and comes: beats in the cycles up to and with `last`. */
typedef struct coming {
    int64_t first, last;
    const uint8_t *data;
    int64_t bytes;
    bool fill;
} coming;

RING(fill_ring, int64_t)
RING(write_ring, waiting_write)
RING(coming_ring, coming)

typedef struct bus_state {
    const vodr_machine *machine;
    storage *storage;
    memory bus;
    int32_t line_bytes;
    int64_t now, refresh_until, row_until; /* what the bus waits for since its last grant, */
    int64_t address, bytes;                /* and what that moves after */
    bool is_write;
    fill_ring fills; /* addresses */
    write_ring writes;
    coming_ring coming;
    int64_t filled, fill_slots; /* fills granted; lines that can be on their way */
    uint8_t *fill_data;         /* a ring of lines */
    int64_t written, taken, write_slots, write_slot_bytes;
    uint8_t *write_data;
    load_port load; /* underway while valid */
    int64_t load_done_bytes;
    uint8_t *load_data[2]; /* of this load and of the one before, whose data may be on their way */
    int load_slot;
} bus_state;

/* Grants the bus; returns the cycle of the last data. */
static int64_t grant(bus_state *s, int64_t address, int64_t bytes, bool write)
{
    uint64_t refresh = s->bus.refresh_cycles, row = s->bus.row_cycles;
    int64_t last = memory_grant(&s->bus, s->now, address, bytes, write);
    s->refresh_until = s->now + (int64_t)(s->bus.refresh_cycles - refresh);
    s->row_until = s->refresh_until + (int64_t)(s->bus.row_cycles - row);
    s->address = address;
    s->bytes = bytes;
    s->is_write = write;
    return last;
}

static void grant_fill(bus_state *s)
{
    int64_t address = *fill_ring_front(&s->fills);
    uint8_t *data = s->fill_data + s->filled++ % s->fill_slots * s->line_bytes;
    int64_t last = grant(s, address, s->line_bytes, false);
    fill_ring_pop(&s->fills);
    storage_read(s->storage, address, s->line_bytes, data);
    coming_ring_push(&s->coming, (coming){last, last, data, s->line_bytes, true});
}

static void grant_write(bus_state *s)
{
    waiting_write w = *write_ring_front(&s->writes);
    grant(s, w.address, w.bytes, true);
    write_ring_pop(&s->writes);
    storage_write(s->storage, w.address, w.bytes, s->write_data + s->written++ % s->write_slots * s->write_slot_bytes);
}

/* One burst of the brick; true when it was the last. */
static bool grant_load(bus_state *s)
{
    int64_t done = s->load_done_bytes, rest = s->load.bytes - done, burst = s->machine->texture_burst_bytes;
    int64_t bytes = rest < burst ? rest : burst;
    int64_t last = grant(s, s->load.address + done, bytes, false);
    const uint8_t *data = s->load_data[s->load_slot] + done;
    coming_ring_push(&s->coming, (coming){last - memory_beats(&s->bus, bytes) + 1, last, data, bytes, false});
    s->load_done_bytes += bytes;
    return s->load_done_bytes == s->load.bytes;
}

static void take_load(bus_state *s, const load_port *load)
{
    s->load = *load;
    s->load_done_bytes = 0;
    s->load_slot = !s->load_slot;
    storage_read(s->storage, load->address, load->bytes, s->load_data[s->load_slot]);
}

static void take_write(bus_state *s, const write_port *w)
{
    write_ring_push(&s->writes, (waiting_write){w->address, w->bytes});
    memcpy(s->write_data + s->taken++ % s->write_slots * s->write_slot_bytes, w->data, (size_t)w->bytes);
}

/* What is seen of it in the next cycle. */
static void hand_on(bus_state *s, frame_buffer_out *out)
{
    if (!s->coming.count || coming_ring_front(&s->coming)->first > s->now + 1)
        return;
    coming *c = coming_ring_front(&s->coming);
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
        coming_ring_pop(&s->coming);
}

/* The beat that moves in this cycle. What is written lies in memory since its grant. */
static void move(const bus_state *s, beat_port *out)
{
    int64_t beat = s->machine->mem_bus_bytes, done = (s->now - s->row_until) * beat, left = s->bytes - done;
    out->valid = s->row_until <= s->now && s->now < s->bus.free_cycle;
    out->read = out->valid && !s->is_write;
    out->write = out->valid && s->is_write;
    out->address = s->address + done;
    out->bytes = (int32_t)(left < beat ? left : beat);
    if (out->write)
        storage_read(s->storage, out->address, out->bytes, out->data);
}

static uint8_t status(const bus_state *s)
{
    return s->now < s->refresh_until    ? BLOCK_STALLED + VODR_STALL_DRAM_REFRESH
           : s->now < s->row_until      ? BLOCK_STALLED + VODR_STALL_DRAM_ROW
           : s->now < s->bus.free_cycle ? BLOCK_BUSY
                                        : BLOCK_IDLE;
}

static void clock(void *state, const frame_buffer_in *in, frame_buffer_out *out)
{
    bus_state *s = state;
    out->filled.valid = out->written.valid = out->load.granted = out->load.data_valid = false;
    if (in->fill->valid)
        fill_ring_push(&s->fills, in->fill->address);
    if (in->write->valid)
        take_write(s, in->write);
    if (in->load->valid && !s->load.valid)
        take_load(s, in->load);
    bool is_free = s->bus.free_cycle <= s->now;
    if (is_free && s->fills.count) {
        grant_fill(s);
    } else if (is_free && s->writes.count) {
        grant_write(s);
        out->written.valid = true;
    } else if (is_free && s->load.valid) {
        out->load.granted = grant_load(s);
        s->load.valid = !out->load.granted;
    }
    hand_on(s, out);
    move(s, &out->memory);
    out->load.ready = !s->load.valid;
    out->report.status = status(s);
    out->report.idle =
        !s->fills.count && !s->writes.count && !s->load.valid && !s->coming.count && s->bus.free_cycle <= s->now + 1;
    s->now++;
}

static void finish(void *state)
{
    bus_state *s = state;
    fill_ring_free(&s->fills);
    write_ring_free(&s->writes);
    coming_ring_free(&s->coming);
    free(s->fill_data);
    free(s->write_data);
    free(s->load_data[0]);
    free(s->load_data[1]);
    free(s);
}

bool clocked_frame_buffer(const block_setup *setup, frame_buffer_face *face, frame_buffer_out *reset)
{
    const vodr_machine *m = setup->machine;
    bool through = m->write_policy == VODR_WRITE_POLICY_THROUGH, whole = m->traversal == VODR_TRAVERSAL_WHOLE;
    bus_state *s = calloc(1, sizeof *s);
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
    s->fill_data = malloc((size_t)(s->fill_slots * s->line_bytes));
    s->write_data = malloc((size_t)(s->write_slots * s->write_slot_bytes));
    bool made = s->fill_data && s->write_data;
    for (int i = 0; i < 2 && !whole; i++) {
        s->load_data[i] = malloc((size_t)s->storage->brick_room_bytes);
        made &= s->load_data[i] != NULL;
    }
    int64_t latency = m->memory == VODR_MEMORY_DRAM ? m->dram_tcas_cycles : m->mem_latency_cycles;
    made &=
        fill_ring_reserve(&s->fills, (size_t)s->fill_slots) && write_ring_reserve(&s->writes, (size_t)s->write_slots);
    made &= coming_ring_reserve(&s->coming, (size_t)latency + 2);
    *reset = (frame_buffer_out){.load.ready = true, .report.idle = true};
    return made;
}
