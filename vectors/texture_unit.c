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
    m->filter = rng_one_in(random, 3) ? VODR_FILTER_NEAREST : VODR_FILTER_LINEAR;
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

/* ---- what is legal ---- */

typedef struct texture_rules {
    uint64_t now;
    vox_box box[VISITS]; /* by number of the visit */
    int64_t known, drawn;
    int64_t bytes[VISITS]; /* of loads that were asked for and have not come, in order */
    int64_t first_load, loads, done_bytes;
    bool granting;         /* the last has bursts that were not granted */
    uint64_t due[WAITING]; /* when voxels come that were fetched */
    uint64_t fetched, answered;
    bool holds; /* a fragment waits before the cache */
} texture_rules;

static const char *illegal_visit(const bench *b, texture_rules *r, const brick_port *p)
{
    const int32_t *bricks = b->setup.walk->bricks;
    if (!p->fresh)
        return NULL;
    if (r->known - r->drawn == VISITS)
        return "brick_fresh is 1, but 8 visits were not gone through";
    if (p->brick >= (uint64_t)bricks[0] * (uint64_t)bricks[1] * (uint64_t)bricks[2])
        return "brick_number is none of the volume's";
    const vox_box box = box_of(b, p->brick);
    for (int c = 0; c < 3; c++)
        if (p->box.lo[c] != box.lo[c] || p->box.hi[c] != box.hi[c])
            return "brick_lo and brick_hi are not the box of brick_number";
    r->box[r->known++ % VISITS] = box;
    return NULL;
}

static bool is_inside(const bench *b, const vox_box *box, const int64_t a[3])
{
    const vodr_view *view = &b->scene.view;
    const int64_t limit = (int64_t)1 << 62;
    for (int c = 0; c < 3; c++) {
        int64_t position = view->base[c] + (a[c] >> view->shift);
        if (a[c] <= -limit || a[c] >= limit || position < (int64_t)box->lo[c] << VODR_POSITION_BITS ||
            position >= (int64_t)box->hi[c] << VODR_POSITION_BITS)
            return false;
    }
    return true;
}

/* `known` visits were handed on before. */
static const char *illegal_fragment(const bench *b, texture_rules *r, const fragment_port *p, int64_t known)
{
    if ((p->valid || p->visit_done) && r->drawn == known)
        return "fragment_valid or fragment_visit_done is 1, but there is no visit";
    if (p->valid && p->visit_done)
        return "fragment_valid and fragment_visit_done are 1";
    if (p->valid && (p->x >= VODR_MAX_SIZE_PX || p->y >= VODR_MAX_SIZE_PX))
        return "fragment_x and fragment_y are no pixel of a frame of 16384x16384";
    if (p->valid && !is_inside(b, &r->box[r->drawn % VISITS], p->a))
        return "fragment_a is no position in the visit's brick";
    r->drawn += p->visit_done;
    return NULL;
}

static const char *illegal_beat(const bench *b, texture_rules *r, const loaded_port *p)
{
    int64_t beat = b->machine.mem_bus_bytes, burst = b->machine.texture_burst_bytes;
    if (!r->loads)
        return "load_data_valid is 1, but nothing is to come";
    int64_t rest = r->bytes[r->first_load % VISITS] - r->done_bytes, of_burst = burst - r->done_bytes % burst;
    beat = beat < of_burst ? beat : of_burst;
    if (p->bytes != (beat < rest ? beat : rest))
        return "load_data_bytes is not what is left of the load or the burst, or a beat";
    for (int32_t i = 0; b->machine.density_bits > 8 && i < p->bytes; i++)
        if (((r->done_bytes + i) & 1) && p->data[i] >> (b->machine.density_bits - 8))
            return "load_data has a density beyond density_bits";
    r->done_bytes += p->bytes;
    if (r->done_bytes == r->bytes[r->first_load % VISITS]) {
        r->first_load++;
        r->loads--;
        r->done_bytes = 0;
    }
    return r->granting && !r->loads ? "load_data ends before load_granted" : NULL;
}

static const char *illegal_load(const bench *b, texture_rules *r, const loaded_port *in, const load_port *out)
{
    const char *why = NULL;
    if (in->granted && !r->granting)
        return "load_granted is 1, but no load is under way";
    if (in->ready && r->granting && !in->granted)
        return "load_ready is 1 while a load is under way";
    r->granting &= !in->granted;
    if (in->data_valid)
        why = illegal_beat(b, r, in);
    if (out->valid && in->ready) {
        r->bytes[(r->first_load + r->loads++) % VISITS] = out->bytes;
        r->granting = true;
    }
    return why;
}

static const char *illegal_voxels(const bench *b, texture_rules *r, const voxels_port *in, const fetch_port *out)
{
    bool is_due = r->answered < r->fetched && r->due[r->answered % WAITING] == r->now;
    if (in->valid != is_due)
        return "voxels_valid does not follow fetch_valid of mem_latency_cycles before";
    r->answered += in->valid;
    for (int i = 0; in->valid && i < 8; i++)
        if (in->density[i] >> b->machine.density_bits)
            return "voxels_density has one beyond density_bits";
    if (out->valid)
        r->due[r->fetched++ % WAITING] = r->now + (uint64_t)b->machine.mem_latency_cycles;
    return NULL;
}

static const char *illegal(const bench *b, void *rules, const void *inputs, const void *shown)
{
    const texture_unit_in *in = inputs;
    const texture_unit_out *out = shown;
    texture_rules *r = rules;
    int64_t known = r->known;
    const char *why = illegal_visit(b, r, in->brick);
    if (!why)
        why = illegal_fragment(b, r, in->fragment, known);
    if (!why)
        why = illegal_load(b, r, in->load, &out->load);
    if (!why)
        why = illegal_voxels(b, r, in->voxels, &out->fetch);
    if (in->colour->gone && !r->holds)
        why = "colour_gone is 1, but no fragment waits before the cache";
    r->holds &= !in->colour->gone;
    if (out->colour.valid && in->colour->ready) {
        if (r->holds)
            why = "colour_ready is 1, but a fragment waits before the cache";
        r->holds = true;
    }
    r->now++;
    return why;
}

const block_bench bench_texture_unit = {.block = VODR_BLOCK_TEXTURE_UNIT,
                                        .machines = machines,
                                        .draw = draw,
                                        .longest_vox = 8192,
                                        .traffic = traffic,
                                        .illegal = illegal,
                                        .rules_bytes = sizeof(texture_rules),
                                        .large = true,
                                        .vectors = "mem_bus_bytes=4 fragment_fifo=6",
                                        .case_cycles = 1024,
                                        .level_cycles = {12000, 1000000}};
