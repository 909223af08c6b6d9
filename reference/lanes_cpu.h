/* lanes_cpu.h - lanes.h on the CPU: vectors of 64 bytes, in as many registers as the instruction set needs. Look-ups
 * are scalar loads: they go faster than gather instructions where those are slow, and no slower elsewhere. */
#ifndef REFERENCE_LANES_CPU_H
#define REFERENCE_LANES_CPU_H

#include <string.h>

#if defined(__AVX2__)
#include <immintrin.h>
#endif

#include "kernel_types.h"

#define WHOLE_OF_float int32_t
#define WHOLE_OF_double int64_t
#define WHOLE_OF(type) WHOLE_OF_AGAIN(type)
#define WHOLE_OF_AGAIN(type) WHOLE_OF_##type

typedef REAL real __attribute__((vector_size(64)));
typedef WHOLE_OF(REAL) whole __attribute__((vector_size(64)));
typedef whole mask;

enum {
    LANES = sizeof(real) / sizeof(REAL),
    TOGETHER = LANES,
    MAX_BATCH = 1,
    SEARCH_RUN = 4,
    SEARCH_RUNS = 256,
    BRICKED = 1
};

KERNEL real spread(REAL x)
{
    return x - (real){0};
}

KERNEL whole spread_whole(int32_t x)
{
    return x - (whole){0};
}

KERNEL real to_real(whole i)
{
    return __builtin_convertvector(i, real);
}

KERNEL whole truncate(real x)
{
    return __builtin_convertvector(x, whole);
}

KERNEL whole floor_of(real x)
{
    whole i = truncate(x);
    return i + (to_real(i) > x);
}

KERNEL real floor_real(real x)
{
    return to_real(floor_of(x));
}

KERNEL whole pick_whole(mask m, whole a, whole b)
{
    return (a & m) | (b & ~m);
}

KERNEL real pick(mask m, real a, real b)
{
    return (real)pick_whole(m, (whole)a, (whole)b);
}

KERNEL real smaller(real a, real b)
{
    return pick(a < b, a, b);
}

KERNEL real larger(real a, real b)
{
    return pick(a > b, a, b);
}

/* Moves into [0, 1]. */
KERNEL real saturate(real x)
{
    return smaller(larger(x, spread(0)), spread(1));
}

KERNEL bool any_lane(mask m)
{
#if defined(__AVX512F__)
    return _mm512_test_epi32_mask((__m512i)m, (__m512i)m) != 0;
#elif defined(__AVX2__)
    __m256i half[2];
    memcpy(half, &m, sizeof half);
    half[0] = _mm256_or_si256(half[0], half[1]);
    return !_mm256_testz_si256(half[0], half[0]);
#else
    uint64_t word[8], all = 0;
    memcpy(word, &m, sizeof word);
    for (int i = 0; i < 8; i++)
        all |= word[i];
    return all != 0;
#endif
}

/* A bit a lane. */
KERNEL uint32_t lanes_of(mask m)
{
#if defined(__AVX512F__) && defined(LANES_OF_FLOAT)
    return _mm512_test_epi32_mask((__m512i)m, (__m512i)m);
#else
    uint32_t bits = 0;
    for (int l = 0; l < LANES; l++)
        bits |= (uint32_t)(m[l] != 0) << l;
    return bits;
#endif
}

/* The greatest and the least of all lanes. */
KERNEL int32_t most_of(whole i)
{
#if defined(__AVX512F__) && defined(LANES_OF_FLOAT)
    return _mm512_reduce_max_epi32((__m512i)i);
#endif
    WHOLE_OF(REAL) lane[LANES], most = i[0];
    memcpy(lane, &i, sizeof lane);
    for (int l = 1; l < LANES; l++)
        most = lane[l] > most ? lane[l] : most;
    return (int32_t)most;
}

KERNEL int32_t least_of(whole i)
{
    return -most_of(-i);
}

KERNEL REAL most_real(real x)
{
#if defined(__AVX512F__) && defined(LANES_OF_FLOAT)
    return _mm512_reduce_max_ps((__m512)x);
#endif
    REAL lane[LANES], most = x[0];
    memcpy(lane, &x, sizeof lane);
    for (int l = 1; l < LANES; l++)
        most = lane[l] > most ? lane[l] : most;
    return most;
}

/* 0 to TOGETHER - 1. */
KERNEL whole lane_number(void)
{
    whole i;
    for (int l = 0; l < LANES; l++)
        i[l] = l;
    return i;
}

KERNEL bool together_any(mask m)
{
    return any_lane(m);
}

KERNEL int32_t together_most(whole i)
{
    return most_of(i);
}

KERNEL int32_t together_least(whole i)
{
    return least_of(i);
}

KERNEL REAL together_most_real(real x)
{
    return most_real(x);
}

KERNEL mask unless(mask m)
{
    return ~m;
}

KERNEL real root(real x)
{
    for (int l = 0; l < LANES; l++)
        x[l] = sizeof(REAL) == sizeof(float) ? (REAL)__builtin_sqrtf((float)x[l]) : (REAL)__builtin_sqrt((double)x[l]);
    return x;
}

KERNEL real fetch(const kernel_volume *v, reference_voxel type, whole index)
{
    real value;
    switch (type) {
    case REFERENCE_UINT8:
        for (int l = 0; l < LANES; l++)
            value[l] = ((const uint8_t *)v->voxels)[index[l]];
        break;
    case REFERENCE_UINT16:
        for (int l = 0; l < LANES; l++)
            value[l] = ((const uint16_t *)v->voxels)[index[l]];
        break;
    default:
        for (int l = 0; l < LANES; l++)
            value[l] = ((const float *)v->voxels)[index[l]];
    }
    return value;
}

/* Asks for a brick of codes (kernel_bounds). */
KERNEL void ask_brick(const uint16_t *brick)
{
    __builtin_prefetch(brick);
    __builtin_prefetch(brick + BOUND_BRICK_CELLS / 2);
}

/* Asks for the voxels around the places, of KERNEL_LINEAR, of the lanes `on`. */
KERNEL void ask_voxels(const kernel_volume *v, reference_voxel type, const real place[3], mask on)
{
    const int64_t bytes = type == REFERENCE_UINT8 ? 1 : type == REFERENCE_UINT16 ? 2 : 4;
    const int64_t row = bytes * v->dims_vox[0], layer = row * v->dims_vox[1];
    whole low[3];
    for (int a = 0; a < 3; a++) {
        low[a] = truncate(place[a]) - 1;
        low[a] = pick_whole(low[a] < 0, spread_whole(0), low[a]);
    }
    for (uint32_t lanes = lanes_of(on); lanes; lanes &= lanes - 1) {
        const int l = __builtin_ctz(lanes);
        const char *voxel = (const char *)v->voxels + (int64_t)low[2][l] * layer + (int64_t)low[1][l] * row +
                            (int64_t)low[0][l] * bytes;
        __builtin_prefetch(voxel);
        __builtin_prefetch(voxel + row);
        __builtin_prefetch(voxel + layer);
        __builtin_prefetch(voxel + layer + row);
    }
}

KERNEL whole fetch_byte(const uint8_t *bytes, whole index)
{
    whole value;
    for (int l = 0; l < LANES; l++)
        value[l] = bytes[index[l]];
    return value;
}

/* A table in memory. */
typedef struct lookup {
    const REAL *rgba;
} lookup;

#ifdef LANES_OF_FLOAT
#include "lanes_cpu_float.h"
#else

KERNEL whole fetch_word(const uint16_t *words, whole index)
{
    whole value;
    for (int l = 0; l < LANES; l++)
        value[l] = words[index[l]];
    return value;
}

/* Rows of pairs and packed cells are of use where speed is. */
KERNEL bool fetch_pairs(const kernel_volume *v, reference_voxel type, const real place[3], real share[3], real edge[4])
{
    (void)v, (void)type, (void)place, (void)share, (void)edge;
    return false;
}

KERNEL void fetch_ahead(const kernel_volume *v, reference_voxel type, const real place[3])
{
    (void)v, (void)type, (void)place;
}

KERNEL void fetch_edges(const kernel_volume *v, reference_voxel type, const real place[3], real share[3], real edge[4])
{
    (void)v, (void)type;
    for (int i = 0; i < 4; i++)
        edge[i] = share[i % 3] = place[i % 3];
}

/* The colour between entry `index` and the one behind it. */
KERNEL void fetch_colour(const lookup *table, whole index, real share, real colour[4])
{
    for (int c = 0; c < 4; c++) {
        real next;
        for (int l = 0; l < LANES; l++) {
            colour[c][l] = table->rgba[4 * index[l] + c];
            next[l] = table->rgba[4 * index[l] + 4 + c];
        }
        colour[c] = colour[c] + (next - colour[c]) * share;
    }
}

#endif

#endif
