/* bounds_cuda.h - private to device_cuda.cu: the codes of bounds.h made on the card, from a volume in its memory. */
#ifndef REFERENCE_BOUNDS_CUDA_H
#define REFERENCE_BOUNDS_CUDA_H

#include "bounds.h"

enum { BOUNDS_THREADS = 256 };

typedef struct bounds_box {
    int32_t size[3];
} bounds_box;

static inline unsigned bounds_grid(const int32_t count[3])
{
    return (unsigned)(((int64_t)count[0] * count[1] * count[2] + BOUNDS_THREADS - 1) / BOUNDS_THREADS);
}

static __device__ __forceinline__ int32_t bounds_code_at(const uint8_t *voxels, int64_t i, const bounds_code &code)
{
    return voxels[i];
}

static __device__ __forceinline__ int32_t bounds_code_at(const uint16_t *voxels, int64_t i, const bounds_code &code)
{
    return voxels[i];
}

static __device__ __forceinline__ int32_t bounds_code_at(const float *voxels, int64_t i, const bounds_code &code)
{
    return (int32_t)fminf(ceilf((voxels[i] - code.least) * code.inverse), 65535.0f);
}

/* The place of a thread in a box; false outside. */
static __device__ __forceinline__ bool bounds_place(const bounds_box &box, int32_t at[3])
{
    const int64_t i = (int64_t)blockIdx.x * BOUNDS_THREADS + threadIdx.x;
    const int64_t row = i / box.size[0];
    at[0] = (int32_t)(i % box.size[0]);
    at[1] = (int32_t)(row % box.size[1]);
    at[2] = (int32_t)(row / box.size[1]);
    return at[2] < box.size[2];
}

static __device__ __forceinline__ int64_t bounds_index(const bounds_box &box, const int32_t at[3])
{
    return ((int64_t)at[2] * box.size[1] + at[1]) * box.size[0] + at[0];
}

/* The greatest corner of each cell. */
template <typename voxel>
static __global__ void bounds_cells(const voxel *voxels, bounds_code code, bounds_box size, bounds_box cells,
                                    uint16_t *out)
{
    int32_t at[3], most = 0;
    if (!bounds_place(cells, at))
        return;
    for (int n = 0; n < 8; n++) {
        int32_t corner[3];
        for (int a = 0; a < 3; a++)
            corner[a] = min(max(at[a] - 1 + (n >> a & 1), 0), size.size[a] - 1);
        most = max(most, bounds_code_at(voxels, bounds_index(size, corner), code));
    }
    out[bounds_index(cells, at)] = (uint16_t)most;
}

/* `in` with `axis` cut into blocks of edge_vox cells. */
template <typename value>
static __global__ void bounds_cut(const value *in, bounds_code code, bounds_box size, bounds_box blocks, int axis,
                                  int32_t edge_vox, uint16_t *out)
{
    int32_t at[3], lo, hi, most = 0;
    if (!bounds_place(blocks, at))
        return;
    const int64_t i = bounds_index(blocks, at);
    bounds_voxels(at[axis], edge_vox, size.size[axis], &lo, &hi);
    for (at[axis] = lo; at[axis] < hi; at[axis]++)
        most = max(most, bounds_code_at(in, bounds_index(size, at), code));
    out[i] = (uint16_t)most;
}

static __global__ void bounds_join(const uint16_t *fine, bounds_box fine_box, bounds_box box, uint16_t *out)
{
    int32_t at[3], most = 0;
    if (!bounds_place(box, at))
        return;
    for (int n = 0; n < 8; n++) {
        int32_t part[3];
        for (int a = 0; a < 3; a++)
            part[a] = min(2 * at[a] + (n >> a & 1), fine_box.size[a] - 1);
        most = max(most, (int32_t)fine[bounds_index(fine_box, part)]);
    }
    out[bounds_index(box, at)] = (uint16_t)most;
}

/* The greatest of four along an axis. */
static __global__ void bounds_widen(const uint16_t *in, bounds_box box, int axis, uint16_t *out)
{
    int32_t at[3], most = 0;
    if (!bounds_place(box, at))
        return;
    const int64_t i = bounds_index(box, at);
    for (int n = 0; n < 4 && at[axis] < box.size[axis]; n++, at[axis]++)
        most = max(most, (int32_t)in[bounds_index(box, at)]);
    out[i] = (uint16_t)most;
}

static inline bounds_box bounds_box_of(const int32_t count[3])
{
    return bounds_box{{count[0], count[1], count[2]}};
}

/* Starts the kernels that fill out[] with the codes of blocks; spare[] has room for the volume cut along one axis. */
template <typename voxel>
static void bounds_start_blocks(const voxel *voxels, const bounds_code &code, const int32_t dims_vox[3],
                                int32_t edge_vox, uint16_t *const spare[2], uint16_t *out)
{
    bounds_box from = bounds_box_of(dims_vox), to = from;
    for (int axis = 2; axis >= 0; axis--) {
        to.size[axis] = bounds_count(dims_vox[axis], edge_vox);
        uint16_t *target = axis == 0 ? out : spare[axis - 1];
        if (axis == 2)
            bounds_cut<<<bounds_grid(to.size), BOUNDS_THREADS>>>(voxels, code, from, to, axis, edge_vox, target);
        else
            bounds_cut<<<bounds_grid(to.size), BOUNDS_THREADS>>>(spare[axis], code, from, to, axis, edge_vox, target);
        from = to;
    }
}

/* Starts the kernels that fill the grids of *b in codes[]; each spare has room for grid 1. */
template <typename voxel>
static void bounds_start_grids(const voxel *voxels, const bounds_code &code, const int32_t dims_vox[3],
                               const kernel_bounds *b, uint16_t *const spare[3], uint16_t *codes)
{
    const bounds_box cells = bounds_box_of(b->count[0]);
    bounds_cells<<<bounds_grid(cells.size), BOUNDS_THREADS>>>(voxels, code, bounds_box_of(dims_vox), cells, codes);
    for (int k = 1; k <= b->levels; k++) {
        uint16_t *next = spare[k & 1], *own = spare[~k & 1];
        const bounds_box finer = bounds_box_of(b->count[k - 1]);
        if (k < b->levels)
            bounds_join<<<bounds_grid(b->count[k]), BOUNDS_THREADS>>>(k == 1 ? codes : own, finer,
                                                                      bounds_box_of(b->count[k]), next);
        if (k == 1)
            continue;
        bounds_widen<<<bounds_grid(finer.size), BOUNDS_THREADS>>>(own, finer, 0, spare[2]);
        bounds_widen<<<bounds_grid(finer.size), BOUNDS_THREADS>>>(spare[2], finer, 1, own);
        bounds_widen<<<bounds_grid(finer.size), BOUNDS_THREADS>>>(own, finer, 2, codes + b->offset[k - 1]);
    }
}

#endif
