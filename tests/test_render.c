/* test_render.c - vodr_render()'s contract (cmodel/vodr.h): which inputs it refuses, what is then left in frame and
 * counters, and that it tells how far it is, whoever draws. */
#include <string.h>

#include "lib/unit.h"

#include "cases.h"
#include "outcome.h"

enum { SEED = 7 };

/* ---- what is refused ---- */

static void refuses(const test_case *c, const vodr_machine *m, vodr_path path, const char *words)
{
    static const vodr_counters none;
    const vodr_options options = {.threads = 1, .path = path};
    outcome o;
    outcome_draw(c, m, &options, &o);
    assert_int_equal(o.status, VODR_INVALID);
    if (!strstr(o.error.text, words)) {
        fail_msg("'%s' does not say '%s'", o.error.text, words);
    }
    assert_null(o.frame.pixels);
    assert_memory_equal(&o.counters, &none, sizeof none);
}

static void refuses_everywhere(const test_case *c, const vodr_machine *m, const char *words)
{
    refuses(c, m, VODR_PATH_FAST, words);
    refuses(c, m, VODR_PATH_BLOCKS, words);
    refuses(c, m, VODR_PATH_CLOCKED, words);
}

static void bad_volumes(void **state)
{
    (void)state;
    test_case c;
    assert_true(case_make(SEED, &c));
    const vodr_volume good = c.input;
    vodr_machine m = unit_machine("density_bits=8");
    for (int axis = 0; axis < 3; axis++) {
        c.input.dims_vox[axis] = 0;
        refuses_everywhere(&c, &m, "voxels but must have 1 to 32768 a side");
        c.input.dims_vox[axis] = VODR_MAX_DIM_VOX + 1;
        refuses_everywhere(&c, &m, "voxels but must have 1 to 32768 a side");
        c.input = good;
    }
    c.input.voxel_bytes = 3;
    refuses_everywhere(&c, &m, "voxel_bytes is 3 but must be 1 or 2");
    c.input.voxel_bytes = 1;
    m.filter = VODR_FILTER_BSPLINE;
    refuses_everywhere(&c, &m, "voxel_bytes is 1 but must be 2: filter=bspline takes coefficients");
    m.filter = VODR_FILTER_LINEAR;
    c.input.map = NULL;
    m.density_bits = 12;
    refuses_everywhere(&c, &m, "8-bit voxels without a map need density_bits=8, not 12");
    memset(c.map, 0, sizeof c.map);
    c.map[255] = 256;
    c.input.map = c.map;
    m.density_bits = 8;
    refuses_everywhere(&c, &m, "map entry 255 is 256 but must be below 256");
    case_free(&c);
}

static void bad_boxes(void **state)
{
    (void)state;
    test_case c;
    assert_true(case_make(SEED, &c));
    for (int axis = 0; axis < 3; axis++) {
        for (int a = 0; a < 3; a++) {
            c.input.lo_vox[a] = 0;
            c.input.hi_vox[a] = c.input.dims_vox[a];
        }
        c.input.lo_vox[axis] = c.input.hi_vox[axis];
        refuses_everywhere(&c, &c.machine, "is to be drawn along");
        c.input.lo_vox[axis] = -1;
        refuses_everywhere(&c, &c.machine, "is to be drawn along");
        c.input.lo_vox[axis] = 0;
        c.input.hi_vox[axis]++;
        refuses_everywhere(&c, &c.machine, "is to be drawn along");
    }
    case_free(&c);
}

static void bad_tables(void **state)
{
    (void)state;
    test_case c;
    assert_true(case_make(SEED, &c));
    const vodr_table good = c.table;
    c.table.count--;
    refuses_everywhere(&c, &c.machine, "entries");
    c.table.entries = NULL;
    refuses_everywhere(&c, &c.machine, "entries");
    c.table = good;
    c.entries[1] = (vodr_rgba){.r = 1, .a = 0};
    refuses_everywhere(&c, &c.machine, "entry 1");
    case_free(&c);
}

/* ---- progress ---- */

static void on_progress(void *context, double done)
{
    double *last = context;
    assert_true(done >= *last && done <= 1);
    *last = done;
}

static void tells_progress(void **state)
{
    (void)state;
    test_case c;
    outcome o;
    assert_true(case_make(SEED, &c));
    for (int path = VODR_PATH_FAST; path <= VODR_PATH_BLOCKS; path++) {
        for (int32_t blend = VODR_BLEND_OVER; blend <= VODR_BLEND_UNDER; blend++) {
            vodr_machine m = c.machine;
            double last = 0;
            const vodr_options options = {
                .threads = 2, .path = (vodr_path)path, .progress = on_progress, .progress_context = &last};
            m.blend = blend;
            outcome_draw(&c, &m, &options, &o);
            assert_int_equal(o.status, VODR_OK);
            assert_true(last > 0);
            outcome_free(&o);
        }
    }
    case_free(&c);
}

/* ---- what may be left out ---- */

static void no_options(void **state)
{
    (void)state;
    test_case c;
    outcome with = {0}, without = {0};
    assert_true(case_make(SEED, &c));
    outcome_draw(&c, &c.machine, &(vodr_options){.threads = 1}, &with);
    outcome_draw(&c, &c.machine, NULL, &without);
    assert_true(outcome_same(stderr, &with, &without));
    outcome_free(&with);
    outcome_free(&without);
    c.input.voxel_bytes = 3;
    assert_int_equal(vodr_render(&c.machine, &c.input, &c.table, &c.view, NULL, &with.frame, &with.counters, NULL),
                     VODR_INVALID);
    case_free(&c);
}

/* ---- whoever draws, the frame is the same ---- */

static void draw_like_blocks(const test_case *c, const vodr_machine *m, const vodr_options *options)
{
    outcome blocks, other;
    outcome_draw(c, m, &(vodr_options){.threads = 1, .path = VODR_PATH_BLOCKS}, &blocks);
    outcome_draw(c, m, options, &other);
    assert_int_equal(blocks.status, VODR_OK);
    assert_true(outcome_same(stderr, &blocks, &other));
    outcome_free(&blocks);
    outcome_free(&other);
}

static void threads_and_instructions(void **state)
{
    (void)state;
    test_case c;
    assert_true(case_make(SEED, &c));
    draw_like_blocks(&c, &c.machine, &(vodr_options){.threads = 0});
    draw_like_blocks(&c, &c.machine, &(vodr_options){.threads = 1000});
    for (int simd = VODR_SIMD_BEST; simd <= VODR_SIMD_AVX512; simd++) {
        draw_like_blocks(&c, &c.machine, &(vodr_options){.threads = 1, .simd = (vodr_simd)simd});
    }
    case_free(&c);
}

/* A volume of few voxels across and many along x, as it is, from the front. */
static void use_volume(test_case *c, uint8_t *voxels, int32_t x_vox, int32_t y_vox, int32_t z_vox)
{
    for (int32_t i = 0; i < x_vox * y_vox * z_vox; i++) {
        voxels[i] = (uint8_t)(i * 37);
    }
    c->input = (vodr_volume){.dims_vox = {x_vox, y_vox, z_vox}, .voxel_bytes = 1, .voxels = voxels};
    c->view = (vodr_view){.width_px = x_vox,
                          .height_px = y_vox,
                          .slices = z_vox,
                          .footprint = 1 << VODR_FOOTPRINT_BITS,
                          .base = {1 << 23, 1 << 23, 1 << 23},
                          .step_u = {1 << 24, 0, 0},
                          .step_v = {0, 1 << 24, 0},
                          .step_s = {0, 0, 1 << 24}};
}

/* Rows that are longer than a brick's words, so that they can be read where they lie. */
static void long_rows(void **state)
{
    (void)state;
    static uint8_t voxels[300 * 6 * 5];
    test_case c;
    assert_true(case_make(SEED, &c));
    use_volume(&c, voxels, 300, 6, 5);
    vodr_machine m = vodr_machine_default();
    vodr_rgba entries[256];
    for (int i = 0; i < 256; i++) {
        entries[i] = (vodr_rgba){.r = (uint16_t)(i / 2), .g = 3 < i / 2 ? 3 : 0, .a = (uint16_t)(i / 2)};
    }
    c.table = (vodr_table){.entries = entries, .count = 256};
    draw_like_blocks(&c, &m, &(vodr_options){.threads = 1});
    /* More fragments than there is room to mark: the fast path leaves the frame to the blocks. */
    c.view.width_px = 512;
    c.view.height_px = 1024;
    c.view.slices = 1024;
    m.blend = VODR_BLEND_UNDER;
    draw_like_blocks(&c, &m, &(vodr_options){.threads = 1});
    case_free(&c);
}

/* ---- who looks on ---- */

static void on_visit(void *context, const vodr_visit *visit)
{
    (void)visit;
    ++*(uint64_t *)context;
}

static void on_miss(void *context, int32_t x_px, int32_t y_px)
{
    (void)x_px;
    (void)y_px;
    ++*(uint64_t *)context;
}

/* Either function of an observer may be missing. */
static void half_observers(void **state)
{
    (void)state;
    test_case c;
    assert_true(case_make(SEED, &c));
    for (int path = VODR_PATH_FAST; path <= VODR_PATH_CLOCKED; path++) {
        uint64_t visits = 0, misses = 0;
        const vodr_observer one = {.context = &visits, .visit = on_visit},
                            other = {.context = &misses, .miss = on_miss};
        outcome o;
        outcome_draw(&c, &c.machine, &(vodr_options){.threads = 1, .path = (vodr_path)path, .observer = &one}, &o);
        assert_int_equal(visits, o.counters.brick_visits);
        outcome_free(&o);
        outcome_draw(&c, &c.machine, &(vodr_options){.threads = 1, .path = (vodr_path)path, .observer = &other}, &o);
        assert_int_equal(misses, o.counters.misses);
        outcome_free(&o);
    }
    case_free(&c);
}

/* A box of a volume is drawn alike by all, cycles included. */
static void boxes(void **state)
{
    (void)state;
    enum { CASES = 60 };
    static const vodr_path paths[] = {VODR_PATH_FAST, VODR_PATH_BLOCKS, VODR_PATH_CLOCKED};
    rng r = {23};
    uint64_t fragments = 0;
    for (uint64_t seed = 0; seed < CASES; seed++) {
        test_case c;
        outcome o[3];
        assert_true(case_make(seed, &c));
        for (int a = 0; a < 3; a++) {
            c.input.lo_vox[a] = (int32_t)rng_int(&r, 0, c.input.dims_vox[a] - 1);
            c.input.hi_vox[a] = (int32_t)rng_int(&r, c.input.lo_vox[a] + 1, c.input.dims_vox[a]);
        }
        for (int i = 0; i < 3; i++)
            outcome_draw(&c, &c.machine, &(vodr_options){.threads = 1, .path = paths[i], .cycles = true}, &o[i]);
        for (int i = 1; i < 3; i++)
            assert_true(outcome_same(stderr, &o[0], &o[i]));
        fragments += o[0].counters.fragments;
        for (int i = 0; i < 3; i++)
            outcome_free(&o[i]);
        case_free(&c);
    }
    assert_true(fragments > 1000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_volumes),
        cmocka_unit_test(bad_tables),
        cmocka_unit_test(tells_progress),
        cmocka_unit_test(no_options),
        cmocka_unit_test(threads_and_instructions),
        cmocka_unit_test(long_rows),
        cmocka_unit_test(half_observers),
        cmocka_unit_test(boxes),
        cmocka_unit_test(bad_boxes),
    };
    return cmocka_run_group_tests_name("render", tests, NULL, NULL);
}
