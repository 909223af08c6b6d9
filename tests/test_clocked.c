/* test_clocked.c - the clocked blocks know each other through their ports alone: the order in which they are clocked
 * makes no difference, nor what their banks of outputs held before, and another block can stand in the place of one. So
 * it is with several pipelines, of which an observer hears in any order.
 * Arguments: [CASES [FIRST_SEED]]; a failing case is drawn again by `test_clocked 1 SEED`. */
#include "clocked.h"

#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "clocked_counts.h"
#include "outcome.h"
#include "suite.h"

/* ---- events, as an observer hears them ---- */

typedef struct events {
    uint64_t hash; /* in their order */
    uint64_t sum;  /* in any */
    uint64_t visits, misses;
} events;

static void mix(events *e, const int64_t *values, int count)
{
    uint64_t event = 0xCBF29CE484222325u;
    for (int i = 0; i < count; i++) {
        event = (event ^ (uint64_t)values[i]) * 0x100000001B3u;
    }
    e->sum += event;
    e->hash = (e->hash ^ event) * 0x100000001B3u;
}

static bool same_events(const events *a, const events *b, bool ordered)
{
    return a->sum == b->sum && a->visits == b->visits && a->misses == b->misses && (!ordered || a->hash == b->hash);
}

static void on_visit(void *context, const vodr_visit *v)
{
    const int64_t values[] = {(int64_t)v->brick, v->lo_vox[0], v->lo_vox[1], v->lo_vox[2], v->hi_vox[0], v->hi_vox[1],
                              v->hi_vox[2],      v->x0_px,     v->y0_px,     v->x1_px,     v->y1_px};
    events *e = context;
    e->visits++;
    mix(e, values, sizeof values / sizeof *values);
}

static void on_miss(void *context, int32_t x_px, int32_t y_px)
{
    const int64_t values[] = {-1, x_px, y_px};
    events *e = context;
    e->misses++;
    mix(e, values, 3);
}

/* ---- blocks in the place of others ---- */

/* Clocks the block that was there, on outputs that hold nothing of use. */
#define DIRTY(block)                                                                                                   \
    static void dirty_##block(void *state, const block##_in *in, block##_out *out)                                     \
    {                                                                                                                  \
        const block##_face *inner = state;                                                                             \
        memset(out, 0xA5, sizeof *out);                                                                                \
        inner->clock(inner->state, in, out);                                                                           \
    }
DIRTY(volume_divider)
DIRTY(slice_generator)
DIRTY(rasterizer)
DIRTY(texture_unit)
DIRTY(alpha_blender)
DIRTY(pixel_cache)
DIRTY(frame_buffer)
DIRTY(voxel_memory)

/* Puts these blocks around those of a machine; `inner` keeps what was there. */
static void surround(clocked *c, block_faces *inner)
{
    block_faces *f = clocked_faces(c);
    *inner = *f;
#define SURROUND(block) f->block = (block##_face){.state = &inner->block, .clock = dirty_##block}
    SURROUND(volume_divider);
    SURROUND(slice_generator);
    SURROUND(rasterizer);
    SURROUND(texture_unit);
    SURROUND(alpha_blender);
    SURROUND(pixel_cache);
    SURROUND(frame_buffer);
    SURROUND(voxel_memory);
#undef SURROUND
}

/* Ends what was surrounded; those round it have nothing to end. */
static void finish_surrounded(block_faces *inner)
{
#define FINISH(block)                                                                                                  \
    if (inner->block.finish) {                                                                                         \
        inner->block.finish(inner->block.state);                                                                       \
    }
    FINISH(volume_divider)
    FINISH(slice_generator)
    FINISH(rasterizer)
    FINISH(texture_unit)
    FINISH(alpha_blender)
    FINISH(pixel_cache)
    FINISH(frame_buffer)
    FINISH(voxel_memory)
#undef FINISH
}

/* An alpha blender whose pixels have a colour larger than their alpha. */
static void wrong_blender(void *state, const alpha_blender_in *in, alpha_blender_out *out)
{
    const alpha_blender_face *inner = state;
    inner->clock(inner->state, in, out);
    out->blended.pixel = 1;
}

/* ---- frames ---- */

static void shuffle(rng *r, uint8_t order[CLOCKED_BLOCKS])
{
    for (int i = 0; i < CLOCKED_BLOCKS; i++) {
        int j = (int)rng_int(r, 0, i);
        order[i] = order[j];
        order[j] = (uint8_t)i;
    }
}

/* Draws with the blocks in another order each cycle, and on dirty outputs. */
static bool draw_shuffled(test_case *c, const vodr_machine *m, outcome *o)
{
    clocked *machine;
    block_faces inner;
    uint8_t order[CLOCKED_BLOCKS];
    o->status = clocked_start(&machine, m, &c->input, &c->table, &c->view, NULL, &o->error);
    if (o->status != VODR_OK) {
        return false;
    }
    surround(machine, &inner);
    do {
        shuffle(&c->random, order);
    } while (clocked_step(machine, order));
    o->status = clocked_readout(machine, &o->frame, &o->counters, &o->error);
    clocked_free(machine);
    finish_surrounded(&inner);
    return o->status == VODR_OK;
}

static bool draw_wrong(test_case *c, const vodr_machine *m, outcome *o)
{
    clocked *machine;
    o->status = clocked_start(&machine, m, &c->input, &c->table, &c->view, NULL, &o->error);
    if (o->status != VODR_OK) {
        return false;
    }
    alpha_blender_face *face = &clocked_faces(machine)->alpha_blender, inner = *face;
    *face = (alpha_blender_face){.state = &inner, .clock = wrong_blender};
    while (clocked_step(machine, NULL)) {
    }
    o->status = clocked_readout(machine, &o->frame, &o->counters, &o->error);
    *face = inner;
    clocked_free(machine);
    return o->status == VODR_OK;
}

static bool tell(FILE *file, const test_case *c, const vodr_machine *m, const char *what)
{
    fprintf(file, "  %s\n", what);
    case_print(file, c, m);
    return false;
}

/* The same frame, counts and events from three sides: blocks, clocked blocks, and those in any order. */
static bool agree(test_case *c, FILE *file)
{
    events heard[2] = {{0}, {0}};
    outcome drawn[2], shuffled = {0}, wrong = {0};
    vodr_machine m;
    case_any_machine(c, &m);
    for (int i = 0; i < 2; i++) {
        const vodr_observer observer = {&heard[i], on_visit, on_miss};
        const vodr_options options = {
            .threads = 1, .path = i ? VODR_PATH_CLOCKED : VODR_PATH_BLOCKS, .observer = &observer};
        outcome_draw(c, &m, &options, &drawn[i]);
    }
    bool good = drawn[0].status == VODR_OK && drawn[1].status == VODR_OK;
    if (good && !same_events(&heard[0], &heard[1], m.pipelines == 1)) {
        good = tell(file, c, &m, "an observer hears something else of the clocked machine");
    }
    good = good && draw_shuffled(c, &m, &shuffled);
    if (good && (memcmp(&shuffled.counters, &drawn[1].counters, sizeof shuffled.counters) != 0 ||
                 !outcome_same_frame(file, &drawn[1], &shuffled))) {
        good = tell(file, c, &m, "the order of blocks makes a difference");
    }
    bool several = m.pipelines > 1; /* the first alone would be wrong */
    good = good && (several || draw_wrong(c, &m, &wrong));
    if (good && !several && m.blend == VODR_BLEND_OVER && drawn[1].counters.misses > 0 &&
        memcmp(drawn[1].frame.pixels, wrong.frame.pixels, wrong.frame.bytes) == 0) {
        good = tell(file, c, &m, "another blender makes no difference");
    }
    for (int i = 0; i < 2; i++) {
        outcome_free(&drawn[i]);
    }
    outcome_free(&shuffled);
    outcome_free(&wrong);
    return good;
}

static void test_random_machines(void **state)
{
    assert_int_equal(suite_run(*state, agree), 0);
}

/* ---- accounts of several pipelines ---- */

/* Those of the pipeline that ends last, of two the first; but the bus' of all. */
static void test_accounts(void **state)
{
    (void)state;
    clocked_counts c[4] = {{.last = 6}, {.last = 9}, {.last = 9}, {.last = -1}};
    for (uint64_t i = 0; i < 4; i++) {
        c[i].cycles.blocks[VODR_BLOCK_RASTERIZER] = (vodr_block_cycles){.busy = i + 1, .stalled = i + 2};
        c[i].cycles.stalls[VODR_STALL_TEXTURE_LOAD] = i + 2;
        c[i].cycles.blocks[VODR_BLOCK_FRAME_BUFFER] = (vodr_block_cycles){.busy = i != 3, .stalled = i};
        c[i].cycles.stalls[VODR_STALL_DRAM_ROW] = i > 1;
        c[i].cycles.stalls[VODR_STALL_DRAM_REFRESH] = i > 1 ? i - 1 : i;
    }
    const vodr_cycles n = clocked_counts_close(c, 4);
    assert_int_equal(n.total, 10);
    assert_int_equal(n.blocks[VODR_BLOCK_RASTERIZER].busy, 2);
    assert_int_equal(n.blocks[VODR_BLOCK_RASTERIZER].stalled, 3);
    assert_int_equal(n.blocks[VODR_BLOCK_RASTERIZER].idle, 5);
    assert_int_equal(n.stalls[VODR_STALL_TEXTURE_LOAD], 3);
    assert_int_equal(n.blocks[VODR_BLOCK_FRAME_BUFFER].busy, 3);
    assert_int_equal(n.blocks[VODR_BLOCK_FRAME_BUFFER].stalled, 6);
    assert_int_equal(n.blocks[VODR_BLOCK_FRAME_BUFFER].idle, 1);
    assert_int_equal(n.stalls[VODR_STALL_DRAM_ROW], 2);
    assert_int_equal(n.stalls[VODR_STALL_DRAM_REFRESH], 4);
    assert_int_equal(n.blocks[VODR_BLOCK_VOLUME_DIVIDER].idle, 10);
}

/* ---- progress ---- */

static void on_progress(void *context, double done)
{
    double *last = context;
    assert_true(done >= *last && done <= 1);
    *last = done;
}

static void expect_progress(int32_t pipelines)
{
    test_case c;
    double last = 0;
    outcome o;
    assert_true(case_make(7, &c));
    c.machine.slice_setup_cycles = 20000;
    c.machine.pipelines = pipelines;
    const vodr_options options = {
        .path = VODR_PATH_CLOCKED, .progress = on_progress, .progress_context = &last, .cycles = true};
    outcome_draw(&c, &c.machine, &options, &o);
    assert_int_equal(o.status, VODR_OK);
    assert_true(last > 0);
    outcome_free(&o);
    case_free(&c);
}

static void test_progress(void **state)
{
    (void)state;
    expect_progress(1);
    expect_progress(3);
}

static void test_free_nothing(void **state)
{
    (void)state;
    clocked_free(NULL);
}

int main(int argc, char **argv)
{
    suite options;
    if (!suite_options(argc, argv, &options)) {
        return 2;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate(test_random_machines, &options),
        cmocka_unit_test(test_accounts),
        cmocka_unit_test(test_progress),
        cmocka_unit_test(test_free_nothing),
    };
    return cmocka_run_group_tests_name("clocked", tests, NULL, NULL) == 0 ? 0 : 1;
}
