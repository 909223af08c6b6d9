/* test_spline.c - coefficients of a B-spline in integers against their definition (docs/architecture.md, section 11):
 * the spline through them meets the densities, a constant stays one, thin volumes have splines too, and what 16 bits do
 * not hold is cut. */
#include "spline.h"

#include <math.h>
#include <string.h>

#include "lib/unit.h"
#include "rng.h"

enum { MOST = 20 };

static int64_t clamped(int64_t i, int64_t size)
{
    return i < 0 ? 0 : i >= size ? size - 1 : i;
}

/* The spline's value at a voxel's centre, in coefficients' units. */
static double spline_at(const vodr_volume *v, const int16_t *coefficients, const int32_t at[3])
{
    static const double weight[3] = {1.0 / 6, 4.0 / 6, 1.0 / 6};
    const int32_t *n = v->dims_vox;
    double sum = 0;
    for (int i = 0; i < 27; i++) {
        int64_t x = clamped(at[0] + i % 3 - 1, n[0]), y = clamped(at[1] + i / 3 % 3 - 1, n[1]);
        int64_t z = clamped(at[2] + i / 9 - 1, n[2]);
        sum += weight[i % 3] * weight[i / 3 % 3] * weight[i / 9] * coefficients[(z * n[1] + y) * n[0] + x];
    }
    return sum;
}

/* Each coefficient is rounded by half a unit at most, and the way there loses less than a hundredth. */
static void check_spline(const vodr_volume *v, int32_t density_bits, const uint16_t *densities)
{
    static int16_t coefficients[MOST * MOST * MOST];
    const double unit = density_bits == 8 ? 8 : 1;
    host_error error;
    assert_int_equal(spline_coefficients(v, density_bits, coefficients, &error), HOST_OK);
    size_t i = 0;
    for (int32_t z = 0; z < v->dims_vox[2]; z++)
        for (int32_t y = 0; y < v->dims_vox[1]; y++)
            for (int32_t x = 0; x < v->dims_vox[0]; x++, i++)
                assert_true(fabs(spline_at(v, coefficients, (int32_t[3]){x, y, z}) - unit * densities[i]) < 0.51);
}

static void the_spline_meets_the_densities(void **state)
{
    (void)state;
    static uint16_t words[MOST * MOST * MOST], densities[MOST * MOST * MOST];
    static uint8_t bytes[MOST * MOST * MOST];
    uint16_t map[256];
    rng r = {51};
    for (int round = 0; round < 400; round++) {
        const int32_t bits = rng_one_in(&r, 2) ? 8 : 12, most = (1 << bits) - 1;
        vodr_volume v = {.voxel_bytes = rng_one_in(&r, 2) ? 1 : 2};
        v.voxels = v.voxel_bytes == 1 ? (const void *)bytes : words;
        v.map = v.voxel_bytes == 1 && (bits == 12 || rng_one_in(&r, 2)) ? map : NULL;
        const bool noise = bits == 8 || rng_one_in(&r, 3);
        for (int i = 0; i < 256; i++)
            map[i] = (uint16_t)(noise && bits == 8 ? rng_int(&r, 0, most) : most * i / 255);
        for (int c = 0; c < 3; c++)
            v.dims_vox[c] = (int32_t)rng_int(&r, 1, rng_one_in(&r, 4) ? 3 : MOST);
        for (size_t i = 0; i < MOST * MOST * MOST; i++) { /* 12 bits: within what 16 hold */
            const int64_t top = bits == 8 ? most + 20 : 2000;
            words[i] = (uint16_t)(rng_one_in(&r, 3) ? rng_int(&r, 0, 1) * top : rng_int(&r, 0, top));
            bytes[i] = (uint8_t)(bits == 8 ? rng_next(&r) : (uint64_t)rng_int(&r, 0, 120));
            const uint16_t word = words[i] > most ? (uint16_t)most : words[i];
            densities[i] = v.voxel_bytes == 2 ? word : v.map ? map[bytes[i]] : bytes[i];
        }
        check_spline(&v, bits, densities);
    }
}

static void constants_are_exact(void **state)
{
    (void)state;
    static uint16_t words[MOST * 3 * 2];
    static int16_t coefficients[MOST * 3 * 2];
    host_error error;
    for (int32_t bits = 8; bits <= 12; bits += 4)
        for (int32_t value = 0; value < 1 << bits; value += bits == 8 ? 1 : 13) {
            const vodr_volume v = {.dims_vox = {MOST, 3, 2}, .voxel_bytes = 2, .voxels = words};
            for (int i = 0; i < MOST * 3 * 2; i++)
                words[i] = (uint16_t)value;
            assert_int_equal(spline_coefficients(&v, bits, coefficients, &error), HOST_OK);
            for (int i = 0; i < MOST * 3 * 2; i++)
                assert_int_equal(coefficients[i], bits == 8 ? 8 * value : value);
        }
}

/* What makes most of the filter along every axis: 14 and -13 times the range. 8 bits have room for it. */
static void the_worst_is_cut_to_16_bits(void **state)
{
    (void)state;
    static uint16_t words[MOST * MOST * MOST];
    static int16_t coefficients[MOST * MOST * MOST];
    host_error error;
    const vodr_volume v = {.dims_vox = {MOST, MOST, MOST}, .voxel_bytes = 2, .voxels = words};
    for (int32_t bits = 8; bits <= 12; bits += 4) {
        for (int i = 0; i < MOST * MOST * MOST; i++)
            words[i] = (i + i / MOST + i / MOST / MOST) % 2 ? 4095 : 0;
        assert_int_equal(spline_coefficients(&v, bits, coefficients, &error), HOST_OK);
        int32_t least = 0, most = 0;
        for (int i = 0; i < MOST * MOST * MOST; i++) {
            least = coefficients[i] < least ? coefficients[i] : least;
            most = coefficients[i] > most ? coefficients[i] : most;
        }
        if (bits == 12) {
            assert_int_equal(least, -32768);
            assert_int_equal(most, 32767);
        } else {
            assert_in_range(most, 13 * 255 * 8, 14 * 255 * 8);
            assert_in_range(-least, 12 * 255 * 8, 13 * 255 * 8);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_spline_meets_the_densities),
        cmocka_unit_test(constants_are_exact),
        cmocka_unit_test(the_worst_is_cut_to_16_bits),
    };
    return cmocka_run_group_tests_name("spline", tests, NULL, NULL);
}
