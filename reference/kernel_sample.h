/* kernel_sample.h - the volume at positions in between its voxels: the value, and its gradient. */
#ifndef REFERENCE_KERNEL_SAMPLE_H
#define REFERENCE_KERNEL_SAMPLE_H

#include "kernel_types.h"
#include "lanes.h"

KERNEL whole clamp_whole(whole i, int32_t least, int32_t most)
{
    i = pick_whole(i < least, spread_whole(least), i);
    return pick_whole(i > most, spread_whole(most), i);
}

KERNEL real mix(real a, real b, real share)
{
    return a + (b - a) * share;
}

/* Offsets of the two voxels around q (q = 0: the first voxel's centre) along an axis, and the share of the second. */
KERNEL void sample_axis(real q, int32_t size, int32_t stride, whole offset[2], real *share)
{
    whole i = floor_of(q);
    *share = q - to_real(i);
    offset[0] = clamp_whole(i, 0, size - 1) * stride;
    offset[1] = clamp_whole(i + 1, 0, size - 1) * stride;
}

KERNEL real sample_linear(const kernel_volume *v, reference_voxel type, const real p[3], bool coarse)
{
    const int32_t stride[3] = {1, v->dims_vox[0], v->dims_vox[0] * v->dims_vox[1]};
    whole offset[3][2];
    real share[3], value[8];
    for (int a = 0; a < 3; a++) {
        sample_axis(p[a] - (REAL)0.5, v->dims_vox[a], stride[a], offset[a], &share[a]);
        if (coarse)
            share[a] = to_real(truncate(share[a] * 256 + (REAL)0.5)) * (REAL)(1 / 256.0);
    }
    for (int n = 0; n < 8; n++)
        value[n] = fetch(v, type, offset[0][n & 1] + offset[1][n >> 1 & 1] + offset[2][n >> 2]);
    for (int a = 0; a < 3; a++)
        for (int n = 0; n < 4 >> a; n++)
            value[n] = mix(value[2 * n], value[2 * n + 1], share[a]);
    return value[0];
}

KERNEL real sample_nearest(const kernel_volume *v, reference_voxel type, const real p[3])
{
    const int32_t stride[3] = {1, v->dims_vox[0], v->dims_vox[0] * v->dims_vox[1]};
    whole index = spread_whole(0);
    for (int a = 0; a < 3; a++)
        index = index + clamp_whole(floor_of(p[a]), 0, v->dims_vox[a] - 1) * stride[a];
    return fetch(v, type, index);
}

/* The stored value at a position in voxels. */
KERNEL real sample(const kernel_volume *v, reference_voxel type, kernel_filter filter, const real p[3])
{
    if (filter == KERNEL_NEAREST)
        return sample_nearest(v, type, p);
#ifdef __CUDACC__
    if (filter == KERNEL_TEXTURE)
        return fetch_texture(v, type, p);
#endif
    return sample_linear(v, type, p, filter == KERNEL_TEXTURE);
}

/* Central differences over two voxels along each axis, in stored values a finest voxel. The loop stays one, as what is
 * in it is large. */
KERNEL void sample_gradient(const kernel_frame *f, reference_voxel type, kernel_filter filter, const real p[3],
                            real gradient[3])
{
    for (int a = 0; a < 3; a++)
        gradient[a] = spread(0);
    ROLLED
    for (int n = 0; n < 6; n++) {
        const REAL side = n < 3 ? -1 : 1;
        real at[3] = {p[0], p[1], p[2]};
        for (int a = 0; a < 3; a++)
            at[a] = at[a] + (n % 3 == a ? side : 0);
        real value = sample(&f->volume, type, filter, at);
        for (int a = 0; a < 3; a++)
            gradient[a] = gradient[a] + value * (n % 3 == a ? side * (REAL)(0.5 / f->camera.spacing_vox[a]) : 0);
    }
}

#endif
