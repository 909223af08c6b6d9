/* prefilter.c - the recursion of Unser, Aldroubi and Eden on the CPU, one axis after the other: c(k-1) + 4 c(k) +
 * c(k+1) = 6 f(k), forth and back. It runs along an axis for many lines at a time, so that the compiler makes vectors
 * of them; of rows, which lie the other way, in a copy turned. */
#include "prefilter.h"

#include <stdlib.h>

enum { ROWS = 16, TILE = 128 };

/* `count` samples `stride` apart, of `width` lines side by side. */
static void recursion(float *restrict c, int32_t count, size_t stride, int32_t width)
{
    const float pole = (float)PREFILTER_POLE, end = (float)(PREFILTER_POLE / (PREFILTER_POLE - 1));
    float begin[TILE] = {0}, share = PREFILTER_GAIN;
    for (int32_t k = 0; k < PREFILTER_HORIZON; k++) {
        const float *row = c + (size_t)prefilter_mirrored(k, count) * stride;
        share *= pole;
        for (int32_t x = 0; x < width; x++)
            begin[x] += share * row[x];
    }
    for (int32_t x = 0; x < width; x++)
        c[x] = PREFILTER_GAIN * c[x] + begin[x];
    for (int32_t k = 1; k < count; k++) {
        float *row = c + (size_t)k * stride;
        for (int32_t x = 0; x < width; x++)
            row[x] = PREFILTER_GAIN * row[x] + pole * row[x - (ptrdiff_t)stride];
    }
    for (int32_t x = 0; x < width; x++)
        c[(size_t)(count - 1) * stride + (size_t)x] *= end;
    for (int32_t k = count - 2; k >= 0; k--) {
        float *row = c + (size_t)k * stride;
        for (int32_t x = 0; x < width; x++)
            row[x] = pole * (row[x + (ptrdiff_t)stride] - row[x]);
    }
}

static float voxel(const reference_volume *v, size_t i)
{
    switch (v->type) {
    case REFERENCE_UINT8: return ((const uint8_t *)v->voxels)[i];
    case REFERENCE_UINT16: return ((const uint16_t *)v->voxels)[i];
    default: return ((const float *)v->voxels)[i];
    }
}

/* Up to ROWS rows from voxel number `first` on, along x. turned: room for ROWS rows. */
static void filter_rows(const reference_volume *v, size_t first, int32_t rows, float *turned, float *coefficients)
{
    const size_t size = (size_t)v->dims_vox[0];
    for (size_t r = 0; r < ROWS; r++)
        for (size_t x = 0; x < size; x++)
            turned[x * ROWS + r] = r < (size_t)rows ? voxel(v, first + r * size + x) : 0;
    recursion(turned, v->dims_vox[0], ROWS, ROWS);
    for (size_t r = 0; r < (size_t)rows; r++)
        for (size_t x = 0; x < size; x++)
            coefficients[first + r * size + x] = turned[x * ROWS + r];
}

/* Along an axis whose samples lie `stride` apart, of a row of lines that begins at c. */
static void filter_lines(const int32_t dims_vox[3], int32_t count, size_t stride, float *c)
{
    for (int32_t x = 0; x < dims_vox[0]; x += TILE)
        recursion(c + x, count, stride, dims_vox[0] - x < TILE ? dims_vox[0] - x : TILE);
}

bool prefilter_layers(const reference_volume *v, int32_t z0, int32_t z1, float *coefficients)
{
    const int32_t *dims = v->dims_vox;
    float *turned = malloc(ROWS * (size_t)dims[0] * sizeof *turned);
    if (!turned)
        return false;
    for (int32_t z = z0; z < z1; z++) {
        const size_t layer = (size_t)z * (size_t)dims[1] * (size_t)dims[0];
        for (int32_t y = 0; y < dims[1]; y += ROWS)
            filter_rows(v, layer + (size_t)y * (size_t)dims[0], dims[1] - y < ROWS ? dims[1] - y : ROWS, turned,
                        coefficients);
        filter_lines(dims, dims[1], (size_t)dims[0], coefficients + layer);
    }
    free(turned);
    return true;
}

void prefilter_rows(const int32_t dims_vox[3], int32_t y0, int32_t y1, float *coefficients)
{
    const size_t row = (size_t)dims_vox[0];
    for (int32_t y = y0; y < y1; y++)
        filter_lines(dims_vox, dims_vox[2], row * (size_t)dims_vox[1], coefficients + (size_t)y * row);
}
