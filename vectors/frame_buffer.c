/* frame_buffer.c - traffic for the frame buffer: a pixel cache that wants lines and writes lines or pixels, a texture
 * unit that wants bricks or parts of them; each as many at once as there can be, and where it likes. */
#include <string.h>

#include "bench.h"
#include "layout.h"
#include "voxels.h"

static const char *const machines[] = {"",
                                       "line_px=4x4 mem_bus_bytes=4 nonblocking=1 nonblocking_misses=3 write_fifo=5",
                                       "fb_bits=16 line_px=1x1 mem_bus_bytes=256 write_fifo=1",
                                       "line_px=8x4 mem_bus_bytes=1 nonblocking=1 nonblocking_misses=1 write_fifo=16",
                                       "line_px=2x1 mem_bus_bytes=16 nonblocking=1 nonblocking_misses=8",
                                       NULL};

/* A figure mostly small, so that much happens, else the largest there can be. */
static int32_t figure(rng *random, int32_t least, int32_t most)
{
    return rng_one_in(random, 3) ? least : rng_one_in(random, 5) ? most : (int32_t)rng_int(random, least, 12);
}

static void draw(rng *random, vodr_machine *m)
{
    m->brick = (int32_t)rng_int(random, 3, rng_one_in(random, 2) ? 48 : 5);
    m->write_policy = (int32_t)rng_int(random, VODR_WRITE_POLICY_BACK, VODR_WRITE_POLICY_THROUGH);
    m->memory = rng_one_in(random, 3) ? VODR_MEMORY_FIXED : VODR_MEMORY_DRAM;
    m->mem_latency_cycles = figure(random, 3, 300);
    m->texture_burst_bytes = rng_one_in(random, 3) ? 4096 : 16 << rng_int(random, 0, 7);
    m->dram_banks = 1 << rng_int(random, 0, 6);
    m->dram_row_bytes = 64 << (rng_one_in(random, 3) ? 10 : rng_int(random, 0, 9));
    m->dram_trcd_cycles = figure(random, 1, 255);
    m->dram_tcas_cycles = figure(random, 3, 255);
    m->dram_trp_cycles = figure(random, 1, 255);
    m->dram_trfc_cycles = (int32_t)rng_int(random, 1, rng_one_in(random, 2) ? 3 : 60);
    m->dram_refresh_cycles = m->dram_trfc_cycles + (int32_t)rng_int(random, 1, rng_one_in(random, 2) ? 3 : 200);
    if (rng_one_in(random, 4))
        m->dram_refresh_cycles = 0;
}

enum { TRANSACTIONS_A_MEMORY = 1000, WRAPS_BYTES = 256 };

/* Both sides of the bus. */
typedef struct sides {
    const block_setup *setup;
    int32_t line_bytes, pixel_bytes;
    int64_t lines, bricks;
    bool through;
    int64_t fills_room, fills, writes_room, writes; /* that can be under way, and that are */
    fill_port fill;
    write_port write;
    load_port load;
    int64_t loads[2]; /* bytes to come of the load before last, and of the last */
    bool loading;     /* the last has bursts left */
    int64_t likes_fill, likes_write, likes_load;
} sides;

static sides sides_of(const bench *b)
{
    const vodr_machine *m = &b->machine;
    const block_setup *setup = &b->setup;
    sides s = {.setup = setup, .line_bytes = line_bytes(m), .pixel_bytes = pixel_bytes(m), .bricks = 1};
    s.lines = setup->storage->texture_base / s.line_bytes;
    for (int c = 0; c < 3; c++)
        s.bricks *= ceil_div32(setup->volume->dims_vox[c], setup->edge_vox[c]);
    s.through = m->write_policy == VODR_WRITE_POLICY_THROUGH;
    s.fills_room = m->nonblocking ? m->nonblocking_misses : 1;
    s.writes_room = s.through ? m->write_fifo : 1;
    return s;
}

/* How busy they are for a while. */
static void like(bench *b, sides *s)
{
    int64_t *const likes[] = {&s->likes_fill, &s->likes_write, &s->likes_load};
    for (int i = 0; i < 3; i++)
        *likes[i] = rng_one_in(&b->random, 3) ? 1 : rng_int(&b->random, 2, rng_one_in(&b->random, 3) ? 300 : 20);
}

/* Few lines, so that they meet each other's rows and data, or any. */
static int64_t any_line(bench *b, const sides *s)
{
    int64_t few = s->lines < 4 ? s->lines : 4;
    return rng_int(&b->random, 0, (rng_one_in(&b->random, 2) ? few : s->lines) - 1) * s->line_bytes;
}

static void ask_write(bench *b, sides *s)
{
    write_port *w = &s->write;
    w->bytes = s->through ? s->pixel_bytes : s->line_bytes;
    w->address = any_line(b, s);
    if (s->through)
        w->address += rng_int(&b->random, 0, s->line_bytes / s->pixel_bytes - 1) * s->pixel_bytes;
    for (int32_t i = 0; i < w->bytes; i++)
        w->data[i] = (uint8_t)bench_bits(&b->random, 8);
}

static void forget_write(bench *b, sides *s)
{
    s->write.bytes = (int32_t)rng_int(&b->random, 0, s->line_bytes);
    memset(s->write.data, (int)bench_bits(&b->random, 8), (size_t)s->line_bytes);
}

/* Of a brick with its border. */
static int64_t brick_bytes(const bench *b, const sides *s, int64_t brick)
{
    int64_t bytes = density_bytes(&b->machine);
    vox_box box;
    for (int c = 0; c < 3; c++) {
        int32_t size = s->setup->volume->dims_vox[c], edge = s->setup->edge_vox[c], count = ceil_div32(size, edge);
        box.lo[c] = (int32_t)(brick % count) * edge;
        box.hi[c] = edge < size - box.lo[c] ? box.lo[c] + edge : size;
        brick /= count;
    }
    box = voxels_reach(s->setup->volume->dims_vox, &box, filter_border_vox(&b->machine));
    for (int c = 0; c < 3; c++)
        bytes *= box.hi[c] - box.lo[c];
    return bytes;
}

static void note_load(sides *s, int64_t bytes)
{
    s->loads[0] = s->loads[1];
    s->loads[1] = bytes;
    s->loading = true;
}

/* A brick, or so much of it that bursts and beats end where they like, or that a count of eight bits comes round. */
static void ask_load(bench *b, sides *s)
{
    int64_t brick = rng_int(&b->random, 0, s->bricks - 1), bytes = brick_bytes(b, s, brick);
    s->load.address = s->setup->storage->texture_base + brick * s->setup->storage->brick_room_bytes;
    s->load.bytes = rng_one_in(&b->random, 3) ? bytes : rng_int(&b->random, 1, bytes < 700 ? bytes : 700);
    if (bytes > WRAPS_BYTES && rng_one_in(&b->random, 4))
        s->load.bytes = WRAPS_BYTES;
    note_load(s, s->load.bytes);
}

/* What they ask for in the next cycle. What is not asked for any more is not kept either. */
static void ask(bench *b, sides *s)
{
    s->fill.valid = s->fills < s->fills_room && rng_one_in(&b->random, s->likes_fill);
    s->fill.address = any_line(b, s);
    s->fills += s->fill.valid;
    s->write.valid = s->writes < s->writes_room && rng_one_in(&b->random, s->likes_write);
    if (s->write.valid)
        ask_write(b, s);
    else
        forget_write(b, s);
    s->writes += s->write.valid;
    if (!s->load.valid && !s->loading && !s->loads[0] && rng_one_in(&b->random, s->likes_load)) {
        s->load.valid = true;
        ask_load(b, s);
    }
}

/* What they see. */
static void hear(sides *s, const frame_buffer_out *out)
{
    s->fills -= out->filled.valid;
    s->writes -= out->written.valid;
    s->loading &= !out->load.granted;
    if (out->load.data_valid)
        s->loads[!s->loads[0]] -= out->load.bytes;
}

static void traffic(bench *b, uint64_t transactions)
{
    frame_buffer_face *face = &b->faces->frame_buffer;
    frame_buffer_out out = b->reset->frame_buffer;
    sides s = sides_of(b);
    const frame_buffer_in in = {.fill = &s.fill, .write = &s.write, .load = &s.load};
    uint64_t done = 0, most = transactions < TRANSACTIONS_A_MEMORY ? transactions : TRANSACTIONS_A_MEMORY;
    like(b, &s);
    ask(b, &s);
    for (; done < most && !bench_differs(b); b->cycles++) {
        bool taken = s.load.valid && out.load.ready;
        if (rng_one_in(&b->random, 200))
            like(b, &s);
        face->clock(face->state, &in, &out);
        done += out.filled.valid + out.written.valid + out.load.data_valid;
        if (taken)
            s.load = (load_port){.valid = false};
        hear(&s, &out);
        ask(b, &s);
    }
    b->left = done < transactions ? transactions - done : 0;
}

/* ---- what is legal ---- */

typedef struct bus_rules {
    sides sides; /* what is under way of theirs */
    bool begun;
} bus_rules;

static const char *illegal_line(const sides *s, const fill_port *fill, const write_port *write)
{
    int64_t end = s->lines * s->line_bytes, unit = s->through ? s->pixel_bytes : s->line_bytes;
    if (fill->valid && s->fills == s->fills_room)
        return "fill_valid is 1, but as many fills wait for their line as can";
    if (fill->valid && (fill->address % s->line_bytes || fill->address >= end))
        return "fill_address is no line's";
    if (write->valid && s->writes == s->writes_room)
        return "write_valid is 1, but as many writes wait for the bus as can";
    if (write->valid && write->bytes != unit)
        return "write_bytes is not the size of a line, or of a pixel written through";
    if (write->valid && (write->address % unit || write->address >= end))
        return "write_address is none of a line, or of a pixel written through";
    return NULL;
}

static const char *illegal_load(const bench *b, const sides *s, const load_port *load)
{
    const storage *memory = s->setup->storage;
    int64_t at = load->address - memory->texture_base, brick = at / memory->brick_room_bytes;
    if (b->machine.traversal == VODR_TRAVERSAL_WHOLE)
        return "load_valid is 1, but traversal is whole";
    if (s->loading || s->loads[0])
        return "load_valid is 1, but two loads are under way";
    if (at < 0 || at % memory->brick_room_bytes || brick >= s->bricks)
        return "load_address is no brick's";
    return load->bytes < 1 || load->bytes > brick_bytes(b, s, brick) ? "load_bytes is 0 or more than the brick has"
                                                                     : NULL;
}

static const char *illegal(const bench *b, void *rules, const void *inputs, const void *shown)
{
    const frame_buffer_in *in = inputs;
    const frame_buffer_out *out = shown;
    bus_rules *r = rules;
    if (!r->begun)
        r->sides = sides_of(b);
    else
        hear(&r->sides, out);
    r->begun = true;
    const char *why = illegal_line(&r->sides, in->fill, in->write);
    r->sides.fills += in->fill->valid;
    r->sides.writes += in->write->valid;
    if (why || !in->load->valid || !out->load.ready)
        return why;
    why = illegal_load(b, &r->sides, in->load);
    note_load(&r->sides, in->load->bytes);
    return why;
}

const block_bench bench_frame_buffer = {.block = VODR_BLOCK_FRAME_BUFFER,
                                        .machines = machines,
                                        .draw = draw,
                                        .traffic = traffic,
                                        .illegal = illegal,
                                        .rules_bytes = sizeof(bus_rules),
                                        .large = true,
                                        .vectors = "line_px=4x1 mem_bus_bytes=4 write_fifo=4",
                                        .case_cycles = 640,
                                        .level_cycles = {10500, 1000000}};
