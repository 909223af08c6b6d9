/* hull_rows.h - the bounds of hull.h on the CPU, row by row: loops run along rows, so that the compiler makes vectors
 * of them. Included by a file for each instruction set. */
#ifndef REFERENCE_HULL_ROWS_H
#define REFERENCE_HULL_ROWS_H

#include <math.h>
#include <stdlib.h>

#include "bounds.h"
#include "hull.h"

KERNEL float lesser(float a, float b)
{
    return a < b ? a : b;
}

KERNEL float greater(float a, float b)
{
    return a > b ? a : b;
}

/* The Bezier points of the cubic between p[1] and p[2]. */
KERNEL void bezier(bool spline, const float p[4], float b[4])
{
    if (spline) {
        const float thirds = (p[1] + p[2]) * (1 / 3.0F);
        b[1] = thirds + p[1] * (1 / 3.0F);
        b[2] = thirds + p[2] * (1 / 3.0F);
        b[0] = (p[0] + p[2]) * (1 / 6.0F) + p[1] * (2 / 3.0F);
        b[3] = (p[1] + p[3]) * (1 / 6.0F) + p[2] * (2 / 3.0F);
    } else {
        b[0] = p[1];
        b[1] = p[1] + (p[2] - p[0]) * (1 / 6.0F);
        b[2] = p[2] - (p[3] - p[1]) * (1 / 6.0F);
        b[3] = p[2];
    }
}

/* A row of voxels as floats. */
KERNEL void hull_load(const reference_volume *v, int32_t y, int32_t z, float *restrict row)
{
    const int32_t size = v->dims_vox[0];
    const size_t first = ((size_t)z * (size_t)v->dims_vox[1] + (size_t)y) * (size_t)size;
    if (v->type == REFERENCE_UINT8)
        for (int32_t x = 0; x < size; x++)
            row[x] = ((const uint8_t *)v->voxels)[first + (size_t)x];
    else if (v->type == REFERENCE_UINT16)
        for (int32_t x = 0; x < size; x++)
            row[x] = ((const uint16_t *)v->voxels)[first + (size_t)x];
    else
        for (int32_t x = 0; x < size; x++)
            row[x] = ((const float *)v->voxels)[first + (size_t)x];
}

KERNEL int32_t hull_clamp(int32_t i, int32_t size)
{
    return i < 0 ? 0 : i < size ? i : size - 1;
}

/* A row's bounds: of the least and of the greatest. */
typedef struct hull_pair {
    float *least, *most;
} hull_pair;

/* The rows of a cell layer at work; rows of points have two more entries at each end. */
typedef struct hull_work {
    float *voxels[4];
    float *ring[4][4]; /* of row of voxels y, number y % 4: points along z */
    float *points[4];  /* along y */
    hull_pair border, inner, next, block;
    float *memory;
} hull_work;

enum { HULL_WORK_ROWS = 32 };

static bool hull_begin(hull_work *w, int32_t size)
{
    const size_t row = (size_t)size + 16;
    float *at = w->memory = malloc(HULL_WORK_ROWS * row * sizeof *at);
    if (!at)
        return false;
    for (int i = 0; i < 4; i++, at += 6 * row) {
        w->voxels[i] = at;
        w->points[i] = at + row;
        for (int k = 0; k < 4; k++)
            w->ring[i][k] = at + (size_t)(2 + k) * row;
    }
    hull_pair *const pairs[4] = {&w->border, &w->inner, &w->next, &w->block};
    for (int i = 0; i < 4; i++, at += 2 * row)
        *pairs[i] = (hull_pair){at, at + row};
    return true;
}

static void hull_empty(hull_pair row, int32_t count)
{
    for (int32_t i = 0; i < count; i++) {
        row.least[i] = INFINITY;
        row.most[i] = -INFINITY;
    }
}

/* Widens a row by another. */
KERNEL void hull_join(const float *restrict least, const float *restrict most, int32_t count, float *restrict own_least,
                      float *restrict own_most)
{
    for (int32_t i = 0; i < count; i++) {
        own_least[i] = lesser(own_least[i], least[i]);
        own_most[i] = greater(own_most[i], most[i]);
    }
}

/* The points along z of row y of voxels in cell layer l. */
KERNEL void hull_points_z(const hull_job *job, bool spline, hull_work *w, int32_t y, int32_t l)
{
    const int32_t size = job->volume.dims_vox[0];
    for (int n = 0; n < 4; n++)
        hull_load(&job->volume, y, hull_clamp(l - 2 + n, job->volume.dims_vox[2]), w->voxels[n]);
    const float *restrict v0 = w->voxels[0], *restrict v1 = w->voxels[1];
    const float *restrict v2 = w->voxels[2], *restrict v3 = w->voxels[3];
    float *const *ring = w->ring[y & 3];
    float *restrict r0 = ring[0] + 2, *restrict r1 = ring[1] + 2, *restrict r2 = ring[2] + 2,
                    *restrict r3 = ring[3] + 2;
    for (int32_t x = 0; x < size; x++) {
        const float p[4] = {v0[x], v1[x], v2[x], v3[x]};
        float b[4];
        bezier(spline, p, b);
        r0[x] = b[0];
        r1[x] = b[1];
        r2[x] = b[2];
        r3[x] = b[3];
    }
    for (int k = 0; k < 4; k++) {
        ring[k][0] = ring[k][1] = ring[k][2];
        ring[k][size + 2] = ring[k][size + 3] = ring[k][size + 1];
    }
}

/* The points along y of point k along z in cell row j. */
KERNEL void hull_points_y(const hull_job *job, bool spline, hull_work *w, int32_t j, int k)
{
    const int32_t *dims = job->volume.dims_vox;
    const float *restrict v0 = w->ring[hull_clamp(j - 2, dims[1]) & 3][k];
    const float *restrict v1 = w->ring[hull_clamp(j - 1, dims[1]) & 3][k];
    const float *restrict v2 = w->ring[hull_clamp(j, dims[1]) & 3][k];
    const float *restrict v3 = w->ring[hull_clamp(j + 1, dims[1]) & 3][k];
    float *restrict r0 = w->points[0], *restrict r1 = w->points[1];
    float *restrict r2 = w->points[2], *restrict r3 = w->points[3];
    for (int32_t x = 0; x < dims[0] + 4; x++) {
        const float p[4] = {v0[x], v1[x], v2[x], v3[x]};
        float b[4];
        bezier(spline, p, b);
        r0[x] = b[0];
        r1[x] = b[1];
        r2[x] = b[2];
        r3[x] = b[3];
    }
}

/* Widens the cells of a row by the points along x. */
KERNEL void hull_points_x(bool spline, const float *restrict row, int32_t cells, float *restrict least,
                          float *restrict most)
{
    for (int32_t i = 0; i < cells; i++) {
        const float p[4] = {row[i], row[i + 1], row[i + 2], row[i + 3]};
        float b[4];
        bezier(spline, p, b);
        least[i] = lesser(least[i], lesser(lesser(b[0], b[1]), lesser(b[2], b[3])));
        most[i] = greater(most[i], greater(greater(b[0], b[1]), greater(b[2], b[3])));
    }
}

/* Leaves the bounds of cell row j in w->inner. What borders the next row is kept in w->border. */
KERNEL void hull_row(const hull_job *job, bool spline, hull_work *w, int32_t j)
{
    const int32_t cells = job->volume.dims_vox[0] + 1;
    hull_empty(w->inner, cells);
    hull_empty(w->next, cells);
    if (j == 0)
        hull_empty(w->border, cells);
    for (int k = 0; k < 4; k++) {
        hull_points_y(job, spline, w, j, k);
        if (j == 0)
            hull_points_x(spline, w->points[0], cells, w->border.least, w->border.most);
        hull_points_x(spline, w->points[1], cells, w->inner.least, w->inner.most);
        hull_points_x(spline, w->points[2], cells, w->inner.least, w->inner.most);
        hull_points_x(spline, w->points[3], cells, w->next.least, w->next.most);
    }
    hull_join(w->border.least, w->border.most, cells, w->inner.least, w->inner.most);
    hull_join(w->next.least, w->next.most, cells, w->inner.least, w->inner.most);
    const hull_pair swap = w->border;
    w->border = w->next;
    w->next = swap;
}

KERNEL void hull_codes(hull_scale s, const float *restrict least, const float *restrict most, int32_t cells,
                       uint16_t *restrict codes)
{
    for (int32_t i = 0; i < cells; i++)
        codes[i] = hull_code(s, least[i], most[i]);
}

/* Widens a row of blocks by rows of their cells, widened by the margin; the first row begins them. */
static void hull_blocks(const hull_job *job, hull_pair row, bool first, size_t number)
{
    const int32_t cells = job->volume.dims_vox[0] + 1;
    for (int32_t i = 0; i < job->count[0]; i++) {
        float least = first ? INFINITY : job->least[number + (size_t)i];
        float most = first ? -INFINITY : job->most[number + (size_t)i];
        for (int32_t x = i * job->edge_vox; x < cells && x < (i + 1) * job->edge_vox; x++) {
            least = lesser(least, row.least[x] - job->scale.margin);
            most = greater(most, row.most[x] + job->scale.margin);
        }
        job->least[number + (size_t)i] = least;
        job->most[number + (size_t)i] = most;
    }
}

/* Cell layer l, `first` of its blocks. */
KERNEL void hull_layer(const hull_job *job, bool spline, hull_work *w, int32_t l, bool first)
{
    const int32_t *dims = job->volume.dims_vox;
    const int32_t cells = dims[0] + 1, edge = job->edge_vox;
    int32_t known = 0; /* rows of voxels whose points along z are in the ring */
    for (int32_t j = 0; j <= dims[1]; j++) {
        for (; known <= j + 1 && known < dims[1]; known++)
            hull_points_z(job, spline, w, known, l);
        hull_row(job, spline, w, j);
        if (job->codes)
            hull_codes(job->scale, w->inner.least, w->inner.most, cells,
                       job->codes + ((size_t)l * (size_t)(dims[1] + 1) + (size_t)j) * (size_t)cells);
        if (j % edge == 0)
            hull_empty(w->block, cells);
        hull_join(w->inner.least, w->inner.most, cells, w->block.least, w->block.most);
        if (j == dims[1] || j % edge == edge - 1)
            hull_blocks(job, w->block, first,
                        ((size_t)(l / edge) * (size_t)job->count[1] + (size_t)(j / edge)) * (size_t)job->count[0]);
    }
}

static bool hull_ranges(const hull_job *job, int32_t l0, int32_t l1)
{
    const int32_t edge = job->edge_vox, layers = job->volume.dims_vox[2] + 1;
    hull_work w;
    if (!hull_begin(&w, job->volume.dims_vox[0]))
        return false;
    for (int32_t l = l0 * edge; l < l1 * edge && l < layers; l++)
        if (job->spline)
            hull_layer(job, true, &w, l, l % edge == 0);
        else
            hull_layer(job, false, &w, l, l % edge == 0);
    free(w.memory);
    return true;
}

static bool find_extremes(const reference_volume *v, int32_t z0, int32_t z1, float *extremes)
{
    const int32_t size = v->dims_vox[0];
    hull_work w;
    if (!hull_begin(&w, size))
        return false;
    for (int32_t z = z0; z < z1; z++) {
        float *out = extremes + 2 * z;
        hull_empty(w.block, size);
        for (int32_t y = 0; y < v->dims_vox[1]; y++) {
            hull_load(v, y, z, w.voxels[0]);
            hull_join(w.voxels[0], w.voxels[0], size, w.block.least, w.block.most);
        }
        out[0] = INFINITY;
        out[1] = -INFINITY;
        for (int32_t x = 0; x < size; x++) {
            out[0] = lesser(out[0], w.block.least[x]);
            out[1] = greater(out[1], w.block.most[x]);
        }
    }
    free(w.memory);
    return true;
}

/* The extremes of the voxels that each block of a row reads, from those of rows, and what they may overshoot. */
static void rival_blocks(const hull_job *job, hull_pair row, size_t number)
{
    for (int32_t i = 0; i < job->count[0]; i++) {
        int32_t lo, hi;
        float least = INFINITY, most = -INFINITY;
        hull_voxels(i, job->edge_vox, job->volume.dims_vox[0], &lo, &hi);
        for (int32_t x = lo; x < hi; x++) {
            least = lesser(least, row.least[x]);
            most = greater(most, row.most[x]);
        }
        const float beyond = job->share * (most - least) + job->scale.margin;
        job->least[number + (size_t)i] = least - beyond;
        job->most[number + (size_t)i] = most + beyond;
    }
}

static bool rival_ranges(const hull_job *job, int32_t l0, int32_t l1)
{
    const int32_t *dims = job->volume.dims_vox;
    hull_work w;
    if (!hull_begin(&w, dims[0]))
        return false;
    for (int32_t l = l0; l < l1; l++)
        for (int32_t j = 0; j < job->count[1]; j++) {
            int32_t z0, z1, y0, y1;
            hull_voxels(l, job->edge_vox, dims[2], &z0, &z1);
            hull_voxels(j, job->edge_vox, dims[1], &y0, &y1);
            hull_empty(w.block, dims[0]);
            for (int32_t z = z0; z < z1; z++)
                for (int32_t y = y0; y < y1; y++) {
                    hull_load(&job->volume, y, z, w.voxels[0]);
                    hull_join(w.voxels[0], w.voxels[0], dims[0], w.block.least, w.block.most);
                }
            rival_blocks(job, w.block, ((size_t)l * (size_t)job->count[1] + (size_t)j) * (size_t)job->count[0]);
        }
    free(w.memory);
    return true;
}

#endif
