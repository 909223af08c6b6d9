/* test_frame_buffer.c - line numbers, bytes and read-out (docs/architecture.md, sections 7 and 8). */
#include <string.h>

#include "frame_buffer.h"
#include "lib/unit.h"

static vodr_machine random_machine(rng *c)
{
    vodr_machine m = vodr_machine_default();
    m.line_px = (vodr_shape){1 << rng_int(c, 0, 5), 1 << rng_int(c, 0, 5)};
    m.fb_layout = rng_one_in(c, 2) ? VODR_FB_LAYOUT_LINEAR : VODR_FB_LAYOUT_TILED;
    m.fb_bits = rng_one_in(c, 2) ? 16 : 8;
    return m;
}

static vodr_view random_size(rng *c)
{
    return (vodr_view){.width_px = (int32_t)rng_int(c, 1, 140), .height_px = (int32_t)rng_int(c, 1, 100)};
}

static int64_t up(int64_t a, int64_t b)
{
    return a % b ? a / b + 1 : a / b;
}

/* The page's formula, as it stands there. */
static int64_t plain_number(const vodr_machine *m, int32_t width_px, int32_t x, int32_t y)
{
    int64_t w = m->line_px.width, h = m->line_px.height;
    if (m->fb_layout == VODR_FB_LAYOUT_LINEAR)
        return (y / h) * up(width_px, w) + x / w;
    int64_t tile = (int64_t)(y / 32) * up(width_px, 32) + x / 32;
    return tile * (32 / w) * (32 / h) + (y % 32 / h) * (32 / w) + x % 32 / w;
}

static void each_pixel_has_a_place_of_its_own(void **state)
{
    (void)state;
    rng c = {21};
    for (int round = 0; round < 300; round++) {
        vodr_machine m = random_machine(&c);
        vodr_view v = random_size(&c);
        frame_buffer f;
        assert_int_equal(frame_buffer_start(&f, &m, &v, true, NULL), VODR_OK);
        assert_int_equal(f.line_bytes, m.line_px.width * m.line_px.height * m.fb_bits / 2);
        for (int32_t y = 0; y < v.height_px; y++)
            for (int32_t x = 0; x < v.width_px; x++) {
                int64_t line = line_number(&f.layout, x, y);
                int32_t offset = line_offset(&f.layout, x, y);
                assert_int_equal(line, plain_number(&m, v.width_px, x, y));
                assert_int_equal(offset, y % m.line_px.height * m.line_px.width + x % m.line_px.width);
                assert_true(line >= 0 && line < f.layout.lines && offset < f.line_pixels);
                vodr_rgba *pixel = &f.pixels[line * f.line_pixels + offset];
                assert_int_equal(pixel->a, 0); /* nobody's yet */
                pixel->a = 1;
            }
        frame_buffer_finish(&f);
    }
}

/* 8-bit frames hold bytes, 16-bit ones native words. */
static uint16_t channel(const vodr_frame *frame, size_t i)
{
    return frame->bits == 16 ? ((const uint16_t *)frame->pixels)[i] : ((const uint8_t *)frame->pixels)[i];
}

static void fill(frame_buffer *f, rng *c, uint16_t most)
{
    for (int64_t i = 0; i < f->layout.lines * f->line_pixels; i++)
        f->pixels[i] = (vodr_rgba){(uint16_t)rng_int(c, 0, most), (uint16_t)rng_int(c, 0, most),
                                   (uint16_t)rng_int(c, 0, most), (uint16_t)rng_int(c, 0, most)};
}

static void the_frame_comes_out_row_by_row(void **state)
{
    (void)state;
    rng c = {22};
    for (int round = 0; round < 200; round++) {
        vodr_machine m = random_machine(&c);
        vodr_view v = random_size(&c);
        frame_buffer f;
        vodr_frame frame;
        assert_int_equal(frame_buffer_start(&f, &m, &v, true, NULL), VODR_OK);
        fill(&f, &c, m.fb_bits == 16 ? 65535 : 255);
        assert_int_equal(frame_buffer_readout(&f, &m, NULL, &frame, NULL), VODR_OK);
        assert_int_equal(frame.bits, m.fb_bits);
        assert_int_equal(frame.bytes, (size_t)v.width_px * (size_t)v.height_px * 4 * (size_t)m.fb_bits / 8);
        size_t i = 0;
        for (int32_t y = 0; y < v.height_px; y++)
            for (int32_t x = 0; x < v.width_px; x++, i += 4) {
                const vodr_rgba *p =
                    &f.pixels[plain_number(&m, v.width_px, x, y) * f.line_pixels + line_offset(&f.layout, x, y)];
                assert_true(channel(&frame, i) == p->r && channel(&frame, i + 1) == p->g &&
                            channel(&frame, i + 2) == p->b && channel(&frame, i + 3) == p->a);
            }
        assert_int_equal(f.read_bytes, 0); /* the read-out is not counted */
        vodr_frame_free(&frame);
        frame_buffer_finish(&f);
    }
}

static void maximum_is_classified_at_the_end(void **state)
{
    (void)state;
    vodr_machine m = unit_machine("blend=mip line_px=4x4");
    vodr_view v = {.width_px = 5, .height_px = 3};
    vodr_rgba table[256];
    for (int i = 0; i < 256; i++)
        table[i] = (vodr_rgba){1, 2, 3, (uint16_t)(255 - i)};
    frame_buffer f;
    vodr_frame frame;
    assert_int_equal(frame_buffer_start(&f, &m, &v, true, NULL), VODR_OK);
    f.pixels[line_number(&f.layout, 4, 2) * 16 + line_offset(&f.layout, 4, 2)] = (vodr_rgba){.r = 0, .a = 1};
    f.pixels[line_number(&f.layout, 1, 1) * 16 + line_offset(&f.layout, 1, 1)] = (vodr_rgba){.r = 200, .a = 1};
    assert_int_equal(frame_buffer_readout(&f, &m, table, &frame, NULL), VODR_OK);
    for (size_t i = 0; i < 15; i++) {
        bool written = i == 14 || i == 6;
        assert_int_equal(channel(&frame, 4 * i), written ? 1 : 0);
        assert_int_equal(channel(&frame, 4 * i + 3), i == 14 ? 255 : i == 6 ? 55 : 0);
    }
    vodr_frame_free(&frame);
    frame_buffer_finish(&f);
}

static void every_byte_is_counted(void **state)
{
    (void)state;
    rng c = {23};
    vodr_rgba line[32 * 32], back[32 * 32];
    for (int round = 0; round < 200; round++) {
        vodr_machine m = random_machine(&c);
        vodr_view v = random_size(&c);
        frame_buffer f;
        assert_int_equal(frame_buffer_start(&f, &m, &v, true, NULL), VODR_OK);
        for (int32_t i = 0; i < f.line_pixels; i++)
            line[i] = (vodr_rgba){(uint16_t)rng_next(&c), 2, 3, (uint16_t)i};
        int64_t n = rng_int(&c, 0, f.layout.lines - 1);
        frame_buffer_write_line(&f, n, line);
        int32_t offset = (int32_t)rng_int(&c, 0, f.line_pixels - 1);
        int32_t count = (int32_t)rng_int(&c, 1, f.line_pixels - offset);
        int32_t written = (int32_t)rng_int(&c, 1, count);
        line[offset].g = 77;
        frame_buffer_write_pixels(&f, n, offset, line + offset, count, written);
        frame_buffer_read_line(&f, n, back);
        assert_memory_equal(line, back, (size_t)f.line_pixels * sizeof *line);
        assert_int_equal(f.read_bytes, f.line_bytes);
        assert_int_equal(f.write_bytes, f.line_bytes + written * m.fb_bits / 2);
        frame_buffer counter;
        assert_int_equal(frame_buffer_start(&counter, &m, &v, false, NULL), VODR_OK);
        frame_buffer_write_line(&counter, n, NULL);
        frame_buffer_write_pixels(&counter, n, offset, NULL, count, written);
        frame_buffer_read_line(&counter, n, NULL);
        assert_int_equal(f.read_bytes, counter.read_bytes);
        assert_int_equal(f.write_bytes, counter.write_bytes);
        frame_buffer_finish(&counter);
        frame_buffer_finish(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_pixel_has_a_place_of_its_own),
        cmocka_unit_test(the_frame_comes_out_row_by_row),
        cmocka_unit_test(maximum_is_classified_at_the_end),
        cmocka_unit_test(every_byte_is_counted),
    };
    return cmocka_run_group_tests_name("frame_buffer", tests, NULL, NULL);
}
