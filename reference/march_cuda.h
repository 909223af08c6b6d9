/* march_cuda.h - private to device_cuda.cu: the marching kernels as threads run them, and the choice among them. */
#ifndef REFERENCE_MARCH_CUDA_H
#define REFERENCE_MARCH_CUDA_H

#include "kernel_cast.h"
#include "kernel_ray.h"
#include "launch_cuda.h"

/* ANY_TYPE: the voxels' type is asked at each read. */
enum { BLOCK_THREADS = 256, SEARCH_THREADS = 64, SEARCH_BLOCKS = 16, TILE_PX = 4, ANY_TYPE = -1 };

static constexpr __host__ __device__ int threads_of(kernel_mode mode)
{
    return mode == KERNEL_SEARCH ? SEARCH_THREADS : BLOCK_THREADS;
}

/* Puts a table of one row into shared memory, as lookup says. */
static __device__ __forceinline__ lookup share_table(const kernel_table &t, int32_t copies_log2, float4 *shared)
{
    const float4 *rgba = (const float4 *)t.rgba;
    for (int i = threadIdx.x; i < (t.columns + 1) << copies_log2; i += BLOCK_THREADS) {
        int column = i >> copies_log2, next = min(column + 1, t.columns);
        float4 e = rgba[column], n = rgba[next];
        shared[2 * i] = e;
        shared[2 * i + 1] = make_float4(n.x - e.x, n.y - e.y, n.z - e.z, n.w - e.w);
    }
    __syncthreads();
    const int copy = threadIdx.x & ((1 << copies_log2) - 1);
    return lookup{shared + 2 * copy, (int)(2 * sizeof(float4)) << copies_log2, true};
}

template <kernel_mode mode, kernel_filter filter, kernel_skip skip, int known_type>
static __global__ void __launch_bounds__(threads_of(mode), mode == KERNEL_SEARCH ? SEARCH_BLOCKS
                                                           : mode == KERNEL_LIT  ? 2
                                                                                 : 4)
    march_kernel(const __grid_constant__ kernel_frame f, const march_launch launch, float4 *rgba, uint32_t *counts)
{
    extern __shared__ float4 shared[];
    const reference_voxel type = known_type == ANY_TYPE ? f.volume.type : (reference_voxel)known_type;
    const int thread = threadIdx.x;
    lookup table = {(const float4 *)f.table.rgba, sizeof(float4), false};
    if (mode == KERNEL_OVER || (mode == KERNEL_LIT && f.table.rows == 1))
        table = share_table(f.table, launch.copies_log2, shared);
    const int lane = thread & 31, warp = thread >> 5, width = 1 << launch.warp_log2, height = 32 >> launch.warp_log2;
    int i = (blockIdx.x * 2 + (warp & 1)) * width, j = (blockIdx.y * (threads_of(mode) / 64) + (warp >> 1)) * height;
    if (mode == KERNEL_SEARCH) { /* lanes that go together are a tile TILE_PX wide */
        i += lane / TOGETHER * TILE_PX + lane % TILE_PX;
        j += lane % TOGETHER / TILE_PX;
    } else {
        i += lane & (width - 1);
        j += lane >> launch.warp_log2;
    }
    int32_t x, y;
    const bool inside = order_has(&f, i, j, &x, &y);
    kernel_ray ray = ray_none(&f.part);
    if (inside)
        ray = ray_make(&f, x, y);
    packet rays;
    rays.boxed = filter != KERNEL_CELLS && f.part.boxed; /* cells are of whole frames, which are faster so */
    for (int a = 0; a < 3; a++) {
        rays.start[a] = (float)(ray.start[a] + place_shift(filter));
        rays.step[a] = (float)ray.step[a];
        rays.origin[a] = (float)f.part.origin_vox[a];
    }
    rays.skipped = (float)ray.skipped;
    rays.count = ray.count;
    rays.first = ray.first;
    packet_result result = cast(&f, &table, &rays, mode, filter, skip, type);
    if (!inside)
        return;
    size_t pixel = (size_t)y * f.camera.width_px + x;
    rgba[pixel] = make_float4(result.rgba[0], result.rgba[1], result.rgba[2], result.rgba[3]);
    counts[pixel] = (uint32_t)result.samples;
}

typedef void march_function(const kernel_frame f, const march_launch launch, float4 *rgba, uint32_t *counts);

/* The kernel of a variant: each parameter in turn becomes a constant. */
template <kernel_mode mode, kernel_skip skip> static march_function *by_filter(const kernel_frame *f)
{
    switch (f->filter) {
    case KERNEL_NEAREST: return march_kernel<mode, KERNEL_NEAREST, skip, ANY_TYPE>;
    case KERNEL_LINEAR: return march_kernel<mode, KERNEL_LINEAR, skip, ANY_TYPE>;
    case KERNEL_CELLS:
        return f->volume.type == REFERENCE_UINT8 ? march_kernel<mode, KERNEL_CELLS, skip, REFERENCE_UINT8>
                                                 : march_kernel<mode, KERNEL_CELLS, skip, REFERENCE_UINT16>;
    case KERNEL_CUBIC: return march_kernel<mode, KERNEL_CUBIC, skip, ANY_TYPE>;
    default: return march_kernel<mode, KERNEL_TEXTURE, skip, ANY_TYPE>;
    }
}

template <kernel_mode mode> static march_function *by_skip(const kernel_frame *f)
{
    if (f->skip == KERNEL_SKIP_CELLS)
        return march_kernel<mode, KERNEL_CUBIC, KERNEL_SKIP_CELLS, ANY_TYPE>;
    return f->skip == KERNEL_SKIP_NONE ? by_filter<mode, KERNEL_SKIP_NONE>(f) : by_filter<mode, KERNEL_SKIP_EMPTY>(f);
}

/* Of neither cells, as a search reads too little for them to be packed, nor cubics. */
static march_function *by_search(const kernel_frame *f)
{
    if (f->filter == KERNEL_NEAREST)
        return march_kernel<KERNEL_SEARCH, KERNEL_NEAREST, KERNEL_SKIP_NONE, ANY_TYPE>;
    if (f->filter == KERNEL_TEXTURE)
        return march_kernel<KERNEL_SEARCH, KERNEL_TEXTURE, KERNEL_SKIP_NONE, ANY_TYPE>;
    switch (f->volume.type) {
    case REFERENCE_UINT8: return march_kernel<KERNEL_SEARCH, KERNEL_LINEAR, KERNEL_SKIP_NONE, REFERENCE_UINT8>;
    case REFERENCE_UINT16: return march_kernel<KERNEL_SEARCH, KERNEL_LINEAR, KERNEL_SKIP_NONE, REFERENCE_UINT16>;
    default: return march_kernel<KERNEL_SEARCH, KERNEL_LINEAR, KERNEL_SKIP_NONE, ANY_TYPE>;
    }
}

static march_function *march_variant(kernel_mode mode, const kernel_frame *f)
{
    switch (mode) {
    case KERNEL_OVER: return by_skip<KERNEL_OVER>(f);
    case KERNEL_LIT: return by_skip<KERNEL_LIT>(f);
    case KERNEL_MIP: return by_filter<KERNEL_MIP, KERNEL_SKIP_NONE>(f);
    case KERNEL_LEAP: return by_filter<KERNEL_LEAP, KERNEL_SKIP_NONE>(f);
    default: return by_search(f);
    }
}

#endif
