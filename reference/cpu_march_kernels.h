/* cpu_march_kernels.h - the functions of cpu_march.h for lanes of REAL, whose packets are tiles of pixels. Included
 * once by a file for each REAL and instruction set; the variants are constants that the compiler folds into each copy
 * of one loop. */
#include "cpu_march.h"
#include "kernel_cast.h"
#include "kernel_order.h"
#include "kernel_ray.h"

/* The pixel of lane l of the tile at column i and row j of the frame's order; false: outside the frame, or from row j1
 * on. */
KERNEL bool tile_pixel(const kernel_frame *f, int32_t i, int32_t j, int32_t j1, int l, int32_t *x, int32_t *y)
{
    const int32_t width_log2 = f->order.tile_log2, row = j + (l >> width_log2);
    return order_has(f, i + (l & ((1 << width_log2) - 1)), row, x, y) && row < j1;
}

/* Lanes without a pixel get no samples. */
KERNEL packet tile_rays(const kernel_frame *f, kernel_filter filter, int32_t i, int32_t j, int32_t j1)
{
    packet rays;
    rays.boxed = f->part.boxed;
    for (int a = 0; a < 3; a++)
        rays.origin[a] = (REAL)f->part.origin_vox[a];
    for (int l = 0; l < LANES; l++) {
        int32_t x, y;
        kernel_ray ray = ray_none(&f->part);
        if (tile_pixel(f, i, j, j1, l, &x, &y))
            ray = ray_make(f, x, y);
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

KERNEL void tile_store(const kernel_frame *f, int32_t i, int32_t j, int32_t j1, const packet_result *result,
                       double *rgba, uint64_t *samples)
{
    for (int l = 0; l < LANES; l++) {
        int32_t x, y;
        *samples += (uint64_t)result->samples[l];
        if (!tile_pixel(f, i, j, j1, l, &x, &y))
            continue;
        double *pixel = rgba + 4 * ((size_t)y * (size_t)f->camera.width_px + (size_t)x);
        for (int c = 0; c < 4; c++)
            pixel[c] = (double)result->rgba[c][l];
    }
}

KERNEL void march_rows(const kernel_frame *f, int32_t j0, int32_t j1, double *rgba, uint64_t *samples, kernel_mode mode,
                       kernel_filter filter)
{
    const lookup entries = {f->table.rgba};
    const int32_t width = 1 << f->order.tile_log2, height = LANES > width ? LANES / width : 1;
    for (int32_t i = 0; i < f->order.columns; i += width) /* tiles one below the other share most of what they read */
        for (int32_t j = j0; j < j1; j += height) {
            packet rays = tile_rays(f, filter, i, j, j1);
            packet_result result = cast(f, &entries, &rays, mode, filter, f->skip, f->volume.type);
            tile_store(f, i, j, j1, &result, rgba, samples);
        }
}

#define DEFINE_ONE(set, filter, mode)                                                                                  \
    static void set##_##mode(const kernel_frame *f, int32_t j0, int32_t j1, double *rgba, uint64_t *samples)           \
    {                                                                                                                  \
        march_rows(f, j0, j1, rgba, samples, mode, filter);                                                            \
    }

/* The kernels of an instruction set, and the table of them. `search` is defined beside it: it reads too little for
 * cells to be packed, and there is none of a cubic (NULL). */
#define DEFINE_MARCH(table, set, cells, filter, search)                                                                \
    DEFINE_ONE(set, filter, KERNEL_OVER)                                                                               \
    DEFINE_ONE(set, filter, KERNEL_LIT)                                                                                \
    DEFINE_ONE(set, filter, KERNEL_MIP)                                                                                \
    DEFINE_ONE(set, filter, KERNEL_LEAP)                                                                               \
    const cpu_kernels table = {                                                                                        \
        #set, cells, {set##_KERNEL_OVER, set##_KERNEL_LIT, set##_KERNEL_MIP, set##_KERNEL_LEAP, search}, READS_QUADS}

#if defined(LANES_OF_FLOAT) && defined(__AVX512F__)
#define READS_QUADS true
#else
#define READS_QUADS false
#endif

#define NOT_CELLS                                                                                                      \
    f->filter == KERNEL_NEAREST ? KERNEL_NEAREST : f->filter == KERNEL_TEXTURE ? KERNEL_TEXTURE : KERNEL_LINEAR
