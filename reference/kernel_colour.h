/* kernel_colour.h - what a sample shows: the transfer function at its value and gradient, and the light on it. */
#ifndef REFERENCE_KERNEL_COLOUR_H
#define REFERENCE_KERNEL_COLOUR_H

#include "kernel_sample.h"

/* What does not change along a ray. */
typedef struct march_lane {
    real inverse[3]; /* of step; 0: along this axis the ray stands still */
    real light[3];   /* from a sample to the eye, of length one, in finest voxels */
} march_lane;

/* Splits a column or a row into an index and a share. */
KERNEL whole classify_place(real at, real *share)
{
    whole i = truncate(at);
    *share = at - to_real(i);
    return i;
}

/* The column of a value, moved into the table. */
KERNEL real classify_column(const kernel_table *t, real value)
{
    return saturate(value * (REAL)t->scale + (REAL)t->offset) * (REAL)(t->columns - 1);
}

/* The colour at a column of a table of one row. */
KERNEL void classify(const lookup *entries, real at, real colour[4])
{
    real share;
    whole column = classify_place(at, &share);
    fetch_colour(entries, column, share, colour);
}

/* The same of a table of rows. */
KERNEL void classify_by_gradient(const kernel_table *t, const lookup *entries, real at, real gradient, real colour[4])
{
    real across, down, below[4];
    whole column = classify_place(at, &across);
    whole row = classify_place(saturate(gradient * (REAL)t->gradient_scale) * (REAL)(t->rows - 1), &down);
    fetch_colour(entries, row * (t->columns + 1) + column, across, colour);
    fetch_colour(entries, (row + 1) * (t->columns + 1) + column, across, below);
    for (int c = 0; c < 4; c++)
        colour[c] = mix(colour[c], below[c], down);
}

/* Light from the eye, on both sides of a surface; ambient 0.3, diffuse 0.6, specular 0.3 to the 20th power. `surface`,
 * 0 to 1, says how much of a surface there is: where there is none, the colour stays. */
KERNEL void shade_phong(const march_lane *lane, const real gradient[3], real magnitude, real surface, real colour[4])
{
    real along = gradient[0] * lane->light[0] + gradient[1] * lane->light[1] + gradient[2] * lane->light[2];
    real facing = along / pick(magnitude > 0, magnitude, spread(1));
    facing = pick(facing < 0, -facing, facing);
    real power4 = facing * facing * facing * facing, power16 = power4 * power4 * power4 * power4;
    real lit = (REAL)0.3 + (REAL)0.6 * facing, shine = (REAL)0.3 * power16 * power4 * colour[3];
    surface = pick(surface > 1, spread(1), surface);
    for (int c = 0; c < 3; c++) {
        real shaded = colour[c] * lit + shine;
        shaded = pick(shaded > colour[3], colour[3], shaded);
        colour[c] = mix(colour[c], shaded, surface);
    }
}

#endif
