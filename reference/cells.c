/* cells.c - packs a volume's voxels so that a cell is read with one load: entry (i, j, k) holds the voxels (i-1; j-1,
 * j; k-1, k), clamped to the volume, y fastest; cell (i, j, k) is the entries i and i+1. */
#include "cells.h"

#include <string.h>

static int32_t clamped(int32_t i, int32_t size)
{
    return i < 0 ? 0 : i < size ? i : size - 1;
}

static size_t entry_bytes(const reference_volume *v)
{
    return v->type == REFERENCE_UINT8 ? 4 : 8;
}

static int64_t entries(const reference_volume *v)
{
    return (int64_t)(v->dims_vox[0] + 2) * (v->dims_vox[1] + 1) * (v->dims_vox[2] + 1);
}

bool cells_suit(const reference_volume *v)
{
    return v->type != REFERENCE_FLOAT32 && entries(v) <= INT32_MAX;
}

size_t cells_bytes(const reference_volume *v)
{
    return (size_t)entries(v) * entry_bytes(v);
}

/* The four rows of voxels that a row of entries is made of. */
static void row_8(const uint8_t *const row[4], int32_t size, uint8_t *out)
{
    for (int32_t i = 0; i < size; i++)
        for (int n = 0; n < 4; n++)
            out[4 * i + n] = row[n][i];
}

static void row_16(const uint16_t *const row[4], int32_t size, uint16_t *out)
{
    for (int32_t i = 0; i < size; i++)
        for (int n = 0; n < 4; n++)
            out[4 * i + n] = row[n][i];
}

void cells_fill(const reference_volume *v, int32_t z0, int32_t z1, void *cells)
{
    const int32_t *size = v->dims_vox;
    const size_t bytes = entry_bytes(v), row_bytes = bytes * (size_t)(size[0] + 2);
    for (int32_t z = z0; z < z1; z++)
        for (int32_t y = 0; y <= size[1]; y++) {
            char *out = (char *)cells + ((size_t)z * (size_t)(size[1] + 1) + (size_t)y) * row_bytes;
            size_t from[4];
            for (int n = 0; n < 4; n++) {
                int32_t row = clamped(y - 1 + n % 2, size[1]), layer = clamped(z - 1 + n / 2, size[2]);
                from[n] = ((size_t)layer * (size_t)size[1] + (size_t)row) * (size_t)size[0];
            }
            if (v->type == REFERENCE_UINT8) {
                const uint8_t *p = v->voxels, *const row[4] = {p + from[0], p + from[1], p + from[2], p + from[3]};
                row_8(row, size[0], (uint8_t *)(out + bytes));
            } else {
                const uint16_t *p = v->voxels, *const row[4] = {p + from[0], p + from[1], p + from[2], p + from[3]};
                row_16(row, size[0], (uint16_t *)(out + bytes));
            }
            memcpy(out, out + bytes, bytes);
            memcpy(out + row_bytes - bytes, out + row_bytes - 2 * bytes, bytes);
        }
}
