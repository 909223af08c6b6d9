/* second_texture.h - the second implementation's texture unit and blender: densities, filter, table, pixels. */
#ifndef TESTS_SECOND_TEXTURE_H
#define TESTS_SECOND_TEXTURE_H

#include "vodr.h"

/* A pixel: a colour in `over` and `under`, a density in `mip`. All zero at the frame's start. */
typedef struct second_pixel {
    uint32_t channel[4]; /* r, g, b, a */
    uint32_t density;
    bool written;
} second_pixel;

/* The density of voxel (x, y, z), with bspline its coefficient; clamped to the volume's edge. */
int64_t second_density(const vodr_machine *machine, const vodr_volume *volume, int64_t x, int64_t y, int64_t z);

/* The filter's output at a position. */
uint32_t second_filter(const vodr_machine *machine, const vodr_volume *volume, const int64_t position[3]);

/* Turns the range of a brick's voxels into that of what the filter makes of them, as skip_empty reckons it. */
void second_filter_bounds(const vodr_machine *machine, int64_t *min, int64_t *max);

/* One channel of the table, converted from tf_bits to fb_bits. */
uint32_t second_convert(const vodr_machine *machine, uint32_t value);

/* Whether entries lo to hi (in mip 0 to hi) of the converted table are all zero in all channels. */
bool second_transparent(const vodr_machine *machine, const vodr_rgba *converted, uint32_t lo, uint32_t hi);

/* Blends a fragment into its pixel. True when the pixel was written; *terminated when it was full (`under`). */
bool second_blend(const vodr_machine *machine, const vodr_rgba *converted, uint32_t density, second_pixel *pixel,
                  bool *terminated);

#endif
