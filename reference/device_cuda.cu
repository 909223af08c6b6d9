/* device_cuda.cu - a CUDA card as a device: the volume in its memory, a thread a pixel. */
#include <cuda_runtime.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define REAL float
#include "bounds_cuda.h"
#include "cells_cuda.h"
#include "cubic_cuda.h"
#include "device.h"
#include "kernel_fixed.h"
#include "march_cuda.h"
#include "state_cuda.h"

enum { BLOCK_W = 16, BLOCK_H = 8 };

static void cuda_close(void *state)
{
    cuda_state *s = (cuda_state *)state;
    if (s->texture)
        cudaDestroyTextureObject(s->texture);
    cudaFreeArray(s->array);
    cudaFree(s->linear);
    cudaFree(s->cells);
    cudaFree((void *)s->bounds.codes);
    cudaFree(s->block_codes);
    for (int i = 0; i < 2; i++) {
        cudaFree(s->cubic[i].coefficients);
        cudaFree(s->cubic[i].codes);
        for (int a = 0; a < 3; a++)
            cudaFree(s->cubic[i].copy[a]);
    }
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

/* Packs the volume's cells once; without room for them, or with voxels that cannot be packed, there are none. */
static reference_status want_cells(cuda_state *s, reference_stats *stats, vodr_error *error)
{
    const reference_volume *v = &s->volume;
    const int3 size = make_int3(v->dims_vox[0], v->dims_vox[1], v->dims_vox[2]);
    size_t room, all, count = (size_t)(size.x + 1) * (size_t)(size.y + 1) * (size_t)(size.z + 1);
    size_t bytes = 8 * voxel_bytes[v->type] * count;
    float ms;
    TRY(cudaMemGetInfo(&room, &all));
    if (s->cells || v->type == REFERENCE_FLOAT32 || count > INT32_MAX || bytes > room / 10 * 9)
        return REFERENCE_OK;
    TRY(cudaMalloc(&s->cells, bytes));
    TRY(cudaEventRecord(s->begin));
    const unsigned blocks = (unsigned)((count + 255) / 256);
    if (v->type == REFERENCE_UINT8)
        pack_cells<<<blocks, 256>>>((const uint8_t *)s->linear, size, (uint2 *)s->cells, (unsigned)count);
    else
        pack_cells<<<blocks, 256>>>((const uint16_t *)s->linear, size, (uint4 *)s->cells, (unsigned)count);
    TRY(cudaGetLastError());
    TRY(cudaEventRecord(s->end));
    TRY(cudaEventSynchronize(s->end));
    TRY(cudaEventElapsedTime(&ms, s->begin, s->end));
    stats->preprocess_ms += ms;
    return REFERENCE_OK;
}

/* ---- bounds ---- */

static void start_blocks(const cuda_state *s, int32_t edge_vox, uint16_t *const spare[2], uint16_t *codes)
{
    const reference_volume *v = &s->volume;
    switch (v->type) {
    case REFERENCE_UINT8:
        return bounds_start_blocks((const uint8_t *)s->linear, s->code, v->dims_vox, edge_vox, spare, codes);
    case REFERENCE_UINT16:
        return bounds_start_blocks((const uint16_t *)s->linear, s->code, v->dims_vox, edge_vox, spare, codes);
    default: return bounds_start_blocks((const float *)s->linear, s->code, v->dims_vox, edge_vox, spare, codes);
    }
}

static void start_grids(const cuda_state *s, uint16_t *const spare[3], uint16_t *codes)
{
    const reference_volume *v = &s->volume;
    switch (v->type) {
    case REFERENCE_UINT8:
        return bounds_start_grids((const uint8_t *)s->linear, s->code, v->dims_vox, &s->bounds, spare, codes);
    case REFERENCE_UINT16:
        return bounds_start_grids((const uint16_t *)s->linear, s->code, v->dims_vox, &s->bounds, spare, codes);
    default: return bounds_start_grids((const float *)s->linear, s->code, v->dims_vox, &s->bounds, spare, codes);
    }
}

/* Fills codes[], which is new, with blocks of edge_vox cells, or with the grids of a search where that is 0. */
static reference_status make_codes(cuda_state *s, frame_memory *m, int32_t edge_vox, size_t count, uint16_t **codes,
                                   reference_stats *stats, vodr_error *error)
{
    const int32_t *dims = s->volume.dims_vox;
    uint16_t *spare[3];
    float ms;
    const size_t cut = edge_vox ? (size_t)dims[0] * dims[1] * bounds_count(dims[2], edge_vox)
                                : (size_t)s->bounds.count[1][0] * s->bounds.count[1][1] * s->bounds.count[1][2];
    TRY_STATUS(need_linear(s, error));
    TRY_STATUS(check_room((count + (edge_vox ? 2 : 3) * cut) * sizeof **codes, "the volume's maxima", error));
    for (int i = 0; i < (edge_vox ? 2 : 3); i++) {
        void *piece;
        TRY_STATUS(take(m, cut * sizeof **codes, NULL, &piece, error));
        spare[i] = (uint16_t *)piece;
    }
    TRY(cudaMalloc(codes, count * sizeof **codes));
    TRY(cudaEventRecord(s->begin));
    if (edge_vox)
        start_blocks(s, edge_vox, spare, *codes);
    else
        start_grids(s, spare, *codes);
    TRY(cudaGetLastError());
    TRY(cudaEventRecord(s->end));
    TRY(cudaEventSynchronize(s->end));
    TRY(cudaEventElapsedTime(&ms, s->begin, s->end));
    stats->preprocess_ms += ms;
    return REFERENCE_OK;
}

static reference_status need_codes(cuda_state *s, kernel_mode mode, const kernel_blocks *b, reference_stats *stats,
                                   vodr_error *error)
{
    frame_memory spare = {};
    reference_status status = REFERENCE_OK;
    uint16_t *codes = NULL;
    if (mode == KERNEL_SEARCH && !s->bounds.codes) {
        size_t count = bounds_shape(s->volume.dims_vox, false, &s->bounds);
        status = make_codes(s, &spare, 0, count, &codes, stats, error);
        s->bounds.codes = codes;
    } else if (mode == KERNEL_LEAP && s->block_edge_vox != b->edge_vox) {
        cudaFree(s->block_codes);
        s->block_edge_vox = 0;
        size_t count = (size_t)b->count[0] * (size_t)b->count[1] * (size_t)b->count[2];
        status = make_codes(s, &spare, b->edge_vox, count, &s->block_codes, stats, error);
        s->block_edge_vox = status == REFERENCE_OK ? b->edge_vox : 0;
    }
    release(&spare);
    return status;
}

/* What a maximum's ways past its blocks need. */
static reference_status take_bounds(cuda_state *s, kernel_mode mode, kernel_frame *f, reference_stats *stats,
                                    vodr_error *error)
{
    if ((mode != KERNEL_LEAP && mode != KERNEL_SEARCH) || f->filter == KERNEL_CUBIC)
        return REFERENCE_OK;
    if (!s->has_code)
        s->code = bounds_code_of(&s->volume);
    s->has_code = true;
    TRY_STATUS(need_codes(s, mode, &f->blocks, stats, error));
    f->bounds = s->bounds;
    f->blocks.most = s->block_codes;
    bounds_decode(&s->code, f->filter, &f->bounds);
    return REFERENCE_OK;
}

/* ---- cubics ---- */

/* Waits for what was begun at s->begin. */
static reference_status add_time(cuda_state *s, reference_stats *stats, vodr_error *error)
{
    float ms;
    TRY(cudaGetLastError());
    TRY(cudaEventRecord(s->end));
    TRY(cudaEventSynchronize(s->end));
    TRY(cudaEventElapsedTime(&ms, s->begin, s->end));
    stats->preprocess_ms += ms;
    return REFERENCE_OK;
}

/* The coefficients of B-splines, once. */
static reference_status need_coefficients(cuda_state *s, frame_memory *m, reference_stats *stats, vodr_error *error)
{
    cubic_cuda *c = &s->cubic[true];
    const int32_t *dims = s->volume.dims_vox;
    const size_t bytes = (size_t)dims[0] * (size_t)dims[1] * (size_t)dims[2] * sizeof(float);
    void *spare;
    if (c->coefficients)
        return REFERENCE_OK;
    TRY_STATUS(check_room(2 * bytes, "the volume's coefficients", error));
    TRY_STATUS(take(m, bytes, NULL, &spare, error));
    TRY(cudaMalloc(&c->coefficients, bytes));
    TRY(cudaEventRecord(s->begin));
    cubic_start_prefilter(&s->volume, s->linear, (float *)spare, c->coefficients);
    return add_time(s, stats, error);
}

/* The volume that a filter reads, on the card. */
static reference_status need_cubic(cuda_state *s, frame_memory *m, bool spline, reference_volume *v,
                                   reference_stats *stats, vodr_error *error)
{
    TRY_STATUS(need_linear(s, error));
    *v = s->volume;
    v->voxels = s->linear;
    if (!spline)
        return REFERENCE_OK;
    TRY_STATUS(need_coefficients(s, m, stats, error));
    v->type = REFERENCE_FLOAT32;
    v->voxels = s->cubic[true].coefficients;
    return REFERENCE_OK;
}

/* Whether there is room for three copies; asked once, before the first. */
static reference_status decide_copies(cuda_state *s, vodr_error *error)
{
    cubic_cuda *c = &s->cubic[true];
    const size_t count = bounds_box_count(cubic_wide(s->volume.dims_vox, 0));
    size_t room, all;
    if (c->copies > 0)
        return REFERENCE_OK;
    TRY(cudaMemGetInfo(&room, &all));
    c->copies = count <= INT32_MAX && 3 * count * sizeof(float) <= room / 10 * 9 ? 3 : 1;
    return REFERENCE_OK;
}

/* The copy whose fastest axis is `first`, in place of the coefficients; once there, its sums are of the same numbers in
 * the same order. */
static reference_status take_copy(cuda_state *s, const device_alignment *a, kernel_volume *v, reference_stats *stats,
                                  vodr_error *error)
{
    cubic_cuda *c = &s->cubic[true];
    const int first = a->fast_axis;
    const bounds_box wide = cubic_wide(s->volume.dims_vox, first);
    stats->copies = 1;
    TRY_STATUS(decide_copies(s, error));
    if (a->copies == 1 || c->copies == 1)
        return REFERENCE_OK;
    if (!c->copy[first]) {
        if (cudaMalloc(&c->copy[first], bounds_box_count(wide) * sizeof(float)) != cudaSuccess) {
            cudaGetLastError(); /* it has been seen to */
            c->copy[first] = NULL;
            c->copies = 1;
            return REFERENCE_OK;
        }
        TRY(cudaEventRecord(s->begin));
        cubic_start_sort(c->coefficients, s->volume.dims_vox, first, c->copy[first]);
        TRY_STATUS(add_time(s, stats, error));
    }
    const int32_t stride[3] = {1, wide.size[0], wide.size[0] * wide.size[1]};
    int64_t begin = 0;
    for (int n = 0; n < 3; n++) {
        v->stride[(first + n) % 3] = stride[n];
        begin += (int64_t)LAYOUT_MARGIN_VOX * stride[n];
    }
    v->layout = KERNEL_WIDE;
    v->voxels = c->copy[first] + begin;
    stats->copies = 3;
    return REFERENCE_OK;
}

/* The scale of a filter's bounds, once; ends[] has room for two numbers on the card. */
static reference_status need_scale(cuda_state *s, const reference_volume *v, bool spline, int32_t *ends,
                                   vodr_error *error)
{
    cubic_cuda *c = &s->cubic[spline];
    int32_t found[2] = {INT32_MAX, INT32_MIN};
    if (c->has_scale)
        return REFERENCE_OK;
    TRY(cudaMemcpy(ends, found, sizeof found, cudaMemcpyHostToDevice));
    cubic_start_extremes(v, ends);
    TRY(cudaMemcpy(found, ends, sizeof found, cudaMemcpyDeviceToHost));
    c->scale = hull_scale_of(spline, cubic_float(found[0]), cubic_float(found[1]));
    c->has_scale = true;
    return REFERENCE_OK;
}

static reference_status make_ranges(cuda_state *s, frame_memory *m, const device_ranges *r, reference_stats *stats,
                                    vodr_error *error)
{
    cubic_cuda *c = &s->cubic[r->spline];
    reference_volume v;
    const size_t count = (size_t)r->count[0] * (size_t)r->count[1] * (size_t)r->count[2];
    const bounds_box cells = cubic_cells(s->volume.dims_vox), blocks = bounds_box_of(r->count);
    const size_t codes = r->cells && !c->codes ? bounds_box_count(cells) : 0;
    void *least, *most;
    TRY_STATUS(need_cubic(s, m, r->spline, &v, stats, error));
    TRY_STATUS(check_room(2 * (count + 1) * sizeof(float) + codes * sizeof(uint16_t), "the volume's bounds", error));
    TRY_STATUS(take(m, (count + 1) * sizeof(float), NULL, &least, error));
    TRY_STATUS(take(m, (count + 1) * sizeof(float), NULL, &most, error));
    if (codes)
        TRY(cudaMalloc(&c->codes, codes * sizeof(uint16_t)));
    TRY(cudaEventRecord(s->begin));
    TRY_STATUS(need_scale(s, &v, r->spline, (int32_t *)least, error));
    *r->scale = c->scale;
    if (r->bound == HULL_BEZIER)
        cubic_start_hull(&v, r->spline, c->scale, blocks, r->edge_vox, (int32_t *)least, (int32_t *)most,
                         codes ? c->codes : NULL);
    else
        cubic_start_rival(&v, c->scale, hull_share(r->bound, r->spline), blocks, r->edge_vox, (float *)least,
                          (float *)most);
    TRY_STATUS(add_time(s, stats, error));
    TRY(cudaMemcpy(r->least, least, count * sizeof(float), cudaMemcpyDeviceToHost));
    TRY(cudaMemcpy(r->most, most, count * sizeof(float), cudaMemcpyDeviceToHost));
    return REFERENCE_OK;
}

static reference_status cuda_ranges(void *state, const device_ranges *r, reference_stats *stats, vodr_error *error)
{
    frame_memory m = {};
    cuda_state *s = (cuda_state *)state;
    const bool had = s->cubic[r->spline].codes != NULL;
    reference_status status = make_ranges(s, &m, r, stats, error);
    if (status != REFERENCE_OK && !had) { /* they may not be filled */
        cudaFree(s->cubic[r->spline].codes);
        s->cubic[r->spline].codes = NULL;
    }
    release(&m);
    return status;
}

/* ---- marching ---- */

/* The frame's tables on the card, in place of the host's. */
static reference_status take_tables(frame_memory *m, kernel_frame *f, vodr_error *error)
{
    void *piece;
    size_t entries = ((size_t)f->table.columns + 1) * ((size_t)f->table.rows + 1);
    size_t count = (size_t)f->blocks.count[0] * (size_t)f->blocks.count[1] * (size_t)f->blocks.count[2];
    TRY_STATUS(take(m, entries * sizeof(float4), f->table.rgba, &piece, error));
    f->table.rgba = piece;
    if (f->filter == KERNEL_CUBIC && f->blocks.most) {
        TRY_STATUS(take(m, count * sizeof(uint16_t), f->blocks.most, &piece, error));
        f->blocks.most = (const uint16_t *)piece;
    }
    if (f->skip == KERNEL_SKIP_CELLS) {
        TRY_STATUS(take(m, CELL_CODES, f->cells.shows, &piece, error));
        f->cells.shows = (const uint8_t *)piece;
    }
    if (f->skip == KERNEL_SKIP_NONE)
        return REFERENCE_OK;
    TRY_STATUS(take(m, count, f->blocks.distance, &piece, error));
    f->blocks.distance = (const uint8_t *)piece;
    return REFERENCE_OK;
}

static reference_status take_volume(cuda_state *s, frame_memory *m, kernel_mode mode, const device_alignment *a,
                                    kernel_frame *f, reference_stats *stats, vodr_error *error)
{
    if (f->filter == KERNEL_CUBIC) {
        reference_volume v;
        TRY_STATUS(need_cubic(s, m, f->volume.spline, &v, stats, error));
        f->volume.type = v.type;
        f->volume.voxels = v.voxels;
        f->cells.codes = s->cubic[f->volume.spline].codes;
        return a->wanted ? take_copy(s, a, &f->volume, stats, error) : REFERENCE_OK;
    }
    TRY_STATUS(f->filter == KERNEL_TEXTURE ? need_texture(s, error) : need_linear(s, error));
    /* A search reads too little for cells to be packed; a box is drawn without. */
    if (f->filter == KERNEL_LINEAR && mode != KERNEL_SEARCH && !f->part.boxed) {
        TRY_STATUS(want_cells(s, stats, error));
        f->filter = s->cells ? KERNEL_CELLS : KERNEL_LINEAR;
    }
    f->volume.voxels = s->linear;
    f->volume.cells = s->cells;
    f->volume.texture = s->texture;
    return REFERENCE_OK;
}

static reference_status draw_march(cuda_state *s, frame_memory *m, const device_march *job, float4 *host,
                                   reference_stats *stats, vodr_error *error)
{
    kernel_frame f = job->frame;
    void *out, *counts;
    size_t pixels = (size_t)f.camera.width_px * (size_t)f.camera.height_px;
    TRY_STATUS(take_volume(s, m, job->mode, &job->alignment, &f, stats, error));
    TRY_STATUS(take_bounds(s, job->mode, &f, stats, error));
    TRY_STATUS(check_room(pixels * (sizeof *host + sizeof(uint32_t)), "the frame", error));
    TRY_STATUS(take_tables(m, &f, error));
    TRY_STATUS(take(m, pixels * sizeof *host, NULL, &out, error));
    TRY_STATUS(take(m, pixels * sizeof(uint32_t), NULL, &counts, error));
    march_function *variant = march_variant(job->mode, &f);
    const march_launch launch = launch_of(job->mode, &f, f.volume.layout == KERNEL_WIDE ? job->alignment.fast_axis : 0);
    const int threads = threads_of(job->mode), width = 2 << launch.warp_log2;
    const int height = threads / 64 * (32 >> launch.warp_log2);
    const dim3 grid((f.order.columns + width - 1) / width, (f.order.rows + height - 1) / height);
    const size_t shared_bytes =
        job->mode == KERNEL_OVER || job->mode == KERNEL_LIT ? table_bytes(&f, launch.copies_log2) : 0;
    TRY(cudaFuncSetAttribute(variant, cudaFuncAttributeMaxDynamicSharedMemorySize, (int)shared_bytes));
    TRY(cudaEventRecord(s->begin));
    variant<<<grid, threads, shared_bytes>>>(f, launch, (float4 *)out, (uint32_t *)counts);
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

static const device_ops ops = {cuda_open, cuda_close, cuda_fixed, cuda_march, cuda_ranges};

const device_ops *device_cuda(void)
{
    return &ops;
}
