#include "voxels.h"

vox_box voxels_drawn(const vodr_volume *volume)
{
    const bool all = volume->hi_vox[0] == 0;
    vox_box drawn;
    for (int c = 0; c < 3; c++) {
        drawn.lo[c] = all ? 0 : volume->lo_vox[c];
        drawn.hi[c] = all ? volume->dims_vox[c] : volume->hi_vox[c];
    }
    return drawn;
}

vox_box voxels_reach(const int32_t dims_vox[3], const vox_box *box, int32_t border)
{
    vox_box reach;
    for (int c = 0; c < 3; c++) {
        reach.lo[c] = box->lo[c] > border ? box->lo[c] - border : 0;
        reach.hi[c] = box->hi[c] < dims_vox[c] - border ? box->hi[c] + border : dims_vox[c];
    }
    return reach;
}

void voxels_range(const vodr_volume *volume, int32_t bits, const vox_box *box, int32_t *min, int32_t *max)
{
    enum { CHUNK = 256 };
    uint16_t row[CHUNK];
    *min = INT32_MAX;
    *max = INT32_MIN;
    for (int32_t z = box->lo[2]; z < box->hi[2]; z++)
        for (int32_t y = box->lo[1]; y < box->hi[1]; y++)
            for (int32_t x = box->lo[0]; x < box->hi[0]; x += CHUNK) {
                int32_t n = box->hi[0] - x < CHUNK ? box->hi[0] - x : CHUNK;
                voxels_row(volume, bits, voxel_index(volume->dims_vox, x, y, z), n, row);
                for (int32_t i = 0; i < n; i++) {
                    int32_t value = voxel_value(row[i], bits);
                    *min = value < *min ? value : *min;
                    *max = value > *max ? value : *max;
                }
            }
}
