/* launch_cuda.h - private to device_cuda.cu: which pixels a warp takes, and how often a table lies in shared memory. */
#ifndef REFERENCE_LAUNCH_CUDA_H
#define REFERENCE_LAUNCH_CUDA_H

#include "kernel_cast.h"
#include "kernel_order.h"

enum { COPIES_BYTES = 34 << 10 };

/* How a frame's pixels are dealt out. A block of threads is two warps wide, four high. */
typedef struct march_launch {
    int32_t warp_log2;   /* of pixels that a warp is wide */
    int32_t copies_log2; /* of copies of a table's entry in shared memory: neighbours then read side by side */
} march_launch;

/* The width of warps along the order's rows, as a power of two, whose pixels' samples lie in the fewest pieces of
 * memory: of `piece` voxels along each axis, at the volume's centre. */
static int32_t best_warp(const kernel_frame *f, const double piece[3])
{
    const reference_camera *c = &f->camera;
    double along = 0, length = 0, least = INFINITY;
    int32_t best = 4;
    for (int a = 0; a < 3; a++) {
        double half_x = c->width_px / 2.0, half_y = c->height_px / 2.0;
        double o = c->origin[0][a] + half_x * c->origin[1][a] + half_y * c->origin[2][a];
        double d = c->direction[0][a] + half_x * c->direction[1][a] + half_y * c->direction[2][a];
        along += (f->volume.dims_vox[a] / 2.0 - o) * d;
        length += d * d;
    }
    double depth = length > 0 ? along / length : 0, slope = f->order.slope / (double)ORDER_ONE, column[3], row[3];
    for (int a = 0; a < 3; a++) {
        double right = c->origin[1][a] + depth * c->direction[1][a];
        double down = c->origin[2][a] + depth * c->direction[2][a];
        column[a] = f->order.steep ? down + slope * right : right + slope * down;
        row[a] = f->order.steep ? right : down;
    }
    for (int32_t log2 = 0; log2 <= 5; log2++) {
        double pieces = 1;
        for (int a = 0; a < 3; a++) {
            double across = fabs(column[a]) * ((1 << log2) - 1), down = fabs(row[a]) * ((32 >> log2) - 1);
            pieces *= (across + down + 1) / piece[a] + 1;
        }
        if (pieces < least) {
            least = pieces;
            best = log2;
        }
    }
    return best;
}

static size_t table_bytes(const kernel_frame *f, int32_t copies_log2)
{
    return (f->table.columns + 1) * 2 * sizeof(float4) << copies_log2;
}

/* fast_axis: of the volume as it lies in memory. A maximum looks its table up once a ray, where it is. Runs of a search
 * are bounded the better the more compact a warp's pixels are. */
static march_launch launch_of(kernel_mode mode, const kernel_frame *f, int32_t fast_axis)
{
    if (mode == KERNEL_SEARCH)
        return march_launch{TOGETHER == 32 ? 2 : TOGETHER == 16 ? 3 : 4, 0};
    static const double line_voxels[] = {128, 64, 32};
    const double line = f->filter == KERNEL_CELLS ? line_voxels[f->volume.type] / 8 : line_voxels[f->volume.type];
    const double texture[3] = {16, 2, 1};
    double linear[3] = {1, 1, 1};
    linear[fast_axis] = line;
    march_launch launch = {best_warp(f, f->filter == KERNEL_TEXTURE ? texture : linear), 0};
    while (launch.copies_log2 < 2 && table_bytes(f, launch.copies_log2 + 1) <= COPIES_BYTES)
        launch.copies_log2++;
    return launch;
}

#endif
