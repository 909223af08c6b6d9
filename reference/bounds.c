/* bounds.c - the grids of kernel_bounds on the CPU. Loops run along rows, so that the compiler makes vectors of them.
 */
#include "bounds.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { FLOAT_CODES = 65534 };

/* ---- what codes stand for ---- */

bounds_code bounds_code_of(const reference_volume *v)
{
    if (v->type != REFERENCE_FLOAT32)
        return (bounds_code){0, 1, 1, 0, v->type == REFERENCE_UINT8 ? 255 : 65535};
    const float *values = v->voxels;
    float least = values[0], most = values[0];
    for (size_t i = 1, n = (size_t)v->dims_vox[0] * (size_t)v->dims_vox[1] * (size_t)v->dims_vox[2]; i < n; i++) {
        least = values[i] < least ? values[i] : least;
        most = values[i] > most ? values[i] : most;
    }
    const double step = ((double)most - (double)least) / FLOAT_CODES;
    const float largest = fmaxf(fabsf(least), fabsf(most)), margin = 0x1p-18f * largest;
    if (step < FLT_MIN) /* one code for all */
        return (bounds_code){.least = least, .offset = most + margin, .largest = largest};
    return (bounds_code){least, (float)(1 / step), (float)step, least + margin, largest};
}

void bounds_decode(const bounds_code *code, kernel_filter filter, kernel_bounds *b)
{
    const float slack = filter == KERNEL_TEXTURE ? 0x1p-16f : 0;
    b->scale = code->scale * (1 + slack);
    b->offset_value = code->offset == 0 ? 0 : code->offset + slack * code->largest;
}

/* ---- shapes ---- */

size_t bounds_shape(const int32_t dims_vox[3], bool bricks, kernel_bounds *b)
{
    int64_t codes = 0;
    bool one = false;
    b->levels = 0;
    for (int k = 0; k < BOUND_GRIDS && !one; k++) {
        int64_t count = 1;
        for (int a = 0; a < 3; a++) {
            b->count[k][a] = bounds_count(dims_vox[a], 1 << k);
            count *= k == 0 && bricks ? bounds_bricks(b->count[k][a]) * BOUND_BRICK : b->count[k][a];
        }
        if (count > INT32_MAX)
            return 0;
        b->offset[k] = codes;
        codes += count;
        b->levels = k + 1;
        one = k > 0 && count == 1;
    }
    return (size_t)codes;
}

/* ---- blocks ---- */

/* The codes of a row of `size` voxels from number `first` on; greater ones than are there already replace them. */
static void raise_row(const reference_volume *v, const bounds_code *code, size_t first, int32_t size, uint16_t *row)
{
    if (v->type == REFERENCE_UINT8) {
        const uint8_t *voxels = (const uint8_t *)v->voxels + first;
        for (int32_t x = 0; x < size; x++)
            row[x] = voxels[x] > row[x] ? voxels[x] : row[x];
    } else if (v->type == REFERENCE_UINT16) {
        const uint16_t *voxels = (const uint16_t *)v->voxels + first;
        for (int32_t x = 0; x < size; x++)
            row[x] = voxels[x] > row[x] ? voxels[x] : row[x];
    } else {
        const float *voxels = (const float *)v->voxels + first;
        for (int32_t x = 0; x < size; x++) {
            float value = fminf(ceilf((voxels[x] - code->least) * code->inverse), FLOAT_CODES + 1);
            row[x] = value > row[x] ? (uint16_t)value : row[x];
        }
    }
}

/* The greatest of each block's voxels of a row. */
static void block_row(const uint16_t *row, int32_t size, int32_t edge_vox, uint16_t *codes)
{
    for (int32_t i = 0; i < bounds_count(size, edge_vox); i++) {
        int32_t lo, hi;
        bounds_voxels(i, edge_vox, size, &lo, &hi);
        uint16_t most = row[lo];
        for (int32_t x = lo + 1; x < hi; x++)
            most = row[x] > most ? row[x] : most;
        codes[i] = most;
    }
}

void bounds_fill(const reference_volume *v, const bounds_code *code, int32_t edge_vox, int32_t l0, int32_t l1,
                 uint16_t *codes)
{
    const int32_t *size = v->dims_vox;
    const int32_t columns = bounds_count(size[0], edge_vox), rows = bounds_count(size[1], edge_vox);
    uint16_t row[VODR_MAX_DIM_VOX];
    for (int32_t l = l0; l < l1; l++)
        for (int32_t j = 0; j < rows; j++) {
            int32_t y0, y1, z0, z1;
            bounds_voxels(j, edge_vox, size[1], &y0, &y1);
            bounds_voxels(l, edge_vox, size[2], &z0, &z1);
            memset(row, 0, (size_t)size[0] * sizeof *row);
            for (int32_t z = z0; z < z1; z++)
                for (int32_t y = y0; y < y1; y++)
                    raise_row(v, code, ((size_t)z * (size_t)size[1] + (size_t)y) * (size_t)size[0], size[0], row);
            block_row(row, size[0], edge_vox, codes + ((size_t)l * (size_t)rows + (size_t)j) * (size_t)columns);
        }
}

static uint16_t *grid_row(const kernel_bounds *b, int32_t k, int32_t l, int32_t j, uint16_t *codes)
{
    const int32_t *count = b->count[k];
    return codes + b->offset[k] + ((int64_t)l * count[1] + j) * count[0];
}

/* Raises a row to the greatest of itself and another. */
static void raise_codes(uint16_t *row, const uint16_t *other, int32_t count)
{
    for (int32_t i = 0; i < count; i++)
        row[i] = other[i] > row[i] ? other[i] : row[i];
}

/* ---- cells ---- */

/* Cells done at a time along a row, a multiple of BOUND_BRICK: what is on the way to bricks stays in the first cache.
 */
enum { STRETCH = 512 };

/* The cells of a layer of bricks that lie in a row of them, `count` along x from x0 on. */
typedef struct brick_rows {
    int32_t x0, count;
    uint16_t codes[BOUND_BRICK * BOUND_BRICK][STRETCH]; /* rows y fastest; 0 beyond the volume */
} brick_rows;

/* Cells [x0, x0 + count) of row (y, z). */
static void cell_row(const reference_volume *v, const bounds_code *code, int32_t y, int32_t z, int32_t x0,
                     int32_t count, uint16_t *out)
{
    const int32_t *size = v->dims_vox, lo = x0 > 0 ? x0 - 1 : 0, hi = x0 + count < size[0] ? x0 + count : size[0];
    uint16_t row[STRETCH + 1] = {0}, *first = row + (x0 == 0);
    int32_t y0, y1, z0, z1;
    bounds_voxels(y, 1, size[1], &y0, &y1);
    bounds_voxels(z, 1, size[2], &z0, &z1);
    for (int32_t k = z0; k < z1; k++)
        for (int32_t j = y0; j < y1; j++)
            raise_row(v, code, ((size_t)k * (size_t)size[1] + (size_t)j) * (size_t)size[0] + (size_t)lo, hi - lo,
                      first);
    for (int32_t i = 0; i < count; i++)
        out[i] = row[i] > row[i + 1] ? row[i] : row[i + 1];
}

static void store_bricks(const kernel_bounds *b, const brick_rows *rows, int32_t j, int32_t l, uint16_t *codes)
{
    const int64_t across = bounds_bricks(b->count[0][0]), down = bounds_bricks(b->count[0][1]);
    uint16_t *out = codes + ((l * down + j) * across + rows->x0 / BOUND_BRICK) * BOUND_BRICK_CELLS;
    for (int32_t i = 0; i < rows->count; i += BOUND_BRICK, out += BOUND_BRICK_CELLS)
        for (int32_t n = 0; n < BOUND_BRICK * BOUND_BRICK; n++)
            memcpy(out + (size_t)n * BOUND_BRICK, rows->codes[n] + i, BOUND_BRICK * sizeof *out);
}

/* Blocks of two cells a side. */
static void store_blocks(const kernel_bounds *b, const brick_rows *rows, int32_t j, int32_t l, uint16_t *codes)
{
    for (int32_t n = 0; n < 4; n++) {
        const int32_t y = 2 * j + n % 2, z = 2 * l + n / 2;
        uint16_t most[STRETCH];
        if (y >= b->count[1][1] || z >= b->count[1][2])
            continue;
        memcpy(most, rows->codes[2 * (n % 2) + 8 * (n / 2)], sizeof most);
        raise_codes(most, rows->codes[2 * (n % 2) + 8 * (n / 2) + 1], rows->count);
        raise_codes(most, rows->codes[2 * (n % 2) + 8 * (n / 2) + 4], rows->count);
        raise_codes(most, rows->codes[2 * (n % 2) + 8 * (n / 2) + 5], rows->count);
        uint16_t *out = grid_row(b, 1, z, y, codes) + rows->x0 / 2;
        for (int32_t i = 0; 2 * i < rows->count && rows->x0 / 2 + i < b->count[1][0]; i++)
            out[i] = most[2 * i] > most[2 * i + 1] ? most[2 * i] : most[2 * i + 1];
    }
}

void bounds_fill_cells(const reference_volume *v, const bounds_code *code, const kernel_bounds *b, int32_t r0,
                       int32_t r1, uint16_t *codes)
{
    const int32_t *count = b->count[0];
    brick_rows rows;
    for (int32_t l = r0; l < r1; l++)
        for (int32_t j = 0; j < bounds_bricks(count[1]); j++)
            for (int32_t x0 = 0; x0 < count[0]; x0 += STRETCH) {
                rows.x0 = x0;
                rows.count = count[0] - x0 < STRETCH ? count[0] - x0 : STRETCH;
                memset(rows.codes, 0, sizeof rows.codes);
                for (int32_t n = 0; n < BOUND_BRICK * BOUND_BRICK; n++) {
                    const int32_t y = BOUND_BRICK * j + n % BOUND_BRICK, z = BOUND_BRICK * l + n / BOUND_BRICK;
                    if (y < count[1] && z < count[2])
                        cell_row(v, code, y, z, x0, rows.count, rows.codes[n]);
                }
                store_bricks(b, &rows, j, l, codes);
                store_blocks(b, &rows, j, l, codes);
            }
}

/* ---- windows ---- */

void bounds_halve(const kernel_bounds *b, int32_t k, int32_t l0, int32_t l1, uint16_t *codes)
{
    const int32_t *fine = b->count[k - 1], *count = b->count[k];
    uint16_t row[VODR_MAX_DIM_VOX + 2];
    for (int32_t l = l0; l < l1; l++)
        for (int32_t j = 0; j < count[1]; j++) {
            uint16_t *out = grid_row(b, k, l, j, codes);
            memset(row, 0, sizeof *row * (size_t)(2 * count[0]));
            for (int32_t z = 2 * l; z < 2 * l + 2 && z < fine[2]; z++)
                for (int32_t y = 2 * j; y < 2 * j + 2 && y < fine[1]; y++)
                    raise_codes(row, grid_row(b, k - 1, z, y, codes), fine[0]);
            for (int32_t i = 0; i < count[0]; i++)
                out[i] = row[2 * i] > row[2 * i + 1] ? row[2 * i] : row[2 * i + 1];
        }
}

void bounds_widen_layers(const kernel_bounds *b, int32_t k, int32_t l0, int32_t l1, uint16_t *codes)
{
    const int32_t *count = b->count[k];
    for (int32_t l = l0; l < l1; l++)
        for (int32_t j = 0; j < count[1]; j++) {
            uint16_t *row = grid_row(b, k, l, j, codes);
            for (int32_t y = j + 1; y < j + 4 && y < count[1]; y++)
                raise_codes(row, grid_row(b, k, l, y, codes), count[0]);
            for (int32_t reach = 1; reach <= 2; reach++) /* of one more, then of two more */
                raise_codes(row, row + reach, count[0] - reach);
        }
}

void bounds_widen_rows(const kernel_bounds *b, int32_t k, int32_t j0, int32_t j1, uint16_t *codes)
{
    const int32_t *count = b->count[k];
    for (int32_t l = 0; l < count[2]; l++)
        for (int32_t j = j0; j < j1; j++)
            for (int32_t z = l + 1; z < l + 4 && z < count[2]; z++)
                raise_codes(grid_row(b, k, l, j, codes), grid_row(b, k, z, j, codes), count[0]);
}

void bounds_fill_near(const kernel_bounds *b, int32_t l0, int32_t l1, const uint16_t *codes, uint16_t *near)
{
    const int32_t *count = b->count[1];
    for (int32_t l = l0; l < l1; l++)
        for (int32_t j = 0; j < count[1]; j++) {
            uint16_t *row = near + ((int64_t)l * count[1] + j) * count[0];
            memset(row, 0, (size_t)count[0] * sizeof *row);
            for (int32_t z = l; z < l + 3 && z < count[2]; z++)
                for (int32_t y = j; y < j + 3 && y < count[1]; y++)
                    raise_codes(row, codes + b->offset[1] + ((int64_t)z * count[1] + y) * count[0], count[0]);
            for (int32_t reach = 0; reach < 2; reach++)
                raise_codes(row, row + 1, count[0] - 1);
        }
}
