/* cpu_march_kernels.h - the functions of cpu_march.h for lanes of REAL, whose packets are tiles of pixels. Included
 * once by a file for each REAL; the variants are constants that the compiler folds into each copy of one loop. */
#include "cpu_march.h"
#include "kernel_march.h"
#include "kernel_ray.h"

enum { TILE_W = CPU_TILE_PX, TILE_H = LANES / CPU_TILE_PX };

/* Lane l is pixel (x + l%TILE_W, y + l/TILE_W); lanes outside the frame or below y1 get no samples. */
KERNEL packet tile_rays(const kernel_frame *f, int32_t x, int32_t y, int32_t y1)
{
    packet rays;
    for (int l = 0; l < LANES; l++) {
        int32_t px = x + l % TILE_W, py = y + l / TILE_W;
        kernel_ray ray = {{0.5, 0.5, 0.5}, {0, 0, 0}, 0};
        if (px < f->camera.width_px && py < y1)
            ray = ray_make(f, px, py);
        for (int a = 0; a < 3; a++) {
            rays.start[a][l] = (REAL)ray.start[a];
            rays.step[a][l] = (REAL)ray.step[a];
        }
        rays.count[l] = ray.count;
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
                       kernel_skip skip)
{
    for (int32_t y = y0; y < y1; y += TILE_H)
        for (int32_t x = 0; x < f->camera.width_px; x += TILE_W) {
            packet rays = tile_rays(f, x, y, y1);
            packet_result result = march(f, f->table.rgba, &rays, mode, f->filter, skip, f->volume.type);
            tile_store(f, x, y, y1, &result, rgba, samples);
        }
}

#define DEFINE_ONE(set, target, mode, skip)                                                                            \
    target static void march_##set##_##mode##_##skip(const kernel_frame *f, int32_t y0, int32_t y1, double *rgba,      \
                                                     uint64_t *samples)                                                \
    {                                                                                                                  \
        march_rows(f, y0, y1, rgba, samples, mode, skip);                                                              \
    }
#define DEFINE_SKIPS(set, target, mode)                                                                                \
    DEFINE_ONE(set, target, mode, KERNEL_SKIP_NONE)                                                                    \
    DEFINE_ONE(set, target, mode, KERNEL_SKIP_EMPTY)
#define ROW_SKIPS(set, mode)                                                                                           \
    {                                                                                                                  \
        march_##set##_##mode##_KERNEL_SKIP_NONE, march_##set##_##mode##_KERNEL_SKIP_EMPTY                              \
    }

/* All variants for an instruction set, and the table of them. */
#define DEFINE_MARCH(set, target)                                                                                      \
    DEFINE_SKIPS(set, target, KERNEL_OVER)                                                                             \
    DEFINE_SKIPS(set, target, KERNEL_LIT)                                                                              \
    DEFINE_SKIPS(set, target, KERNEL_MIP)                                                                              \
    static const cpu_kernels kernels_##set = {                                                                         \
        #set, {ROW_SKIPS(set, KERNEL_OVER), ROW_SKIPS(set, KERNEL_LIT), ROW_SKIPS(set, KERNEL_MIP)}}
