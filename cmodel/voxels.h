/* voxels.h - densities of a volume in memory, converted voxel by voxel (vodr.h, vodr_volume). */
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

/* Densities of the `count` voxels from index `first` on. */
void voxels_row(const vodr_volume *volume, int32_t density_bits, size_t first, int32_t count, uint16_t *densities);

/* Smallest and largest density in `box`. */
void voxels_range(const vodr_volume *volume, int32_t density_bits, const vox_box *box, int32_t *min, int32_t *max);

#endif
