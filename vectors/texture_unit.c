/* texture_unit.c - traffic for the texture unit: a divider that hands visits on, a rasterizer that goes through them, a
 * frame buffer that answers loads with densities of its own, the external memory of `whole`, and a pixel cache that
 * lets fragments go when it likes. A transaction is a fragment. */
#include <string.h>

#include "bench.h"
#include "layout.h"
#include "volume_divider.h"

static const char *const machines[] = {
    "",
    "density_bits=12 tf_bits=16 fb_bits=16 guard_bits=6 weight_bits=12 mem_bus_bytes=64 texture_burst_bytes=16",
    "density_bits=12 guard_bits=0 weight_bits=1 mem_bus_bytes=1 fragment_fifo=1",
    "guard_bits=1 weight_bits=5 fb_bits=16 mem_bus_bytes=1 fragment_fifo=5",
    "traversal=whole mem_latency_cycles=20 fragment_fifo=9",
    "traversal=whole density_bits=12 mem_latency_cycles=1 fragment_fifo=1",
    NULL};

enum { BUFFER_BYTES = 1 << 16, LARGEST_EDGE_VOX = 30, VISITS = 8, WAITING = 1024 };

static void draw(rng *random, vodr_machine *m)
{
    m->blend = (int32_t)rng_int(random, VODR_BLEND_OVER, VODR_BLEND_MIP);
    m->filter = rng_one_in(random, 4) ? VODR_FILTER_NEAREST : VODR_FILTER_LINEAR;
    m->kill_transparent = (int32_t)rng_int(random, 0, 1);
    m->texture_latency_cycles =
        rng_one_in(random, 3) ? 3 : (int32_t)rng_int(random, 3, rng_one_in(random, 3) ? 255 : 12);
    m->double_buffer = (int32_t)rng_int(random, 0, 1);
    m->texture_memory_bytes = BUFFER_BYTES * (1 + m->double_buffer);
    m->brick = (int32_t)rng_int(random, 1, rng_one_in(random, 3) ? LARGEST_EDGE_VOX : 7);
    if (m->texture_burst_bytes >= m->mem_bus_bytes) /* so that beats stay as wide as the library has them */
        m->texture_burst_bytes = 16 << rng_int(random, 0, 4);
    if (m->traversal != VODR_TRAVERSAL_WHOLE)
        m->traversal = (int32_t)rng_int(random, VODR_TRAVERSAL_LAYER, VODR_TRAVERSAL_TILE);
}

/* ---- visits: the divider's side ---- */

typedef struct visits {
    vox_box box[VISITS]; /* by number */
    brick_port port;
    uint64_t last[3]; /* bricks of the visits that came last: they may come again */
    int64_t known, drawn;
} visits;

static vox_box box_of(const bench *b, uint64_t number)
{
    const block_setup *setup = &b->setup;
    vox_box box;
    for (int c = 0; c < 3; c++) {
        int32_t size = setup->volume->dims_vox[c], edge = setup->edge_vox[c], count = setup->walk->bricks[c];
        box.lo[c] = (int32_t)(number % (uint64_t)count) * edge;
        box.hi[c] = edge < size - box.lo[c] ? box.lo[c] + edge : size;
        number /= (uint64_t)count;
    }
    return box;
}

static void hand_on(bench *b, visits *v, int64_t haste)
{
    const volume_divider *walk = b->setup.walk;
    int64_t bricks = (int64_t)walk->bricks[0] * walk->bricks[1] * walk->bricks[2];
    v->port.valid = v->port.fresh = v->known - v->drawn < VISITS && rng_one_in(&b->random, haste);
    if (!v->port.fresh)
        return;
    int64_t again = rng_int(&b->random, 0, 5);
    v->port.brick = again < 3 ? v->last[again] : (uint64_t)rng_int(&b->random, 0, bricks - 1);
    v->port.box = v->box[v->known++ % VISITS] = box_of(b, v->port.brick);
    v->last[2] = v->last[1];
    v->last[1] = v->last[0];
    v->last[0] = v->port.brick;
}

/* ---- fragments: the rasterizer's side ---- */

typedef struct raster {
    fragment_port port;
    int64_t left; /* fragments of the visit that is drawn; 0: none was begun */
} raster;

/* The numerator of a position inside [lo, hi) voxels: on borders and centres, or next to them, or anywhere. */
static int64_t numerator(bench *b, int c, int32_t lo, int32_t hi)
{
    const vodr_view *view = &b->scene.view;
    int64_t least = (int64_t)lo << VODR_POSITION_BITS, most = ((int64_t)hi << VODR_POSITION_BITS) - 1;
    int64_t half = (int64_t)1 << (VODR_POSITION_BITS - 1), position = rng_int(&b->random, least, most);
    switch (rng_int(&b->random, 0, 7)) {
    case 0: position = least; break;
    case 1: position = most; break;
    case 2: position = (position >> VODR_POSITION_BITS << VODR_POSITION_BITS) + half; break;
    case 3: position = (position >> VODR_POSITION_BITS << VODR_POSITION_BITS) + half - 1; break;
    default: break;
    }
    int64_t below = (int64_t)(rng_next(&b->random) & (((uint64_t)1 << view->shift) - 1));
    return (position - view->base[c]) * ((int64_t)1 << view->shift) + below;
}

/* What the rasterizer registers for the next cycle; `moved`: its fragment was accepted. */
static void rasterize(bench *b, visits *v, raster *r, bool moved, int64_t haste)
{
    if (moved) {
        r->port.valid = false;
        r->left--;
    }
    v->drawn += r->port.visit_done;
    r->port.visit_done = moved && r->left == 0;
    if (r->port.valid || r->port.visit_done || v->drawn == v->known - v->port.fresh || rng_one_in(&b->random, haste))
        return;
    if (r->left == 0)
        r->left = rng_one_in(&b->random, 3) ? rng_int(&b->random, 1, 80) : rng_int(&b->random, 1, 4);
    const vox_box *box = &v->box[v->drawn % VISITS];
    r->port.valid = true;
    r->port.x = (int32_t)bench_bits(&b->random, 14);
    r->port.y = (int32_t)bench_bits(&b->random, 14);
    for (int c = 0; c < 3; c++)
        r->port.a[c] = numerator(b, c, box->lo[c], box->hi[c]);
}

/* ---- loads: the frame buffer's side ---- */

typedef struct memory_side {
    loaded_port port;
    int64_t wanted_bytes;             /* of the load under way, that no burst was granted for */
    int64_t granted_bytes;            /* that come */
    int64_t brick_bytes[VISITS];      /* of loads whose data have not all come, in order */
    int64_t first, count, done_bytes; /* among them; done: of the first */
} memory_side;

static void grant(bench *b, memory_side *m, int64_t haste)
{
    int64_t burst = b->machine.texture_burst_bytes;
    if (!m->wanted_bytes || rng_one_in(&b->random, haste))
        return;
    burst = m->wanted_bytes < burst ? m->wanted_bytes : burst;
    m->wanted_bytes -= burst;
    m->granted_bytes += burst;
    m->port.granted = m->wanted_bytes == 0;
}

/* A beat of what was granted. */
static void send(bench *b, memory_side *m)
{
    int64_t beat = b->machine.mem_bus_bytes, burst = b->machine.texture_burst_bytes;
    int64_t rest = m->brick_bytes[m->first % VISITS] - m->done_bytes, of_burst = burst - m->done_bytes % burst;
    beat = beat < of_burst ? beat : of_burst;
    beat = beat < rest ? beat : rest;
    int64_t bits = rng_one_in(&b->random, 8) ? 8 * (rng_int(&b->random, 0, 1)) : -1;
    for (int64_t i = 0; i < PORT_BEAT_BYTES; i++) {
        uint8_t byte = bits < 0 ? (uint8_t)rng_next(&b->random) : (uint8_t)((1 << bits) - 1);
        bool high = b->machine.density_bits > 8 && ((m->done_bytes + i) & 1);
        m->port.data[i] = high ? byte & ((1 << (b->machine.density_bits - 8)) - 1) : byte;
    }
    m->port.data_valid = true;
    m->port.bytes = (int32_t)beat;
    m->granted_bytes -= beat;
    m->done_bytes += beat;
    if (m->done_bytes < m->brick_bytes[m->first % VISITS])
        return;
    m->done_bytes = 0;
    m->first++;
    m->count--;
}

static void remember(bench *b, memory_side *m, const load_port *load, int64_t haste)
{
    m->port.granted = m->port.data_valid = false;
    if (load->valid && m->port.ready) {
        m->wanted_bytes = load->bytes;
        m->brick_bytes[(m->first + m->count++) % VISITS] = load->bytes;
    }
    grant(b, m, haste);
    if (m->granted_bytes > 0 && !rng_one_in(&b->random, haste))
        send(b, m);
    m->port.ready = m->wanted_bytes == 0;
}

/* ---- fetches: the external memory of `whole` ---- */

typedef struct voxel_side {
    fetch_port waiting[WAITING];
    int64_t due[WAITING], first, count;
    voxels_port port;
} voxel_side;

static void fetch(bench *b, voxel_side *s, const fetch_port *f)
{
    int64_t now = (int64_t)b->cycles, latency = b->machine.mem_latency_cycles;
    if (f->valid) {
        s->waiting[(s->first + s->count) % WAITING] = *f;
        s->due[(s->first + s->count++) % WAITING] = now + latency - 1;
    }
    s->port.valid = s->count > 0 && s->due[s->first % WAITING] == now;
    if (!s->port.valid)
        return;
    const fetch_port *oldest = &s->waiting[s->first++ % WAITING];
    s->count--;
    for (int i = 0; i < 8; i++) {
        int same = i; /* the voxel's first index: both neighbours of an axis can be one */
        for (int c = 0; c < 3; c++)
            if (oldest->lo[c] == oldest->hi[c])
                same &= ~(1 << c);
        uint64_t density = bench_bits(&b->random, b->machine.density_bits);
        s->port.density[i] = same < i ? s->port.density[same] : (uint16_t)density;
    }
}

/* ---- colours: the pixel cache's side ---- */

typedef struct cache_side {
    bool holds;
    door_port port;
} cache_side;

static void take(bench *b, cache_side *s, bool moved, int64_t haste)
{
    if (s->port.gone)
        s->holds = false;
    s->holds |= moved;
    s->port.gone = s->holds && rng_one_in(&b->random, haste);
    s->port.ready = !s->holds || s->port.gone;
}

/* ---- all of them ---- */

typedef struct surroundings {
    visits visits;
    raster raster;
    memory_side memory;
    voxel_side voxels;
    cache_side cache;
    int64_t visits_haste, raster_haste, memory_haste, cache_haste;
} surroundings;

/* Now and then everybody takes another pace: none waits, or one keeps all others waiting. */
static void pace(bench *b, surroundings *s)
{
    s->visits_haste = rng_one_in(&b->random, 3) ? rng_int(&b->random, 2, 100) : 1;
    s->raster_haste = rng_int(&b->random, 2, rng_one_in(&b->random, 2) ? 3 : 100);
    s->memory_haste = rng_int(&b->random, 2, rng_one_in(&b->random, 2) ? 3 : 100);
    s->cache_haste = rng_one_in(&b->random, 2) ? 1 : rng_int(&b->random, 2, rng_one_in(&b->random, 4) ? 700 : 6);
}

static void traffic(bench *b, uint64_t transactions)
{
    texture_unit_face *face = &b->faces->texture_unit;
    texture_unit_out out = b->reset->texture_unit;
    surroundings s = {.memory.port.ready = true, .cache.port.ready = true};
    const texture_unit_in in = {.brick = &s.visits.port,
                                .fragment = &s.raster.port,
                                .load = &s.memory.port,
                                .voxels = &s.voxels.port,
                                .colour = &s.cache.port};
    for (uint64_t done = 0; done < transactions && !bench_differs(b); b->cycles++) {
        if (b->cycles % 256 == 0)
            pace(b, &s);
        bool accepted = s.raster.port.valid && out.fragment.ready;
        bool moved = out.colour.valid && s.cache.port.ready;
        load_port load = out.load;
        fetch_port fetched = out.fetch;
        face->clock(face->state, &in, &out);
        done += accepted;
        rasterize(b, &s.visits, &s.raster, accepted, s.raster_haste);
        hand_on(b, &s.visits, s.visits_haste);
        remember(b, &s.memory, &load, s.memory_haste);
        fetch(b, &s.voxels, &fetched);
        take(b, &s.cache, moved, s.cache_haste);
    }
}

const block_bench bench_texture_unit = {VODR_BLOCK_TEXTURE_UNIT, machines, draw, NULL, traffic};
