/* device_cuda.cu - a CUDA card as a device: the volume in its memory, a thread a pixel. */
#include <cuda_runtime.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define REAL float
#include "device.h"
#include "kernel_fixed.h"
#include "kernel_march.h"
#include "kernel_ray.h"

enum { BLOCK_W = 16, BLOCK_H = 8, MAX_SHARED_BYTES = 32 << 10 };

typedef struct cuda_state {
    reference_volume volume; /* voxels in the host's memory */
    void *linear;            /* the voxels, as they are; NULL until a frame needs them */
    cudaArray_t array;       /* the same for the texture unit */
    cudaTextureObject_t texture;
    cudaEvent_t begin, end;
} cuda_state;

/* Memory of one frame, freed together. */
enum { PIECES = 8 };
typedef struct frame_memory {
    void *piece[PIECES];
    int count;
} frame_memory;

static const size_t voxel_bytes[] = {1, 2, 4};

static size_t volume_bytes(const reference_volume *v)
{
    return (size_t)v->dims_vox[0] * (size_t)v->dims_vox[1] * (size_t)v->dims_vox[2] * voxel_bytes[v->type];
}

/* Whether a call went well; the sentence says which did not. */
static reference_status check(cudaError_t code, const char *what, vodr_error *error)
{
    if (code == cudaSuccess)
        return REFERENCE_OK;
    reference_status status = code == cudaErrorMemoryAllocation ? REFERENCE_NO_MEMORY : REFERENCE_NO_DEVICE;
    return reference_fail(error, status, "CUDA: %s: %s", what, cudaGetErrorString(code));
}

/* Leaves the function that it stands in when a call fails. */
#define TRY(call)                                                                                                      \
    do {                                                                                                               \
        reference_status try_status = check(call, #call, error);                                                       \
        if (try_status != REFERENCE_OK)                                                                                \
            return try_status;                                                                                         \
    } while (0)

/* Refuses what the card has no room for, before anything is allocated. */
static reference_status check_room(size_t bytes, const char *what, vodr_error *error)
{
    size_t room, all;
    TRY(cudaMemGetInfo(&room, &all));
    if (bytes <= room)
        return REFERENCE_OK;
    return reference_fail(error, REFERENCE_NO_MEMORY, "%s needs %zu MiB on the card, which has %zu of its %zu MiB free",
                          what, (bytes >> 20) + 1, room >> 20, all >> 20);
}

static void cuda_close(void *state)
{
    cuda_state *s = (cuda_state *)state;
    if (s->texture)
        cudaDestroyTextureObject(s->texture);
    cudaFreeArray(s->array);
    cudaFree(s->linear);
    if (s->begin)
        cudaEventDestroy(s->begin);
    if (s->end)
        cudaEventDestroy(s->end);
    free(s);
}

static reference_status open_device(cuda_state *s, char name[DEVICE_NAME_CHARS], vodr_error *error)
{
    int count = 0;
    cudaDeviceProp properties;
    if (cudaGetDeviceCount(&count) != cudaSuccess || count == 0)
        return reference_fail(error, REFERENCE_NO_DEVICE, "there is no CUDA device (--device cpu needs none)");
    TRY(cudaGetDeviceProperties(&properties, 0));
    snprintf(name, DEVICE_NAME_CHARS, "%.150s", properties.name);
    TRY(cudaEventCreate(&s->begin));
    TRY(cudaEventCreate(&s->end));
    return check_room(volume_bytes(&s->volume), "the volume", error);
}

static reference_status cuda_open(const reference_options *options, const reference_volume *volume, void **state,
                                  char name[DEVICE_NAME_CHARS], vodr_error *error)
{
    (void)options;
    cuda_state *s = (cuda_state *)calloc(1, sizeof *s);
    if (!s)
        return reference_fail(error, REFERENCE_NO_MEMORY, "no memory for the reference renderer");
    s->volume = *volume;
    reference_status status = open_device(s, name, error);
    if (status == REFERENCE_OK)
        *state = s;
    else
        cuda_close(s);
    return status;
}

static reference_status need_linear(cuda_state *s, vodr_error *error)
{
    if (s->linear)
        return REFERENCE_OK;
    size_t bytes = volume_bytes(&s->volume);
    reference_status status = check_room(bytes, "the volume", error);
    if (status != REFERENCE_OK)
        return status;
    TRY(cudaMalloc(&s->linear, bytes));
    TRY(cudaMemcpy(s->linear, s->volume.voxels, bytes, cudaMemcpyHostToDevice));
    return REFERENCE_OK;
}

static reference_status need_texture(cuda_state *s, vodr_error *error)
{
    if (s->texture)
        return REFERENCE_OK;
    const reference_volume *v = &s->volume;
    const int bits = 8 * (int)voxel_bytes[v->type];
    const bool is_float = v->type == REFERENCE_FLOAT32;
    reference_status status = check_room(volume_bytes(v), "the volume as a texture", error);
    if (status != REFERENCE_OK)
        return status;
    cudaChannelFormatDesc format =
        cudaCreateChannelDesc(bits, 0, 0, 0, is_float ? cudaChannelFormatKindFloat : cudaChannelFormatKindUnsigned);
    cudaExtent extent = make_cudaExtent(v->dims_vox[0], v->dims_vox[1], v->dims_vox[2]);
    if (!s->array)
        TRY(cudaMalloc3DArray(&s->array, &format, extent));
    cudaMemcpy3DParms copy = {};
    copy.srcPtr =
        make_cudaPitchedPtr((void *)v->voxels, v->dims_vox[0] * voxel_bytes[v->type], v->dims_vox[0], v->dims_vox[1]);
    copy.dstArray = s->array;
    copy.extent = extent;
    copy.kind = cudaMemcpyHostToDevice;
    TRY(cudaMemcpy3D(&copy));
    cudaResourceDesc resource = {};
    resource.resType = cudaResourceTypeArray;
    resource.res.array.array = s->array;
    cudaTextureDesc texture = {};
    for (int a = 0; a < 3; a++)
        texture.addressMode[a] = cudaAddressModeClamp;
    texture.filterMode = cudaFilterModeLinear;
    texture.readMode = is_float ? cudaReadModeElementType : cudaReadModeNormalizedFloat;
    TRY(cudaCreateTextureObject(&s->texture, &resource, &texture, NULL));
    return REFERENCE_OK;
}

/* A piece of device memory for the frame, filled from `data` where that is not NULL. */
static reference_status take(frame_memory *m, size_t bytes, const void *data, void **piece, vodr_error *error)
{
    TRY(cudaMalloc(piece, bytes ? bytes : 1));
    m->piece[m->count++] = *piece;
    if (data)
        TRY(cudaMemcpy(*piece, data, bytes, cudaMemcpyHostToDevice));
    return REFERENCE_OK;
}

static void release(frame_memory *m)
{
    while (m->count > 0)
        cudaFree(m->piece[--m->count]);
}

#define TRY_STATUS(call)                                                                                               \
    do {                                                                                                               \
        reference_status try_status = call;                                                                            \
        if (try_status != REFERENCE_OK)                                                                                \
            return try_status;                                                                                         \
    } while (0)

static dim3 grid_of(int32_t width_px, int32_t height_px)
{
    return dim3((unsigned)(width_px + BLOCK_W - 1) / BLOCK_W, (unsigned)(height_px + BLOCK_H - 1) / BLOCK_H);
}

/* Waits for the kernel and adds up the samples of its pixels. */
static reference_status finish(cuda_state *s, const uint32_t *counts, size_t pixels, reference_stats *stats,
                               vodr_error *error)
{
    float ms;
    TRY(cudaGetLastError());
    TRY(cudaEventRecord(s->end));
    TRY(cudaEventSynchronize(s->end));
    TRY(cudaEventElapsedTime(&ms, s->begin, s->end));
    stats->draw_ms = ms;
    uint32_t *host = (uint32_t *)malloc(pixels * sizeof *host);
    if (!host)
        return reference_fail(error, REFERENCE_NO_MEMORY, "no memory for the samples of %zu pixels", pixels);
    reference_status status =
        check(cudaMemcpy(host, counts, pixels * sizeof *host, cudaMemcpyDeviceToHost), "cudaMemcpy of samples", error);
    for (size_t i = 0; status == REFERENCE_OK && i < pixels; i++)
        stats->samples += host[i];
    free(host);
    return status;
}

/* ---- the machine's arithmetic ---- */

static __global__ void fixed_kernel(kernel_fixed f, vodr_rgba *pixels, uint32_t *counts)
{
    int32_t x = blockIdx.x * BLOCK_W + threadIdx.x, y = blockIdx.y * BLOCK_H + threadIdx.y;
    if (x >= f.view.width_px || y >= f.view.height_px)
        return;
    uint32_t fragments = 0;
    size_t i = (size_t)y * f.view.width_px + x;
    pixels[i] = fixed_pixel(&f, x, y, &fragments);
    counts[i] = fragments;
}

static reference_status draw_fixed(cuda_state *s, frame_memory *m, kernel_fixed f, vodr_rgba *pixels,
                                   reference_stats *stats, vodr_error *error)
{
    void *map, *table, *out, *counts;
    size_t count = (size_t)f.view.width_px * (size_t)f.view.height_px;
    TRY_STATUS(need_linear(s, error));
    TRY_STATUS(check_room(count * (sizeof *pixels + sizeof(uint32_t)), "the frame", error));
    TRY_STATUS(take(m, 256 * sizeof *f.map, f.map, &map, error));
    TRY_STATUS(take(m, sizeof *f.table << f.density_bits, f.table, &table, error));
    TRY_STATUS(take(m, count * sizeof *pixels, NULL, &out, error));
    TRY_STATUS(take(m, count * sizeof(uint32_t), NULL, &counts, error));
    f.voxels = s->linear;
    f.map = (const uint16_t *)map;
    f.table = (const vodr_rgba *)table;
    TRY(cudaEventRecord(s->begin));
    fixed_kernel<<<grid_of(f.view.width_px, f.view.height_px), dim3(BLOCK_W, BLOCK_H)>>>(f, (vodr_rgba *)out,
                                                                                         (uint32_t *)counts);
    TRY_STATUS(finish(s, (const uint32_t *)counts, count, stats, error));
    TRY(cudaMemcpy(pixels, out, count * sizeof *pixels, cudaMemcpyDeviceToHost));
    return REFERENCE_OK;
}

static reference_status cuda_fixed(void *state, const kernel_fixed *f, vodr_rgba *pixels, reference_stats *stats,
                                   vodr_error *error)
{
    frame_memory m = {};
    reference_status status = draw_fixed((cuda_state *)state, &m, *f, pixels, stats, error);
    release(&m);
    return status;
}

/* ---- floating point ---- */

template <kernel_mode mode, kernel_filter filter, kernel_skip skip, reference_voxel type>
static __global__ void march_kernel(const __grid_constant__ kernel_frame f, float4 *rgba, uint32_t *counts)
{
    extern __shared__ float4 shared[];
    const int entries = f.table.columns * f.table.rows;
    const void *table = f.table.rgba;
    if (entries * sizeof *shared <= MAX_SHARED_BYTES) {
        for (int i = threadIdx.y * BLOCK_W + threadIdx.x; i < entries; i += BLOCK_W * BLOCK_H)
            shared[i] = ((const float4 *)table)[i];
        __syncthreads();
        table = shared;
    }
    int32_t x = blockIdx.x * BLOCK_W + threadIdx.x, y = blockIdx.y * BLOCK_H + threadIdx.y;
    if (x >= f.camera.width_px || y >= f.camera.height_px)
        return;
    kernel_ray ray = ray_make(&f, x, y);
    packet rays;
    for (int a = 0; a < 3; a++) {
        rays.start[a] = (float)ray.start[a];
        rays.step[a] = (float)ray.step[a];
    }
    rays.count = ray.count;
    packet_result result = march(&f, table, &rays, mode, filter, skip, type);
    size_t i = (size_t)y * f.camera.width_px + x;
    rgba[i] = make_float4(result.rgba[0], result.rgba[1], result.rgba[2], result.rgba[3]);
    counts[i] = (uint32_t)result.samples;
}

typedef void march_function(const kernel_frame f, float4 *rgba, uint32_t *counts);

/* The kernel of a variant: each parameter in turn becomes a constant. */
template <kernel_mode mode, kernel_filter filter, kernel_skip skip> static march_function *by_type(reference_voxel type)
{
    switch (type) {
    case REFERENCE_UINT8: return march_kernel<mode, filter, skip, REFERENCE_UINT8>;
    case REFERENCE_UINT16: return march_kernel<mode, filter, skip, REFERENCE_UINT16>;
    default: return march_kernel<mode, filter, skip, REFERENCE_FLOAT32>;
    }
}

template <kernel_mode mode, kernel_filter filter> static march_function *by_skip(kernel_skip skip, reference_voxel type)
{
    return skip == KERNEL_SKIP_NONE ? by_type<mode, filter, KERNEL_SKIP_NONE>(type)
                                    : by_type<mode, filter, KERNEL_SKIP_EMPTY>(type);
}

template <kernel_mode mode> static march_function *by_filter(const device_march *m, reference_voxel type)
{
    switch (m->frame.filter) {
    case KERNEL_NEAREST: return by_skip<mode, KERNEL_NEAREST>(m->skip, type);
    case KERNEL_LINEAR: return by_skip<mode, KERNEL_LINEAR>(m->skip, type);
    default: return by_skip<mode, KERNEL_TEXTURE>(m->skip, type);
    }
}

static march_function *march_variant(const device_march *m, reference_voxel type)
{
    switch (m->mode) {
    case KERNEL_OVER: return by_filter<KERNEL_OVER>(m, type);
    case KERNEL_LIT: return by_filter<KERNEL_LIT>(m, type);
    default: return by_filter<KERNEL_MIP>(m, type);
    }
}

/* The frame's tables on the card, in place of the host's. */
static reference_status take_tables(frame_memory *m, kernel_frame *f, kernel_skip skip, vodr_error *error)
{
    void *piece;
    size_t entries = (size_t)f->table.columns * (size_t)f->table.rows;
    size_t count = (size_t)f->blocks.count[0] * (size_t)f->blocks.count[1] * (size_t)f->blocks.count[2];
    TRY_STATUS(take(m, entries * sizeof(float4), f->table.rgba, &piece, error));
    f->table.rgba = piece;
    if (skip == KERNEL_SKIP_NONE)
        return REFERENCE_OK;
    TRY_STATUS(take(m, count, f->blocks.distance, &piece, error));
    f->blocks.distance = (const uint8_t *)piece;
    TRY_STATUS(take(m, count * sizeof *f->blocks.most, f->blocks.most, &piece, error));
    f->blocks.most = (const float *)piece;
    return REFERENCE_OK;
}

static reference_status draw_march(cuda_state *s, frame_memory *m, const device_march *job, float4 *host,
                                   reference_stats *stats, vodr_error *error)
{
    kernel_frame f = job->frame;
    void *out, *counts;
    size_t pixels = (size_t)f.camera.width_px * (size_t)f.camera.height_px;
    size_t table_bytes = (size_t)f.table.columns * (size_t)f.table.rows * sizeof(float4);
    TRY_STATUS(f.filter == KERNEL_TEXTURE ? need_texture(s, error) : need_linear(s, error));
    TRY_STATUS(check_room(pixels * (sizeof *host + sizeof(uint32_t)), "the frame", error));
    TRY_STATUS(take_tables(m, &f, job->skip, error));
    TRY_STATUS(take(m, pixels * sizeof *host, NULL, &out, error));
    TRY_STATUS(take(m, pixels * sizeof(uint32_t), NULL, &counts, error));
    f.volume.voxels = s->linear;
    f.volume.texture = s->texture;
    march_function *variant = march_variant(job, f.volume.type);
    dim3 grid = grid_of(f.camera.width_px, f.camera.height_px), block(BLOCK_W, BLOCK_H);
    TRY(cudaEventRecord(s->begin));
    variant<<<grid, block, table_bytes <= MAX_SHARED_BYTES ? table_bytes : 0>>>(f, (float4 *)out, (uint32_t *)counts);
    TRY_STATUS(finish(s, (const uint32_t *)counts, pixels, stats, error));
    TRY(cudaMemcpy(host, out, pixels * sizeof *host, cudaMemcpyDeviceToHost));
    return REFERENCE_OK;
}

static reference_status cuda_march(void *state, const device_march *job, double *rgba, reference_stats *stats,
                                   vodr_error *error)
{
    frame_memory m = {};
    size_t pixels = (size_t)job->frame.camera.width_px * (size_t)job->frame.camera.height_px;
    float4 *host = (float4 *)malloc(pixels * sizeof *host);
    if (!host)
        return reference_fail(error, REFERENCE_NO_MEMORY, "no memory for %zu pixels", pixels);
    reference_status status = draw_march((cuda_state *)state, &m, job, host, stats, error);
    for (size_t i = 0; status == REFERENCE_OK && i < pixels; i++) {
        rgba[4 * i] = host[i].x;
        rgba[4 * i + 1] = host[i].y;
        rgba[4 * i + 2] = host[i].z;
        rgba[4 * i + 3] = host[i].w;
    }
    free(host);
    release(&m);
    return status;
}

static const device_ops ops = {cuda_open, cuda_close, cuda_fixed, cuda_march};

const device_ops *device_cuda(void)
{
    return &ops;
}
