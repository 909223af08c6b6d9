/* prefilter.h - private to reference/: the coefficients of the cubic B-spline through a volume's voxels. */
#ifndef REFERENCE_PREFILTER_H
#define REFERENCE_PREFILTER_H

#include "kernel_types.h"
#include "lanes.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Pole and gain of the recursion, and how many samples its beginning takes: the pole to that power is below a double's
 * last bit. */
#define PREFILTER_POLE (-0.26794919243112270647)
enum { PREFILTER_GAIN = 6, PREFILTER_HORIZON = 28 };

/* Voxel `i` of an axis that goes on mirrored at both ends, as coefficients that go on as they are at the border do. */
HOST_AND_KERNEL int32_t prefilter_mirrored(int32_t i, int32_t size)
{
    i %= 2 * size;
    return i < size ? i : 2 * size - 1 - i;
}

/* Layers [z0, z1) along x and y; then, of all layers, rows [y0, y1) along z. `coefficients` is as large as the volume.
 * False when the host is out of memory. */
bool prefilter_layers(const reference_volume *v, int32_t z0, int32_t z1, float *coefficients);
void prefilter_rows(const int32_t dims_vox[3], int32_t y0, int32_t y1, float *coefficients);

#ifdef __cplusplus
}
#endif

#endif
