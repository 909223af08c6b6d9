/* test_rasterizer.c - spans against a look at every pixel, with numerators as large as 62 bits (docs/architecture.md,
 * sections 3 and 5). */
#include "rasterizer.h"

#include "lib/unit.h"

enum { MOST_PX = 40 };

static const int64_t limit = (int64_t)1 << 62;

static bool fits(wide_int a)
{
    return a > -(wide_int)limit && a < (wide_int)limit;
}

static wide_int numerator(const slice_plane *p, int c, int32_t x, int32_t y)
{
    return (wide_int)p->origin[c] + (wide_int)x * p->step_u[c] + (wide_int)y * p->step_v[c];
}

/* A plane whose numerators, with every partial sum, fit 62 bits over the frame, as a checked view's do. */
static void random_plane(rng *c, int c3, int32_t width, int32_t height, slice_plane *p)
{
    for (;;) {
        int bits = (int)rng_int(c, 6, 62);
        p->origin[c3] = rng_signed(c, bits);
        p->step_u[c3] = rng_one_in(c, 6) ? 0 : rng_signed(c, bits - (int)rng_int(c, 0, 5));
        p->step_v[c3] = rng_one_in(c, 6) ? 0 : rng_signed(c, bits - (int)rng_int(c, 0, 5));
        bool ok = fits((wide_int)p->step_u[c3] * (width - 1)) && fits((wide_int)p->step_v[c3] * (height - 1));
        for (int corner = 0; corner < 4; corner++)
            ok = ok && fits(numerator(p, c3, corner & 1 ? width - 1 : 0, corner & 2 ? height - 1 : 0));
        if (ok)
            return;
    }
}

/* Borders where the plane is: a numerator of some pixel, one off it, or anything. */
static int64_t random_border(rng *c, const slice_plane *p, int c3, int32_t width, int32_t height)
{
    if (rng_one_in(c, 5))
        return rng_signed(c, 62);
    wide_int a = numerator(p, c3, (int32_t)rng_int(c, 0, width - 1), (int32_t)rng_int(c, 0, height - 1));
    a += rng_int(c, -1, 1);
    return fits(a) ? (int64_t)a : limit - 1;
}

static bool covered(const brick_slice *s, int32_t x, int32_t y)
{
    for (int c = 0; c < 3; c++) {
        wide_int a = numerator(&s->plane, c, x, y);
        if (a < s->lo[c] || a >= s->hi[c])
            return false;
    }
    return true;
}

static void random_slice(rng *c, int32_t width, int32_t height, brick_slice *s)
{
    s->k = 0;
    for (int i = 0; i < 3; i++) {
        random_plane(c, i, width, height, &s->plane);
        s->lo[i] = random_border(c, &s->plane, i, width, height);
        s->hi[i] = random_border(c, &s->plane, i, width, height);
        if (s->lo[i] > s->hi[i] || rng_one_in(c, 3)) {
            s->lo[i] = s->lo[i] < s->hi[i] ? s->lo[i] : s->hi[i];
            s->hi[i] = limit - 1;
        }
    }
}

static void spans_are_what_every_pixel_says(void **state)
{
    (void)state;
    rng c = {51};
    uint64_t fragments = 0;
    for (int round = 0; round < 60000; round++) {
        int32_t width = (int32_t)rng_int(&c, 1, rng_one_in(&c, 2) ? MOST_PX : VODR_MAX_SIZE_PX);
        int32_t height = (int32_t)rng_int(&c, 1, rng_one_in(&c, 2) ? 8 : VODR_MAX_SIZE_PX);
        brick_slice s;
        random_slice(&c, width, height, &s);
        px_rect bound = {(int32_t)rng_int(&c, 0, width - 1), (int32_t)rng_int(&c, 0, height - 1), 0, 0};
        bound.x1 = (int32_t)rng_int(&c, bound.x0, bound.x0 + MOST_PX < width ? bound.x0 + MOST_PX : width);
        int32_t rows = rng_one_in(&c, 8) ? 3 * RASTER_ROWS : 8;
        bound.y1 = (int32_t)rng_int(&c, bound.y0, bound.y0 + rows < height ? bound.y0 + rows : height);
        rasterizer r;
        rasterizer_start(&r, &s, &bound);
        span run = {.y = -1};
        bool more = rasterizer_next(&r, &run);
        for (int32_t y = bound.y0; y < bound.y1; y++) {
            int32_t last = bound.x0 - 1;
            for (int32_t x = bound.x0; x < bound.x1; x++) {
                bool in = covered(&s, x, y), spanned = more && run.y == y && x >= run.x0 && x < run.x1;
                assert_int_equal(in, spanned);
                last = in ? x : last;
                fragments += in;
            }
            if (!more || run.y != y)
                continue;
            assert_true(run.x0 >= bound.x0 && run.x1 <= bound.x1 && run.x1 == last + 1);
            for (int i = 0; i < 3; i++)
                assert_true((wide_int)numerator_at(&s.plane, i, run.x0, y) == numerator(&s.plane, i, run.x0, y));
            more = rasterizer_next(&r, &run);
        }
        assert_false(more);
    }
    assert_true(fragments > 100000); /* the cases are not all empty */
}

/* Boxes that share a border share out the pixels: each in exactly one. */
static void neighbours_partition_the_row(void **state)
{
    (void)state;
    rng c = {52};
    for (int round = 0; round < 20000; round++) {
        int32_t width = MOST_PX, owners[MOST_PX] = {0};
        brick_slice s = {.lo = {0, -limit + 1, -limit + 1}, .hi = {0, limit - 1, limit - 1}};
        for (int i = 0; i < 3; i++)
            random_plane(&c, i, width, 1, &s.plane);
        int64_t border = random_border(&c, &s.plane, 0, width, 1);
        const int64_t lo[2] = {-limit + 1, border}, hi[2] = {border, limit - 1};
        for (int half = 0; half < 2; half++) {
            s.lo[0] = lo[half];
            s.hi[0] = hi[half];
            rasterizer r;
            rasterizer_start(&r, &s, &(px_rect){0, 0, width, 1});
            for (span run; rasterizer_next(&r, &run);)
                for (int32_t x = run.x0; x < run.x1; x++)
                    owners[x]++;
        }
        for (int32_t x = 0; x < width; x++) {
            bool edge = false; /* the limit itself is in no box */
            for (int i = 0; i < 3; i++)
                edge = edge || numerator(&s.plane, i, x, 0) >= limit - 1;
            assert_int_equal(owners[x], !edge);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spans_are_what_every_pixel_says),
        cmocka_unit_test(neighbours_partition_the_row),
    };
    return cmocka_run_group_tests_name("rasterizer", tests, NULL, NULL);
}
