/* kernel_cubic.h - the cubic filters: the value at a place from the 64 voxels around its cell, four along each axis,
 * weighted by cubics in the place's share of the cell; and whether a cell has anything to show.
 *
 * Cell i of an axis reads voxels i - 2 to i + 1; beyond the volume voxels are those of its border. The cardinal spline
 * is Catmull and Rom's, equation 1 of Kye, "Efficient High Quality Volume Visualization Using Cardinal Interpolation".
 */
#ifndef REFERENCE_KERNEL_CUBIC_H
#define REFERENCE_KERNEL_CUBIC_H

#include "kernel_types.h"
#include "lanes.h"

KERNEL whole clamp_whole(whole i, int32_t least, int32_t most)
{
    i = pick_whole(i < least, spread_whole(least), i);
    return pick_whole(i > most, spread_whole(most), i);
}

/* The number of a place's cell, of one more along each axis than voxels. */
KERNEL whole cubic_cell(const kernel_volume *v, const real place[3])
{
    const int32_t *size = v->dims_vox;
    return (truncate(place[2]) * (size[1] + 1) + truncate(place[1])) * (size[0] + 1) + truncate(place[0]);
}

/* Whether samples at places may show something. */
KERNEL mask cubic_shows(const kernel_frame *f, const real place[3])
{
    return fetch_byte(f->cells.shows, fetch_word(f->cells.codes, cubic_cell(&f->volume, place))) != 0;
}

/* Whether samples at places may be greater than what there is. */
KERNEL mask cubic_raises(const kernel_frame *f, const real place[3], real greatest)
{
    const whole code = fetch_word(f->cells.codes, cubic_cell(&f->volume, place)) >> 8;
    return to_real(code) * (REAL)f->cells.step + (REAL)f->cells.base > greatest;
}

/* sample_cubic(): the value at places of the lanes `on`; what the others get means nothing. cubic_ask(): asks for what
 * cubic_shows() will read at places, where that gains anything. */
#if defined(LANES_OF_FLOAT)
#include "lanes_cpu_cubic.h"
#else

KERNEL void cubic_weights(bool spline, real t, real weight[4])
{
    const real u = 1 - t;
    if (spline) {
        weight[0] = u * u * u * (REAL)(1 / 6.0);
        weight[1] = (t * (REAL)0.5 - 1) * t * t + (REAL)(2 / 3.0);
        weight[2] = (u * (REAL)0.5 - 1) * u * u + (REAL)(2 / 3.0);
        weight[3] = t * t * t * (REAL)(1 / 6.0);
    } else {
        weight[0] = t * u * u * (REAL)-0.5;
        weight[1] = (t * (REAL)1.5 - (REAL)2.5) * t * t + 1;
        weight[2] = (u * (REAL)1.5 - (REAL)2.5) * u * u + 1;
        weight[3] = u * t * t * (REAL)-0.5;
    }
}

/* The sum of 64 voxels of one type. On a card the loop over layers stays one, for want of registers. */
KERNEL real cubic_sum(const kernel_volume *v, reference_voxel type, const whole offset[3][4], const real weight[3][4])
{
    real sum = spread(0);
    ROLLED
    for (int z = 0; z < 4; z++) {
        real layer = spread(0);
        UNROLLED
        for (int y = 0; y < 4; y++) {
            const whole row = offset[2][z] + offset[1][y];
            real line = spread(0);
            UNROLLED
            for (int x = 0; x < 4; x++)
                line = line + weight[0][x] * fetch(v, type, row + offset[0][x]);
            layer = layer + weight[1][y] * line;
        }
        sum = sum + weight[2][z] * layer;
    }
    return sum;
}

/* The values at places. */
APART void cubic_values(const kernel_volume *v, reference_voxel type, const real place[3], real *value)
{
    whole offset[3][4];
    real weight[3][4];
    for (int a = 0; a < 3; a++) {
        const whole cell = truncate(place[a]);
        cubic_weights(v->spline, place[a] - to_real(cell), weight[a]);
        for (int n = 0; n < 4; n++) {
            const whole voxel = cell + (n - 2);
            offset[a][n] =
                (v->layout == KERNEL_PLAIN ? clamp_whole(voxel, 0, v->dims_vox[a] - 1) : voxel) * v->stride[a];
        }
    }
    switch (type) {
    case REFERENCE_UINT8: *value = cubic_sum(v, REFERENCE_UINT8, offset, weight); break;
    case REFERENCE_UINT16: *value = cubic_sum(v, REFERENCE_UINT16, offset, weight); break;
    default: *value = cubic_sum(v, REFERENCE_FLOAT32, offset, weight);
    }
}

KERNEL real sample_cubic(const kernel_volume *v, reference_voxel type, const real place[3], mask on)
{
    real value;
    (void)on;
    cubic_values(v, type, place, &value);
    return value;
}

KERNEL void cubic_ask(const kernel_frame *f, const real place[3])
{
    (void)f, (void)place;
}

#endif

#endif
