/* test_clocked_frame_buffer.c - the bus behind several pipelines, cycle by cycle, against the rules of docs/timing.md,
 * sections 8 and 14, written down a second time: a list of requests, out of which each grant takes one. */
#include <stdlib.h>

#include "clocked_blocks.h"
#include "layout.h"
#include "lib/unit.h"

enum { CYCLES = 600, MOST_REQUESTS = 4096, ROUNDS = 60, PORTS = 5 };

typedef enum kind { FILL, WRITE, LOAD } kind;

/* A request, or a burst of one. */
typedef struct request {
    kind kind;
    int64_t raised;
    int32_t port;
    int64_t bytes, left; /* left: of a load, with this burst */
    bool granted;
} request;

typedef struct bench {
    vodr_machine machine;
    storage storage;
    frame_buffer_face face;
    frame_buffer_in in[PORTS];
    fill_port fill[PORTS];
    write_port write[PORTS];
    load_port load[PORTS];
    frame_buffer_out out[PORTS];
    /* what is expected */
    request requests[MOST_REQUESTS];
    int32_t count;
    int64_t free_cycle;
    int32_t served;
    int32_t fills_out[PORTS], writes_out[PORTS], loads_out[PORTS]; /* raised, and not there, granted, granted in full */
    int64_t filled[PORTS][CYCLES + 400], data[PORTS][CYCLES + 400]; /* by cycle: lines, bytes of a brick */
} bench;

static const uint8_t voxels[8 * 8 * 8];
static const vodr_volume block = {.dims_vox = {8, 8, 8}, .voxel_bytes = 1, .voxels = voxels};
static const vodr_view view = {.width_px = 64, .height_px = 64, .slices = 1, .footprint = 1 << 20};

static int64_t beats(const bench *b, int64_t bytes)
{
    return (bytes + b->machine.mem_bus_bytes - 1) / b->machine.mem_bus_bytes;
}

static void raise(bench *b, kind what, int64_t cycle, int32_t port, int64_t left)
{
    int64_t burst = b->machine.texture_burst_bytes, bytes = what == LOAD && left > burst ? burst : left;
    assert_true(b->count < MOST_REQUESTS);
    b->requests[b->count++] = (request){what, cycle, port, bytes, left, false};
}

/* What the pipelines ask for in a cycle. */
static void ask(bench *b, rng *r, int64_t cycle)
{
    const int64_t lines = b->storage.texture_base / line_bytes(&b->machine);
    for (int32_t i = 0; i < b->machine.pipelines; i++) {
        b->fill[i].valid = b->fills_out[i] < b->machine.nonblocking_misses && rng_one_in(r, 12);
        b->write[i].valid = b->writes_out[i] < b->machine.write_fifo && rng_one_in(r, 12);
        b->load[i].valid = !b->loads_out[i] && rng_one_in(r, 20);
        if (b->fill[i].valid) {
            b->fill[i].address = rng_int(r, 0, lines - 1) * line_bytes(&b->machine);
            b->fills_out[i]++;
            raise(b, FILL, cycle, i, line_bytes(&b->machine));
        }
        if (b->write[i].valid) {
            b->write[i].bytes = pixel_bytes(&b->machine);
            b->write[i].address = rng_int(r, 0, lines - 1) * line_bytes(&b->machine);
            b->writes_out[i]++;
            raise(b, WRITE, cycle, i, pixel_bytes(&b->machine));
        }
        if (b->load[i].valid) {
            b->load[i].address = b->storage.texture_base;
            b->load[i].bytes = rng_int(r, 1, 400);
            b->loads_out[i] = 1;
            raise(b, LOAD, cycle, i, b->load[i].bytes);
        }
    }
}

/* Whom the bus serves in a cycle: fills, writes, loads; the oldest; the lowest pipeline. */
static request *choose(bench *b, int64_t cycle)
{
    request *best = NULL;
    for (int32_t i = 0; i < b->count; i++) {
        request *q = &b->requests[i];
        if (q->granted || q->raised >= cycle) {
            continue;
        }
        bool better = !best || q->kind < best->kind;
        better |= best && q->kind == best->kind &&
                  (q->raised < best->raised || (q->raised == best->raised && q->port < best->port));
        best = better ? q : best;
    }
    return best;
}

/* A grant of the cycle, if there is one, and what follows of it; what is expected at once is checked. */
static void expect_grant(bench *b, int64_t cycle)
{
    request *q = cycle >= b->free_cycle ? choose(b, cycle) : NULL;
    bool last = q && q->bytes == q->left;
    for (int32_t i = 0; i < b->machine.pipelines; i++) {
        bool mine = q && q->port == i;
        assert_int_equal(b->out[i].written.valid, mine && q->kind == WRITE);
        assert_int_equal(b->out[i].load.granted, mine && q->kind == LOAD && last);
    }
    if (!q) {
        return;
    }
    int64_t end = cycle + beats(b, q->bytes) - 1, latency = b->machine.mem_latency_cycles;
    q->granted = true;
    b->free_cycle = end + 1;
    b->served = q->port;
    b->writes_out[q->port] -= q->kind == WRITE;
    b->loads_out[q->port] -= q->kind == LOAD && last;
    if (q->kind == FILL) {
        b->filled[q->port][end + latency] = 1;
    }
    for (int64_t at = cycle, left = q->bytes; q->kind == LOAD && left > 0; at++, left -= b->machine.mem_bus_bytes) {
        b->data[q->port][at + latency] = left < b->machine.mem_bus_bytes ? left : b->machine.mem_bus_bytes;
    }
    if (q->kind == LOAD && !last) {
        raise(b, LOAD, cycle, q->port, q->left - q->bytes);
    }
}

/* What all ports show at the end of a cycle, to be seen in the next. */
static void expect_ports(bench *b, int64_t cycle)
{
    for (int32_t i = 0; i < b->machine.pipelines; i++) {
        const frame_buffer_out *o = &b->out[i];
        int64_t bytes = b->data[i][cycle + 1];
        assert_int_equal(o->filled.valid, b->filled[i][cycle + 1]);
        assert_int_equal(o->load.data_valid, bytes > 0);
        if (bytes > 0) {
            assert_int_equal(o->load.bytes, bytes);
        }
        assert_int_equal(o->report.status, cycle < b->free_cycle && b->served == i ? BLOCK_BUSY : BLOCK_IDLE);
        b->fills_out[i] -= o->filled.valid;
    }
}

static void run(bench *b, rng *r)
{
    const frame_buffer_in *in[PORTS];
    frame_buffer_out *out[PORTS];
    for (int32_t i = 0; i < PORTS; i++) {
        b->in[i] = (frame_buffer_in){&b->fill[i], &b->write[i], &b->load[i]};
        in[i] = &b->in[i];
        out[i] = &b->out[i];
    }
    for (int64_t cycle = 0; cycle < CYCLES; cycle++) {
        clocked_frame_buffer_ports(b->face.state, in, out);
        expect_grant(b, cycle);
        expect_ports(b, cycle);
        ask(b, r, cycle);
    }
}

static void grants_are_in_order(void **state)
{
    (void)state;
    rng r = {71};
    for (int round = 0; round < ROUNDS; round++) {
        bench *b = calloc(1, sizeof *b);
        assert_non_null(b);
        b->machine = unit_machine("brick=8 nonblocking=1 write_policy=through texture_burst_bytes=64");
        b->machine.pipelines = (int32_t)rng_int(&r, 1, PORTS);
        b->machine.nonblocking_misses = (int32_t)rng_int(&r, 1, 4);
        b->machine.write_fifo = (int32_t)rng_int(&r, 1, 4);
        b->machine.mem_bus_bytes = 1 << rng_int(&r, 2, 7);
        b->machine.mem_latency_cycles = (int32_t)rng_int(&r, 1, 100);
        block_setup setup = {
            .machine = &b->machine, .view = &view, .volume = &block, .edge_vox = {8, 8, 8}, .storage = &b->storage};
        assert_true(storage_start(&b->storage, &b->machine, &view, &block, setup.edge_vox));
        assert_true(clocked_frame_buffer(&setup, &b->face, &b->out[0]));
        run(b, &r);
        b->face.finish(b->face.state);
        storage_finish(&b->storage);
        free(b);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(grants_are_in_order)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
