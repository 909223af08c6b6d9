/* frame_buffer.h - the memory controller behind the pixel cache: lines of pixels in the machine's layout, and every
 * byte that moves (Figure 2 of the paper). */
#ifndef VODR_FRAME_BUFFER_H
#define VODR_FRAME_BUFFER_H

#include "layout.h"
#include "vodr.h"

typedef struct frame_buffer {
    fb_layout layout;
    int32_t width_px, height_px, line_pixels, line_bytes, pixel_bytes;
    vodr_rgba *pixels; /* line after line; NULL when only bytes are counted, and then lines are not touched either */
    uint64_t read_bytes, write_bytes;
} frame_buffer;

/* A frame buffer of zeros, or with `picture` false one that only counts. Free with frame_buffer_finish() in either
 * case. */
vodr_status frame_buffer_start(frame_buffer *f, const vodr_machine *m, const vodr_view *view, bool picture,
                               vodr_error *error);

void frame_buffer_read_line(frame_buffer *f, int64_t line, vodr_rgba *pixels);
void frame_buffer_write_line(frame_buffer *f, int64_t line, const vodr_rgba *pixels);

/* Writes `written` of the `count` pixels from `offset` of a line on; the others hold what they held (write-through). */
void frame_buffer_write_pixels(frame_buffer *f, int64_t line, int32_t offset, const vodr_rgba *pixels, int32_t count,
                               int32_t written);

/* Reads out the finished frame: rows top to bottom, fb_bits a channel. `readout` turns a mip pixel's density into its
 * colour; NULL in other blends. */
vodr_status frame_buffer_readout(const frame_buffer *f, const vodr_machine *m, const vodr_rgba *readout,
                                 vodr_frame *frame, vodr_error *error);

void frame_buffer_finish(frame_buffer *f);

#endif
