/* texture_ceiling.cu - what a card's texture unit gives at most: nothing but tex3D along rays, the greatest kept; and
 * ways to do without it, in exact float. A line a kernel and view, in JSON: G samples/s, median, least and greatest.
 *
 *   texture_ceiling [SIDE_VOX [SIZE_PX [SAMPLES [ROUNDS [ONLY]]]]]    512 1024 512 9; ONLY: one kernel's name
 *
 * `eight-fetch` is the cubic B-spline as eight trilinear fetches (Sigg and Hadwiger, GPU Gems 2, chapter 20), whose weights
 * have the texture unit's 8 bits. */
#include <algorithm>
#include <cuda_runtime.h>
#include <numeric>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <vector>

/* A frame of rays: sample n of pixel (x, y) lies at start + x*across + y*down + n*step, in voxels. */
struct rays {
    float start[3], across[3], down[3], step[3];
    int size_px, samples, side_vox;
    bool clip; /* samples outside the volume are left out */
};

struct source {
    cudaTextureObject_t texture;
    const uint8_t *bytes;  /* the voxels */
    const uint2 *corners;  /* of each voxel, it and its seven upper neighbours */
    const uint32_t *quads; /* of each voxel, it and its neighbours in y and z: y in byte 1, z in byte 2 */
};

static void must(cudaError_t code, const char *what)
{
    if (code == cudaSuccess)
        return;
    fprintf(stderr, "texture_ceiling: %s: %s\n", what, cudaGetErrorString(code));
    exit(3);
}

struct by_texture {
    static constexpr float columns = 1023; /* of a value */
    static __device__ __forceinline__ float at(const source &s, int, float x, float y, float z)
    {
        return tex3D<float>(s.texture, x, y, z);
    }
};

/* Along an axis: where the two fetches lie, and the weight of the second. */
static __device__ __forceinline__ float eight_axis(float p, float at[2])
{
    float first = floorf(p - 0.5f), t = p - 0.5f - first, u = 1 - t;
    float w0 = u * u * u / 6, w1 = 2 / 3.0f - t * t * (1 - t / 2), w2 = 2 / 3.0f - u * u * (1 - u / 2), w3 = t * t * t / 6;
    at[0] = first - 0.5f + w1 / (w0 + w1);
    at[1] = first + 1.5f + w3 / (w2 + w3);
    return w2 + w3;
}

struct by_eight {
    static constexpr float columns = 1023; /* of a value */
    static __device__ __forceinline__ float at(const source &s, int, float x, float y, float z)
    {
        float ax[2], ay[2], az[2], u = eight_axis(x, ax), v = eight_axis(y, ay), w = eight_axis(z, az), layer[2];
#pragma unroll
        for (int k = 0; k < 2; k++) {
            float a = tex3D<float>(s.texture, ax[0], ay[0], az[k]), b = tex3D<float>(s.texture, ax[1], ay[0], az[k]);
            float c = tex3D<float>(s.texture, ax[0], ay[1], az[k]), d = tex3D<float>(s.texture, ax[1], ay[1], az[k]);
            float near = a + (b - a) * u, far = c + (d - c) * u;
            layer[k] = near + (far - near) * v;
        }
        return layer[0] + (layer[1] - layer[0]) * w;
    }
};

struct cell {
    int index;
    float u, v, w;
};

static __device__ __forceinline__ cell cell_of(int side, float x, float y, float z)
{
    float fx = floorf(x - 0.5f), fy = floorf(y - 0.5f), fz = floorf(z - 0.5f);
    int i = min(max((int)fx, 0), side - 2), j = min(max((int)fy, 0), side - 2), k = min(max((int)fz, 0), side - 2);
    return cell{(k * side + j) * side + i, x - 0.5f - fx, y - 0.5f - fy, z - 0.5f - fz};
}

static __device__ __forceinline__ float mixed(float a, float b, float t)
{
    return a + (b - a) * t;
}

static __device__ __forceinline__ float mixed8(const float c[8], const cell &at)
{
    float y0 = mixed(mixed(c[0], c[1], at.u), mixed(c[2], c[3], at.u), at.v);
    float y1 = mixed(mixed(c[4], c[5], at.u), mixed(c[6], c[7], at.u), at.v);
    return mixed(y0, y1, at.w);
}

struct by_bytes {
    static constexpr float columns = 1023 / 255.0f;
    static __device__ __forceinline__ float at(const source &s, int side, float x, float y, float z)
    {
        cell c = cell_of(side, x, y, z);
        const uint8_t *p = s.bytes + c.index;
        float v[8];
        for (int n = 0; n < 8; n++)
            v[n] = (float)__ldg(p + (n & 1) + (n >> 1 & 1) * side + (n >> 2) * side * side);
        return mixed8(v, c);
    }
};

/* A byte as a float, less 2^23. */
static __device__ __forceinline__ float raised(uint32_t word, int byte)
{
    return __uint_as_float(__byte_perm(word, 0x4B000000u, 0x7650 | byte));
}

static __device__ __forceinline__ float mixed_raised(uint32_t word, int a, int b, float t)
{
    float low = raised(word, a), high = raised(word, b);
    return (low - 8388608.0f) + (high - low) * t;
}

struct by_corners {
    static constexpr float columns = 1023 / 255.0f;
    static __device__ __forceinline__ float at(const source &s, int side, float x, float y, float z)
    {
        cell c = cell_of(side, x, y, z);
        uint2 v = __ldg(s.corners + c.index);
        float y0 = mixed(mixed_raised(v.x, 0, 1, c.u), mixed_raised(v.x, 2, 3, c.u), c.v);
        float y1 = mixed(mixed_raised(v.y, 0, 1, c.u), mixed_raised(v.y, 2, 3, c.u), c.v);
        return mixed(y0, y1, c.w);
    }
};

struct by_quads {
    static constexpr float columns = 1023 / 255.0f;
    static __device__ __forceinline__ float at(const source &s, int side, float x, float y, float z)
    {
        cell c = cell_of(side, x, y, z);
        uint32_t a = __ldg(s.quads + c.index), b = __ldg(s.quads + c.index + 1);
        float x0 = mixed(mixed_raised(a, 0, 1, c.v), mixed_raised(a, 2, 3, c.v), c.w);
        float x1 = mixed(mixed_raised(b, 0, 1, c.v), mixed_raised(b, 2, 3, c.v), c.w);
        return mixed(x0, x1, c.u);
    }
};

/* The samples of a ray that lie in the volume, half a sample from its faces. */
static __device__ __forceinline__ int2 inside(const rays &r, const float p[3])
{
    float first = 0, last = (float)r.samples;
    for (int a = 0; a < 3; a++) {
        float u = (0.5f - p[a]) / r.step[a], v = (r.side_vox - 0.5f - p[a]) / r.step[a];
        first = fmaxf(first, fminf(u, v));
        last = fminf(last, fmaxf(u, v));
    }
    return make_int2((int)ceilf(first), max((int)ceilf(first), (int)floorf(last)));
}

/* Position by an addition a sample. `table`: an entry of four floats from shared memory is blended too. */
template <class sampler, bool table> static __global__ void march(source s, rays r, float *out, unsigned *counts)
{
    __shared__ float4 entries[1025];
    if (table) {
        for (int i = threadIdx.y * blockDim.x + threadIdx.x; i < 1025; i += blockDim.x * blockDim.y)
            entries[i] = make_float4(i * 1e-6f, i * 1e-6f, i * 1e-6f, i * 1e-6f);
        __syncthreads();
    }
    int x = blockIdx.x * blockDim.x + threadIdx.x, y = blockIdx.y * blockDim.y + threadIdx.y;
    if (x >= r.size_px || y >= r.size_px)
        return;
    float p[3], greatest = 0;
    float4 c = make_float4(0, 0, 0, 0);
    for (int a = 0; a < 3; a++)
        p[a] = r.start[a] + x * r.across[a] + y * r.down[a];
    const int2 range = r.clip ? inside(r, p) : make_int2(0, r.samples);
    for (int a = 0; a < 3; a++)
        p[a] += range.x * r.step[a];
#pragma unroll 4
    for (int n = range.x; n < range.y; n++) {
        float value = sampler::at(s, r.side_vox, p[0], p[1], p[2]);
        if (table) {
            float place = value * sampler::columns;
            int i = min((int)place, 1023);
            float share = place - i, through = 1 - c.w;
            float4 e = entries[i], f = entries[i + 1];
            c.x += mixed(e.x, f.x, share) * through;
            c.y += mixed(e.y, f.y, share) * through;
            c.z += mixed(e.z, f.z, share) * through;
            c.w += mixed(e.w, f.w, share) * through;
        } else {
            greatest = fmaxf(greatest, value);
        }
        for (int a = 0; a < 3; a++)
            p[a] += r.step[a];
    }
    out[(size_t)y * r.size_px + x] = table ? c.x + c.y + c.z + c.w : greatest;
    counts[(size_t)y * r.size_px + x] = range.y - range.x;
}

static __global__ void pack(const uint8_t *bytes, int side, uint2 *corners, uint32_t *quads)
{
    size_t i = (size_t)blockIdx.x * blockDim.x + threadIdx.x, count = (size_t)side * side * side;
    if (i >= count)
        return;
    int x = (int)(i % side), y = (int)(i / side % side), z = (int)(i / side / side);
    uint32_t v[8];
    for (int n = 0; n < 8; n++) {
        int nx = min(x + (n & 1), side - 1), ny = min(y + (n >> 1 & 1), side - 1), nz = min(z + (n >> 2), side - 1);
        v[n] = bytes[((size_t)nz * side + ny) * side + nx];
    }
    corners[i] = make_uint2(v[0] | v[1] << 8 | v[2] << 16 | v[3] << 24, v[4] | v[5] << 8 | v[6] << 16 | v[7] << 24);
    quads[i] = v[0] | v[2] << 8 | v[4] << 16 | v[6] << 24;
}

static source make_source(int side)
{
    size_t count = (size_t)side * side * side;
    std::vector<uint8_t> voxels(count);
    uint32_t state = 1;
    for (size_t i = 0; i < count; i++) {
        state = state * 1664525u + 1013904223u;
        voxels[i] = (uint8_t)((i / side / side + i / side % side) / 4 % 200 + (state >> 28));
    }
    source s = {};
    uint8_t *bytes;
    uint2 *corners;
    uint32_t *quads;
    must(cudaMalloc(&bytes, count), "cudaMalloc");
    must(cudaMalloc(&corners, count * sizeof *corners), "cudaMalloc");
    must(cudaMalloc(&quads, (count + 1) * sizeof *quads), "cudaMalloc");
    must(cudaMemcpy(bytes, voxels.data(), count, cudaMemcpyHostToDevice), "cudaMemcpy");
    pack<<<(unsigned)((count + 255) / 256), 256>>>(bytes, side, corners, quads);
    must(cudaDeviceSynchronize(), "pack");
    cudaChannelFormatDesc format = cudaCreateChannelDesc(8, 0, 0, 0, cudaChannelFormatKindUnsigned);
    cudaArray_t array;
    must(cudaMalloc3DArray(&array, &format, make_cudaExtent(side, side, side)), "cudaMalloc3DArray");
    cudaMemcpy3DParms copy = {};
    copy.srcPtr = make_cudaPitchedPtr(voxels.data(), side, side, side);
    copy.dstArray = array;
    copy.extent = make_cudaExtent(side, side, side);
    copy.kind = cudaMemcpyHostToDevice;
    must(cudaMemcpy3D(&copy), "cudaMemcpy3D");
    cudaResourceDesc resource = {};
    resource.resType = cudaResourceTypeArray;
    resource.res.array.array = array;
    cudaTextureDesc texture = {};
    for (int a = 0; a < 3; a++)
        texture.addressMode[a] = cudaAddressModeClamp;
    texture.filterMode = cudaFilterModeLinear;
    texture.readMode = cudaReadModeNormalizedFloat;
    must(cudaCreateTextureObject(&s.texture, &resource, &texture, NULL), "cudaCreateTextureObject");
    s.bytes = bytes;
    s.corners = corners;
    s.quads = quads;
    return s;
}

/* Rays that look along axis `axis`, the image's x along the next axis but one when `turned`; or obliquely. */
static rays make_rays(int view, int side, int size, int samples)
{
    rays r = {};
    r.size_px = size;
    r.samples = samples;
    r.side_vox = side;
    float pixel = (float)side / size, step = (float)side / samples;
    if (view < 3) {
        int across = view == 0 ? 1 : 0, down = view == 2 ? 1 : 2;
        r.across[across] = pixel;
        r.down[down] = pixel;
        r.step[view] = step;
        r.start[across] = r.start[down] = pixel / 2;
        r.start[view] = step / 2;
        return r;
    }
    /* Azimuth and elevation 30 degrees: shrunk to stay within the volume, or a frame with samples a voxel apart. */
    const float c = 0.8660254f, s = 0.5f, shrink = view == 3 ? 0.57f : 1;
    r.clip = view == 4;
    if (r.clip) {
        r.samples = 2 * side;
        step = 1;
    }
    const float right[3] = {c, 0, -s}, up[3] = {-s * s, c, -c * s}, eye[3] = {s * c, s, c * c};
    for (int a = 0; a < 3; a++) {
        r.across[a] = right[a] * pixel * shrink;
        r.down[a] = -up[a] * pixel * shrink;
        r.step[a] = -eye[a] * step * shrink;
        r.start[a] = side / 2.0f - (r.across[a] + r.down[a]) * size / 2 - r.step[a] * r.samples / 2;
    }
    return r;
}

static const char *const view_names[] = {"x", "y", "z", "oblique", "frame"};

template <class sampler, bool table>
static void measure(const char *name, const source &s, int side, int size, int samples, int rounds, float *out,
                    unsigned *counts)
{
    cudaEvent_t begin, end;
    must(cudaEventCreate(&begin), "cudaEventCreate");
    must(cudaEventCreate(&end), "cudaEventCreate");
    static const dim3 blocks[] = {dim3(16, 8), dim3(32, 8), dim3(8, 8), dim3(32, 4), dim3(8, 16), dim3(4, 32)};
    std::vector<unsigned> taken((size_t)size * size);
    for (int view = 0; view < 5; view++) {
        rays r = make_rays(view, side, size, samples);
        double best = 0, best_least = 0, best_most = 0, all = 0;
        dim3 best_block;
        for (const dim3 &block : blocks) {
            dim3 grid((size + block.x - 1) / block.x, (size + block.y - 1) / block.y);
            std::vector<double> rates;
            for (int i = -2; i < rounds; i++) {
                float ms;
                must(cudaEventRecord(begin), "cudaEventRecord");
                march<sampler, table><<<grid, block>>>(s, r, out, counts);
                must(cudaGetLastError(), name);
                must(cudaEventRecord(end), "cudaEventRecord");
                must(cudaEventSynchronize(end), name);
                must(cudaEventElapsedTime(&ms, begin, end), "cudaEventElapsedTime");
                if (i == -2) {
                    must(cudaMemcpy(taken.data(), counts, taken.size() * sizeof *counts, cudaMemcpyDeviceToHost), name);
                    all = std::accumulate(taken.begin(), taken.end(), 0.0);
                }
                if (i >= 0)
                    rates.push_back(all / ms * 1e-6);
            }
            std::sort(rates.begin(), rates.end());
            if (rates[rates.size() / 2] > best) {
                best = rates[rates.size() / 2];
                best_least = rates.front();
                best_most = rates.back();
                best_block = block;
            }
        }
        printf("{\"kernel\": \"%s\", \"blend\": \"%s\", \"view\": \"%s\", \"block\": \"%ux%u\", \"gsamples_s\": %.1f, "
               "\"least\": %.1f, \"most\": %.1f}\n",
               name, table ? "over" : "max", view_names[view], best_block.x, best_block.y, best, best_least, best_most);
        fflush(stdout);
    }
}

static int argument(int argc, char **argv, int i, int fallback)
{
    return argc > i ? atoi(argv[i]) : fallback;
}

static bool wanted(const char *only, const char *name)
{
    return only[0] == 0 || strcmp(only, name) == 0;
}

int main(int argc, char **argv)
{
    int side = argument(argc, argv, 1, 512), size = argument(argc, argv, 2, 1024);
    int samples = argument(argc, argv, 3, 512), rounds = argument(argc, argv, 4, 9);
    if (side < 2 || side > 1024 || size < 1 || size > 8192 || samples < 1 || rounds < 1) {
        fprintf(stderr, "usage: texture_ceiling [SIDE_VOX [SIZE_PX [SAMPLES [ROUNDS [ONLY]]]]]\n");
        return 2;
    }
    const char *only = argc > 5 ? argv[5] : "";
    source s = make_source(side);
    float *out;
    unsigned *counts;
    must(cudaMalloc(&counts, (size_t)size * size * sizeof *counts), "cudaMalloc");
    must(cudaMalloc(&out, (size_t)size * size * sizeof *out), "cudaMalloc");
    if (wanted(only, "tex3D"))
        measure<by_texture, false>("tex3D", s, side, size, samples, rounds, out, counts);
    if (wanted(only, "tex3D"))
        measure<by_texture, true>("tex3D", s, side, size, samples, rounds, out, counts);
    if (wanted(only, "corners"))
        measure<by_corners, false>("corners", s, side, size, samples, rounds, out, counts);
    if (wanted(only, "corners"))
        measure<by_corners, true>("corners", s, side, size, samples, rounds, out, counts);
    if (wanted(only, "quads"))
        measure<by_quads, false>("quads", s, side, size, samples, rounds, out, counts);
    if (wanted(only, "quads"))
        measure<by_quads, true>("quads", s, side, size, samples, rounds, out, counts);
    if (wanted(only, "bytes"))
        measure<by_bytes, false>("bytes", s, side, size, samples, rounds, out, counts);
    if (wanted(only, "eight-fetch"))
        measure<by_eight, false>("eight-fetch", s, side, size, samples, rounds, out, counts);
    if (wanted(only, "eight-fetch"))
        measure<by_eight, true>("eight-fetch", s, side, size, samples, rounds, out, counts);
    return 0;
}
