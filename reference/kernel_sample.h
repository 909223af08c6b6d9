/* kernel_sample.h - the volume at positions in between its voxels: the value, and its gradient.
 *
 * A filter has its own places: positions in voxels, but for KERNEL_LINEAR, KERNEL_CELLS and KERNEL_CUBIC, where they
 * are half a voxel more, so that the whole part is the cell. */
#ifndef REFERENCE_KERNEL_SAMPLE_H
#define REFERENCE_KERNEL_SAMPLE_H

#include "kernel_cubic.h"

/* What a filter's places are more than positions in voxels. */
KERNEL REAL place_shift(kernel_filter filter)
{
    return filter == KERNEL_LINEAR || filter == KERNEL_CELLS || filter == KERNEL_CUBIC ? (REAL)0.5 : 0;
}

KERNEL real clamp_real(real x, REAL least, REAL most)
{
    return smaller(larger(x, spread(least)), spread(most));
}

KERNEL real mix(real a, real b, real share)
{
    return a + (b - a) * share;
}

/* Mixes the values around a place along the axes from `first` on; the lower axis is the faster. */
KERNEL real mix_around(real value[8], int first, const real share[3])
{
    for (int a = first; a < 3; a++)
        for (int n = 0; n < 4 >> a; n++)
            value[n] = mix(value[2 * n], value[2 * n + 1], share[a]);
    return value[0];
}

/* Offsets of the two voxels around a cell along an axis, and the share of the second. */
KERNEL void sample_axis(real place, int32_t size, int32_t stride, whole offset[2], real *share)
{
    whole i = floor_of(place);
    *share = place - to_real(i);
    offset[0] = clamp_whole(i - 1, 0, size - 1) * stride;
    offset[1] = clamp_whole(i, 0, size - 1) * stride;
}

/* At a place of KERNEL_LINEAR. */
KERNEL real sample_linear(const kernel_volume *v, reference_voxel type, const real place[3], bool coarse)
{
    const int32_t stride[3] = {1, v->dims_vox[0], v->dims_vox[0] * v->dims_vox[1]};
    whole offset[3][2];
    real share[3], value[8];
    if (!coarse && fetch_pairs(v, type, place, share, value))
        return mix_around(value, 1, share);
    for (int a = 0; a < 3; a++) {
        sample_axis(place[a], v->dims_vox[a], stride[a], offset[a], &share[a]);
        if (coarse)
            share[a] = to_real(truncate(share[a] * 256 + (REAL)0.5)) * (REAL)(1 / 256.0);
    }
    for (int n = 0; n < 8; n++)
        value[n] = fetch(v, type, offset[0][n & 1] + offset[1][n >> 1 & 1] + offset[2][n >> 2]);
    return mix_around(value, 0, share);
}

KERNEL real sample_nearest(const kernel_volume *v, reference_voxel type, const real p[3])
{
    const int32_t stride[3] = {1, v->dims_vox[0], v->dims_vox[0] * v->dims_vox[1]};
    whole index = spread_whole(0);
    for (int a = 0; a < 3; a++)
        index = index + clamp_whole(floor_of(p[a]), 0, v->dims_vox[a] - 1) * stride[a];
    return fetch(v, type, index);
}

/* The stored value at a place of the filter; what lanes get that are not `on` means nothing. */
KERNEL real sample_on(const kernel_volume *v, reference_voxel type, kernel_filter filter, const real p[3], mask on)
{
    if (filter == KERNEL_CUBIC)
        return sample_cubic(v, type, p, on);
    if (filter == KERNEL_NEAREST)
        return sample_nearest(v, type, p);
    if (filter == KERNEL_CELLS) {
        real share[3], value[8];
        fetch_edges(v, type, p, share, value);
        return mix_around(value, 1, share);
    }
    if (filter == KERNEL_LINEAR)
        return sample_linear(v, type, p, false);
#ifdef __CUDACC__
    return fetch_texture(v, type, p);
#else
    const real place[3] = {p[0] + (REAL)0.5, p[1] + (REAL)0.5, p[2] + (REAL)0.5};
    return sample_linear(v, type, place, true);
#endif
}

/* The same of all lanes. */
KERNEL real sample(const kernel_volume *v, reference_voxel type, kernel_filter filter, const real p[3])
{
    return sample_on(v, type, filter, p, spread_whole(0) == 0);
}

/* Central differences over two voxels along each axis, in stored values a finest voxel, of the lanes `on`. On a card
 * the loop stays one, as what is in it is large; on the CPU the six places share most of what is computed of them. */
KERNEL void sample_gradient(const kernel_frame *f, reference_voxel type, kernel_filter filter, const real p[3], mask on,
                            real gradient[3])
{
    const REAL shift = place_shift(filter);
    for (int a = 0; a < 3; a++)
        gradient[a] = spread(0);
    if (LANES > 1) {
        real place[3][3];
        for (int a = 0; a < 3; a++)
            for (int i = 0; i < 3; i++)
                place[a][i] = clamp_real(p[a] + (REAL)(i - 1), shift, (REAL)f->volume.dims_vox[a] + shift);
        UNROLLED
        for (int n = 0; n < 6; n++) {
            const int a = n / 2, side = n % 2 ? 1 : -1;
            const real at[3] = {place[0][a == 0 ? side + 1 : 1], place[1][a == 1 ? side + 1 : 1],
                                place[2][a == 2 ? side + 1 : 1]};
            real value = sample_on(&f->volume, type, filter, at, on);
            gradient[a] = gradient[a] + value * ((REAL)side * (REAL)(0.5 / f->camera.spacing_vox[a]));
        }
        return;
    }
    ROLLED
    for (int n = 0; n < 6; n++) {
        const REAL side = n < 3 ? -1 : 1;
        real at[3];
        for (int a = 0; a < 3; a++)
            at[a] = clamp_real(p[a] + (n % 3 == a ? side : 0), shift, (REAL)f->volume.dims_vox[a] + shift);
        real value = sample_on(&f->volume, type, filter, at, on);
        for (int a = 0; a < 3; a++)
            gradient[a] = gradient[a] + value * (n % 3 == a ? side * (REAL)(0.5 / f->camera.spacing_vox[a]) : 0);
    }
}

#endif
