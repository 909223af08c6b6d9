/* state_cuda.h - private to device_cuda.cu: what it keeps of a volume, memory of a frame, and calls that may fail. */
#ifndef REFERENCE_STATE_CUDA_H
#define REFERENCE_STATE_CUDA_H

#include <cuda_runtime.h>

#include "bounds_cuda.h"
#include "cubic_cuda.h"
#include "device.h"

typedef struct cuda_state {
    reference_volume volume; /* voxels in the host's memory */
    void *linear;            /* the voxels, as they are; NULL until a frame needs them */
    void *cells;             /* the same packed (lanes_cuda.h) */
    cudaArray_t array;       /* the same for the texture unit */
    cudaTextureObject_t texture;
    bounds_code code;
    bool has_code;
    kernel_bounds bounds;  /* codes on the card; NULL until a search needs them */
    uint16_t *block_codes; /* on the card; of the last edge asked for */
    int32_t block_edge_vox;
    cubic_cuda cubic[2]; /* of cardinal splines, of B-splines */
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

#endif
