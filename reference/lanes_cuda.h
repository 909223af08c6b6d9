/* lanes_cuda.h - lanes.h on a card: a thread is one lane. */
#ifndef REFERENCE_LANES_CUDA_H
#define REFERENCE_LANES_CUDA_H

#include "kernel_types.h"

typedef REAL real;
typedef int32_t whole;
typedef bool mask;

enum { LANES = 1, MAX_BATCH = 4, TOGETHER = 16, SEARCH_RUN = 4, SEARCH_RUNS = 128, BRICKED = 0 };

KERNEL real spread(REAL x)
{
    return x;
}

KERNEL whole spread_whole(int32_t x)
{
    return x;
}

KERNEL real to_real(whole i)
{
    return (real)i;
}

KERNEL real floor_real(real x)
{
    return floorf(x);
}

KERNEL whole floor_of(real x)
{
    return __float2int_rd(x);
}

KERNEL whole truncate(real x)
{
    return (int)x;
}

KERNEL real pick(mask m, real a, real b)
{
    return m ? a : b;
}

KERNEL real smaller(real a, real b)
{
    return fminf(a, b);
}

KERNEL real larger(real a, real b)
{
    return fmaxf(a, b);
}

/* Moves into [0, 1]. */
KERNEL real saturate(real x)
{
    return __saturatef(x);
}

KERNEL whole pick_whole(mask m, whole a, whole b)
{
    return m ? a : b;
}

/* A card has other rays to go on with while it waits. */
KERNEL void ask_brick(const uint16_t *)
{
}

KERNEL void ask_voxels(const kernel_volume *, reference_voxel, const real[3], mask)
{
}

KERNEL bool any_lane(mask m)
{
    return m;
}

/* The greatest and the least of all lanes. */
KERNEL int32_t most_of(whole i)
{
    return i;
}

KERNEL int32_t least_of(whole i)
{
    return i;
}

/* 0 to TOGETHER - 1. */
KERNEL whole lane_number()
{
    return threadIdx.x & (TOGETHER - 1);
}

/* The threads of the warp that go together with this. */
KERNEL unsigned together_mask()
{
    return ~0u >> (32 - TOGETHER) << (threadIdx.x & 31 & ~(TOGETHER - 1));
}

KERNEL bool together_any(mask m)
{
    return __any_sync(together_mask(), m);
}

KERNEL int32_t together_most(whole i)
{
    return __reduce_max_sync(together_mask(), i);
}

KERNEL int32_t together_least(whole i)
{
    return __reduce_min_sync(together_mask(), i);
}

/* Floats in the order of integers: those below zero are turned round. */
KERNEL int32_t float_order(int32_t bits)
{
    return bits < 0 ? bits ^ INT32_MAX : bits;
}

KERNEL REAL together_most_real(real x)
{
    return __int_as_float(float_order(together_most(float_order(__float_as_int(x)))));
}

KERNEL mask unless(mask m)
{
    return !m;
}

KERNEL real root(real x)
{
    return sqrtf(x);
}

/* Voxels at an index each. */
KERNEL real fetch(const kernel_volume *v, reference_voxel type, whole index)
{
    switch (type) {
    case REFERENCE_UINT8: return (real)__ldg((const unsigned char *)v->voxels + index);
    case REFERENCE_UINT16: return (real)__ldg((const unsigned short *)v->voxels + index);
    default: return __ldg((const float *)v->voxels + index);
    }
}

/* What a texture unit makes of a position in voxels, in stored values. */
KERNEL real fetch_texture(const kernel_volume *v, reference_voxel type, const real p[3])
{
    real value = tex3D<float>(v->texture, p[0], p[1], p[2]);
    return type == REFERENCE_UINT8 ? value * 255 : type == REFERENCE_UINT16 ? value * 65535 : value;
}

KERNEL whole fetch_byte(const uint8_t *bytes, whole index)
{
    return __ldg(bytes + index);
}

KERNEL whole fetch_word(const uint16_t *words, whole index)
{
    return __ldg(words + index);
}

/* Voxels of 8 or 16 bits as floats, raised by 2^23. */
template <int bits> KERNEL float raised(unsigned word, int i)
{
    return __uint_as_float(__byte_perm(word, 0x4B000000u, bits == 8 ? 0x7650 | i : i ? 0x7632 : 0x7610));
}

/* Mixes the voxels i and i + 1 of a word. Their difference is the same raised or not. */
template <int bits> KERNEL float mix_raised(unsigned word, int i, float share)
{
    float low = raised<bits>(word, i), high = raised<bits>(word, i + 1);
    return (low - 8388608.0f) + (high - low) * share;
}

/* What lies on the four edges of a place's cell that run along x, y fastest, and the place's shares of the cell. A cell
 * is its eight corners, x fastest. */
KERNEL void fetch_edges(const kernel_volume *v, reference_voxel type, const real place[3], real share[3], real edge[4])
{
    const unsigned row = v->dims_vox[0] + 1, layer = row * (v->dims_vox[1] + 1);
    const unsigned lift = 0x4B000000u * (1 + row + layer); /* of floats whose last bits are a whole number */
    float first[3];
    for (int a = 0; a < 3; a++) {
        first[a] = floorf(place[a]);
        share[a] = place[a] - first[a];
        first[a] += 8388608.0f;
    }
    unsigned index =
        __float_as_uint(first[2]) * layer + __float_as_uint(first[1]) * row + (__float_as_uint(first[0]) - lift);
    if (type == REFERENCE_UINT8) {
        uint2 cell = __ldg((const uint2 *)v->cells + index);
        edge[0] = mix_raised<8>(cell.x, 0, share[0]);
        edge[1] = mix_raised<8>(cell.x, 2, share[0]);
        edge[2] = mix_raised<8>(cell.y, 0, share[0]);
        edge[3] = mix_raised<8>(cell.y, 2, share[0]);
    } else {
        uint4 cell = __ldg((const uint4 *)v->cells + index);
        edge[0] = mix_raised<16>(cell.x, 0, share[0]);
        edge[1] = mix_raised<16>(cell.y, 0, share[0]);
        edge[2] = mix_raised<16>(cell.z, 0, share[0]);
        edge[3] = mix_raised<16>(cell.w, 0, share[0]);
    }
}

/* A card's threads read as fast one by one. */
KERNEL bool fetch_pairs(const kernel_volume *v, reference_voxel type, const real place[3], real share[3], real edge[4])
{
    return false;
}

/* A card hides what reads take by other warps. */
KERNEL void fetch_ahead(const kernel_volume *v, reference_voxel type, const real place[3])
{
}

/* A table on the card. In shared memory an entry is followed by its difference from the next; then there are several
 * copies of the pair, one behind the other, and rgba is the lane's. */
typedef struct lookup {
    const float4 *rgba;
    int32_t entry_bytes;
    bool pairs;
} lookup;

/* The colour between entry `index` and the one behind it. */
KERNEL void fetch_colour(const lookup *table, whole index, real share, real colour[4])
{
    const float4 *at = (const float4 *)((const char *)table->rgba + index * table->entry_bytes);
    const float4 e = at[0];
    float4 d = at[1];
    if (!table->pairs)
        d = make_float4(d.x - e.x, d.y - e.y, d.z - e.z, d.w - e.w);
    colour[0] = e.x + d.x * share;
    colour[1] = e.y + d.y * share;
    colour[2] = e.z + d.z * share;
    colour[3] = e.w + d.w * share;
}

#endif
