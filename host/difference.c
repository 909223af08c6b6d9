/* difference.c - how far two pictures of one size are apart: errors, and the picture of them. */
#include "difference.h"

#include <math.h>
#include <stdlib.h>

enum { LEVEL = 257 }; /* an 8-bit level, in the 16 bits of an image */

static int channels(const image *a, const image *b)
{
    return a->has_alpha || b->has_alpha ? 4 : 3;
}

static int absolute(int value)
{
    return value < 0 ? -value : value;
}

static void note_first(const image *a, const image *b, size_t pixel, int channel, difference *d)
{
    static const char *const names[] = {"r", "g", "b", "a"};
    size_t i = 4 * pixel + (size_t)channel;
    d->equal = false;
    d->first_x = (int32_t)(pixel % (size_t)a->width_px);
    d->first_y = (int32_t)(pixel / (size_t)a->width_px);
    d->first_channel = names[channel];
    d->first_a = (double)a->rgba[i] / LEVEL;
    d->first_b = (double)b->rgba[i] / LEVEL;
}

host_status difference_measure(const image *a, const image *b, difference *d, host_error *error)
{
    *d = (difference){.equal = true, .first_x = -1, .first_y = -1};
    const size_t pixels = (size_t)a->width_px * (size_t)a->height_px;
    const int count = channels(a, b);
    int largest = 0;
    uint64_t squares = 0; /* at most 2^30 pixels of 4*65535^2 */
    for (size_t p = 0; p < pixels; p++)
        for (int c = 0; c < count; c++) {
            int error16 = absolute(a->rgba[4 * p + (size_t)c] - b->rgba[4 * p + (size_t)c]);
            if (error16 && d->equal)
                note_first(a, b, p, c, d);
            largest = error16 > largest ? error16 : largest;
            squares += (uint64_t)error16 * (uint64_t)error16;
        }
    d->max_error = (double)largest / LEVEL;
    d->rmse = sqrt((double)squares / ((double)pixels * count)) / LEVEL;
    d->psnr_db = 20 * log10(255 / d->rmse);
    return ssim_mean(a, b, &d->ssim, error);
}

static int pixel_error(const image *a, const image *b, size_t pixel, int channel)
{
    size_t colour = 4 * pixel + (size_t)channel, alpha = 4 * pixel + 3;
    int colour16 = absolute(a->rgba[colour] - b->rgba[colour]);
    int alpha16 = absolute(a->rgba[alpha] - b->rgba[alpha]);
    return colour16 > alpha16 ? colour16 : alpha16;
}

host_status difference_picture(const image *a, const image *b, vodr_frame *frame, host_error *error)
{
    const size_t pixels = (size_t)a->width_px * (size_t)a->height_px;
    uint8_t *rgba = malloc(4 * pixels);
    if (!rgba)
        return host_fail(error, HOST_ENVIRONMENT, "no memory for the picture of the differences");
    int largest = 1;
    for (size_t i = 0; i < 3 * pixels; i++) {
        int error16 = pixel_error(a, b, i / 3, (int)(i % 3));
        largest = error16 > largest ? error16 : largest;
    }
    for (size_t p = 0; p < pixels; p++) {
        for (int c = 0; c < 3; c++)
            rgba[4 * p + (size_t)c] = (uint8_t)((pixel_error(a, b, p, c) * 255 + largest / 2) / largest);
        rgba[4 * p + 3] = 255;
    }
    *frame = (vodr_frame){a->width_px, a->height_px, 8, rgba, 4 * pixels};
    return HOST_OK;
}
