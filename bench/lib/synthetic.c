/* synthetic.c - shells, tubes and noise, row by row. */
#include "synthetic.h"

#include <math.h>

#include "rng.h"

enum { SHELLS = 3, TUBES = 4 };

/* The middle of voxel i, -1 to 1 along its axis. */
static float place(int32_t i, int32_t size)
{
    return (2 * (float)i + 1) / (float)size - 1;
}

static void shells_row(const int32_t dims_vox[3], float yz_squared, uint16_t *row)
{
    static const struct {
        float radius, half_width, peak;
    } shells[SHELLS] = {{0.9f, 0.05f, 20000}, {0.6f, 0.06f, 42000}, {0.25f, 0.04f, 65000}};
    for (int32_t x = 0; x < dims_vox[0]; x++) {
        const float px = place(x, dims_vox[0]), r = sqrtf(px * px + yz_squared);
        float value = 0;
        for (int i = 0; i < SHELLS; i++)
            value = fmaxf(value, shells[i].peak * (1 - fabsf(r - shells[i].radius) / shells[i].half_width));
        row[x] = (uint16_t)value;
    }
}

static void tubes_row(const int32_t dims_vox[3], float y, float z, uint16_t *row)
{
    for (int32_t x = 0; x < dims_vox[0]; x++)
        row[x] = (uint16_t)(3000 + 37 * (x % 16));
    for (int i = 0; i < TUBES; i++) {
        const float turn = 5 * y + 1.7f * (float)i, away = 0.2f + 0.15f * (float)i;
        const float cx = away * cosf(turn), dz = z - away * sinf(turn), radius = 0.03f + 0.02f * (1 - y);
        for (int32_t x = 0; x < dims_vox[0]; x++) {
            const float dx = place(x, dims_vox[0]) - cx, inside = 1 - (dx * dx + dz * dz) / (radius * radius);
            const float value = (float)row[x] + inside * (30000 + 8000 * (float)i);
            if (inside > 0)
                row[x] = (uint16_t)value;
        }
    }
}

static void noise_row(const int32_t dims_vox[3], rng *random, uint16_t *row)
{
    for (int32_t x = 0; x < dims_vox[0]; x++)
        row[x] = (uint16_t)rng_next(random);
}

void synthetic_fill(synthetic_kind kind, const int32_t dims_vox[3], uint16_t *voxels)
{
    rng random = {1};
    for (int32_t z = 0; z < dims_vox[2]; z++)
        for (int32_t y = 0; y < dims_vox[1]; y++) {
            const float py = place(y, dims_vox[1]), pz = place(z, dims_vox[2]);
            uint16_t *row = voxels + ((size_t)z * (size_t)dims_vox[1] + (size_t)y) * (size_t)dims_vox[0];
            if (kind == SYNTHETIC_SHELLS)
                shells_row(dims_vox, py * py + pz * pz, row);
            else if (kind == SYNTHETIC_TUBES)
                tubes_row(dims_vox, py, pz, row);
            else
                noise_row(dims_vox, &random, row);
        }
}
