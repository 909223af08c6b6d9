/* blend.c - the alpha blender in Verilog, in lock-step with C, of all legal 8-bit operands: every colour at most its
 * alpha with every target, in over and in under. A fragment a cycle, three colours in each; what C makes of them is
 * held against exact division by tests/test_exhaustive.c. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "bench.h"
#include "exhaustive.h"
#include "lockstep.h"
#include "pixel_word.h"

enum { FULL = 255 };

typedef struct blend_bench {
    bench bench;
    lockstep pair;
    alpha_blender_out out;
    colour_port colour;
    door_port door;
    pixel_port pixel;
    vodr_rgba behind[2]; /* pixels of the fragments that wait: for the cache, and for their pixel */
    int64_t cycles;
} blend_bench;

static void open_bench(blend_bench *b, vodr_blend mode)
{
    const rtl_source source = {.root = VODR_ROOT, .build = VODR_BUILD};
    vodr_machine machine;
    vodr_error error;
    block_bench what = bench_alpha_blender;
    what.draw = NULL;
    assert_int_equal(vodr_machine_named("paper-16", &machine, &error), VODR_OK);
    machine.blend = mode;
    *b = (blend_bench){.door.ready = true};
    if (bench_open(&b->bench, &what, &machine, 1, &error) != VODR_OK ||
        lockstep_open(&b->pair, &source, what.block, &b->bench.setup, b->bench.faces, b->bench.reset, &error) !=
            RTL_OK) {
        fail_msg("%s", error.text);
    }
    b->out = b->bench.reset->alpha_blender;
}

/* A fragment is offered while the one before goes and the one before that meets its pixel. */
static void step(blend_bench *b, vodr_rgba source, vodr_rgba target)
{
    const alpha_blender_in in = {.colour = &b->colour, .door = &b->door, .pixel = &b->pixel};
    const alpha_blender_face *face = &b->bench.faces->alpha_blender;
    const vodr_machine *m = &b->bench.machine;
    b->colour = (colour_port){.valid = true, .colour = pixel_word(m, source)};
    b->door.gone = b->cycles >= 1;
    b->pixel = (pixel_port){.valid = b->cycles >= 2, .pixel = pixel_word(m, b->behind[1])};
    face->clock(face->state, &in, &b->out);
    b->behind[1] = b->behind[0];
    b->behind[0] = target;
    b->cycles++;
    const difference *d = &b->pair.first;
    if (d->found) {
        fail_msg("cycle %ld: %s: expected %s, got %s", (long)b->cycles, d->field->name, d->expected, d->got);
    }
}

/* The colours of one side of a blend: three neighbours of those at most alpha. */
static vodr_rgba three(int32_t first, int32_t alpha)
{
    int32_t second = first + 1 < alpha ? first + 1 : alpha, third = first + 2 < alpha ? first + 2 : alpha;
    return (vodr_rgba){(uint16_t)first, (uint16_t)second, (uint16_t)third, (uint16_t)alpha};
}

static void every_blend(vodr_blend mode)
{
    static blend_bench b;
    open_bench(&b, mode);
    for (int32_t alpha = 0; alpha <= FULL; alpha++) {
        for (int32_t first = 0; first <= alpha; first += 3) {
            for (int32_t value = 0; value <= FULL; value++) {
                const vodr_rgba front = three(first, alpha);
                const vodr_rgba other = {(uint16_t)value, (uint16_t)value, (uint16_t)value, FULL};
                step(&b, mode == VODR_BLEND_OVER ? front : other, mode == VODR_BLEND_OVER ? other : front);
            }
        }
    }
    for (int32_t rest = 0; rest <= b.bench.machine.blend_cycles; rest++) {
        step(&b, (vodr_rgba){0, 0, 0, 0}, (vodr_rgba){0, 0, 0, 0});
    }
    lockstep_close(&b.pair, b.bench.faces);
    bench_close(&b.bench);
}

void lockstep_blend(void **state)
{
    (void)state;
    every_blend(VODR_BLEND_OVER);
    every_blend(VODR_BLEND_UNDER);
}
