/* test_compare.c - the figures of `vodr compare` on pictures whose differences are known. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "difference.h"

/* A picture of one grey level (8 bits), opaque. */
static image grey(int32_t width_px, int32_t height_px, int level)
{
    size_t pixels = (size_t)width_px * (size_t)height_px;
    image p = {width_px, height_px, false, malloc(pixels * 8)};
    for (size_t i = 0; i < 4 * pixels; i++)
        p.rgba[i] = (uint16_t)(i % 4 == 3 ? 65535 : level * 257);
    return p;
}

static image noise(int32_t width_px, int32_t height_px, uint32_t seed)
{
    image p = grey(width_px, height_px, 0);
    for (size_t i = 0; i < (size_t)width_px * (size_t)height_px; i++) {
        seed = seed * 1664525 + 1013904223;
        for (size_t c = 0; c < 3; c++)
            p.rgba[4 * i + c] = (uint16_t)((seed >> 24) * 257);
    }
    return p;
}

static difference measure(image *a, image *b)
{
    difference d;
    assert_int_equal(difference_measure(a, b, &d, NULL), HOST_OK);
    image_free(a);
    image_free(b);
    return d;
}

static void test_equal(void **state)
{
    (void)state;
    static const int32_t sizes[][2] = {{1, 1}, {3, 40}, {40, 10}, {11, 11}, {33, 31}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        image a = noise(sizes[i][0], sizes[i][1], 7), b = noise(sizes[i][0], sizes[i][1], 7);
        difference d = measure(&a, &b);
        assert_true(d.equal && d.max_error == 0 && d.rmse == 0 && isinf(d.psnr_db));
        assert_true(fabs(d.ssim - 1) < 1e-12);
        assert_int_equal(d.first_x, -1);
    }
}

static void test_one_channel(void **state)
{
    (void)state;
    image a = grey(20, 16, 100), b = grey(20, 16, 100);
    b.rgba[4 * (5 * 20 + 3) + 1] = 110 * 257;
    b.rgba[4 * (9 * 20 + 1) + 2] = 98 * 257;
    difference d = measure(&a, &b);
    assert_false(d.equal);
    assert_true(d.max_error == 10);
    assert_true(fabs(d.rmse - sqrt(104.0 / (3 * 320))) < 1e-12);
    assert_true(fabs(d.psnr_db - 20 * log10(255 / d.rmse)) < 1e-9);
    assert_int_equal(d.first_x, 3);
    assert_int_equal(d.first_y, 5);
    assert_string_equal(d.first_channel, "g");
    assert_true(d.first_a == 100 && d.first_b == 110);
}

static void test_fractions_of_a_level(void **state)
{
    (void)state;
    image a = grey(12, 12, 100), b = grey(12, 12, 100);
    b.rgba[0] += 1;
    difference d = measure(&a, &b);
    assert_true(d.max_error == 1.0 / 257);
}

/* Alpha counts, as a fourth channel, as soon as one of the pictures has it. */
static void test_alpha(void **state)
{
    (void)state;
    image a = grey(12, 12, 100), b = grey(12, 12, 100);
    b.has_alpha = true;
    for (size_t i = 0; i < 144; i++)
        b.rgba[4 * i + 3] = 251 * 257;
    difference d = measure(&a, &b);
    assert_string_equal(d.first_channel, "a");
    assert_true(d.max_error == 4);
    assert_true(fabs(d.rmse - 2) < 1e-12);
}

/* Of flat pictures only the luminance term is left: (2ab + C1)/(a^2 + b^2 + C1). */
static void test_ssim_flat(void **state)
{
    (void)state;
    image a = grey(32, 32, 100), b = grey(32, 32, 150);
    difference d = measure(&a, &b);
    double c1 = 2.55 * 2.55;
    assert_true(fabs(d.ssim - (2 * 100.0 * 150 + c1) / (100.0 * 100 + 150.0 * 150 + c1)) < 1e-9);
}

/* A window by hand, without separating it: a picture of 11x11 has exactly one. */
static void test_ssim_one_window(void **state)
{
    (void)state;
    image a = noise(11, 11, 1), b = noise(11, 11, 2);
    double sum = 0, m[5] = {0};
    for (int i = 0; i < 121; i++) {
        double x = i % 11 - 5, y = i / 11 - 5, w = exp(-(x * x + y * y) / 4.5);
        double la = a.rgba[4 * i] / 257.0, lb = b.rgba[4 * i] / 257.0;
        const double term[5] = {la, lb, la * la, lb * lb, la * lb};
        sum += w;
        for (int k = 0; k < 5; k++)
            m[k] += w * term[k];
    }
    for (int k = 0; k < 5; k++)
        m[k] /= sum;
    double c1 = 6.5025, c2 = 58.5225;
    double expected = (2 * m[0] * m[1] + c1) * (2 * (m[4] - m[0] * m[1]) + c2) /
                      ((m[0] * m[0] + m[1] * m[1] + c1) * (m[2] - m[0] * m[0] + m[3] - m[1] * m[1] + c2));
    difference d = measure(&a, &b);
    assert_true(fabs(d.ssim - expected) < 1e-9);
    assert_true(d.ssim < 0.5);
}

static void test_picture(void **state)
{
    (void)state;
    image a = grey(3, 1, 100), b = grey(3, 1, 100);
    b.rgba[0] = 104 * 257;
    b.rgba[4 + 1] = 98 * 257;
    vodr_frame frame;
    assert_int_equal(difference_picture(&a, &b, &frame, NULL), HOST_OK);
    const uint8_t expected[] = {255, 0, 0, 255, 0, 128, 0, 255, 0, 0, 0, 255};
    assert_int_equal(frame.bytes, sizeof expected);
    assert_memory_equal(frame.pixels, expected, sizeof expected);
    free(frame.pixels);
    image_free(&a);
    image_free(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_equal),     cmocka_unit_test(test_one_channel),
        cmocka_unit_test(test_alpha),     cmocka_unit_test(test_fractions_of_a_level),
        cmocka_unit_test(test_ssim_flat), cmocka_unit_test(test_ssim_one_window),
        cmocka_unit_test(test_picture),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
