/* cpu_march_kernels.h - the functions of cpu_march.h for lanes of REAL, whose packets are tiles of pixels. Included
 * once by a file for each REAL and instruction set; the variants are constants that the compiler folds into each copy
 * of one loop. */
#include "cpu_march.h"
#include "kernel_cast.h"
#include "kernel_ray.h"

enum { TILE_W = CPU_TILE_PX, TILE_H = LANES / CPU_TILE_PX };

/* Lane l is pixel (x + l%TILE_W, y + l/TILE_W); lanes outside the frame or below y1 get no samples. */
KERNEL packet tile_rays(const kernel_frame *f, kernel_filter filter, int32_t x, int32_t y, int32_t y1)
{
    packet rays;
    for (int a = 0; a < 3; a++)
        rays.origin[a] = (REAL)f->part.origin_vox[a];
    for (int l = 0; l < LANES; l++) {
        int32_t px = x + l % TILE_W, py = y + l / TILE_W;
        kernel_ray ray = ray_none(&f->part);
        if (px < f->camera.width_px && py < y1)
            ray = ray_make(f, px, py);
        for (int a = 0; a < 3; a++) {
            rays.start[a][l] = (REAL)(ray.start[a] + (double)place_shift(filter));
            rays.step[a][l] = (REAL)ray.step[a];
        }
        rays.skipped[l] = (REAL)ray.skipped;
        rays.count[l] = ray.count;
        rays.first[l] = ray.first;
    }
    return rays;
}

KERNEL void tile_store(const kernel_frame *f, int32_t x, int32_t y, int32_t y1, const packet_result *result,
                       double *rgba, uint64_t *samples)
{
    for (int l = 0; l < LANES; l++) {
        int32_t px = x + l % TILE_W, py = y + l / TILE_W;
        *samples += (uint64_t)result->samples[l];
        if (px >= f->camera.width_px || py >= y1)
            continue;
        double *pixel = rgba + 4 * ((size_t)py * (size_t)f->camera.width_px + (size_t)px);
        for (int c = 0; c < 4; c++)
            pixel[c] = (double)result->rgba[c][l];
    }
}

KERNEL void march_rows(const kernel_frame *f, int32_t y0, int32_t y1, double *rgba, uint64_t *samples, kernel_mode mode,
                       kernel_filter filter)
{
    const lookup entries = {f->table.rgba};
    for (int32_t y = y0; y < y1; y += TILE_H)
        for (int32_t x = 0; x < f->camera.width_px; x += TILE_W) {
            packet rays = tile_rays(f, filter, x, y, y1);
            packet_result result = cast(f, &entries, &rays, mode, filter, f->skip, f->volume.type);
            tile_store(f, x, y, y1, &result, rgba, samples);
        }
}

#define DEFINE_ONE(set, filter, mode)                                                                                  \
    static void set##_##mode(const kernel_frame *f, int32_t y0, int32_t y1, double *rgba, uint64_t *samples)           \
    {                                                                                                                  \
        march_rows(f, y0, y1, rgba, samples, mode, filter);                                                            \
    }

/* The kernels of an instruction set, and the table of them. A search reads too little for cells to be packed. */
#define DEFINE_MARCH(table, set, cells, filter, scattered)                                                             \
    DEFINE_ONE(set, filter, KERNEL_OVER)                                                                               \
    DEFINE_ONE(set, filter, KERNEL_LIT)                                                                                \
    DEFINE_ONE(set, filter, KERNEL_MIP)                                                                                \
    DEFINE_ONE(set, filter, KERNEL_LEAP)                                                                               \
    DEFINE_ONE(set, scattered, KERNEL_SEARCH)                                                                          \
    const cpu_kernels table = {                                                                                        \
        #set, cells, {set##_KERNEL_OVER, set##_KERNEL_LIT, set##_KERNEL_MIP, set##_KERNEL_LEAP, set##_KERNEL_SEARCH}}

#define NOT_CELLS                                                                                                      \
    f->filter == KERNEL_NEAREST ? KERNEL_NEAREST : f->filter == KERNEL_TEXTURE ? KERNEL_TEXTURE : KERNEL_LINEAR
