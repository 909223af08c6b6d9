/* cubic_cuda.h - private to device_cuda.cu: what the cubic filters need of a volume in the card's memory: coefficients
 * of B-splines, and the bounds of hull.h. */
#ifndef REFERENCE_CUBIC_CUDA_H
#define REFERENCE_CUBIC_CUDA_H

#include "bounds_cuda.h"
#include "hull.h"
#include "prefilter.h"

typedef struct cubic_cuda {
    float *coefficients; /* NULL until a frame needs them */
    float *copy[3];      /* KERNEL_WIDE, sorted by each axis; likewise */
    int32_t copies;      /* 3, or 1 where three had no room; 0 until a frame needs them */
    uint16_t *codes;     /* of cells; likewise */
    hull_scale scale;
    bool has_scale;
} cubic_cuda;

static inline bounds_box cubic_cells(const int32_t dims_vox[3])
{
    return bounds_box{{dims_vox[0] + 1, dims_vox[1] + 1, dims_vox[2] + 1}};
}

static inline size_t bounds_box_count(const bounds_box &b)
{
    return (size_t)b.size[0] * (size_t)b.size[1] * (size_t)b.size[2];
}

/* Floats as integers of the same order, for atomic operations, and back. */
static inline float cubic_float(int32_t order)
{
    const int32_t bits = order < 0 ? order ^ INT32_MAX : order;
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static __device__ __forceinline__ int32_t cubic_order(float value)
{
    const int32_t bits = __float_as_int(value);
    return bits < 0 ? bits ^ INT32_MAX : bits;
}

/* ---- coefficients ---- */

/* A thread makes PREFILTER_RUN coefficients of a line along an axis by the recursion, forth and back, from
 * PREFILTER_WARM samples further on both sides: what lies beyond these weighs less than a float's last bit. */
enum { PREFILTER_RUN = 16, PREFILTER_WARM = 14 };

template <typename voxel>
static __global__ void cubic_prefilter(const voxel *in, bounds_box size, bounds_box runs, int axis, float *out)
{
    const float pole = (float)PREFILTER_POLE;
    float line[PREFILTER_RUN + 2 * PREFILTER_WARM];
    int32_t at[3];
    if (!bounds_place(runs, at))
        return;
    const int32_t first = at[axis] * PREFILTER_RUN, count = size.size[axis];
    const int64_t stride = axis == 0 ? 1 : axis == 1 ? size.size[0] : (int64_t)size.size[0] * size.size[1];
    at[axis] = 0;
    const int64_t begin = bounds_index(size, at);
    float before = 0;
#pragma unroll
    for (int k = 0; k < PREFILTER_RUN + 2 * PREFILTER_WARM; k++) {
        const int32_t i = first + k - PREFILTER_WARM;
        const int32_t mirrored = prefilter_mirrored(i < 0 ? -1 - i : i, count);
        before = PREFILTER_GAIN * (float)in[begin + mirrored * stride] + pole * before;
        line[k] = before;
    }
    before = 0;
#pragma unroll
    for (int k = PREFILTER_RUN + 2 * PREFILTER_WARM - 1; k >= PREFILTER_WARM; k--) {
        before = pole * (before - line[k]);
        if (k < PREFILTER_RUN + PREFILTER_WARM && first + k - PREFILTER_WARM < count)
            out[begin + (first + k - PREFILTER_WARM) * stride] = before;
    }
}

template <typename voxel> static void cubic_start_axis(const voxel *in, const int32_t dims_vox[3], int axis, float *out)
{
    bounds_box size = bounds_box_of(dims_vox), runs = size;
    runs.size[axis] = (size.size[axis] + PREFILTER_RUN - 1) / PREFILTER_RUN;
    cubic_prefilter<<<bounds_grid(runs.size), BOUNDS_THREADS>>>(in, size, runs, axis, out);
}

/* `voxels`: the volume's on the card; `spare` is as large as the coefficients. */
static void cubic_start_prefilter(const reference_volume *v, const void *voxels, float *spare, float *coefficients)
{
    switch (v->type) {
    case REFERENCE_UINT8: cubic_start_axis((const uint8_t *)voxels, v->dims_vox, 0, coefficients); break;
    case REFERENCE_UINT16: cubic_start_axis((const uint16_t *)voxels, v->dims_vox, 0, coefficients); break;
    default: cubic_start_axis((const float *)voxels, v->dims_vox, 0, coefficients);
    }
    cubic_start_axis(coefficients, v->dims_vox, 1, spare);
    cubic_start_axis(spare, v->dims_vox, 2, coefficients);
}

/* ---- copies ---- */

/* The sizes of a copy along its axes, which are those of the volume from first_axis on. */
static inline bounds_box cubic_wide(const int32_t dims_vox[3], int first_axis)
{
    bounds_box wide;
    for (int a = 0; a < 3; a++)
        wide.size[a] = dims_vox[(first_axis + a) % 3] + 2 * LAYOUT_MARGIN_VOX;
    return wide;
}

template <int first_axis>
static __global__ void cubic_sort(const float *in, bounds_box size, bounds_box wide, float *out)
{
    int32_t at[3], from[3];
    if (!bounds_place(wide, at))
        return;
#pragma unroll
    for (int a = 0; a < 3; a++) {
        const int axis = (first_axis + a) % 3;
        from[axis] = min(max(at[a] - LAYOUT_MARGIN_VOX, 0), size.size[axis] - 1);
    }
    out[bounds_index(wide, at)] = in[bounds_index(size, from)];
}

static void cubic_start_sort(const float *coefficients, const int32_t dims_vox[3], int first_axis, float *out)
{
    const bounds_box size = bounds_box_of(dims_vox), wide = cubic_wide(dims_vox, first_axis);
    const unsigned grid = bounds_grid(wide.size);
    if (first_axis == 0)
        cubic_sort<0><<<grid, BOUNDS_THREADS>>>(coefficients, size, wide, out);
    else if (first_axis == 1)
        cubic_sort<1><<<grid, BOUNDS_THREADS>>>(coefficients, size, wide, out);
    else
        cubic_sort<2><<<grid, BOUNDS_THREADS>>>(coefficients, size, wide, out);
}

/* ---- extremes ---- */

enum { EXTREME_GRID = 1024 };

/* Widens ends[0] and ends[1] by orders of a warp's values. */
static __device__ __forceinline__ void cubic_widen(int32_t least, int32_t most, int32_t *low, int32_t *high)
{
    least = __reduce_min_sync(~0u, least);
    most = __reduce_max_sync(~0u, most);
    if ((threadIdx.x & 31) == 0) {
        atomicMin(low, least);
        atomicMax(high, most);
    }
}

template <typename voxel> static __global__ void cubic_extremes(const voxel *voxels, int64_t count, int32_t *ends)
{
    int32_t least = INT32_MAX, most = INT32_MIN;
    for (int64_t i = (int64_t)blockIdx.x * BOUNDS_THREADS + threadIdx.x; i < count;
         i += EXTREME_GRID * BOUNDS_THREADS) {
        const int32_t order = cubic_order((float)voxels[i]);
        least = min(least, order);
        most = max(most, order);
    }
    cubic_widen(least, most, &ends[0], &ends[1]);
}

static void cubic_start_extremes(const reference_volume *v, int32_t *ends)
{
    const int64_t count = (int64_t)v->dims_vox[0] * v->dims_vox[1] * v->dims_vox[2];
    switch (v->type) {
    case REFERENCE_UINT8:
        cubic_extremes<<<EXTREME_GRID, BOUNDS_THREADS>>>((const uint8_t *)v->voxels, count, ends);
        break;
    case REFERENCE_UINT16:
        cubic_extremes<<<EXTREME_GRID, BOUNDS_THREADS>>>((const uint16_t *)v->voxels, count, ends);
        break;
    default: cubic_extremes<<<EXTREME_GRID, BOUNDS_THREADS>>>((const float *)v->voxels, count, ends);
    }
}

/* ---- bounds ---- */

/* The Bezier points of the cubic between p[1] and p[2], in place. */
static __device__ __forceinline__ void cubic_bezier(bool spline, float *p, int stride)
{
    const float p0 = p[0], p1 = p[stride], p2 = p[2 * stride], p3 = p[3 * stride];
    if (spline) {
        const float thirds = (p1 + p2) * (1 / 3.0f);
        p[0] = (p0 + p2) * (1 / 6.0f) + p1 * (2 / 3.0f);
        p[stride] = thirds + p1 * (1 / 3.0f);
        p[2 * stride] = thirds + p2 * (1 / 3.0f);
        p[3 * stride] = (p1 + p3) * (1 / 6.0f) + p2 * (2 / 3.0f);
    } else {
        p[0] = p1;
        p[stride] = p1 + (p2 - p0) * (1 / 6.0f);
        p[2 * stride] = p2 - (p3 - p1) * (1 / 6.0f);
        p[3 * stride] = p2;
    }
}

static __global__ void cubic_clear(int32_t *least, int32_t *most, int64_t count)
{
    const int64_t i = (int64_t)blockIdx.x * BOUNDS_THREADS + threadIdx.x;
    if (i >= count)
        return;
    least[i] = INT32_MAX;
    most[i] = INT32_MIN;
}

/* The bounds of a cell, which go to its block and, as a code, to codes[] where there are any. */
template <typename voxel, bool spline>
static __global__ void cubic_hull(const voxel *voxels, bounds_box size, bounds_box cells, hull_scale scale,
                                  bounds_box blocks, int32_t edge_vox, int32_t *least, int32_t *most, uint16_t *codes)
{
    int32_t at[3], offset[3][4];
    float p[64];
    const bool inside = bounds_place(cells, at);
    if (!inside)
        return;
    for (int a = 0; a < 3; a++)
        for (int n = 0; n < 4; n++)
            offset[a][n] = min(max(at[a] - 2 + n, 0), size.size[a] - 1);
#pragma unroll
    for (int z = 0; z < 4; z++) {
#pragma unroll
        for (int y = 0; y < 4; y++) {
            const int64_t row = ((int64_t)offset[2][z] * size.size[1] + offset[1][y]) * size.size[0];
#pragma unroll
            for (int x = 0; x < 4; x++)
                p[16 * z + 4 * y + x] = (float)voxels[row + offset[0][x]];
            cubic_bezier(spline, p + 16 * z + 4 * y, 1);
        }
#pragma unroll
        for (int x = 0; x < 4; x++)
            cubic_bezier(spline, p + 16 * z + x, 4);
    }
    float low = INFINITY, high = -INFINITY;
#pragma unroll
    for (int n = 0; n < 16; n++) {
        cubic_bezier(spline, p + n, 16);
#pragma unroll
        for (int z = 0; z < 4; z++) {
            low = fminf(low, p[16 * z + n]);
            high = fmaxf(high, p[16 * z + n]);
        }
    }
    if (codes)
        codes[bounds_index(cells, at)] = hull_code(scale, low, high);
    const int32_t of_block[3] = {at[0] / edge_vox, at[1] / edge_vox, at[2] / edge_vox};
    const int64_t block = bounds_index(blocks, of_block);
    const unsigned together = __match_any_sync(__activemask(), block);
    const int32_t warp_low = __reduce_min_sync(together, cubic_order(low - scale.margin));
    const int32_t warp_high = __reduce_max_sync(together, cubic_order(high + scale.margin));
    if ((threadIdx.x & 31) == __ffs(together) - 1) {
        atomicMin(&least[block], warp_low);
        atomicMax(&most[block], warp_high);
    }
}

/* Orders become the floats that they stand for. */
static __global__ void cubic_decode(int32_t *least, int32_t *most, int64_t count)
{
    const int64_t i = (int64_t)blockIdx.x * BOUNDS_THREADS + threadIdx.x;
    if (i >= count)
        return;
    least[i] = least[i] < 0 ? least[i] ^ INT32_MAX : least[i];
    most[i] = most[i] < 0 ? most[i] ^ INT32_MAX : most[i];
}

template <typename voxel>
static void cubic_start_hull_of(const voxel *voxels, const reference_volume *v, bool spline, hull_scale scale,
                                bounds_box blocks, int32_t edge_vox, int32_t *least, int32_t *most, uint16_t *codes)
{
    const bounds_box size = bounds_box_of(v->dims_vox), cells = cubic_cells(v->dims_vox);
    if (spline)
        cubic_hull<voxel, true><<<bounds_grid(cells.size), BOUNDS_THREADS>>>(voxels, size, cells, scale, blocks,
                                                                             edge_vox, least, most, codes);
    else
        cubic_hull<voxel, false><<<bounds_grid(cells.size), BOUNDS_THREADS>>>(voxels, size, cells, scale, blocks,
                                                                              edge_vox, least, most, codes);
}

/* Starts the kernels that fill least[] and most[] with floats, of each block, and codes[], unless it is NULL. */
static void cubic_start_hull(const reference_volume *v, bool spline, hull_scale scale, bounds_box blocks,
                             int32_t edge_vox, int32_t *least, int32_t *most, uint16_t *codes)
{
    const int64_t count = (int64_t)bounds_box_count(blocks);
    cubic_clear<<<bounds_grid(blocks.size), BOUNDS_THREADS>>>(least, most, count);
    switch (v->type) {
    case REFERENCE_UINT8:
        cubic_start_hull_of((const uint8_t *)v->voxels, v, spline, scale, blocks, edge_vox, least, most, codes);
        break;
    case REFERENCE_UINT16:
        cubic_start_hull_of((const uint16_t *)v->voxels, v, spline, scale, blocks, edge_vox, least, most, codes);
        break;
    default: cubic_start_hull_of((const float *)v->voxels, v, spline, scale, blocks, edge_vox, least, most, codes);
    }
    cubic_decode<<<bounds_grid(blocks.size), BOUNDS_THREADS>>>(least, most, count);
}

/* The extremes of the voxels that each block reads, and what they may overshoot. A warp a block. */
template <typename voxel>
static __global__ void cubic_rival(const voxel *voxels, bounds_box size, hull_scale scale, float share,
                                   bounds_box blocks, int32_t edge_vox, float *least, float *most)
{
    const int64_t block = ((int64_t)blockIdx.x * BOUNDS_THREADS + threadIdx.x) / 32, row = block / blocks.size[0];
    const int32_t at[3] = {(int32_t)(block % blocks.size[0]), (int32_t)(row % blocks.size[1]),
                           (int32_t)(row / blocks.size[1])};
    int32_t lo[3], hi[3];
    float low = INFINITY, high = -INFINITY;
    if (at[2] >= blocks.size[2])
        return;
    for (int a = 0; a < 3; a++)
        hull_voxels(at[a], edge_vox, size.size[a], &lo[a], &hi[a]);
    for (int32_t z = lo[2]; z < hi[2]; z++)
        for (int32_t y = lo[1]; y < hi[1]; y++)
            for (int32_t x = lo[0] + (int32_t)(threadIdx.x & 31); x < hi[0]; x += 32) {
                const float value = (float)voxels[((int64_t)z * size.size[1] + y) * size.size[0] + x];
                low = fminf(low, value);
                high = fmaxf(high, value);
            }
    for (int n = 16; n > 0; n /= 2) {
        low = fminf(low, __shfl_xor_sync(~0u, low, n));
        high = fmaxf(high, __shfl_xor_sync(~0u, high, n));
    }
    if ((threadIdx.x & 31) != 0)
        return;
    const float beyond = share * (high - low) + scale.margin;
    least[block] = low - beyond;
    most[block] = high + beyond;
}

static void cubic_start_rival(const reference_volume *v, hull_scale scale, float share, bounds_box blocks,
                              int32_t edge_vox, float *least, float *most)
{
    const bounds_box size = bounds_box_of(v->dims_vox);
    const unsigned grid = (unsigned)((bounds_box_count(blocks) * 32 + BOUNDS_THREADS - 1) / BOUNDS_THREADS);
    switch (v->type) {
    case REFERENCE_UINT8:
        cubic_rival<<<grid, BOUNDS_THREADS>>>((const uint8_t *)v->voxels, size, scale, share, blocks, edge_vox, least,
                                              most);
        break;
    case REFERENCE_UINT16:
        cubic_rival<<<grid, BOUNDS_THREADS>>>((const uint16_t *)v->voxels, size, scale, share, blocks, edge_vox, least,
                                              most);
        break;
    default:
        cubic_rival<<<grid, BOUNDS_THREADS>>>((const float *)v->voxels, size, scale, share, blocks, edge_vox, least,
                                              most);
    }
}

#endif
