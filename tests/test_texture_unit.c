/* test_texture_unit.c - filter, table and texture memory against plain formulas (docs/architecture.md, sections 4 and
 * 6). */
#include "texture_unit.h"

#include <string.h>

#include "lib/unit.h"

enum { MOST_VOXELS = 12 * 12 * 12, MOST_ENTRIES = 4096, ONE = 1 << 24 };

/* A random small volume, in each form that the machine takes, and its densities as the page defines them. */
typedef struct subject {
    uint8_t bytes[MOST_VOXELS];
    uint16_t words[MOST_VOXELS], density[MOST_VOXELS], map[256];
    bool coefficients; /* words are, in two's complement; else densities */
    vodr_volume volume;
    vodr_rgba entries[MOST_ENTRIES];
    vodr_table table;
} subject;

static void fill_subject(subject *s, rng *c, int32_t density_bits, bool coefficients)
{
    int32_t most = (1 << density_bits) - 1, kind = (int32_t)rng_int(c, density_bits == 8 ? 0 : 1, 2);
    kind = coefficients ? 2 : kind;
    s->coefficients = coefficients;
    s->volume =
        (vodr_volume){.dims_vox = {(int32_t)rng_int(c, 1, 12), (int32_t)rng_int(c, 1, 12), (int32_t)rng_int(c, 1, 12)},
                      .voxel_bytes = kind == 2 ? 2 : 1,
                      .voxels = kind == 2 ? (const void *)s->words : s->bytes,
                      .map = kind == 1 ? s->map : NULL};
    for (int i = 0; i < 256; i++)
        s->map[i] = (uint16_t)rng_int(c, 0, most);
    for (int i = 0; i < MOST_VOXELS; i++) {
        s->bytes[i] = (uint8_t)(rng_one_in(c, 4) ? 255 * rng_one_in(c, 2) : rng_next(c));
        s->words[i] = (uint16_t)(rng_one_in(c, coefficients ? 1 : 4) ? (int64_t)rng_next(c) : rng_int(c, 0, most));
        uint16_t word = s->words[i] > most ? (uint16_t)most : s->words[i];
        s->density[i] = kind == 0 ? s->bytes[i] : kind == 1 ? s->map[s->bytes[i]] : word;
    }
    s->table = (vodr_table){.entries = s->entries, .count = (size_t)most + 1};
    memset(s->entries, 0, sizeof s->entries);
}

static int64_t floor_div(int64_t a, int64_t b)
{
    return a / b - (a % b < 0);
}

static int64_t voxel(const subject *s, int64_t x, int64_t y, int64_t z)
{
    int64_t i[3] = {x, y, z};
    for (int c = 0; c < 3; c++)
        i[c] = i[c] < 0 ? 0 : i[c] >= s->volume.dims_vox[c] ? s->volume.dims_vox[c] - 1 : i[c];
    int64_t at = (i[2] * s->volume.dims_vox[1] + i[1]) * s->volume.dims_vox[0] + i[0];
    return s->coefficients ? (int16_t)s->words[at] : s->density[at];
}

/* Weights as the page's real functions of t = u/B, rounded as it says: in whole parts of 1/(6*B^3). */
static void plain_weights(const vodr_machine *m, int64_t u, int64_t w[4])
{
    int64_t B = (int64_t)1 << m->weight_bits, v = B - u, whole = 6 * B * B * B;
    bool spline = m->filter == VODR_FILTER_BSPLINE;
    int64_t outer = spline ? v * v * v : 3 * u * v * v, other = spline ? u * u * u : 3 * u * u * v;
    int64_t inner =
        spline ? B * B * B + 3 * u * B * B + 3 * u * u * B - 3 * u * u * u : 3 * u * (B * B + 4 * u * B - 3 * u * u);
    w[0] = (spline ? 1 : -1) * (outer * 4 * B / whole);
    w[2] = (2 * inner * 4 * B + whole) / (2 * whole);
    w[3] = (spline ? 1 : -1) * (other * 4 * B / whole);
    w[1] = 4 * B - w[0] - w[2] - w[3];
}

static int64_t plain_cubic(const subject *s, const vodr_machine *m, const int64_t p[3])
{
    int64_t value[64], weight[3][4], first[3], unit = (int64_t)1 << m->weight_bits, guard = (int64_t)1 << m->guard_bits;
    int64_t most = (1 << m->density_bits) - 1;
    for (int c = 0; c < 3; c++) {
        int64_t q = p[c] - ONE / 2;
        first[c] = floor_div(q, ONE);
        plain_weights(m, (q - first[c] * ONE) / (ONE / unit), weight[c]);
    }
    for (int i = 0; i < 64; i++)
        value[i] = guard * voxel(s, first[0] - 1 + i % 4, first[1] - 1 + i / 4 % 4, first[2] - 1 + i / 16);
    for (int c = 0, n = 16; c < 3; c++, n /= 4)
        for (int i = 0; i < n; i++) {
            int64_t sum = 0;
            for (int tap = 0; tap < 4; tap++)
                sum += weight[c][tap] * value[4 * i + tap];
            value[i] = floor_div(sum, 4 * unit);
        }
    guard *= m->filter == VODR_FILTER_BSPLINE && m->density_bits == 8 ? 8 : 1;
    int64_t density = floor_div(value[0] + guard / 2, guard);
    return density < 0 ? 0 : density > most ? most : density;
}

static int64_t plain_filter(const subject *s, const vodr_machine *m, const int64_t p[3])
{
    if (m->filter == VODR_FILTER_CARDINAL || m->filter == VODR_FILTER_BSPLINE)
        return plain_cubic(s, m, p);
    if (m->filter == VODR_FILTER_NEAREST)
        return voxel(s, floor_div(p[0], ONE), floor_div(p[1], ONE), floor_div(p[2], ONE));
    int64_t value[8], unit = (int64_t)1 << m->weight_bits, guard = (int64_t)1 << m->guard_bits, first[3], weight[3];
    for (int c = 0; c < 3; c++) {
        int64_t q = p[c] - ONE / 2;
        first[c] = floor_div(q, ONE);
        weight[c] = (q - first[c] * ONE) / (ONE / unit);
    }
    for (int i = 0; i < 8; i++)
        value[i] = guard * voxel(s, first[0] + (i & 1), first[1] + (i >> 1 & 1), first[2] + (i >> 2));
    for (int c = 0, n = 4; c < 3; c++, n /= 2)
        for (int i = 0; i < n; i++)
            value[i] = value[2 * i] + floor_div((value[2 * i + 1] - value[2 * i]) * weight[c], unit);
    return floor_div(value[0] + guard / 2, guard);
}

static vodr_machine random_machine(rng *c)
{
    vodr_machine m = vodr_machine_default();
    m.filter = (int32_t)rng_int(c, VODR_FILTER_NEAREST, VODR_FILTER_BSPLINE);
    m.density_bits = rng_one_in(c, 2) ? 12 : 8;
    m.weight_bits = (int32_t)rng_int(c, 1, 12);
    m.guard_bits = (int32_t)rng_int(c, 0, 6);
    m.traversal = rng_one_in(c, 3) ? VODR_TRAVERSAL_WHOLE : VODR_TRAVERSAL_LAYER;
    m.double_buffer = rng_one_in(c, 2);
    return m;
}

/* A position in [lo, hi): on a border, on a voxel's centre, just below one of these, or anywhere. */
static int64_t random_position(rng *c, int32_t lo, int32_t hi)
{
    int64_t first = (int64_t)lo * ONE, last = (int64_t)hi * ONE - 1;
    switch (rng_int(c, 0, 5)) {
    case 0: return first;
    case 1: return last;
    case 2: return rng_int(c, lo, hi - 1) * ONE + ONE / 2;
    case 3: return rng_int(c, lo, hi - 1) * ONE + ONE / 2 - 1;
    default: return rng_int(c, first, last);
    }
}

static void check_filter(const subject *s, const vodr_machine *m, texture_unit *t, vodr_view *view, const vox_box *box,
                         rng *c)
{
    int64_t a = rng_int(c, 0, 1), half = ONE / 2;
    brick_slice slice = {.k = 0};
    const span run = {.x0 = 5, .x1 = 8};
    uint16_t got[3];
    for (int i = 0; i < 3; i++) {
        int64_t p = random_position(c, box->lo[i], box->hi[i]);
        /* Three samples inside the box, or three times the same one. */
        slice.plane.step_u[i] = p + 2 * half < (int64_t)box->hi[i] * ONE ? half * a : 0;
        view->base[i] = p - 1000;
        slice.plane.origin[i] = 1000 - run.x0 * slice.plane.step_u[i];
    }
    texture_unit_filter(t, &slice, &run, got);
    static const uint64_t fetches[] = {1, 8, 64, 64}; /* nearest, linear, cardinal, bspline */
    uint64_t each = fetches[m->filter] * (m->density_bits == 12 || s->coefficients ? 2 : 1);
    assert_int_equal(texture_unit_fetched(t, 3), m->traversal == VODR_TRAVERSAL_WHOLE ? 3 * each : 0);
    for (int n = 0; n < 3; n++) {
        int64_t p[3];
        for (int i = 0; i < 3; i++)
            p[i] = view->base[i] + 1000 + n * slice.plane.step_u[i];
        int64_t want = plain_filter(s, m, p);
        if (got[n] != want)
            fail_msg("position %lld %lld %lld / 2^24: %u, not %lld", (long long)p[0], (long long)p[1], (long long)p[2],
                     got[n], (long long)want);
    }
}

/* Whole and from a brick with its border: the same formula. */
static void the_filter_is_the_formula(void **state)
{
    (void)state;
    rng c = {31};
    subject s;
    for (int round = 0; round < 3000; round++) {
        vodr_machine m = random_machine(&c);
        fill_subject(&s, &c, m.density_bits, m.filter == VODR_FILTER_BSPLINE);
        vodr_view view = {0};
        texture_unit t;
        assert_int_equal(texture_unit_start(&t, &m, &s.volume, &s.table, &view, NULL), VODR_OK);
        int32_t edge = (int32_t)rng_int(&c, 1, 6);
        assert_int_equal(texture_unit_reserve(&t, edge, NULL), VODR_OK);
        for (size_t brick = 0; brick < 4; brick++) {
            vox_box box;
            for (int i = 0; i < 3; i++) {
                int32_t size = s.volume.dims_vox[i];
                box.lo[i] = m.traversal == VODR_TRAVERSAL_WHOLE ? 0 : (int32_t)rng_int(&c, 0, size - 1);
                box.hi[i] = box.lo[i] + edge < size && m.traversal ? box.lo[i] + edge : size;
            }
            texture_unit_load(&t, brick, &box);
            for (int n = 0; n < 20; n++)
                check_filter(&s, &m, &t, &view, &box, &c);
        }
        texture_unit_finish(&t);
    }
}

/* Of every width and share: weights add up to one; a B-spline's are not negative, a cardinal spline's outer ones take
 * at most an eighth. So a constant stays what it is, and nothing leaves the bounds that filter_range() tells. */
static void cubic_weights_keep_their_bounds(void **state)
{
    (void)state;
    for (int32_t filter = VODR_FILTER_CARDINAL; filter <= VODR_FILTER_BSPLINE; filter++)
        for (int32_t bits = 1; bits <= 12; bits++) {
            vodr_machine m = unit_machine("density_bits=12 guard_bits=3");
            m.filter = filter;
            m.weight_bits = bits;
            cubic c;
            assert_true(cubic_start(&c, &m));
            for (int32_t u = 0; u < 1 << bits; u++) {
                const int16_t *w = c.weights[u].tap;
                assert_int_equal(w[0] + w[1] + w[2] + w[3], 4 << bits);
                assert_true(w[1] >= 0 && w[2] >= 0 && w[1] <= 4 << bits && w[2] <= 4 << bits);
                if (filter == VODR_FILTER_BSPLINE)
                    assert_true(w[0] >= 0 && w[3] >= 0);
                else
                    assert_true(w[0] <= 0 && w[3] <= 0 && -w[0] - w[3] <= (4 << bits) / 8);
            }
            cubic_finish(&c);
        }
}

/* The least and the greatest that two values can make: bounds hold, and where they can be met they are. */
static void ranges_bound_the_filter(void **state)
{
    (void)state;
    rng r = {35};
    for (int round = 0; round < 20000; round++) {
        vodr_machine m = random_machine(&r);
        m.filter = rng_one_in(&r, 2) ? VODR_FILTER_CARDINAL : VODR_FILTER_BSPLINE;
        bool spline = m.filter == VODR_FILTER_BSPLINE;
        int32_t most = (1 << m.density_bits) - 1;
        int32_t a = (int32_t)(spline ? rng_int(&r, -32768, 32767) : rng_int(&r, 0, most));
        int32_t b = (int32_t)(spline ? rng_int(&r, -32768, 32767) : rng_int(&r, 0, most));
        int32_t min = a < b ? a : b, max = a < b ? b : a, voxels[CUBIC_VOXELS], share[3];
        cubic c;
        assert_true(cubic_start(&c, &m));
        for (int i = 0; i < 3; i++)
            share[i] =
                (int32_t)(rng_one_in(&r, 2) ? (1 << m.weight_bits) / 2 : rng_int(&r, 0, (1 << m.weight_bits) - 1));
        int parity = (int)rng_int(&r, 0, 1);
        for (int i = 0; i < CUBIC_VOXELS; i++) { /* what makes most of a cardinal spline: by the weights' signs */
            int outer = (i % 4 % 3 == 0) + (i / 4 % 4 % 3 == 0) + (i / 16 % 3 == 0);
            voxels[i] = outer % 2 == parity ? max : min;
        }
        filter_range(&m, &min, &max);
        int32_t density = cubic_value(&c, share, voxels);
        assert_true(min <= density && density <= max);
        cubic_finish(&c);
    }
    vodr_machine m = unit_machine("filter=cardinal density_bits=12 weight_bits=8");
    int32_t min = 1000, max = 2000;
    filter_range(&m, &min, &max);
    assert_int_equal(min, 1000 - 477); /* 0.4766 of the range */
    assert_int_equal(max, 2000 + 477);
}

/* Numerators are shifted with one floor, also below zero. */
static void perspective_floors_each_position(void **state)
{
    (void)state;
    subject s;
    rng c = {32};
    fill_subject(&s, &c, 8, false);
    s.volume = (vodr_volume){.dims_vox = {4, 1, 1}, .voxel_bytes = 1, .voxels = "\1\2\3\4"};
    vodr_machine m = unit_machine("filter=nearest traversal=whole");
    vodr_view view = {.perspective = true, .shift = 5, .base = {2 * ONE, 0, 0}};
    texture_unit t;
    assert_int_equal(texture_unit_start(&t, &m, &s.volume, &s.table, &view, NULL), VODR_OK);
    brick_slice slice = {.plane.step_u = {1, 0, 0}, .plane.origin = {-2, 0, 0}};
    const span run = {.x0 = 0, .x1 = 3};
    uint16_t got[3];
    texture_unit_filter(&t, &slice, &run, got);
    assert_int_equal(got[0], 2);
    assert_int_equal(got[1], 2);
    assert_int_equal(got[2], 3);
    texture_unit_finish(&t);
}

static void tables_are_converted_exactly(void **state)
{
    (void)state;
    static vodr_rgba entries[MOST_ENTRIES];
    vodr_volume one = {.dims_vox = {1, 1, 1}, .voxel_bytes = 2, .voxels = entries};
    vodr_view view = {0};
    for (int tf = 8; tf <= 16; tf += 8)
        for (int fb = 8; fb <= 16; fb += 8)
            for (int first = 0; first < (tf == 8 ? 256 : 65536); first += MOST_ENTRIES) {
                vodr_machine m = unit_machine("density_bits=12");
                m.tf_bits = tf;
                m.fb_bits = fb;
                for (int i = 0; i < MOST_ENTRIES; i++) {
                    uint16_t v = (uint16_t)((first + i) % (tf == 8 ? 256 : 65536));
                    entries[i] = (vodr_rgba){v, v / 2, 0, v};
                }
                texture_unit t;
                vodr_table table = {entries, MOST_ENTRIES};
                assert_int_equal(texture_unit_start(&t, &m, &one, &table, &view, NULL), VODR_OK);
                for (int i = 0; i < MOST_ENTRIES; i++) {
                    uint16_t channel[2] = {entries[i].r, entries[i].g};
                    uint16_t got[2] = {t.readout[i].r, t.readout[i].g};
                    for (int n = 0; n < 2; n++) {
                        /* v/full of the one width is the same share of the other's, to nearest */
                        int64_t from = tf == 16 ? 65535 : 255, to = fb == 16 ? 65535 : 255;
                        assert_int_equal(got[n], (2 * channel[n] * to + from) / (2 * from));
                    }
                    assert_int_equal(t.colours[i].a, t.readout[i].a);
                }
                texture_unit_finish(&t);
            }
}

static void wrong_tables_are_refused(void **state)
{
    (void)state;
    static vodr_rgba entries[256];
    vodr_volume one = {.dims_vox = {1, 1, 1}, .voxel_bytes = 1, .voxels = ""};
    vodr_view view = {0};
    vodr_machine m = unit_machine("tf_bits=8");
    vodr_table table = {entries, 255};
    vodr_error error;
    texture_unit t;
    assert_int_equal(texture_unit_start(&t, &m, &one, &table, &view, &error), VODR_INVALID);
    assert_non_null(strstr(error.text, "255 entries but must have 256"));
    texture_unit_finish(&t);
    table.count = 256;
    static const vodr_rgba bad[] = {{0, 0, 0, 256}, {2, 0, 0, 1}, {0, 2, 0, 1}, {0, 0, 2, 1}};
    for (int i = 0; i < 4; i++) {
        entries[17] = bad[i];
        assert_int_equal(texture_unit_start(&t, &m, &one, &table, &view, &error), VODR_INVALID);
        assert_non_null(strstr(error.text, "table entry 17 is ("));
        texture_unit_finish(&t);
    }
}

/* transparent_to and dead against their definitions, range by range. */
static void transparency_by_definition(void **state)
{
    (void)state;
    rng c = {33};
    static vodr_rgba entries[256];
    vodr_volume one = {.dims_vox = {1, 1, 1}, .voxel_bytes = 1, .voxels = ""};
    vodr_table table = {entries, 256};
    vodr_view view = {0};
    for (int round = 0; round < 40; round++) {
        vodr_machine m = unit_machine(round & 1 ? "kill_transparent=1" : "tf_bits=16 kill_transparent=1");
        m.blend = round % 3 == 0 ? VODR_BLEND_MIP : VODR_BLEND_OVER;
        for (int i = 0; i < 256; i++) /* in 16 bits an alpha of 1 is 0 at 8 bits */
            entries[i] = (vodr_rgba){.a = rng_one_in(&c, 1 + round * 2) || i + 4 * round > 300};
        texture_unit t;
        assert_int_equal(texture_unit_start(&t, &m, &one, &table, &view, NULL), VODR_OK);
        bool none_before = true;
        for (int lo = 0; lo < 256; lo++) {
            bool all = true;
            for (int hi = lo; hi < 256; hi++) {
                all = all && (m.tf_bits == 16 || entries[hi].a == 0);
                assert_int_equal(t.transparent_to[lo] >= hi, all);
            }
            bool shows = m.tf_bits == 8 && entries[lo].a;
            none_before = none_before && !shows;
            assert_int_equal(t.dead[lo], m.blend == VODR_BLEND_MIP ? none_before : !shows);
        }
        texture_unit_finish(&t);
    }
}

/* Which of the visits A B A C A B C C load, with one buffer and with two. */
static void residency(void **state)
{
    (void)state;
    static const char visits[] = "ABACABCC";
    static const bool loads[2][8] = {{1, 1, 1, 1, 1, 1, 1, 0}, {1, 1, 0, 1, 0, 1, 1, 0}};
    rng c = {34};
    subject s;
    for (int buffers = 1; buffers <= 2; buffers++) {
        vodr_machine m = unit_machine("density_bits=12");
        m.double_buffer = buffers == 2;
        fill_subject(&s, &c, 12, false);
        s.volume.dims_vox[0] = 12;
        s.volume.dims_vox[1] = 2;
        s.volume.dims_vox[2] = 3;
        vodr_view view = {0};
        texture_unit t, counter;
        assert_int_equal(texture_unit_start(&t, &m, &s.volume, &s.table, &view, NULL), VODR_OK);
        assert_int_equal(texture_unit_start(&counter, &m, &s.volume, &s.table, &view, NULL), VODR_OK);
        assert_int_equal(texture_unit_reserve(&t, 4, NULL), VODR_OK);
        for (int i = 0; i < 8; i++) {
            int32_t brick = visits[i] - 'A', width = brick == 1 ? 6 : 5; /* a border on one side or on both */
            vox_box box = {{4 * brick, 0, 0}, {4 * brick + 4, 2, 3}};
            uint64_t bytes = loads[buffers - 1][i] ? (uint64_t)width * 2 * 3 * 2 : 0;
            assert_int_equal(texture_unit_load(&t, (size_t)brick, &box), bytes);
            assert_int_equal(texture_unit_load(&counter, (size_t)brick, &box), bytes); /* holds no densities */
            for (int n = 0; n < 10; n++)
                check_filter(&s, &m, &t, &view, &box, &c);
        }
        texture_unit_finish(&t);
        texture_unit_finish(&counter);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_filter_is_the_formula),       cmocka_unit_test(perspective_floors_each_position),
        cmocka_unit_test(tables_are_converted_exactly),    cmocka_unit_test(wrong_tables_are_refused),
        cmocka_unit_test(transparency_by_definition),      cmocka_unit_test(residency),
        cmocka_unit_test(cubic_weights_keep_their_bounds), cmocka_unit_test(ranges_bound_the_filter),
    };
    return cmocka_run_group_tests_name("texture_unit", tests, NULL, NULL);
}
