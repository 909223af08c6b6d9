/* ideal.h - the picture that the machine approximates: the same slices in double precision, with densities, colours and
 * pixels that are not quantised. */
#ifndef TESTS_IDEAL_H
#define TESTS_IDEAL_H

#include "transfer.h"
#include "vodr.h"

typedef struct ideal_scene {
    int32_t dims_vox[3];
    const float *values; /* of voxels, in the volume's units; x fastest */
    const vodr_view *view;
    const transfer *transfer;
    double window_lo, window_hi;
    double depth_vox; /* between slices, for opacity correction */
} ideal_scene;

/* Blends the frame over: r, g, b, a a pixel, premultiplied, 0 to 1, rows top to bottom. */
void ideal_render(const ideal_scene *s, double *rgba);

typedef struct ideal_error {
    uint64_t covered_px; /* pixels that either frame draws anything on */
    double psnr;         /* decibels, over all four channels of these */
    double largest;      /* error of a channel, of 1 */
} ideal_error;

/* How far a frame of the machine is from the ideal one. */
ideal_error ideal_compare(const vodr_frame *frame, const double *rgba);

#endif
