/* cube.c - the volume and the views of Table 1. */
#include "cube.h"

#include <math.h>
#include <stdlib.h>

#include "camera.h"
#include "transfer.h"

enum { DENSITY_BITS = 8, TF_BITS = 8, SHELLS = 5 };

static void fill_voxels(uint8_t *voxels)
{
    uint32_t noise = 1;
    for (int32_t z = 0; z < CUBE_VOX; z++)
        for (int32_t y = 0; y < CUBE_VOX; y++)
            for (int32_t x = 0; x < CUBE_VOX; x++) {
                double dx = x - 127.5, dy = y - 127.5, dz = z - 127.5;
                double radius = sqrt(dx * dx + dy * dy + dz * dz) / 128 + 0.04 * sin(dx / 13) * cos(dy / 17);
                double shell = 0.5 + 0.5 * cos(radius * SHELLS * 6.283185307179586);
                noise = noise * 1664525u + 1013904223u;
                *voxels++ = (uint8_t)(radius < 1 ? 250 * shell + (noise >> 30) : noise >> 30);
            }
}

host_status cube_make(cube *c, host_error *error)
{
    const size_t count = (size_t)CUBE_VOX * CUBE_VOX * CUBE_VOX, entries = (size_t)1 << DENSITY_BITS;
    transfer ramp = {0};
    *c = (cube){.voxels = malloc(count), .entries = malloc(entries * sizeof *c->entries)};
    host_status status = c->voxels && c->entries
                             ? transfer_open("ramp", false, &ramp, error)
                             : host_fail(error, HOST_ENVIRONMENT, "no memory for a volume of 256^3");
    if (status != HOST_OK) {
        cube_free(c);
        return status;
    }
    fill_voxels(c->voxels);
    transfer_table(&ramp, 0, 255, DENSITY_BITS, TF_BITS, 1, false, c->entries);
    transfer_close(&ramp);
    c->volume = (vodr_volume){.dims_vox = {CUBE_VOX, CUBE_VOX, CUBE_VOX}, .voxel_bytes = 1, .voxels = c->voxels};
    c->table = (vodr_table){c->entries, entries};
    return HOST_OK;
}

void cube_free(cube *c)
{
    free(c->voxels);
    free(c->entries);
    *c = (cube){0};
}

host_status cube_view(double azimuth_deg, double elevation_deg, vodr_view *view, host_error *error)
{
    const volume v = {.path = "cube",
                      .dims_vox = {CUBE_VOX, CUBE_VOX, CUBE_VOX},
                      .spacing = {1, 1, 1},
                      .axis = {0, 1, 2},
                      .sign = {1, 1, 1}};
    camera c = camera_default();
    double depth_vox;
    c.azimuth_deg = azimuth_deg;
    c.elevation_deg = elevation_deg;
    c.width_px = c.height_px = c.slices = CUBE_VOX;
    return camera_view(&c, &v, view, &depth_vox, error);
}
