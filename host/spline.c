/* spline.c - coefficients c of a cubic B-spline through samples s, c[i-1] + 4 c[i] + c[i+1] = 6 s[i], along one axis
 * after the other: Gauss's elimination in integers, so that every computer makes the same (docs/architecture.md,
 * section 11). Beyond both ends of a line coefficients go on as they are there. */
#include "spline.h"

#include <stdlib.h>

enum { LINE_BITS = 14, PIVOT_BITS = 30 }; /* fraction bits of numbers on the way, and of pivots */

/* Lines side by side: sample i of line j is at i*stride + j. */
typedef struct lines {
    int32_t *first;
    int32_t count; /* samples of a line */
    size_t stride, width;
} lines;

/* 1/(4 - the pivot before); at a line's ends the coefficient beyond, as large, joins the four. */
static void fill_pivots(int32_t count, int64_t *pivots)
{
    int64_t before = 0;
    for (int32_t i = 0; i < count; i++) {
        const int64_t diagonal = 4 + (i == 0) + (i == count - 1);
        pivots[i] = before = ((int64_t)1 << (2 * PIVOT_BITS)) / ((diagonal << PIVOT_BITS) - before);
    }
}

static void solve(const lines *l, const int64_t *pivots)
{
    for (int32_t i = 0; i < l->count; i++) {
        int32_t *row = l->first + (size_t)i * l->stride;
        for (size_t j = 0; j < l->width; j++) {
            const int64_t before = i ? *(row + j - l->stride) : 0;
            row[j] = (int32_t)(((6 * (int64_t)row[j] - before) * pivots[i]) >> PIVOT_BITS);
        }
    }
    for (int32_t i = l->count - 2; i >= 0; i--) {
        int32_t *row = l->first + (size_t)i * l->stride;
        for (size_t j = 0; j < l->width; j++)
            row[j] -= (int32_t)((row[j + l->stride] * pivots[i]) >> PIVOT_BITS);
    }
}

static void solve_axes(const int32_t dims_vox[3], int32_t *numbers, int64_t *pivots)
{
    const size_t width = (size_t)dims_vox[0], layer = width * (size_t)dims_vox[1];
    fill_pivots(dims_vox[0], pivots);
    for (size_t row = 0; row < layer / width * (size_t)dims_vox[2]; row++)
        solve(&(lines){numbers + row * width, dims_vox[0], 1, 1}, pivots);
    fill_pivots(dims_vox[1], pivots);
    for (size_t z = 0; z < (size_t)dims_vox[2]; z++)
        solve(&(lines){numbers + z * layer, dims_vox[1], width, width}, pivots);
    fill_pivots(dims_vox[2], pivots);
    for (size_t y = 0; y < (size_t)dims_vox[1]; y++)
        solve(&(lines){numbers + y * width, dims_vox[2], layer, width}, pivots);
}

static int32_t density(const vodr_volume *v, size_t i, int32_t most)
{
    int32_t d = v->voxel_bytes == 2 ? ((const uint16_t *)v->voxels)[i] : ((const uint8_t *)v->voxels)[i];
    if (v->voxel_bytes == 1)
        return v->map ? v->map[d] : d;
    return d < most ? d : most;
}

static int16_t rounded(int32_t number, int32_t drop_bits)
{
    const int32_t c = (number + (1 << (drop_bits - 1))) >> drop_bits;
    return (int16_t)(c < INT16_MIN ? INT16_MIN : c > INT16_MAX ? INT16_MAX : c);
}

host_status spline_coefficients(const vodr_volume *densities, int32_t density_bits, int16_t *coefficients,
                                host_error *error)
{
    const int32_t *dims = densities->dims_vox, most = (1 << density_bits) - 1;
    const size_t count = (size_t)dims[0] * (size_t)dims[1] * (size_t)dims[2];
    int32_t longest = dims[0] > dims[1] ? dims[0] : dims[1];
    longest = longest > dims[2] ? longest : dims[2];
    int32_t *numbers = malloc(count * sizeof *numbers);
    int64_t *pivots = malloc((size_t)longest * sizeof *pivots);
    if (numbers && pivots) {
        for (size_t i = 0; i < count; i++)
            numbers[i] = density(densities, i, most) << LINE_BITS;
        solve_axes(dims, numbers, pivots);
        for (size_t i = 0; i < count; i++)
            coefficients[i] = rounded(numbers[i], density_bits == 8 ? LINE_BITS - 3 : LINE_BITS);
    }
    const bool made = numbers && pivots;
    free(numbers);
    free(pivots);
    return made ? HOST_OK : host_fail(error, HOST_ENVIRONMENT, "no memory for the coefficients of %zu voxels", count);
}
