/* difference.h - how far two pictures of one size are apart. */
#ifndef HOST_DIFFERENCE_H
#define HOST_DIFFERENCE_H

#include "host.h"
#include "image.h"

/* Over red, green and blue, and alpha where a picture has it, straight (not premultiplied). Levels are 8-bit ones: a
 * 16-bit picture has fractions of them. */
typedef struct difference {
    bool equal;
    double max_error, rmse;    /* levels */
    double psnr_db;            /* peak 255; infinite when equal */
    double ssim;               /* mean structural similarity, of the luma over black */
    int32_t first_x, first_y;  /* the topmost, then leftmost pixel that differs; -1 when equal */
    const char *first_channel; /* "r", "g", "b" or "a"; NULL when equal */
    double first_a, first_b;   /* levels */
} difference;

/* The pictures must have one size. */
host_status difference_measure(const image *a, const image *b, difference *d, host_error *error);

/* A new opaque 8-bit frame of absolute differences, amplified so that the greatest is 255; a difference in alpha shows
 * in all three colours. free() its pixels. */
host_status difference_picture(const image *a, const image *b, vodr_frame *frame, host_error *error);

/* Mean SSIM of Wang, Bovik, Sheikh and Simoncelli (2004): Gaussian window of 11x11, sigma 1.5, K1 = 0.01, K2 = 0.03,
 * L = 255, over all windows that lie inside the picture; where it is less than 11 wide or high the window is cut to it.
 */
host_status ssim_mean(const image *a, const image *b, double *ssim, host_error *error);

#endif
