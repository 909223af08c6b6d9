/* image.h - pictures in files: PNG written from a frame and read back, and a frame's raw bytes. */
#ifndef HOST_IMAGE_H
#define HOST_IMAGE_H

#include "host.h"
#include "output.h"
#include "vodr.h"

/* How a frame's transparency meets the file. */
typedef struct image_style {
    bool alpha;            /* keep it: straight alpha, RGBA; else opaque RGB over the background */
    uint8_t background[3]; /* RGB */
} image_style;

/* Writes a PNG of the frame's own depth (8 or 16 bits). With full = 255 or 65535, every division rounded to nearest,
 * half up: over a background b (b*257 at 16 bits) a channel is min(full, premultiplied + b*(full - a)/full); with alpha
 * it is min(full, premultiplied*full/a), 0 where a = 0. */
host_status image_write_png(output *o, const vodr_frame *frame, const image_style *style, host_error *error);

/* Bytes of a row of --raw. */
size_t image_raw_row_bytes(const vodr_frame *frame);

/* Row y as --raw writes it: premultiplied RGBA, 8 bits, or 16 bits little endian. */
void image_raw_row(const vodr_frame *frame, int32_t y, uint8_t *bytes);

/* Writes all rows, top to bottom. */
host_status image_write_raw(output *o, const vodr_frame *frame, host_error *error);

/* A picture read from a file: straight RGBA, every channel brought to 16 bits (an 8-bit level is 257). */
typedef struct image {
    int32_t width_px, height_px;
    bool has_alpha; /* the file has transparency; else every alpha is 65535 */
    uint16_t *rgba; /* owned: image_free() */
} image;

/* Any bit depth and colour type of PNG; HOST_BAD_INPUT when the file is not a whole, valid PNG. */
host_status image_read_png(const char *path, image *picture, host_error *error);
void image_free(image *picture);

#endif
