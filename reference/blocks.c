/* blocks.c - the range of the voxels in each block, and how far each block is from one that shows something. */
#include "blocks.h"

#include <math.h>
#include <stdlib.h>

#include "device.h"

enum { FARTHEST = 255 };

static float stored_value(const reference_volume *v, size_t i)
{
    switch (v->type) {
    case REFERENCE_UINT8: return ((const uint8_t *)v->voxels)[i];
    case REFERENCE_UINT16: return ((const uint16_t *)v->voxels)[i];
    default: return ((const float *)v->voxels)[i];
    }
}

/* The voxels that samples in cells [edge*i, edge*i + edge) of an axis lie between. */
static void voxel_range(int32_t i, int32_t edge, int32_t size, int32_t *lo, int32_t *hi)
{
    *lo = i * edge - 1 < 0 ? 0 : i * edge - 1;
    *hi = i * edge + edge > size ? size : i * edge + edge;
    if (*lo >= size)
        *lo = size - 1;
}

/* The range of the voxels of one block. Interpolation rounds: floats get a margin. */
static void block_range(const reference_volume *v, int32_t edge, const int32_t at[3], float *least, float *most)
{
    int32_t lo[3], hi[3];
    float min = INFINITY, max = -INFINITY;
    for (int a = 0; a < 3; a++)
        voxel_range(at[a], edge, v->dims_vox[a], &lo[a], &hi[a]);
    for (int32_t z = lo[2]; z < hi[2]; z++)
        for (int32_t y = lo[1]; y < hi[1]; y++) {
            size_t row = ((size_t)z * (size_t)v->dims_vox[1] + (size_t)y) * (size_t)v->dims_vox[0];
            for (int32_t x = lo[0]; x < hi[0]; x++) {
                float value = stored_value(v, row + (size_t)x);
                min = value < min ? value : min;
                max = value > max ? value : max;
            }
        }
    float margin = v->type == REFERENCE_FLOAT32 ? 0x1p-20f * fmaxf(fabsf(min), fabsf(max)) : 0;
    *least = min - margin;
    *most = max + margin;
}

reference_status blocks_make(const reference_volume *v, int32_t edge_vox, blocks *b, vodr_error *error)
{
    *b = (blocks){.edge_vox = edge_vox};
    for (int a = 0; a < 3; a++)
        b->count[a] = v->dims_vox[a] / edge_vox + 1; /* dims + 1 cells */
    size_t count = blocks_count(b);
    b->least = malloc(count * sizeof *b->least);
    b->most = malloc(count * sizeof *b->most);
    if (!b->least || !b->most) {
        blocks_free(b);
        return reference_fail(error, REFERENCE_NO_MEMORY, "no memory for the ranges of %zu blocks", count);
    }
    int32_t at[3];
    size_t i = 0;
    for (at[2] = 0; at[2] < b->count[2]; at[2]++)
        for (at[1] = 0; at[1] < b->count[1]; at[1]++)
            for (at[0] = 0; at[0] < b->count[0]; at[0]++, i++)
                block_range(v, edge_vox, at, &b->least[i], &b->most[i]);
    return REFERENCE_OK;
}

void blocks_free(blocks *b)
{
    free(b->least);
    free(b->most);
    *b = (blocks){0};
}

/* Whether all entries that values from least to most meet are transparent, with an entry's margin. */
static bool transparent(const reference_table *t, double least, double most)
{
    int32_t first = (int32_t)fmin(fmax(floor(least - 0.001), 0), t->columns - 1);
    int32_t last = (int32_t)fmin(fmax(floor(most + 0.001) + 1, 0), t->columns - 1);
    for (int32_t row = 0; row < t->rows; row++)
        for (int32_t i = first; i <= last; i++)
            if (t->rgba[4 * ((size_t)row * (size_t)t->columns + (size_t)i) + 3] > 0)
                return false;
    return true;
}

/* Lowers distance[i] to one more than the least of the neighbours that the scan has passed: those before it (way = -1)
 * or after it (way = 1). Two scans give the exact distance along axes and diagonals. */
static void relax(const blocks *b, int32_t x, int32_t y, int32_t z, int way, uint8_t *distance)
{
    const int32_t *n = b->count;
    uint8_t *own = &distance[((size_t)z * (size_t)n[1] + (size_t)y) * (size_t)n[0] + (size_t)x];
    int least = *own;
    for (int i = 1; i <= 13; i++) {
        int code = 13 + way * i; /* of the 27 neighbours, x fastest; 13 is the block itself */
        int32_t nx = x + code % 3 - 1, ny = y + code / 3 % 3 - 1, nz = z + code / 9 - 1;
        if (nx < 0 || ny < 0 || nz < 0 || nx >= n[0] || ny >= n[1] || nz >= n[2])
            continue;
        int beside = distance[((size_t)nz * (size_t)n[1] + (size_t)ny) * (size_t)n[0] + (size_t)nx] + 1;
        least = beside < least ? beside : least;
    }
    *own = (uint8_t)least;
}

static void spread_distances(const blocks *b, uint8_t *distance)
{
    const int32_t *n = b->count;
    for (int32_t z = 0; z < n[2]; z++)
        for (int32_t y = 0; y < n[1]; y++)
            for (int32_t x = 0; x < n[0]; x++)
                relax(b, x, y, z, -1, distance);
    for (int32_t z = n[2] - 1; z >= 0; z--)
        for (int32_t y = n[1] - 1; y >= 0; y--)
            for (int32_t x = n[0] - 1; x >= 0; x--)
                relax(b, x, y, z, 1, distance);
}

void blocks_classify(const blocks *b, const reference_table *table, double scale, double offset, bool far,
                     uint8_t *distance)
{
    double per_column = table->columns - 1;
    for (size_t i = 0, count = blocks_count(b); i < count; i++) {
        double p = ((double)b->least[i] * scale + offset) * per_column;
        double q = ((double)b->most[i] * scale + offset) * per_column;
        distance[i] = transparent(table, fmin(p, q), fmax(p, q)) ? far ? FARTHEST : 1 : 0;
    }
    if (far)
        spread_distances(b, distance);
}
