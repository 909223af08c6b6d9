#include "fused_brick.h"

#include <stdlib.h>

#include "error.h"
#include "voxels.h"

enum { VOXEL_EDGE = FUSED_EDGE_VOX + 2 };

vodr_status fused_brick_start(fused_brick *b, const vodr_machine *m, const vodr_volume *volume, vodr_error *error)
{
    *b = (fused_brick){.volume = volume,
                       .density_bits = m->density_bits,
                       .linear = m->filter == VODR_FILTER_LINEAR,
                       .wide = m->density_bits > 8,
                       .texture = {.weight_bits = m->weight_bits, .guard_bits = m->guard_bits}};
    size_t words = (size_t)VOXEL_EDGE * VOXEL_EDGE * VOXEL_EDGE;
    b->words = malloc(words * (b->wide ? sizeof(uint64_t) : sizeof(uint32_t)));
    b->voxels = malloc(words * sizeof *b->voxels);
    if (!b->words || !b->voxels)
        return vodr_fail(error, VODR_NO_MEMORY, "no memory for a brick of %zu words", words);
    b->texture.words = b->words;
    return VODR_OK;
}

static int32_t clamp(int32_t i, int32_t last)
{
    return i < 0 ? 0 : i > last ? last : i;
}

/* `count` voxels of a row from x on, those outside the volume being the nearest inside. */
static void load_row(const fused_brick *b, int32_t x, int32_t y, int32_t z, int32_t count, uint16_t *row)
{
    const int32_t *dims = b->volume->dims_vox;
    int32_t first = clamp(x, dims[0] - 1), last = clamp(x + count - 1, dims[0] - 1), inside = last - first + 1;
    size_t from = voxel_index(dims, first, clamp(y, dims[1] - 1), clamp(z, dims[2] - 1));
    voxels_row(b->volume, b->density_bits, from, inside, row + (first - x));
    for (int32_t i = 0; i < first - x; i++)
        row[i] = row[first - x];
    for (int32_t i = last - x + 1; i < count; i++)
        row[i] = row[last - x];
}

/* Packs two rows of voxels, y and y+1, into `count` words. */
static void pack_row8(const uint16_t *upper, const uint16_t *lower, int32_t count, uint32_t *words)
{
    for (int32_t i = 0; i < count; i++)
        words[i] =
            (uint32_t)upper[i] | (uint32_t)upper[i + 1] << 8 | (uint32_t)lower[i] << 16 | (uint32_t)lower[i + 1] << 24;
}

static void pack_row12(const uint16_t *upper, const uint16_t *lower, int32_t count, uint64_t *words)
{
    for (int32_t i = 0; i < count; i++)
        words[i] =
            (uint64_t)upper[i] | (uint64_t)upper[i + 1] << 16 | (uint64_t)lower[i] << 32 | (uint64_t)lower[i + 1] << 48;
}

bool fused_brick_load(fused_brick *b, const vox_box *box, const int32_t *transparent_to)
{
    int32_t border = b->linear ? 1 : 0, size[3];
    for (int c = 0; c < 3; c++) {
        b->origin_vox[c] = box->lo[c] - border;
        size[c] = box->hi[c] - box->lo[c] + 2 * border;
    }
    uint16_t min = UINT16_MAX, max = 0, *row = b->voxels;
    for (int32_t z = 0; z < size[2]; z++)
        for (int32_t y = 0; y < size[1]; y++, row += size[0]) {
            load_row(b, b->origin_vox[0], b->origin_vox[1] + y, b->origin_vox[2] + z, size[0], row);
            for (int32_t i = 0; i < size[0]; i++) {
                min = row[i] < min ? row[i] : min;
                max = row[i] > max ? row[i] : max;
            }
        }
    if (transparent_to[min] >= max)
        return false;
    /* A linear brick's last word in x and y begins one voxel earlier; its last plane is only ever the far one. */
    int32_t width = size[0] - border, height = size[1] - border;
    int32_t right = b->linear ? 0 : -1; /* nearest reads a word's first voxel alone: any neighbours will do */
    b->texture.row_stride = (uint32_t)width;
    b->texture.plane_stride = (uint32_t)(width * height);
    uint32_t *words8 = b->words;
    uint64_t *words12 = b->words;
    for (int32_t z = 0; z < size[2]; z++)
        for (int32_t y = 0; y < height; y++) {
            const uint16_t *upper = b->voxels + (z * size[1] + y) * size[0],
                           *lower = b->linear ? upper + size[0] : upper;
            size_t at = (size_t)(z * height + y) * (size_t)width;
            if (right < 0)
                for (int32_t i = 0; i < width; i++) {
                    if (b->wide)
                        words12[at + (size_t)i] = upper[i];
                    else
                        words8[at + (size_t)i] = upper[i];
                }
            else if (b->wide)
                pack_row12(upper, lower, width, words12 + at);
            else
                pack_row8(upper, lower, width, words8 + at);
        }
    return true;
}

void fused_brick_finish(fused_brick *b)
{
    free(b->words);
    free(b->voxels);
    *b = (fused_brick){0};
}
