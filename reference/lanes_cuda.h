/* lanes_cuda.h - lanes.h on a card: a thread is one lane. */
#ifndef REFERENCE_LANES_CUDA_H
#define REFERENCE_LANES_CUDA_H

#include "kernel_types.h"

typedef REAL real;
typedef int32_t whole;
typedef bool mask;

enum { LANES = 1 };

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

KERNEL whole pick_whole(mask m, whole a, whole b)
{
    return m ? a : b;
}

KERNEL bool any_lane(mask m)
{
    return m;
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

KERNEL real fetch_float(const float *values, whole index)
{
    return __ldg(values + index);
}

/* Entry `index` of a table of four channels. */
KERNEL void fetch_entry(const void *rgba, whole index, real entry[4])
{
    float4 e = ((const float4 *)rgba)[index];
    entry[0] = e.x;
    entry[1] = e.y;
    entry[2] = e.z;
    entry[3] = e.w;
}

#endif
