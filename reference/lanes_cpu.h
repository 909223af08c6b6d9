/* lanes_cpu.h - lanes.h on the CPU: vectors of 64 bytes, in as many registers as the instruction set needs. Look-ups
 * are scalar loads: they go faster than gather instructions where those are slow, and no slower elsewhere. */
#ifndef REFERENCE_LANES_CPU_H
#define REFERENCE_LANES_CPU_H

#include <string.h>

#include "kernel_types.h"

#define WHOLE_OF_float int32_t
#define WHOLE_OF_double int64_t
#define WHOLE_OF(type) WHOLE_OF_AGAIN(type)
#define WHOLE_OF_AGAIN(type) WHOLE_OF_##type

typedef REAL real __attribute__((vector_size(64)));
typedef WHOLE_OF(REAL) whole __attribute__((vector_size(64)));
typedef whole mask;

enum { LANES = sizeof(real) / sizeof(REAL) };

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

KERNEL whole pick_whole(mask m, whole a, whole b)
{
    return (a & m) | (b & ~m);
}

KERNEL real pick(mask m, real a, real b)
{
    return (real)pick_whole(m, (whole)a, (whole)b);
}

KERNEL bool any_lane(mask m)
{
    uint64_t word[8], all = 0;
    memcpy(word, &m, sizeof word);
    for (int i = 0; i < 8; i++)
        all |= word[i];
    return all != 0;
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

KERNEL whole fetch_byte(const uint8_t *bytes, whole index)
{
    whole value;
    for (int l = 0; l < LANES; l++)
        value[l] = bytes[index[l]];
    return value;
}

KERNEL real fetch_float(const float *values, whole index)
{
    real value;
    for (int l = 0; l < LANES; l++)
        value[l] = values[index[l]];
    return value;
}

KERNEL void fetch_entry(const void *rgba, whole index, real entry[4])
{
    const REAL *table = rgba;
    for (int c = 0; c < 4; c++)
        for (int l = 0; l < LANES; l++)
            entry[c][l] = table[4 * index[l] + c];
}

#endif
