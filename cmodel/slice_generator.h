/* slice_generator.h - the slices of one candidate, in blending order (the paper's section 3.2). */
#ifndef VODR_SLICE_GENERATOR_H
#define VODR_SLICE_GENERATOR_H

#include "view.h"
#include "vodr.h"

typedef struct slice_generator {
    const vodr_view *view;
    int32_t k, end, step;
    int64_t lo[3], hi[3];
} slice_generator;

/* Slices k0 to k1-1 of the box: back to front, or front to back. */
slice_generator slice_generator_start(const vodr_view *view, const vox_box *box, int32_t k0, int32_t k1,
                                      bool front_to_back);

/* The next slice; false after the last. */
bool slice_generator_next(slice_generator *g, brick_slice *slice);

#endif
