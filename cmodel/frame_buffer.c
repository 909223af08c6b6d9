#include "frame_buffer.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"

vodr_status frame_buffer_start(frame_buffer *f, const vodr_machine *m, const vodr_view *view, bool picture,
                               vodr_error *error)
{
    *f = (frame_buffer){.layout = fb_layout_of(m, view->width_px, view->height_px),
                        .width_px = view->width_px,
                        .height_px = view->height_px,
                        .line_pixels = line_pixels(m),
                        .line_bytes = line_bytes(m),
                        .pixel_bytes = pixel_bytes(m)};
    if (!picture)
        return VODR_OK;
    f->pixels = calloc((size_t)f->layout.lines * (size_t)f->line_pixels, sizeof *f->pixels);
    if (!f->pixels)
        return vodr_fail(error, VODR_NO_MEMORY, "no memory for a frame buffer of %" PRId32 "x%" PRId32 " pixels",
                         view->width_px, view->height_px);
    return VODR_OK;
}

static vodr_rgba *line_at(const frame_buffer *f, int64_t line)
{
    return f->pixels + (size_t)line * (size_t)f->line_pixels;
}

void frame_buffer_read_line(frame_buffer *f, int64_t line, vodr_rgba *pixels)
{
    if (f->pixels)
        memcpy(pixels, line_at(f, line), (size_t)f->line_pixels * sizeof *pixels);
    f->read_bytes += (uint64_t)f->line_bytes;
}

void frame_buffer_write_line(frame_buffer *f, int64_t line, const vodr_rgba *pixels)
{
    if (f->pixels)
        memcpy(line_at(f, line), pixels, (size_t)f->line_pixels * sizeof *pixels);
    f->write_bytes += (uint64_t)f->line_bytes;
}

void frame_buffer_write_pixels(frame_buffer *f, int64_t line, int32_t offset, const vodr_rgba *pixels, int32_t count,
                               int32_t written)
{
    if (f->pixels)
        memcpy(line_at(f, line) + offset, pixels, (size_t)count * sizeof *pixels);
    f->write_bytes += (uint64_t)written * (uint64_t)f->pixel_bytes;
}

vodr_status frame_buffer_readout(const frame_buffer *f, const vodr_machine *m, const vodr_rgba *readout,
                                 vodr_frame *frame, vodr_error *error)
{
    size_t pixels = (size_t)f->width_px * (size_t)f->height_px;
    size_t bytes = pixels * (size_t)f->pixel_bytes;
    void *made = malloc(bytes);
    if (!made)
        return vodr_fail(error, VODR_NO_MEMORY, "no memory for a frame of %zu bytes", bytes);
    *frame = (vodr_frame){
        .width_px = f->width_px, .height_px = f->height_px, .bits = m->fb_bits, .pixels = made, .bytes = bytes};
    uint8_t *out8 = frame->pixels;
    uint16_t *out16 = frame->pixels;
    for (int32_t y = 0; y < f->height_px; y++)
        for (int32_t x = 0; x < f->width_px; x++) {
            vodr_rgba p = line_at(f, line_number(&f->layout, x, y))[line_offset(&f->layout, x, y)];
            if (readout)
                p = p.a ? readout[p.r] : (vodr_rgba){0};
            const uint16_t channels[4] = {p.r, p.g, p.b, p.a};
            for (int c = 0; c < 4; c++) {
                if (m->fb_bits == 16)
                    *out16++ = channels[c];
                else
                    *out8++ = (uint8_t)channels[c];
            }
        }
    return VODR_OK;
}

void frame_buffer_finish(frame_buffer *f)
{
    free(f->pixels);
    *f = (frame_buffer){0};
}
