/* kernel_fixed.h - one pixel of the machine's frame, slice after slice, in integers: sections 2, 3, 6 and 7 of
 * docs/architecture.md. No organisation of the machine enters: it changes nothing. */
#ifndef REFERENCE_KERNEL_FIXED_H
#define REFERENCE_KERNEL_FIXED_H

#include "kernel_types.h"
#include "lanes.h"

/* Section 2: the term of a position that all slices of a pixel share. */
KERNEL void fixed_ray(const vodr_view *v, int32_t x, int32_t y, int64_t ray[3])
{
    for (int c = 0; c < 3; c++)
        ray[c] = (v->perspective ? v->step_s[c] : 0) + x * v->step_u[c] + y * v->step_v[c];
}

/* Section 2: the position of slice k. */
KERNEL void fixed_position(const vodr_view *v, const int64_t ray[3], int32_t k, int64_t position[3])
{
    int64_t z = (v->depth_first + k * v->depth_step) >> VODR_DEPTH_BITS;
    for (int c = 0; c < 3; c++) {
        int64_t a = v->perspective ? z * ray[c] : k * v->step_s[c] + ray[c];
        position[c] = v->base[c] + (a >> v->shift);
    }
}

/* Section 3. */
KERNEL bool fixed_inside(const int32_t dims_vox[3], const int64_t position[3])
{
    bool inside = true;
    for (int c = 0; c < 3; c++)
        inside &= position[c] >= 0 && position[c] < (int64_t)dims_vox[c] * (1 << VODR_POSITION_BITS);
    return inside;
}

/* Section 6, densities and coefficients; index of a voxel of the volume. */
KERNEL int32_t fixed_density(const kernel_fixed *f, int64_t index)
{
    if (f->filter == VODR_FILTER_BSPLINE)
        return ((const int16_t *)f->voxels)[index];
    if (f->voxel_bytes == 1)
        return f->map[((const uint8_t *)f->voxels)[index]];
    int32_t voxel = ((const uint16_t *)f->voxels)[index], most = (1 << f->density_bits) - 1;
    return voxel < most ? voxel : most;
}

KERNEL int32_t fixed_lerp(int32_t a, int32_t b, int32_t w, int32_t weight_bits)
{
    return a + (((b - a) * w) >> weight_bits);
}

/* Section 6, weights of a cubic filter for a share of u/2^bits. */
KERNEL void fixed_weights(const kernel_fixed *f, int64_t u, int64_t weight[4])
{
    const int64_t b = (int64_t)1 << f->weight_bits, b2 = b * b, v = b - u;
    if (f->filter == VODR_FILTER_CARDINAL) {
        weight[0] = -(2 * u * v * v / b2);
        weight[2] = (4 * u * (b2 + 4 * u * b - 3 * u * u) + b2) / (2 * b2);
        weight[3] = -(2 * u * u * v / b2);
    } else {
        weight[0] = 2 * v * v * v / (3 * b2);
        weight[2] = (4 * (b2 * b + 3 * u * b2 + 3 * u * u * b - 3 * u * u * u) + 3 * b2) / (6 * b2);
        weight[3] = 2 * u * u * u / (3 * b2);
    }
    weight[1] = 4 * b - weight[0] - weight[2] - weight[3];
}

/* Section 6, filter, `cardinal` and `bspline`. */
KERNEL int32_t fixed_cubic(const kernel_fixed *f, const int64_t position[3], const int64_t stride[3])
{
    const int32_t more = f->filter == VODR_FILTER_BSPLINE && f->density_bits == 8 ? 3 : 0,
                  most = (1 << f->density_bits) - 1;
    const int32_t drop = f->guard_bits + more;
    int64_t at[3][4], weight[3][4], along_z = 0;
    for (int c = 0; c < 3; c++) {
        const int64_t q = position[c] - (1 << (VODR_POSITION_BITS - 1)), first = (q >> VODR_POSITION_BITS) - 1;
        for (int n = 0; n < 4; n++) {
            const int64_t i = first + n, last = f->dims_vox[c] - 1;
            at[c][n] = (i < 0 ? 0 : i > last ? last : i) * stride[c];
        }
        fixed_weights(f, (q >> (VODR_POSITION_BITS - f->weight_bits)) & ((1 << f->weight_bits) - 1), weight[c]);
    }
    for (int z = 0; z < 4; z++) {
        int64_t along_y = 0;
        for (int y = 0; y < 4; y++) {
            int64_t along_x = 0;
            for (int x = 0; x < 4; x++)
                along_x += weight[0][x] * fixed_density(f, at[0][x] + at[1][y] + at[2][z]) * (1 << f->guard_bits);
            along_y += weight[1][y] * (along_x >> (f->weight_bits + 2));
        }
        along_z += weight[2][z] * (along_y >> (f->weight_bits + 2));
    }
    const int64_t density = ((along_z >> (f->weight_bits + 2)) + (1 << drop) / 2) >> drop;
    return (int32_t)(density < 0 ? 0 : density > most ? most : density);
}

/* Section 6, filter. */
KERNEL int32_t fixed_sample(const kernel_fixed *f, const int64_t position[3])
{
    const int64_t stride[3] = {1, f->dims_vox[0], (int64_t)f->dims_vox[0] * f->dims_vox[1]};
    if (f->filter == VODR_FILTER_CARDINAL || f->filter == VODR_FILTER_BSPLINE)
        return fixed_cubic(f, position, stride);
    if (f->filter == VODR_FILTER_NEAREST) {
        int64_t index = 0;
        for (int c = 0; c < 3; c++)
            index += (position[c] >> VODR_POSITION_BITS) * stride[c];
        return fixed_density(f, index);
    }
    int64_t at[3][2];
    int32_t w[3], d[8];
    for (int c = 0; c < 3; c++) {
        int64_t q = position[c] - (1 << (VODR_POSITION_BITS - 1)), i = q >> VODR_POSITION_BITS,
                last = f->dims_vox[c] - 1;
        w[c] = (int32_t)(q >> (VODR_POSITION_BITS - f->weight_bits)) & ((1 << f->weight_bits) - 1);
        at[c][0] = (i < 0 ? 0 : i) * stride[c];
        at[c][1] = (i + 1 > last ? last : i + 1) * stride[c];
    }
    for (int n = 0; n < 8; n++)
        d[n] = fixed_density(f, at[0][n & 1] + at[1][n >> 1 & 1] + at[2][n >> 2]) * (1 << f->guard_bits);
    for (int c = 0; c < 3; c++)
        for (int n = 0; n < 4 >> c; n++)
            d[n] = fixed_lerp(d[2 * n], d[2 * n + 1], w[c], f->weight_bits);
    return (d[0] + (1 << f->guard_bits) / 2) >> f->guard_bits;
}

/* Section 7: u*v/M to nearest. */
KERNEL uint32_t fixed_scale(uint32_t u, uint32_t v, int32_t bits)
{
    uint64_t t = (uint64_t)u * v + (1u << (bits - 1));
    return (uint32_t)((t + (t >> bits)) >> bits);
}

/* Adds to one colour another, as it shines through the alpha of the first. */
KERNEL vodr_rgba fixed_add(vodr_rgba front, vodr_rgba back, int32_t bits)
{
    uint32_t through = (1u << bits) - 1 - front.a;
    front.r = (uint16_t)(front.r + fixed_scale(back.r, through, bits));
    front.g = (uint16_t)(front.g + fixed_scale(back.g, through, bits));
    front.b = (uint16_t)(front.b + fixed_scale(back.b, through, bits));
    front.a = (uint16_t)(front.a + fixed_scale(back.a, through, bits));
    return front;
}

/* The pixel after read-out; *fragments grows by the samples inside the volume that were fetched. Positions are monotone
 * in k along each axis, so the slices inside the volume lie together. */
KERNEL vodr_rgba fixed_pixel(const kernel_fixed *f, int32_t x, int32_t y, uint32_t *fragments)
{
    const vodr_view *v = &f->view;
    const bool descends = f->blend == VODR_BLEND_UNDER;
    const uint16_t full = (uint16_t)((1u << f->bits) - 1);
    vodr_rgba pixel = {0, 0, 0, 0};
    int32_t greatest = -1;
    uint32_t count = 0;
    int64_t ray[3], position[3];
    fixed_ray(v, x, y, ray);
    for (int32_t n = 0; n < v->slices; n++) {
        fixed_position(v, ray, descends ? v->slices - 1 - n : n, position);
        if (!fixed_inside(f->dims_vox, position)) {
            if (count)
                break;
            continue;
        }
        int32_t density = fixed_sample(f, position);
        count++;
        if (f->blend == VODR_BLEND_MIP)
            greatest = density > greatest ? density : greatest;
        else if (descends)
            pixel = fixed_add(pixel, f->table[density], f->bits);
        else
            pixel = fixed_add(f->table[density], pixel, f->bits);
        if (descends && pixel.a == full)
            break;
    }
    *fragments += count;
    return greatest < 0 ? pixel : f->table[greatest];
}

#endif
