/* test_exhaustive.c - arithmetic of the blocks in C on all its 8-bit operands, against formulas that share nothing with
 * it: exact division for the blends (docs/architecture.md, section 7), a weighted mean for the interpolation (section
 * 6). The same in Verilog: tests/lockstep/blend.c and lerp.c. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "alpha_blender.h"
#include "texture_unit.h"

enum { FULL = 255, VALUES = 256 };

static alpha_blender blender(vodr_blend mode)
{
    vodr_machine m = vodr_machine_default();
    m.blend = mode;
    return alpha_blender_of(&m);
}

/* u*v/255 to nearest; there are no ties. */
static int32_t of_full(int32_t u, int32_t v)
{
    return (2 * u * v + FULL) / (2 * FULL);
}

/* Every colour at most its alpha, over every target; each channel by itself has the operands of all. */
static void every_over(void **state)
{
    (void)state;
    const alpha_blender over = blender(VODR_BLEND_OVER);
    for (int32_t a = 0; a <= FULL; a++)
        for (int32_t s = 0; s <= a; s++) {
            vodr_rgba source[VALUES], pixel[VALUES];
            uint64_t terminated = 0;
            for (int32_t t = 0; t < VALUES; t++) {
                source[t] = (vodr_rgba){(uint16_t)s, (uint16_t)(a - s), (uint16_t)s, (uint16_t)a};
                pixel[t] = (vodr_rgba){(uint16_t)t, (uint16_t)t, (uint16_t)(FULL - t), (uint16_t)t};
            }
            assert_int_equal(alpha_blender_run(&over, source, VALUES, pixel, &terminated), VALUES);
            for (int32_t t = 0; t < VALUES; t++)
                if (pixel[t].r != s + of_full(t, FULL - a) || pixel[t].g != a - s + of_full(t, FULL - a) ||
                    pixel[t].b != s + of_full(FULL - t, FULL - a) || pixel[t].a != a + of_full(t, FULL - a))
                    fail_msg("over: colour %d of alpha %d on %d gives %d,%d,%d,%d", s, a, t, pixel[t].r, pixel[t].g,
                             pixel[t].b, pixel[t].a);
        }
}

/* Every pixel's colour at most its alpha, under it every colour. */
static void every_under(void **state)
{
    (void)state;
    const alpha_blender under = blender(VODR_BLEND_UNDER);
    for (int32_t a = 0; a <= FULL; a++)
        for (int32_t t = 0; t <= a; t++) {
            vodr_rgba source[VALUES], pixel[VALUES];
            uint64_t terminated = 0;
            for (int32_t s = 0; s < VALUES; s++) {
                source[s] = (vodr_rgba){(uint16_t)s, (uint16_t)s, (uint16_t)(FULL - s), FULL};
                pixel[s] = (vodr_rgba){(uint16_t)t, (uint16_t)(a - t), (uint16_t)t, (uint16_t)a};
            }
            int32_t written = a == FULL ? 0 : VALUES, through = a == FULL ? 0 : FULL - a;
            assert_int_equal(alpha_blender_run(&under, source, VALUES, pixel, &terminated), written);
            assert_int_equal(terminated, VALUES - written);
            for (int32_t s = 0; s < VALUES; s++)
                if (pixel[s].r != t + of_full(s, through) || pixel[s].g != a - t + of_full(s, through) ||
                    pixel[s].b != t + of_full(FULL - s, through) || pixel[s].a != a + of_full(FULL, through))
                    fail_msg("under: %d of alpha %d with %d behind gives %d,%d,%d,%d", t, a, s, pixel[s].r, pixel[s].g,
                             pixel[s].b, pixel[s].a);
        }
}

/* Every pair of densities with every weight of 8 bits, alone and with guard bits: a row of samples between two voxels.
 */
static void every_interpolation(void **state)
{
    uint8_t voxels[2];
    const vodr_volume volume = {.dims_vox = {2, 1, 1}, .voxel_bytes = 1, .voxels = voxels};
    const vodr_view view = {.base = {0}};
    const brick_slice slice = {.plane = {.origin = {1 << 23, 1 << 23, 1 << 23}, .step_u = {1 << 16}}};
    const span row = {.x1 = VALUES};
    vodr_rgba entries[VALUES] = {{0}};
    const vodr_table table = {entries, VALUES};
    (void)state;
    for (int guard = 0; guard <= 6; guard += 3) {
        vodr_machine m = vodr_machine_default();
        texture_unit unit;
        m.traversal = VODR_TRAVERSAL_WHOLE;
        m.guard_bits = guard;
        assert_int_equal(texture_unit_start(&unit, &m, &volume, &table, &view, NULL), VODR_OK);
        for (int32_t pair = 0; pair < VALUES * VALUES; pair++) {
            uint16_t got[VALUES];
            voxels[0] = (uint8_t)pair;
            voxels[1] = (uint8_t)(pair / VALUES);
            texture_unit_filter(&unit, &slice, &row, got);
            for (int32_t w = 0; w < VALUES; w++) {
                /* A mean in 1/256 of a density, cut to the guard bits, and those to nearest. */
                int32_t mean = voxels[0] * (VALUES - w) + voxels[1] * w, kept = mean >> (8 - guard);
                int32_t want = (kept + (1 << guard) / 2) >> guard;
                if (got[w] != want)
                    fail_msg("%d guard bits: %d/256 from %d to %d is %d, not %d", guard, w, voxels[0], voxels[1],
                             got[w], want);
            }
        }
        texture_unit_finish(&unit);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_over), cmocka_unit_test(every_under),
                                       cmocka_unit_test(every_interpolation)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
