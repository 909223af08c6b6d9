/* blocks.c - the range of the voxels in each block, and how far each block is from one that shows something. */
#include "blocks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bounds.h"
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

/* The range of the voxels of one block. Interpolation rounds: floats get a margin. */
static void block_range(const reference_volume *v, int32_t edge, const int32_t at[3], float *least, float *most)
{
    int32_t lo[3], hi[3];
    float min = INFINITY, max = -INFINITY;
    for (int a = 0; a < 3; a++)
        bounds_voxels(at[a], edge, v->dims_vox[a], &lo[a], &hi[a]);
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

reference_status blocks_alloc(const reference_volume *v, int32_t edge_vox, blocks *b, vodr_error *error)
{
    *b = (blocks){.edge_vox = edge_vox};
    for (int a = 0; a < 3; a++)
        b->count[a] = bounds_count(v->dims_vox[a], edge_vox);
    size_t count = blocks_count(b);
    b->least = malloc(count * sizeof *b->least);
    b->most = malloc(count * sizeof *b->most);
    if (!b->least || !b->most) {
        blocks_free(b);
        return reference_fail(error, REFERENCE_NO_MEMORY, "no memory for the ranges of %zu blocks", count);
    }
    return REFERENCE_OK;
}

reference_status blocks_make(const reference_volume *v, int32_t edge_vox, blocks *b, vodr_error *error)
{
    int32_t at[3];
    size_t i = 0;
    reference_status status = blocks_alloc(v, edge_vox, b, error);
    if (status != REFERENCE_OK)
        return status;
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
    free(b->distance);
    free(b->known);
    *b = (blocks){0};
}

/* visible[i]: how many of the first i columns are not transparent, in any row. */
static void count_visible(const reference_table *t, int32_t *visible)
{
    visible[0] = 0;
    for (int32_t i = 0; i < t->columns; i++) {
        bool shows = false;
        for (int32_t row = 0; row < t->rows; row++)
            shows |= t->rgba[4 * ((size_t)row * (size_t)t->columns + (size_t)i) + 3] > 0;
        visible[i + 1] = visible[i] + shows;
    }
}

/* The columns that a value at a place in the table meets, with an entry's margin. */
static int32_t first_column(double place, int32_t columns)
{
    return (int32_t)fmin(fmax(floor(place - 0.001), 0), columns - 1);
}

static int32_t last_column(double place, int32_t columns)
{
    return (int32_t)fmin(fmax(floor(place + 0.001) + 1, 0), columns - 1);
}

/* Whether all columns that values from least to most meet are transparent. */
static bool transparent(const int32_t *visible, int32_t columns, double least, double most)
{
    return visible[last_column(most, columns) + 1] == visible[first_column(least, columns)];
}

/* Lowers own[] to one more than the least of beside[] at the same place and on both sides of it. */
static void lower_row(const uint8_t *beside, int32_t count, uint8_t *own)
{
    for (int32_t x = 0; x < count; x++) {
        uint8_t least = beside[x];
        if (x > 0 && beside[x - 1] < least)
            least = beside[x - 1];
        if (x + 1 < count && beside[x + 1] < least)
            least = beside[x + 1];
        if (least < own[x])
            own[x] = (uint8_t)(least + 1);
    }
}

/* One scan, upwards (way = 1) or downwards: each block against the neighbours that the scan has passed. Two scans give
 * the exact distance along axes and diagonals. */
static void spread(const blocks *b, int32_t way, uint8_t *distance)
{
    const int32_t *n = b->count;
    const size_t row_blocks = (size_t)n[0], layer_blocks = row_blocks * (size_t)n[1];
    for (int32_t l = 0; l < n[2]; l++)
        for (int32_t j = 0; j < n[1]; j++) {
            int32_t z = way > 0 ? l : n[2] - 1 - l, y = way > 0 ? j : n[1] - 1 - j;
            uint8_t *own = distance + (size_t)z * layer_blocks + (size_t)y * row_blocks;
            for (int32_t dy = -1; l > 0 && dy <= 1; dy++)
                if (y + dy >= 0 && y + dy < n[1])
                    lower_row(distance + (size_t)(z - way) * layer_blocks + (size_t)(y + dy) * row_blocks, n[0], own);
            if (j > 0)
                lower_row(distance + (size_t)z * layer_blocks + (size_t)(y - way) * row_blocks, n[0], own);
            for (int32_t i = 1; i < n[0]; i++) {
                uint8_t *at = own + (way > 0 ? i : n[0] - 1 - i);
                if (at[-way] < *at)
                    *at = (uint8_t)(at[-way] + 1);
            }
        }
}

static void fill_distances(blocks *b, const reference_table *table, double scale, double offset, bool far,
                           const int32_t *visible)
{
    double last = table->columns - 1;
    for (size_t i = 0, count = blocks_count(b); i < count; i++) {
        double p = ((double)b->least[i] * scale + offset) * last, q = ((double)b->most[i] * scale + offset) * last;
        b->distance[i] = transparent(visible, table->columns, fmin(p, q), fmax(p, q)) ? far ? FARTHEST : 1 : 0;
    }
    if (far) {
        spread(b, 1, b->distance);
        spread(b, -1, b->distance);
    }
}

/* What distances depend on beside the volume: its opacities, and numbers of the call. */
static double *make_key(const reference_table *t, double scale, double offset, bool far, size_t *count)
{
    size_t entries = (size_t)t->columns * (size_t)t->rows;
    *count = entries + 5;
    double *key = malloc(*count * sizeof *key);
    if (!key)
        return NULL;
    const double numbers[5] = {scale, offset, far, t->columns, t->rows};
    memcpy(key, numbers, sizeof numbers);
    for (size_t i = 0; i < entries; i++)
        key[5 + i] = t->rgba[4 * i + 3];
    return key;
}

reference_status blocks_classify(blocks *b, const reference_table *table, double scale, double offset, bool far,
                                 vodr_error *error)
{
    size_t count;
    double *key = make_key(table, scale, offset, far, &count);
    int32_t *visible = malloc(((size_t)table->columns + 1) * sizeof *visible);
    if (!b->distance)
        b->distance = malloc(blocks_count(b));
    if (!key || !visible || !b->distance) {
        free(key);
        free(visible);
        return reference_fail(error, REFERENCE_NO_MEMORY, "no memory for the distances of %zu blocks", blocks_count(b));
    }
    if (b->known && b->known_count == count && memcmp(b->known, key, count * sizeof *key) == 0) {
        free(key);
    } else {
        count_visible(table, visible);
        fill_distances(b, table, scale, offset, far, visible);
        free(b->known);
        b->known = key;
        b->known_count = count;
    }
    free(visible);
    return REFERENCE_OK;
}

/* ---- cubics ---- */

reference_status blocks_classify_cells(hull_scale s, const reference_table *table, double scale, double offset,
                                       uint8_t shows[CELL_CODES], vodr_error *error)
{
    const double last = table->columns - 1;
    int32_t below[256], above[256]; /* where what a code of the least, and of the greatest, shows begins or ends */
    int32_t *visible = malloc(((size_t)table->columns + 1) * sizeof *visible);
    if (!visible)
        return reference_fail(error, REFERENCE_NO_MEMORY, "no memory for a table of %d columns", table->columns);
    count_visible(table, visible);
    for (uint32_t i = 0; i < 256; i++) {
        const double p = (hull_least(s, i) * scale + offset) * last, q = (hull_greatest(s, i) * scale + offset) * last;
        below[i] = scale < 0 ? last_column(p, table->columns) + 1 : first_column(p, table->columns);
        above[i] = scale < 0 ? first_column(q, table->columns) : last_column(q, table->columns) + 1;
    }
    for (uint32_t code = 0; code < CELL_CODES; code++)
        shows[code] = visible[below[code & 255]] != visible[above[code >> 8]];
    free(visible);
    return REFERENCE_OK;
}

void blocks_encode(const blocks *b, hull_scale s, uint16_t *codes, kernel_bounds *bounds)
{
    const double step = ((double)s.most - (double)s.least) / UINT16_MAX;
    for (size_t i = 0, count = blocks_count(b); i < count; i++)
        codes[i] = (uint16_t)fmin(fmax(ceil(((double)b->most[i] - (double)s.least) / step), 0), UINT16_MAX);
    bounds->scale = (float)step;
    bounds->offset_value = (float)((double)s.least + step);
}
