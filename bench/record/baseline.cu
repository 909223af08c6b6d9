/* baseline.cu - a plain ray caster after the CUDA samples' volumeRender: see baseline.h. Its rays are ours, so that the
 * pictures can be compared. */
#include <cuda_runtime.h>
#include <stdio.h>
#include <stdlib.h>
#include <vector>

#define REAL float
#include "baseline.h"
#include "kernel_ray.h"
#include "part.h"

#define TRY(call)                                                                                                      \
    do {                                                                                                               \
        cudaError_t try_code = call;                                                                                   \
        if (try_code != cudaSuccess) {                                                                                 \
            snprintf(error->text, sizeof error->text, "CUDA: %s: %s", #call, cudaGetErrorString(try_code));            \
            return REFERENCE_NO_DEVICE;                                                                                \
        }                                                                                                              \
    } while (0)

/* place = value*scale + offset is where a table of texels at half steps has the column of a value. */
static __global__ void baseline_kernel(kernel_frame f, cudaTextureObject_t table, float scale, float offset,
                                       float threshold, float4 *out)
{
    int x = blockIdx.x * blockDim.x + threadIdx.x, y = blockIdx.y * blockDim.y + threadIdx.y;
    if (x >= f.camera.width_px || y >= f.camera.height_px)
        return;
    kernel_ray ray = ray_make(&f, x, y);
    float3 p = make_float3(ray.start[0], ray.start[1], ray.start[2]);
    float3 step = make_float3(ray.step[0], ray.step[1], ray.step[2]);
    float4 sum = make_float4(0, 0, 0, 0);
    for (int n = 0; n < ray.count; n++) {
        float value = tex3D<float>(f.volume.texture, p.x, p.y, p.z);
        float4 c = tex1D<float4>(table, value * scale + offset);
        float through = 1 - sum.w;
        sum.x += c.x * through;
        sum.y += c.y * through;
        sum.z += c.z * through;
        sum.w += c.w * through;
        if (sum.w >= threshold)
            break;
        p.x += step.x;
        p.y += step.y;
        p.z += step.z;
    }
    out[(size_t)y * f.camera.width_px + x] = sum;
}

static cudaTextureDesc linear_texture(bool normalised)
{
    cudaTextureDesc d = {};
    d.addressMode[0] = d.addressMode[1] = d.addressMode[2] = cudaAddressModeClamp;
    d.filterMode = cudaFilterModeLinear;
    d.normalizedCoords = normalised;
    d.readMode = normalised ? cudaReadModeElementType : cudaReadModeNormalizedFloat;
    return d;
}

static reference_status upload(const reference_volume *v, const reference_march_job *job, cudaArray_t arrays[2],
                               cudaTextureObject_t textures[2], vodr_error *error)
{
    cudaChannelFormatDesc bytes = cudaCreateChannelDesc(8, 0, 0, 0, cudaChannelFormatKindUnsigned);
    cudaChannelFormatDesc colours = cudaCreateChannelDesc<float4>();
    const int columns = job->table.columns;
    std::vector<float4> table(columns);
    for (int i = 0; i < columns; i++) {
        const double *e = job->table.rgba + 4 * i;
        table[i] = make_float4(e[0], e[1], e[2], e[3]);
    }
    cudaMemcpy3DParms copy = {};
    TRY(cudaMalloc3DArray(&arrays[0], &bytes, make_cudaExtent(v->dims_vox[0], v->dims_vox[1], v->dims_vox[2])));
    copy.srcPtr = make_cudaPitchedPtr((void *)v->voxels, v->dims_vox[0], v->dims_vox[0], v->dims_vox[1]);
    copy.dstArray = arrays[0];
    copy.extent = make_cudaExtent(v->dims_vox[0], v->dims_vox[1], v->dims_vox[2]);
    copy.kind = cudaMemcpyHostToDevice;
    TRY(cudaMemcpy3D(&copy));
    TRY(cudaMallocArray(&arrays[1], &colours, columns));
    TRY(cudaMemcpy2DToArray(arrays[1], 0, 0, table.data(), columns * sizeof(float4), columns * sizeof(float4), 1,
                            cudaMemcpyHostToDevice));
    for (int i = 0; i < 2; i++) {
        cudaResourceDesc resource = {};
        resource.resType = cudaResourceTypeArray;
        resource.res.array.array = arrays[i];
        cudaTextureDesc texture = linear_texture(i == 1);
        TRY(cudaCreateTextureObject(&textures[i], &resource, &texture, NULL));
    }
    return REFERENCE_OK;
}

static reference_status draw(const reference_march_job *job, kernel_frame f, cudaTextureObject_t table, float4 *out,
                             double *ms, int rounds, vodr_error *error)
{
    const float columns = job->table.columns;
    cudaEvent_t begin, end;
    dim3 block(16, 16), grid((f.camera.width_px + 15) / 16, (f.camera.height_px + 15) / 16);
    TRY(cudaEventCreate(&begin));
    TRY(cudaEventCreate(&end));
    for (int i = -1; i < rounds; i++) {
        float once_ms;
        TRY(cudaEventRecord(begin));
        baseline_kernel<<<grid, block>>>(f, table, (columns - 1) / columns, 0.5f / columns, (float)job->termination,
                                         out);
        TRY(cudaGetLastError());
        TRY(cudaEventRecord(end));
        TRY(cudaEventSynchronize(end));
        TRY(cudaEventElapsedTime(&once_ms, begin, end));
        if (i >= 0)
            ms[i] = once_ms;
    }
    TRY(cudaEventDestroy(begin));
    TRY(cudaEventDestroy(end));
    return REFERENCE_OK;
}

reference_status baseline_draw(const reference_volume *volume, const reference_march_job *job, double *rgba, double *ms,
                               int rounds, vodr_error *error)
{
    cudaArray_t arrays[2] = {};
    cudaTextureObject_t textures[2] = {};
    float4 *out = NULL;
    size_t pixels = (size_t)job->camera.width_px * job->camera.height_px;
    std::vector<float4> host(pixels);
    kernel_frame f = {};
    f.camera = job->camera;
    reference_status status = part_of(volume, job, &f.part, error);
    if (status == REFERENCE_OK)
        status = upload(volume, job, arrays, textures, error);
    f.volume.texture = textures[0];
    if (status == REFERENCE_OK && cudaMalloc(&out, pixels * sizeof *out) != cudaSuccess)
        status = REFERENCE_NO_MEMORY;
    if (status == REFERENCE_OK)
        status = draw(job, f, textures[1], out, ms, rounds, error);
    if (status == REFERENCE_OK)
        TRY(cudaMemcpy(host.data(), out, pixels * sizeof *out, cudaMemcpyDeviceToHost));
    for (size_t i = 0; i < pixels; i++) {
        rgba[4 * i] = host[i].x;
        rgba[4 * i + 1] = host[i].y;
        rgba[4 * i + 2] = host[i].z;
        rgba[4 * i + 3] = host[i].w;
    }
    cudaFree(out);
    for (int i = 0; i < 2; i++) {
        if (textures[i])
            cudaDestroyTextureObject(textures[i]);
        cudaFreeArray(arrays[i]);
    }
    return status;
}
