/* rasterizer.c - traffic for the rasterizer: slices of any steps, from single units to numerators that just fit, whose
 * limits lie on a pixel's own numerator, next to it, or some pixels away; a texture unit that accepts when it likes. */
#include "bench.h"

static const char *const machines[] = {"", NULL};

enum { NUMERATOR_BITS = 62, ANY_PX = VODR_MAX_SIZE_PX };

/* Numbers below `limit` in magnitude: none, one unit, the largest, or any. */
static int64_t below(rng *random, int64_t limit)
{
    int64_t size = limit - 1;
    switch (rng_int(random, 0, 5)) {
    case 0: return 0;
    case 1: size = size < 1 ? size : 1; break;
    case 2: break;
    default: size = rng_int(random, 0, size);
    }
    return rng_one_in(random, 2) ? size : -size;
}

/* Few pixels mostly, at either end of what there may be or anywhere. */
static void range(rng *random, int32_t *lo, int32_t *hi)
{
    int32_t size = (int32_t)rng_int(random, 1, rng_one_in(random, 40) ? ANY_PX : rng_one_in(random, 2) ? 4 : 40);
    int64_t room = ANY_PX - size;
    *lo = (int32_t)(rng_one_in(random, 3) ? room : rng_one_in(random, 2) ? 0 : rng_int(random, 0, room));
    *hi = *lo + size;
}

/* A limit some units or pixels from a numerator, or beyond all that its side can have. */
static int64_t limit_near(rng *random, int64_t numerator, int64_t step, int64_t side)
{
    const int64_t most = ((int64_t)1 << NUMERATOR_BITS) - 1;
    if (rng_one_in(random, 6))
        return side * most;
    int64_t away = rng_int(random, -1, 1), pixels = rng_int(random, -3, 3);
    away += rng_one_in(random, 3) ? 0 : pixels * (step / 4);
    away += rng_one_in(random, 2) ? 0 : rng_int(random, 0, 30) * (step / 8);
    int64_t limit = numerator + away;
    return limit > most ? most : limit < -most ? -most : limit;
}

/* An axis whose numerators fit wherever the bound lies; its limits enclose, or just miss, pixel (x, y). */
static void any_axis(rng *random, const px_rect *bound, int32_t x, int32_t y, int c, brick_slice *s)
{
    slice_plane *p = &s->plane;
    int64_t limit = (int64_t)1 << rng_int(random, 18, NUMERATOR_BITS);
    p->step_u[c] = below(random, limit / 4 / bound->x1);
    p->step_v[c] = below(random, limit / 4 / bound->y1);
    p->origin[c] = below(random, limit / 2);
    int64_t a = numerator_at(p, c, x, y), step = rng_one_in(random, 2) ? p->step_u[c] : p->step_v[c];
    step = step < 0 ? -step : step;
    s->lo[c] = limit_near(random, a - step, step, -1);
    s->hi[c] = limit_near(random, a + step + 1, step, 1);
}

static slice_port any_slice(rng *random)
{
    slice_port p = {.last = rng_one_in(random, 3)};
    px_rect *b = &p.bound;
    range(random, &b->x0, &b->x1);
    range(random, &b->y0, &b->y1);
    p.slice.k = (int32_t)rng_int(random, 0, VODR_MAX_SLICES - 1);
    int32_t x = (int32_t)rng_int(random, b->x0, b->x1 - 1), y = (int32_t)rng_int(random, b->y0, b->y1 - 1);
    for (int c = 0; c < 3; c++)
        any_axis(random, b, x, y, c, &p.slice);
    return p;
}

static void traffic(bench *b, uint64_t transactions)
{
    rasterizer_face *face = &b->faces->rasterizer;
    rasterizer_out out = b->reset->rasterizer;
    slice_port slice = {.valid = false};
    accept_port accept = {.ready = false};
    const rasterizer_in in = {.slice = &slice, .fragment = &accept};
    int64_t haste = 1, offers = 1;
    for (uint64_t done = 0; done < transactions && !bench_differs(b); b->cycles++) {
        bool taken = slice.valid && out.slice.ready;
        if (rng_one_in(&b->random, 100))
            haste = rng_one_in(&b->random, 2) ? rng_int(&b->random, 2, 10) : 1;
        if (rng_one_in(&b->random, 100))
            offers = rng_one_in(&b->random, 3) ? 2 : rng_int(&b->random, 2, 60);
        done += taken + (out.fragment.valid && accept.ready);
        face->clock(face->state, &in, &out);
        if (taken || !slice.valid) {
            slice = any_slice(&b->random);
            slice.valid = rng_one_in(&b->random, offers);
        }
        accept.ready = rng_one_in(&b->random, haste);
        accept.loading = rng_one_in(&b->random, 2);
    }
}

/* ---- what is legal ---- */

__extension__ typedef __int128 wide;

static bool fits(wide number)
{
    const wide limit = (wide)1 << NUMERATOR_BITS;
    return number > -limit && number < limit;
}

/* Whether no sum that leads to a numerator within the bound overflows. */
static bool axis_fits(const slice_port *p, int c)
{
    const slice_plane *plane = &p->slice.plane;
    bool good = fits(p->slice.lo[c]) && fits(p->slice.hi[c]) && fits(plane->origin[c]) && fits(plane->step_u[c]) &&
                fits(plane->step_v[c]);
    for (int corner = 0; corner < 4; corner++) {
        wide x = corner & 1 ? p->bound.x1 : 0, y = corner & 2 ? p->bound.y1 : 0;
        wide u = x * plane->step_u[c], v = y * plane->step_v[c];
        good &= fits(u) && fits(v) && fits(plane->origin[c] + u) && fits(plane->origin[c] + v) &&
                fits(plane->origin[c] + u + v);
    }
    return good;
}

static const char *illegal(const bench *b, void *rules, const void *inputs, const void *shown)
{
    const slice_port *p = ((const rasterizer_in *)inputs)->slice;
    const px_rect *bound = &p->bound;
    (void)b;
    (void)rules;
    (void)shown;
    if (!p->valid)
        return NULL;
    if (bound->x0 >= bound->x1 || bound->x1 > ANY_PX || bound->y0 >= bound->y1 || bound->y1 > ANY_PX)
        return "slice_x0, _y0, _x1, _y1 are no rectangle of a frame of 16384x16384 pixels";
    for (int c = 0; c < 3; c++)
        if (!axis_fits(p, c))
            return "a limit, a step, the origin or a numerator of the slice has a magnitude of 2^62 or more";
    return NULL;
}

const block_bench bench_rasterizer = {.block = VODR_BLOCK_RASTERIZER,
                                      .machines = machines,
                                      .traffic = traffic,
                                      .illegal = illegal,
                                      .vectors = "",
                                      .case_cycles = 512,
                                      .level_cycles = {10000, 1000000}};
