/* cube.h - the volume and the views of Table 1: 256^3 voxels, 256x256 pixels, 256 slices.
 *
 * The volume is made here: concentric shells of densities, their radii bent by a wave, with noise of four levels on
 * top. Counters do not depend on the voxels as long as nothing is skipped or killed. */
#ifndef BENCH_CUBE_H
#define BENCH_CUBE_H

#include "host.h"
#include "vodr.h"

enum { CUBE_VOX = 256 };

typedef struct cube {
    uint8_t *voxels; /* owned */
    vodr_rgba *entries;
    vodr_volume volume;
    vodr_table table; /* `ramp`, 8 bits, for a spacing of one voxel */
} cube;

host_status cube_make(cube *c, host_error *error);
void cube_free(cube *c);

/* The registers for a parallel view of 256x256 pixels and 256 slices. */
host_status cube_view(double azimuth_deg, double elevation_deg, vodr_view *view, host_error *error);

#endif
