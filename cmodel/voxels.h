/* voxels.h - densities of a volume in memory, converted voxel by voxel, or its coefficients as they are (vodr.h,
 * vodr_volume). `bits` is stored_bits() of the machine: 16 are a coefficient's. */
#ifndef VODR_VOXELS_H
#define VODR_VOXELS_H

#include "view.h"
#include "vodr.h"

/* What of a volume is drawn. */
vox_box voxels_drawn(const vodr_volume *volume);

/* The voxels that samples inside `box` can touch: the box grown by `border` and clipped to the volume. */
vox_box voxels_reach(const int32_t dims_vox[3], const vox_box *box, int32_t border);

static inline size_t voxel_index(const int32_t dims_vox[3], int32_t x, int32_t y, int32_t z)
{
    return ((size_t)z * dims_vox[1] + y) * dims_vox[0] + x;
}

/* The number that texture memory holds for a voxel: coefficients are signed. */
static inline int32_t voxel_value(uint16_t stored, int32_t bits)
{
    return bits == 16 ? (int16_t)stored : stored;
}

/* Densities of the `count` voxels from index `first` on, or their coefficients in two's complement. */
static inline void voxels_row(const vodr_volume *volume, int32_t bits, size_t first, int32_t count, uint16_t *densities)
{
    uint16_t limit = (uint16_t)((1 << bits) - 1);
    if (volume->voxel_bytes == 2) {
        const uint16_t *voxel = (const uint16_t *)volume->voxels + first;
        for (int32_t i = 0; i < count; i++)
            densities[i] = voxel[i] < limit ? voxel[i] : limit;
        return;
    }
    const uint8_t *voxel = (const uint8_t *)volume->voxels + first;
    const uint16_t *restrict map = volume->map;
    for (int32_t i = 0; i < count && map; i++)
        densities[i] = map[voxel[i]];
    for (int32_t i = 0; i < count && !map; i++)
        densities[i] = voxel[i];
}

/* Smallest and largest of those in `box`. */
void voxels_range(const vodr_volume *volume, int32_t bits, const vox_box *box, int32_t *min, int32_t *max);

#endif
