/* alpha_blender.c - traffic for the alpha blender: a texture unit that offers fragments, a pixel cache that lets them
 * go and reads their pixels when it likes. */
#include "bench.h"
#include "pixel_word.h"

static const char *const machines[] = {"", "fb_bits=16 tf_bits=16", "blend_cycles=3",
                                       "nonblocking=1 nonblocking_fifo=5 blend_cycles=9", NULL};

enum { NEARLY = 15 };

static void draw(rng *random, vodr_machine *m)
{
    m->blend = (int32_t)rng_int(random, VODR_BLEND_OVER, VODR_BLEND_MIP);
    m->density_bits = rng_one_in(random, 2) ? 8 : 12;
}

/* An opacity: nearly full, full but for a bit, or any. */
static uint16_t opacity(bench *b)
{
    const int32_t bits = b->machine.fb_bits;
    const uint64_t full = ((uint64_t)1 << bits) - 1;
    switch (rng_int(&b->random, 0, 5)) {
    case 0: return (uint16_t)(full - (uint64_t)rng_int(&b->random, 0, NEARLY));
    case 1: return (uint16_t)(full ^ (uint64_t)1 << rng_int(&b->random, 0, bits - 1));
    default: return (uint16_t)bench_bits(&b->random, bits);
    }
}

/* A channel up to `most`: behind something nearly opaque its product lies on the border between two roundings. */
static uint16_t channel(bench *b, int64_t most)
{
    const int64_t full = ((int64_t)1 << b->machine.fb_bits) - 1;
    if (!rng_one_in(&b->random, 4))
        return (uint16_t)rng_int(&b->random, 0, most);
    int64_t through = rng_int(&b->random, 1, NEARLY), half = 2 * rng_int(&b->random, 0, through - 1) + 1;
    int64_t value = half * full / (2 * through) + rng_int(&b->random, 0, 1);
    return (uint16_t)(value < most ? value : most);
}

/* A premultiplied colour, or in mip a density. */
static uint64_t word(bench *b, bool written)
{
    vodr_rgba p = {.a = opacity(b)};
    if (b->machine.blend == VODR_BLEND_MIP)
        return written ? bench_bits(&b->random, b->machine.density_bits) | PIXEL_WORD_WRITTEN : 0;
    p.r = channel(b, p.a);
    p.g = rng_one_in(&b->random, 4) ? p.a : channel(b, p.a);
    p.b = rng_one_in(&b->random, 4) ? 0 : channel(b, p.a);
    return pixel_word(&b->machine, p);
}

/* The pixel cache's side: the fragment before it, and how many that are gone wait for their pixel. */
typedef struct cache_side {
    bool holds, dead;
    int64_t unread, room;
    door_port door;
    pixel_port pixel;
} cache_side;

/* What the cache registers for the next cycle, in which `unread` still counts what is read in it. */
static void decide(bench *b, cache_side *c, int64_t haste)
{
    c->pixel.valid = c->unread > 0 && !rng_one_in(&b->random, haste);
    c->pixel.pixel = word(b, rng_one_in(&b->random, 2));
    c->door.gone = c->holds && !rng_one_in(&b->random, haste) && (c->dead || c->unread - c->pixel.valid < c->room);
    c->door.hazard = c->holds && !c->door.gone && rng_one_in(&b->random, 2);
    c->door.ready = !c->holds || c->door.gone;
}

static void traffic(bench *b, uint64_t transactions)
{
    alpha_blender_face *face = &b->faces->alpha_blender;
    alpha_blender_out out = b->reset->alpha_blender;
    colour_port colour = {.valid = false};
    cache_side cache = {.room = b->machine.nonblocking ? b->machine.nonblocking_fifo : 1, .door.ready = true};
    const alpha_blender_in in = {.colour = &colour, .door = &cache.door, .pixel = &cache.pixel};
    int64_t haste = 2;
    for (uint64_t done = 0; done < transactions && !bench_differs(b); b->cycles++) {
        face->clock(face->state, &in, &out);
        if (rng_one_in(&b->random, 100))
            haste = rng_int(&b->random, 2, 20);
        cache.unread -= cache.pixel.valid;
        if (cache.door.gone) {
            cache.unread += !cache.dead;
            cache.holds = false;
        }
        if (colour.valid && cache.door.ready) {
            cache.holds = true;
            cache.dead = colour.dead;
            colour.valid = false;
            done++;
        }
        if (!colour.valid)
            colour = (colour_port){
                .valid = !rng_one_in(&b->random, haste), .dead = rng_one_in(&b->random, 5), .colour = word(b, true)};
        decide(b, &cache, haste);
    }
}

/* ---- what is legal ---- */

typedef struct blender_rules {
    bool holds, dead; /* a fragment waits before the cache */
    int64_t unread;   /* fragments that are gone and wait for their pixel */
} blender_rules;

static bool is_premultiplied(const bench *b, uint64_t word)
{
    if (b->machine.blend == VODR_BLEND_MIP)
        return !word || (word & ~(uint64_t)PIXEL_WORD_WRITTEN) >> b->machine.density_bits == 0;
    const vodr_rgba p = pixel_of_word(&b->machine, word);
    return p.r <= p.a && p.g <= p.a && p.b <= p.a;
}

static const char *illegal(const bench *b, void *rules, const void *inputs, const void *shown)
{
    const alpha_blender_in *in = inputs;
    blender_rules *r = rules;
    (void)shown;
    if (in->pixel->valid && !r->unread)
        return "pixel_valid is 1, but no fragment waits for its pixel";
    if (in->pixel->valid && !is_premultiplied(b, in->pixel->pixel))
        return "pixel_rgba is no pixel: a colour is above alpha, or bits beyond a density are set";
    r->unread -= in->pixel->valid;
    if (in->door->gone && !r->holds)
        return "colour_gone is 1, but no fragment waits before the cache";
    if (in->door->gone) {
        r->unread += !r->dead;
        r->holds = false;
    }
    if (r->unread > (b->machine.nonblocking ? b->machine.nonblocking_fifo : 1))
        return "colour_gone is 1, but as many fragments wait for their pixel as can";
    if (in->colour->valid && !is_premultiplied(b, in->colour->colour))
        return "colour_rgba is no pixel: a colour is above alpha, or bits beyond a density are set";
    if (!in->colour->valid || !in->door->ready)
        return NULL;
    if (r->holds)
        return "colour_valid and colour_ready are 1, but a fragment waits before the cache";
    r->holds = true;
    r->dead = in->colour->dead;
    return NULL;
}

const block_bench bench_alpha_blender = {.block = VODR_BLOCK_ALPHA_BLENDER,
                                         .machines = machines,
                                         .draw = draw,
                                         .traffic = traffic,
                                         .illegal = illegal,
                                         .rules_bytes = sizeof(blender_rules),
                                         .vectors = "nonblocking_fifo=4",
                                         .case_cycles = 512,
                                         .level_cycles = {10500, 1000000}};
