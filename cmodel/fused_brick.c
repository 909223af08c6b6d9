#include "fused_brick.h"

#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "layout.h"
#include "voxels.h"

enum { MAX_ROWS = 33, BRICK_BYTES = 40 << 10 };

/* What a row costs before its first fragment, a voxel's repacking, and a fragment fetched without, in the time of a
 * fragment. */
static const double row_cost = 12, voxel_cost = 0.1, direct_cost = 8;

/* Fragments' worth of work a fragment costs beyond itself. The mean chord of a box along u is 1/sum(|u|/edge). */
static double overhead(const int32_t edge[3], const double u[3], double fragments_per_voxel)
{
    double rows = 0, voxels = 1;
    for (int c = 0; c < 3; c++) {
        rows += u[c] / edge[c];
        voxels *= 1 + 2.0 / edge[c];
    }
    return row_cost * rows + voxel_cost * voxels / fragments_per_voxel;
}

bool fused_brick_edges(const vodr_machine *m, const vodr_view *view, int32_t edge_vox[3])
{
    const slice_plane p = slice_plane_of(view, view->slices / 2);
    double u[3], v[3], s[3], unit = 1.0 / ((double)((int64_t)1 << view->shift) * (1 << VODR_POSITION_BITS)), best = 0;
    double depth_step = (double)view->depth_step / (1 << VODR_DEPTH_BITS);
    for (int c = 0; c < 3; c++) {
        u[c] = (double)p.step_u[c] * unit;
        v[c] = (double)p.step_v[c] * unit;
        s[c] = (double)view->step_s[c] * unit * (view->perspective ? depth_step : 1);
    }
    double volume =
        u[0] * (v[1] * s[2] - v[2] * s[1]) + u[1] * (v[2] * s[0] - v[0] * s[2]) + u[2] * (v[0] * s[1] - v[1] * s[0]);
    volume = volume < 0 ? -volume : volume;
    for (int c = 0; c < 3; c++)
        u[c] = u[c] < 0 ? -u[c] : u[c];
    int32_t word_bytes = m->density_bits > 8 ? 8 : 4, edge[3];
    for (edge[0] = 15; edge[0] < FUSED_MAX_ROW_WORDS; edge[0] = 2 * edge[0] + 1)
        for (edge[1] = 7; edge[1] < MAX_ROWS; edge[1] = 2 * edge[1] + 1)
            for (edge[2] = 7; edge[2] < 64; edge[2] += 8) {
                double cost = overhead(edge, u, 1 / (volume + 1e-9));
                bool fits = (edge[0] + 1) * (edge[1] + 1) * (edge[2] + 1) * word_bytes <= BRICK_BYTES;
                if (fits && (best == 0 || cost < best)) {
                    best = cost;
                    for (int c = 0; c < 3; c++)
                        edge_vox[c] = edge[c];
                }
            }
    return voxel_cost * volume < direct_cost;
}

vodr_status fused_brick_start(fused_brick *b, const vodr_machine *m, const vodr_volume *volume,
                              const int32_t edge_vox[3], const fused_kernels *kernels, vodr_error *error)
{
    *b = (fused_brick){.volume = volume,
                       .kernels = kernels,
                       .density_bits = m->density_bits,
                       .linear = m->filter == VODR_FILTER_LINEAR,
                       .wide = m->density_bits > 8,
                       .direct = volume->voxel_bytes == 1 && !volume->map,
                       .row_words = edge_vox[0] + 1,
                       .texture = {.weight_bits = m->weight_bits, .guard_bits = m->guard_bits}};
    b->texture.row_bits = log2_of(b->row_words);
    b->texture.plane_bits = b->texture.row_bits + log2_of(edge_vox[1] + 1);
    size_t words = (size_t)(edge_vox[2] + 2) << b->texture.plane_bits;
    if (posix_memalign(&b->words, 64, words * (b->wide ? sizeof(uint64_t) : sizeof(uint32_t))) != 0)
        b->words = NULL;
    b->rows = malloc((size_t)(b->row_words + 1) * MAX_ROWS * sizeof(uint16_t));
    if (!b->words || !b->rows)
        return vodr_fail(error, VODR_NO_MEMORY, "no memory for a brick of %zu words", words);
    b->texture.words = b->words;
    return VODR_OK;
}

static int32_t clamp(int32_t i, int32_t last)
{
    return i < 0 ? 0 : i > last ? last : i;
}

/* A row of words and its last neighbour: densities from the brick's first column on, those outside the volume being the
 * nearest inside. */
static void load_row(const fused_brick *b, int32_t y, int32_t z, uint16_t *row)
{
    const int32_t *dims = b->volume->dims_vox;
    int32_t x = b->origin_vox[0], end = x + b->row_words, first = clamp(x, dims[0] - 1), last = clamp(end, dims[0] - 1);
    voxels_row(b->volume, b->density_bits, voxel_index(dims, first, y, z), last - first + 1, row + (first - x));
    for (int32_t i = 0; i < first - x; i++)
        row[i] = row[first - x];
    for (int32_t i = last - x + 1; i <= b->row_words; i++)
        row[i] = row[last - x];
}

static const uint8_t *row8(const fused_brick *b, int32_t n, int32_t y, int32_t z)
{
    const int32_t *dims = b->volume->dims_vox;
    if (b->direct && b->origin_vox[0] >= 0 && b->origin_vox[0] + b->row_words < dims[0])
        return (const uint8_t *)b->volume->voxels + voxel_index(dims, b->origin_vox[0], y, z);
    uint16_t wide[FUSED_MAX_ROW_WORDS + 1];
    uint8_t *row = (uint8_t *)b->rows + n * (b->row_words + 1);
    load_row(b, y, z, wide);
    for (int32_t i = 0; i <= b->row_words; i++)
        row[i] = (uint8_t)wide[i];
    return row;
}

static const uint16_t *row12(const fused_brick *b, int32_t n, int32_t y, int32_t z)
{
    uint16_t *row = (uint16_t *)b->rows + n * (b->row_words + 1);
    load_row(b, y, z, row);
    return row;
}

/* Packs plane `plane` of the brick: `count` rows of words. */
static void pack_plane(const fused_brick *b, int32_t plane, int32_t count, fused_range *range)
{
    const uint8_t *rows8[MAX_ROWS];
    const uint16_t *rows12[MAX_ROWS];
    int32_t last_y = b->volume->dims_vox[1] - 1, z = clamp(b->origin_vox[2] + plane, b->volume->dims_vox[2] - 1);
    for (int32_t n = 0; n <= count; n++) {
        int32_t y = clamp(b->origin_vox[1] + n, last_y);
        if (b->wide)
            rows12[n] = row12(b, n, y, z);
        else
            rows8[n] = row8(b, n, y, z);
    }
    size_t at = (size_t)plane << b->texture.plane_bits;
    if (b->wide)
        b->kernels->pack12(rows12, count, b->row_words, (uint64_t *)b->words + at, range);
    else
        b->kernels->pack8(rows8, count, b->row_words, (uint32_t *)b->words + at, range);
}

void fused_brick_load(fused_brick *b, const vox_box *box, int32_t *min, int32_t *max)
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
    *min = INT32_MAX;
    *max = 0;
    for (int i = 0; i <= b->row_words; i++) {
        int32_t low = b->wide ? range.min12[i] : range.min8[i], high = b->wide ? range.max12[i] : range.max8[i];
        *min = low < *min ? low : *min;
        *max = high > *max ? high : *max;
    }
}

void fused_brick_finish(fused_brick *b)
{
    free(b->words);
    free(b->rows);
    *b = (fused_brick){0};
}
