/* test_alpha_blender.c - over, under and maximum against exact division (docs/architecture.md, section 7). */
#include "alpha_blender.h"
#include "lib/unit.h"

static alpha_blender blender(vodr_blend mode, int fb_bits)
{
    vodr_machine m = vodr_machine_default();
    m.blend = mode;
    m.fb_bits = fb_bits;
    return alpha_blender_of(&m);
}

/* u*v/full, to nearest; full is odd, so there are no ties. */
static uint32_t nearest(uint32_t u, uint32_t v, uint32_t full)
{
    uint64_t product = (uint64_t)u * v, quotient = product / full;
    return (uint32_t)(quotient + (2 * (product - quotient * full) > full));
}

/* Blends once in over and once in under: both take the product scale(u, v) on every channel. */
static void check_product(const alpha_blender *over, const alpha_blender *under, uint32_t u, uint32_t v)
{
    uint16_t through = (uint16_t)(over->full - v), value = (uint16_t)u, want = (uint16_t)nearest(u, v, over->full);
    uint64_t terminated = 0;
    vodr_rgba source = {0, 0, 0, through}, pixel = {value, value, value, value};
    alpha_blender_run(over, &source, 1, &pixel, &terminated);
    if (pixel.r != want || pixel.g != want || pixel.b != want || pixel.a != through + want)
        fail_msg("over: %u*%u of %u gives (%u,%u,%u,%u), not %u", u, v, over->full, pixel.r, pixel.g, pixel.b, pixel.a,
                 want);
    if (v == 0)
        return; /* under terminates */
    source = (vodr_rgba){value, value, value, value};
    pixel = (vodr_rgba){0, 0, 0, through};
    alpha_blender_run(under, &source, 1, &pixel, &terminated);
    if (pixel.r != want || pixel.g != want || pixel.b != want || pixel.a != through + want || terminated)
        fail_msg("under: %u*%u of %u gives (%u,%u,%u,%u), not %u", u, v, over->full, pixel.r, pixel.g, pixel.b, pixel.a,
                 want);
}

static void every_product_of_8_bits(void **state)
{
    (void)state;
    alpha_blender over = blender(VODR_BLEND_OVER, 8), under = blender(VODR_BLEND_UNDER, 8);
    assert_int_equal(over.full, 255);
    for (uint32_t u = 0; u < 256; u++)
        for (uint32_t v = 0; v < 256; v++)
            check_product(&over, &under, u, v);
}

static void many_products_of_16_bits(void **state)
{
    (void)state;
    alpha_blender over = blender(VODR_BLEND_OVER, 16), under = blender(VODR_BLEND_UNDER, 16);
    static const uint32_t corners[] = {0,     1,     2,     254,   255,   256,   257,   32767,
                                       32768, 32769, 65278, 65279, 65280, 65533, 65534, 65535};
    rng c = {1};
    assert_int_equal(over.full, 65535);
    for (uint32_t u = 0; u < 65536; u++)
        for (size_t i = 0; i < sizeof corners / sizeof *corners; i++) {
            check_product(&over, &under, u, corners[i]);
            check_product(&over, &under, corners[i], u);
        }
    for (int i = 0; i < 2000000; i++)
        check_product(&over, &under, (uint32_t)rng_int(&c, 0, 65535), (uint32_t)rng_int(&c, 0, 65535));
}

static vodr_rgba random_colour(rng *c, uint32_t full)
{
    vodr_rgba p = {.a = (uint16_t)(rng_one_in(c, 4) ? full : rng_one_in(c, 3) ? 0 : rng_int(c, 0, full))};
    p.r = (uint16_t)rng_int(c, 0, p.a);
    p.g = (uint16_t)(rng_one_in(c, 3) ? p.a : rng_int(c, 0, p.a));
    p.b = (uint16_t)rng_int(c, 0, p.a);
    return p;
}

static void assert_colour(vodr_rgba got, uint32_t r, uint32_t g, uint32_t b, uint32_t a)
{
    if (got.r != r || got.g != g || got.b != b || got.a != a)
        fail_msg("(%u,%u,%u,%u) instead of (%u,%u,%u,%u)", got.r, got.g, got.b, got.a, r, g, b, a);
}

static void channels_are_apart_and_stay_premultiplied(void **state)
{
    (void)state;
    rng c = {2};
    for (int round = 0; round < 200000; round++) {
        int bits = round & 1 ? 16 : 8;
        uint32_t f = bits == 16 ? 65535 : 255;
        alpha_blender over = blender(VODR_BLEND_OVER, bits);
        vodr_rgba s = random_colour(&c, f), p = random_colour(&c, f), out = p;
        uint64_t terminated = 0;
        assert_int_equal(alpha_blender_run(&over, &s, 1, &out, &terminated), 1);
        uint32_t v = f - s.a;
        assert_colour(out, s.r + nearest(p.r, v, f), s.g + nearest(p.g, v, f), s.b + nearest(p.b, v, f),
                      s.a + nearest(p.a, v, f));
        assert_true(out.r <= out.a && out.g <= out.a && out.b <= out.a && out.a <= f);
    }
}

/* Runs of any length, pixel i meeting fragment i; every one written in over, all but the full ones in under. */
static void runs_and_termination(void **state)
{
    (void)state;
    enum { MOST = 40 };
    rng c = {3};
    for (int round = 0; round < 20000; round++) {
        int bits = round & 1 ? 16 : 8;
        uint32_t f = bits == 16 ? 65535 : 255;
        int32_t count = (int32_t)rng_int(&c, 0, MOST), open = 0;
        vodr_rgba s[MOST + 1], p[MOST + 1], o[MOST + 1], u[MOST + 1];
        for (int32_t i = 0; i <= MOST; i++) {
            s[i] = random_colour(&c, f);
            o[i] = u[i] = p[i] = random_colour(&c, f);
            open += i < count && p[i].a != f;
        }
        alpha_blender over = blender(VODR_BLEND_OVER, bits), under = blender(VODR_BLEND_UNDER, bits);
        uint64_t terminated = 7;
        assert_int_equal(alpha_blender_run(&over, s, count, o, &terminated), count);
        assert_int_equal(terminated, 7);
        assert_int_equal(alpha_blender_run(&under, s, count, u, &terminated), open);
        assert_int_equal(terminated, 7 + count - open);
        for (int32_t i = 0; i <= MOST; i++) {
            uint32_t v = i < count ? f - p[i].a : 0; /* a full pixel lets nothing through */
            assert_colour(u[i], p[i].r + nearest(s[i].r, v, f), p[i].g + nearest(s[i].g, v, f),
                          p[i].b + nearest(s[i].b, v, f), p[i].a + nearest(s[i].a, v, f));
        }
        assert_memory_equal(&o[count], &p[count], (size_t)(MOST + 1 - count) * sizeof *p);
    }
}

static void maximum_keeps_the_first_and_the_greatest(void **state)
{
    (void)state;
    alpha_blender mip = blender(VODR_BLEND_MIP, 8);
    static const uint16_t densities[] = {0, 0, 5, 4, 5, 6, 4095};
    static const int32_t written[] = {1, 0, 1, 0, 0, 1, 1};
    vodr_rgba pixel = {0};
    uint64_t terminated = 0;
    uint16_t most = 0;
    for (size_t i = 0; i < sizeof densities / sizeof *densities; i++) {
        vodr_rgba fragment = {.r = densities[i], .a = 1};
        assert_int_equal(alpha_blender_run(&mip, &fragment, 1, &pixel, &terminated), written[i]);
        most = densities[i] > most ? densities[i] : most;
        assert_int_equal(pixel.r, most);
        assert_int_equal(pixel.a, 1);
    }
    assert_int_equal(terminated, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_product_of_8_bits),
        cmocka_unit_test(many_products_of_16_bits),
        cmocka_unit_test(channels_are_apart_and_stay_premultiplied),
        cmocka_unit_test(runs_and_termination),
        cmocka_unit_test(maximum_keeps_the_first_and_the_greatest),
    };
    return cmocka_run_group_tests_name("alpha_blender", tests, NULL, NULL);
}
