#include "fused_brick.h"

#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "voxels.h"

enum { ROW_VOX = FUSED_ROW_WORDS + 1, PLANES = FUSED_EDGE_VOX + 2 };

vodr_status fused_brick_start(fused_brick *b, const vodr_machine *m, const vodr_volume *volume,
                              const fused_kernels *kernels, vodr_error *error)
{
    *b = (fused_brick){.volume = volume,
                       .kernels = kernels,
                       .density_bits = m->density_bits,
                       .linear = m->filter == VODR_FILTER_LINEAR,
                       .wide = m->density_bits > 8,
                       .direct = volume->voxel_bytes == 1 && !volume->map,
                       .texture = {.weight_bits = m->weight_bits, .guard_bits = m->guard_bits}};
    size_t words = (size_t)FUSED_PLANE_WORDS * PLANES;
    if (posix_memalign(&b->words, 64, words * (b->wide ? sizeof(uint64_t) : sizeof(uint32_t))) != 0)
        b->words = NULL;
    b->rows = malloc((size_t)ROW_VOX * ROW_VOX * sizeof(uint16_t));
    if (!b->words || !b->rows)
        return vodr_fail(error, VODR_NO_MEMORY, "no memory for a brick of %zu words", words);
    b->texture.words = b->words;
    return VODR_OK;
}

static int32_t clamp(int32_t i, int32_t last)
{
    return i < 0 ? 0 : i > last ? last : i;
}

/* ROW_VOX densities from the brick's first column on, those outside the volume being the nearest inside. */
static void load_row(const fused_brick *b, int32_t y, int32_t z, uint16_t *row)
{
    const int32_t *dims = b->volume->dims_vox;
    int32_t x = b->origin_vox[0], first = clamp(x, dims[0] - 1), last = clamp(x + ROW_VOX - 1, dims[0] - 1);
    voxels_row(b->volume, b->density_bits, voxel_index(dims, first, y, z), last - first + 1, row + (first - x));
    for (int32_t i = 0; i < first - x; i++)
        row[i] = row[first - x];
    for (int32_t i = last - x + 1; i < ROW_VOX; i++)
        row[i] = row[last - x];
}

static const uint8_t *row8(const fused_brick *b, int32_t n, int32_t y, int32_t z)
{
    const int32_t *dims = b->volume->dims_vox;
    if (b->direct && b->origin_vox[0] >= 0 && b->origin_vox[0] + ROW_VOX <= dims[0])
        return (const uint8_t *)b->volume->voxels + voxel_index(dims, b->origin_vox[0], y, z);
    uint16_t wide[ROW_VOX];
    uint8_t *row = (uint8_t *)b->rows + n * ROW_VOX;
    load_row(b, y, z, wide);
    for (int32_t i = 0; i < ROW_VOX; i++)
        row[i] = (uint8_t)wide[i];
    return row;
}

static const uint16_t *row12(const fused_brick *b, int32_t n, int32_t y, int32_t z)
{
    uint16_t *row = (uint16_t *)b->rows + n * ROW_VOX;
    load_row(b, y, z, row);
    return row;
}

/* Packs plane `plane` of the brick: `count` rows of words. */
static void pack_plane(const fused_brick *b, int32_t plane, int32_t count, fused_range *range)
{
    const uint8_t *rows8[ROW_VOX];
    const uint16_t *rows12[ROW_VOX];
    int32_t last_y = b->volume->dims_vox[1] - 1, z = clamp(b->origin_vox[2] + plane, b->volume->dims_vox[2] - 1);
    for (int32_t n = 0; n <= count; n++) {
        int32_t y = clamp(b->origin_vox[1] + n, last_y);
        if (b->wide)
            rows12[n] = row12(b, n, y, z);
        else
            rows8[n] = row8(b, n, y, z);
    }
    if (b->wide)
        b->kernels->pack12(rows12, count, (uint64_t *)b->words + plane * FUSED_PLANE_WORDS, range);
    else
        b->kernels->pack8(rows8, count, (uint32_t *)b->words + plane * FUSED_PLANE_WORDS, range);
}

bool fused_brick_load(fused_brick *b, const vox_box *box, const int32_t *transparent_to)
{
    int32_t border = b->linear ? 1 : 0;
    fused_range range;
    memset(range.min8, 0xff, sizeof range.min8);
    memset(range.max8, 0, sizeof range.max8);
    memset(range.min12, 0xff, sizeof range.min12);
    memset(range.max12, 0, sizeof range.max12);
    for (int c = 0; c < 3; c++)
        b->origin_vox[c] = box->lo[c] - border;
    /* A sample between two voxels needs the words of the first in x and y, and both planes. */
    int32_t rows = box->hi[1] - box->lo[1] + border, planes = box->hi[2] - box->lo[2] + 2 * border;
    for (int32_t plane = 0; plane < planes; plane++)
        pack_plane(b, plane, rows, &range);
    int32_t min = INT32_MAX, max = 0;
    for (int i = 0; i < FUSED_ROW_WORDS; i++) {
        int32_t low = b->wide ? range.min12[i] : range.min8[i], high = b->wide ? range.max12[i] : range.max8[i];
        min = low < min ? low : min;
        max = high > max ? high : max;
    }
    return transparent_to[min] < max;
}

void fused_brick_finish(fused_brick *b)
{
    free(b->words);
    free(b->rows);
    *b = (fused_brick){0};
}
