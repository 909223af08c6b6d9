/* image.c - pictures in files: PNG written from a frame and read back (libpng), and a frame's raw bytes. */
#include "image.h"

#include <errno.h>
#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { MAX_DEFLATE_RATIO = 1100 };

/* Channel c of pixel x of a row of a frame. */
static uint32_t channel_at(const void *row, int bits, size_t x, int c)
{
    return bits == 16 ? ((const uint16_t *)row)[4 * x + (size_t)c] : ((const uint8_t *)row)[4 * x + (size_t)c];
}

static const void *frame_row(const vodr_frame *frame, int32_t y)
{
    return (const uint8_t *)frame->pixels + (size_t)y * (size_t)frame->width_px * (frame->bits == 16 ? 8 : 4);
}

/* Stores a channel in PNG's (big endian) or --raw's (little endian) order; returns what follows it. */
static uint8_t *put_channel(uint8_t *bytes, int bits, bool big_endian, uint32_t value)
{
    if (bits == 8) {
        *bytes = (uint8_t)value;
        return bytes + 1;
    }
    bytes[big_endian ? 0 : 1] = (uint8_t)(value >> 8);
    bytes[big_endian ? 1 : 0] = (uint8_t)value;
    return bytes + 2;
}

/* n/d rounded to nearest, half up, at most `full`. */
static uint32_t divide(uint64_t n, uint32_t d, uint32_t full)
{
    uint64_t quotient = (2 * n + d) / (2 * (uint64_t)d);
    return quotient < full ? (uint32_t)quotient : full;
}

static void png_row(const vodr_frame *frame, int32_t y, const image_style *style, uint8_t *bytes)
{
    const void *row = frame_row(frame, y);
    const uint32_t full = frame->bits == 16 ? 65535 : 255;
    for (size_t x = 0; x < (size_t)frame->width_px; x++) {
        uint32_t a = channel_at(row, frame->bits, x, 3);
        for (int c = 0; c < 3; c++) {
            uint64_t colour = channel_at(row, frame->bits, x, c);
            uint32_t value;
            if (style->alpha)
                value = a ? divide(colour * full, a, full) : 0;
            else
                value = divide(colour * full + (uint64_t)style->background[c] * (full / 255) * (full - a), full, full);
            bytes = put_channel(bytes, frame->bits, true, value);
        }
        if (style->alpha)
            bytes = put_channel(bytes, frame->bits, true, a);
    }
}

/* libpng's errors come here; the jump goes back to the function that set it. */
static void on_error(png_structp png, png_const_charp message)
{
    snprintf(png_get_error_ptr(png), 128, "%s", message);
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
    (void)png, (void)message;
}

/* Runs between png_create and png_destroy: every local that outlives a jump is set before it. */
static bool write_rows(png_structp png, png_infop info, FILE *file, const vodr_frame *frame, const image_style *style,
                       uint8_t *row)
{
    if (setjmp(png_jmpbuf(png)))
        return false;
    png_init_io(png, file);
    png_set_user_limits(png, VODR_MAX_SIZE_PX, VODR_MAX_SIZE_PX);
    png_set_IHDR(png, info, (png_uint_32)frame->width_px, (png_uint_32)frame->height_px, frame->bits,
                 style->alpha ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    for (int32_t y = 0; y < frame->height_px; y++) {
        png_row(frame, y, style, row);
        png_write_row(png, row);
    }
    png_write_end(png, info);
    return true;
}

host_status image_write_png(output *o, const vodr_frame *frame, const image_style *style, host_error *error)
{
    char message[128] = "no memory";
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, message, on_error, on_warning);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    uint8_t *row = malloc((size_t)frame->width_px * 8);
    bool ok = info && row && write_rows(png, info, o->file, frame, style, row);
    int code = errno;
    free(row);
    png_destroy_write_struct(&png, &info);
    if (ok)
        return HOST_OK;
    return host_fail(error, HOST_ENVIRONMENT, "cannot write '%s': %s", o->path,
                     ferror(o->file) ? strerror(code) : message);
}

size_t image_raw_row_bytes(const vodr_frame *frame)
{
    return (size_t)frame->width_px * (frame->bits == 16 ? 8 : 4);
}

void image_raw_row(const vodr_frame *frame, int32_t y, uint8_t *bytes)
{
    const void *row = frame_row(frame, y);
    for (size_t x = 0; x < (size_t)frame->width_px; x++)
        for (int c = 0; c < 4; c++)
            bytes = put_channel(bytes, frame->bits, false, channel_at(row, frame->bits, x, c));
}

host_status image_write_raw(output *o, const vodr_frame *frame, host_error *error)
{
    size_t row_bytes = image_raw_row_bytes(frame);
    uint8_t *row = malloc(row_bytes);
    if (!row)
        return host_fail(error, HOST_ENVIRONMENT, "no memory to write '%s'", o->path);
    bool ok = true;
    for (int32_t y = 0; ok && y < frame->height_px; y++) {
        image_raw_row(frame, y, row);
        ok = fwrite(row, 1, row_bytes, o->file) == row_bytes;
    }
    int code = errno;
    free(row);
    return ok ? HOST_OK : host_fail(error, HOST_ENVIRONMENT, "cannot write '%s': %s", o->path, strerror(code));
}

/* Has libpng deliver straight RGBA of 8 or 16 bits whatever the file holds. Returns whether it has transparency. */
static bool expand_to_rgba(png_structp png, png_infop info)
{
    bool has_alpha =
        (png_get_color_type(png, info) & PNG_COLOR_MASK_ALPHA) != 0 || png_get_valid(png, info, PNG_INFO_tRNS) != 0;
    png_set_expand(png);
    png_set_gray_to_rgb(png);
    png_set_add_alpha(png, 0xffff, PNG_FILLER_AFTER);
    png_set_interlace_handling(png);
    png_read_update_info(png, info);
    return has_alpha;
}

/* Whether the file can hold the picture that its header names, before memory is taken: deflate cannot shrink data more
 * than 1032 times. Of a pipe nobody knows. */
static bool can_hold(png_structp png, png_infop info, FILE *file)
{
    struct stat status;
    uint64_t need = (uint64_t)png_get_rowbytes(png, info) * png_get_image_height(png, info);
    return fstat(fileno(file), &status) == 0 &&
           (!S_ISREG(status.st_mode) || need / MAX_DEFLATE_RATIO <= (uint64_t)status.st_size);
}

/* What reading holds, so that nothing is lost in a jump. */
typedef struct reader {
    png_structp png;
    png_infop info;
    uint8_t *bytes;
    uint8_t **rows;
    char message[128];
} reader;

static bool read_rows(reader *r, FILE *file, image *picture)
{
    if (setjmp(png_jmpbuf(r->png)))
        return false;
    png_init_io(r->png, file);
    /* Pixels, palette and transparency count; other chunks would be read whole, however long they say they are. */
    png_set_keep_unknown_chunks(r->png, PNG_HANDLE_CHUNK_NEVER, NULL, -1);
    png_read_info(r->png, r->info);
    png_uint_32 width = png_get_image_width(r->png, r->info), height = png_get_image_height(r->png, r->info);
    if (width > INT16_MAX || height > INT16_MAX)
        png_error(r->png, "it is more than 32767 pixels wide or high");
    if (!can_hold(r->png, r->info, file))
        png_error(r->png, "its file is too short for the size that its header names");
    picture->has_alpha = expand_to_rgba(r->png, r->info);
    size_t row_bytes = png_get_rowbytes(r->png, r->info);
    r->bytes = malloc(row_bytes * height);
    r->rows = malloc(sizeof *r->rows * height);
    picture->rgba = malloc(sizeof *picture->rgba * 4 * width * height);
    if (!r->bytes || !r->rows || !picture->rgba)
        png_error(r->png, "no memory");
    for (png_uint_32 y = 0; y < height; y++)
        r->rows[y] = r->bytes + y * row_bytes;
    png_read_image(r->png, r->rows);
    png_read_end(r->png, NULL);
    size_t count = 4 * (size_t)width * height;
    bool wide = png_get_bit_depth(r->png, r->info) == 16;
    for (size_t i = 0; i < count; i++)
        picture->rgba[i] = (uint16_t)(wide ? r->bytes[2 * i] << 8 | r->bytes[2 * i + 1] : r->bytes[i] * 257);
    picture->width_px = (int32_t)width;
    picture->height_px = (int32_t)height;
    return true;
}

host_status image_read_png(const char *path, image *picture, host_error *error)
{
    *picture = (image){0};
    FILE *file = fopen(path, "rb");
    if (!file)
        return host_fail(error, HOST_BAD_INPUT, "cannot open '%s': %s", path, strerror(errno));
    reader r = {.message = "no memory"};
    r.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, r.message, on_error, on_warning);
    r.info = r.png ? png_create_info_struct(r.png) : NULL;
    bool ok = r.info && read_rows(&r, file, picture);
    png_destroy_read_struct(&r.png, &r.info, NULL);
    free(r.bytes);
    free(r.rows);
    fclose(file);
    if (ok)
        return HOST_OK;
    image_free(picture);
    return host_fail(error, HOST_BAD_INPUT, "cannot read '%s' as a PNG: %s", path, r.message);
}

void image_free(image *picture)
{
    free(picture->rgba);
    *picture = (image){0};
}
