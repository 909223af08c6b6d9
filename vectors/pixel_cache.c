/* pixel_cache.c - traffic for the pixel cache: a texture unit that offers fragments, an alpha blender that answers when
 * it has to, and a frame buffer that answers when it likes. A transaction is a fragment; after the last one the cache
 * is flushed. */
#include "bench.h"
#include "layout.h"

static const char *const machines[] = {
    "",
    "nonblocking=1",
    "ways=1 line_px=4x4 cache_bytes=256 blend_cycles=3 write_fifo=1",
    "ways=16 line_px=2x1 fb_bits=16 tf_bits=16 cache_bytes=1024 nonblocking=1 nonblocking_fifo=5 "
    "nonblocking_misses=2 blend_cycles=9",
    "ways=8 line_px=8x8 cache_bytes=2048 blend_cycles=40 write_fifo=5 clear_on_first_touch=1",
    "ways=2 line_px=2x1 cache_bytes=64 nonblocking=1 nonblocking_fifo=40 nonblocking_misses=11 write_fifo=7 "
    "blend_cycles=20 clear_on_first_touch=1",
    "ways=1 line_px=4x4 cache_bytes=64 nonblocking=1 nonblocking_fifo=1 nonblocking_misses=1 write_fifo=1",
    NULL};

enum { BLENDING = 256, THRASHING = 24, BLOCKS_BEFORE = 4, LONGEST_FRAME = 1500 };

static void draw(rng *random, vodr_machine *m)
{
    m->index = (int32_t)rng_int(random, VODR_INDEX_MODULO, VODR_INDEX_XOR);
    m->replacement = (int32_t)rng_int(random, VODR_REPLACEMENT_LRU, VODR_REPLACEMENT_RANDOM);
    m->fb_layout = (int32_t)rng_int(random, VODR_FB_LAYOUT_LINEAR, VODR_FB_LAYOUT_TILED);
    m->write_policy = rng_one_in(random, 3) ? VODR_WRITE_POLICY_THROUGH : VODR_WRITE_POLICY_BACK;
}

static int32_t side_px(rng *random)
{
    enum { LARGE_PX = 2048 };
    return rng_one_in(random, 4) ? VODR_MAX_SIZE_PX : (int32_t)rng_int(random, 1, LARGE_PX);
}

/* Frames as long as they can be, and large ones, so that numbers of lines have all their bits. */
static void look(rng *random, const int32_t dims_vox[3], vodr_view *view)
{
    enum { SHORT_PX = 8 };
    (void)dims_vox;
    if (rng_one_in(random, 3)) {
        view->width_px = side_px(random);
        view->height_px = side_px(random);
    } else if (rng_one_in(random, 4)) {
        bool wide = rng_one_in(random, 2);
        view->width_px = wide ? VODR_MAX_SIZE_PX : SHORT_PX;
        view->height_px = wide ? SHORT_PX : VODR_MAX_SIZE_PX;
    }
}

/* ---- fragments: the texture unit's side ---- */

typedef enum pattern { SAME_PIXEL, ROWS, THRASH, TWINS, NEAR, ANYWHERE, PATTERNS } pattern;

typedef struct texture_side {
    colour_port port;
    pattern pattern;
    int32_t x0, y0, width, height;      /* rectangle that fragments lie in */
    int32_t x[THRASHING], y[THRASHING]; /* pixels whose lines fight for a set */
    int32_t thrashing;
    uint64_t left; /* fragments that were not offered */
    int64_t dead_one_in;
} texture_side;

/* Pixels of as many lines of one set as there are ways, and some more; fewer when the frame has not so many. */
static void draw_thrash(bench *b, texture_side *t)
{
    const vodr_view *view = &b->scene.view;
    const fb_layout layout = fb_layout_of(&b->machine, view->width_px, view->height_px);
    int64_t sets = cache_sets(&b->machine), set = rng_int(&b->random, 0, sets - 1);
    int32_t wanted = b->machine.ways + (int32_t)rng_int(&b->random, 1, 3);
    t->thrashing = 0;
    for (int i = 0; i < 400 && t->thrashing < wanted && t->thrashing < THRASHING; i++) {
        int32_t x = (int32_t)rng_int(&b->random, 0, view->width_px - 1);
        int32_t y = (int32_t)rng_int(&b->random, 0, view->height_px - 1);
        if (t->thrashing && line_number(&layout, x, y) % sets != set)
            continue;
        t->x[t->thrashing] = x;
        t->y[t->thrashing++] = y;
    }
}

/* Another pattern, around another place. */
static void draw_pattern(bench *b, texture_side *t)
{
    const vodr_view *view = &b->scene.view;
    t->pattern = (pattern)rng_int(&b->random, 0, PATTERNS - 1);
    int32_t most = t->pattern == SAME_PIXEL ? 1 : t->pattern == ANYWHERE ? VODR_MAX_SIZE_PX : 40;
    t->width = (int32_t)rng_int(&b->random, 1, most < view->width_px ? most : view->width_px);
    t->height = (int32_t)rng_int(&b->random, 1, most < view->height_px ? most : view->height_px);
    bool corner = rng_one_in(&b->random, 4);
    t->x0 = t->port.x = corner ? 0 : (int32_t)rng_int(&b->random, 0, view->width_px - t->width);
    t->y0 = t->port.y = corner ? 0 : (int32_t)rng_int(&b->random, 0, view->height_px - t->height);
    t->dead_one_in = rng_one_in(&b->random, 3) ? 3 : 1000;
    if (t->pattern == THRASH)
        draw_thrash(b, t);
}

/* The first pixel of the line whose number differs in one bit, of lines row by row. */
static void next_line_twin(bench *b, texture_side *t, const fb_layout *layout)
{
    int64_t number = line_number(layout, t->port.x, t->port.y) ^ (int64_t)1 << rng_int(&b->random, 0, 25);
    if (number >= layout->lines)
        return;
    t->port.x = (int32_t)(number % layout->columns) * b->machine.line_px.width;
    t->port.y = (int32_t)(number / layout->columns) * b->machine.line_px.height;
}

/* The pixel whose coordinates, or whose line's number, differ in one bit. */
static void next_twin(bench *b, texture_side *t)
{
    const fb_layout layout = fb_layout_of(&b->machine, b->scene.view.width_px, b->scene.view.height_px);
    if (!layout.tiled && rng_one_in(&b->random, 2)) {
        next_line_twin(b, t, &layout);
        return;
    }
    int32_t bit = 1 << rng_int(&b->random, 0, 13);
    bool across = rng_one_in(&b->random, 2);
    int32_t x = across ? t->port.x ^ bit : t->port.x, y = across ? t->port.y : t->port.y ^ bit;
    if (x >= b->scene.view.width_px || y >= b->scene.view.height_px)
        return;
    t->port.x = x;
    t->port.y = y;
}

static void next_pixel(bench *b, texture_side *t)
{
    int32_t i = t->pattern == THRASH ? (int32_t)rng_int(&b->random, 0, t->thrashing - 1) : 0;
    switch (t->pattern) {
    case SAME_PIXEL: break;
    case ROWS:
        t->port.x++;
        t->port.y += t->port.x == t->x0 + t->width;
        t->port.x = t->port.x == t->x0 + t->width ? t->x0 : t->port.x;
        t->port.y = t->port.y == t->y0 + t->height ? t->y0 : t->port.y;
        break;
    case THRASH:
        t->port.x = t->x[i];
        t->port.y = t->y[i];
        break;
    case TWINS: next_twin(b, t); break;
    default:
        t->port.x = t->x0 + (int32_t)rng_int(&b->random, 0, t->width - 1);
        t->port.y = t->y0 + (int32_t)rng_int(&b->random, 0, t->height - 1);
    }
}

static void offer(bench *b, texture_side *t, bool moved, int64_t haste)
{
    if (moved)
        t->port.valid = false;
    if (t->port.valid || !t->left || !rng_one_in(&b->random, haste))
        return;
    t->left--;
    if (rng_one_in(&b->random, 60))
        draw_pattern(b, t);
    next_pixel(b, t);
    t->port.valid = true;
    t->port.dead = rng_one_in(&b->random, t->dead_one_in);
}

/* ---- blends: the alpha blender's side ---- */

typedef struct blend_side {
    bool read[BLENDING], writes[BLENDING]; /* by cycle: a pixel was read in it, and is written */
    blended_port port;
} blend_side;

/* After a cycle in which a pixel was read or not: what is told in the next. */
static void blend(bench *b, blend_side *s, const pixel_port *pixel, int64_t unwritten_one_in)
{
    uint64_t now = b->cycles, known = now - 1, done = now + 2 - (uint64_t)b->machine.blend_cycles;
    s->read[now % BLENDING] = pixel->valid;
    s->writes[now % BLENDING] = !rng_one_in(&b->random, unwritten_one_in);
    s->port.known = s->read[known % BLENDING];
    s->port.known_writes = s->writes[known % BLENDING];
    s->port.valid = s->read[done % BLENDING];
    s->port.writes = s->writes[done % BLENDING];
    s->port.pixel = bench_bits(&b->random, 4 * b->machine.fb_bits);
}

/* ---- lines: the frame buffer's side ---- */

typedef struct memory_side {
    int64_t fills, writes; /* that have not been answered */
    filled_port filled;
    granted_port written;
} memory_side;

static void answer(bench *b, memory_side *m, bool fill, bool write, int64_t fill_haste, int64_t write_haste)
{
    m->fills += fill;
    m->writes += write;
    m->filled.valid = m->fills > 0 && rng_one_in(&b->random, fill_haste);
    m->written.valid = m->writes > 0 && rng_one_in(&b->random, write_haste);
    m->fills -= m->filled.valid;
    m->writes -= m->written.valid;
    if (!m->filled.valid)
        return;
    uint64_t bits = bench_bits(&b->random, 64);
    for (int32_t i = 0; i < line_bytes(&b->machine); i++)
        m->filled.data[i] = (uint8_t)((bits >> i % 8 * 8) + (uint64_t)(i / 8));
}

/* ---- all of them ---- */

typedef struct paces {
    int64_t texture, fill, write, unwritten_one_in;
} paces;

static void draw_paces(bench *b, paces *p)
{
    p->texture = rng_one_in(&b->random, 2) ? 1 : rng_int(&b->random, 2, 12);
    p->fill = rng_one_in(&b->random, 3) ? 1 : rng_int(&b->random, 2, 40);
    p->write = rng_one_in(&b->random, 3) ? 1 : rng_int(&b->random, 2, 60);
    p->unwritten_one_in = rng_one_in(&b->random, 2) ? 2 : 20;
}

/* Blocks that fragments come through: idle now and then, but all at once only when no fragment can come any more. */
static void set_before(bench *b, const texture_side *t, report_port before[BLOCKS_BEFORE])
{
    bool over = !t->left && !t->port.valid;
    for (int i = 0; i < BLOCKS_BEFORE; i++)
        before[i].idle = over ? before[i].idle || rng_one_in(&b->random, 5) : rng_one_in(&b->random, 2);
    if (!over)
        before[rng_int(&b->random, 0, BLOCKS_BEFORE - 1)].idle = false;
}

/* How many fragments a frame has: often so few that hardly a line is left for the flush. */
static uint64_t draw_length(bench *b, uint64_t transactions)
{
    enum { FEW = 4, SOME = 64 };
    int64_t most = rng_one_in(&b->random, 6) ? FEW : rng_one_in(&b->random, 6) ? SOME : LONGEST_FRAME;
    return (uint64_t)rng_int(&b->random, 1, (uint64_t)most < transactions ? most : (int64_t)transactions);
}

static void traffic(bench *b, uint64_t transactions)
{
    pixel_cache_face *face = &b->faces->pixel_cache;
    pixel_cache_out out = b->reset->pixel_cache;
    texture_side texture = {.left = draw_length(b, transactions)};
    blend_side blender = {.port = {.valid = false}};
    memory_side memory = {0};
    report_port before[BLOCKS_BEFORE] = {{0}};
    paces p = {1, 1, 1, 1};
    const pixel_cache_in in = {.colour = &texture.port,
                               .blended = &blender.port,
                               .filled = &memory.filled,
                               .written = &memory.written,
                               .before = {&before[0], &before[1], &before[2], &before[3]}};
    b->left = transactions - texture.left;
    draw_pattern(b, &texture);
    for (; !bench_differs(b) && (!out.report.idle || memory.writes || texture.left || texture.port.valid);
         b->cycles++) {
        if (b->cycles % 256 == 0)
            draw_paces(b, &p);
        bool moved = texture.port.valid && out.door.ready;
        bool fill = out.fill.valid, write = out.write.valid;
        face->clock(face->state, &in, &out);
        blend(b, &blender, &out.pixel, p.unwritten_one_in);
        answer(b, &memory, fill, write, p.fill, p.write);
        offer(b, &texture, moved, p.texture);
        set_before(b, &texture, before);
    }
}

/* ---- what is legal ---- */

typedef struct cache_rules {
    uint64_t now;
    bool read[BLENDING], writes[BLENDING]; /* by cycle: a pixel was shown in it, and is written */
    int64_t fills, writes_waiting;         /* shown in cycles before, and not answered */
    bool over;                             /* no fragment comes any more */
} cache_rules;

/* Pixels are shown a cycle after their read. */
static const char *illegal_blended(const bench *b, cache_rules *r, const blended_port *p)
{
    uint64_t known = r->now - 1, done = r->now + 2 - (uint64_t)b->machine.blend_cycles;
    if (p->known != r->read[known % BLENDING])
        return "blended_known does not follow pixel_valid of the cycle before";
    if (p->known)
        r->writes[known % BLENDING] = p->known_writes;
    if (p->valid != r->read[done % BLENDING])
        return "blended_valid does not follow pixel_valid of BLEND_CYCLES - 2 cycles before";
    if (p->valid && p->writes != r->writes[done % BLENDING])
        return "blended_writes is not what blended_known_writes was for this pixel";
    return NULL;
}

static const char *illegal(const bench *b, void *rules, const void *inputs, const void *shown)
{
    const pixel_cache_in *in = inputs;
    const pixel_cache_out *out = shown;
    const vodr_view *view = &b->scene.view;
    cache_rules *r = rules;
    r->read[r->now % BLENDING] = out->pixel.valid;
    const char *why = illegal_blended(b, r, in->blended);
    if (in->filled->valid && !r->fills)
        why = "filled_valid is 1, but no line is wanted";
    if (in->written->valid && !r->writes_waiting)
        why = "written_valid is 1, but no write waits";
    if (in->colour->valid && (in->colour->x >= view->width_px || in->colour->y >= view->height_px))
        why = "colour_x and colour_y are no pixel of the frame";
    if (in->colour->valid && r->over)
        why = "colour_valid is 1 after all blocks before were idle";
    r->fills += out->fill.valid - in->filled->valid;
    r->writes_waiting += out->write.valid - in->written->valid;
    bool over = true;
    for (int i = 0; i < BLOCKS_BEFORE; i++)
        over &= in->before[i]->idle;
    r->over |= over;
    r->now++;
    return why;
}

const block_bench bench_pixel_cache = {.block = VODR_BLOCK_PIXEL_CACHE,
                                       .machines = machines,
                                       .draw = draw,
                                       .look = look,
                                       .traffic = traffic,
                                       .illegal = illegal,
                                       .rules_bytes = sizeof(cache_rules),
                                       .vectors = "line_px=4x1 cache_bytes=256 write_fifo=4",
                                       .case_cycles = 768,
                                       .level_cycles = {12000, 1000000}};
