/* kernel_ray.h - the ray of a pixel, clipped to the volume's half-open box. In double precision and without contraction
 * on every device, so that all agree which samples there are. */
#ifndef REFERENCE_KERNEL_RAY_H
#define REFERENCE_KERNEL_RAY_H

#include <math.h>

#include "kernel_types.h"
#include "lanes.h"

/* a + b*c, rounded twice. */
KERNEL double ray_along(double a, double b, double c)
{
#ifdef __CUDACC__
    return __dadd_rn(a, __dmul_rn(b, c));
#else
    return a + b * c;
#endif
}

/* The least j of [lo, hi] at which start + j*step has come up to `border` (rising) or fallen below it; hi if none has.
 * The quotient is a guess that rounding may have moved. */
KERNEL int64_t ray_crossing(double start, double step, double border, int64_t lo, int64_t hi)
{
    const bool rising = step > 0;
    double guess = step == 0 ? (double)hi : ceil((border - start) / step);
    int64_t j = guess <= (double)lo ? lo : guess >= (double)hi ? hi : (int64_t)guess;
    while (j > lo && (ray_along(start, (double)(j - 1), step) >= border) == rising)
        j--;
    while (j < hi && (ray_along(start, (double)j, step) >= border) != rising)
        j++;
    return j;
}

/* Cuts [*lo, *hi) to the samples that lie in [low, high). */
KERNEL void ray_clip(double start, double step, int32_t low, int32_t high, int64_t *lo, int64_t *hi)
{
    if (step == 0) {
        if (!(start >= low && start < high))
            *hi = *lo;
        return;
    }
    int64_t enter = ray_crossing(start, step, step > 0 ? low : high, *lo, *hi);
    *hi = ray_crossing(start, step, step > 0 ? high : low, enter, *hi);
    *lo = enter;
}

/* The first sample from `lo` on that lies in the volume, given that sample `hi` does. */
KERNEL int64_t ray_enter(const double start[3], const double step[3], const int32_t whole_vox[3], int64_t lo,
                         int64_t hi)
{
    for (int a = 0; a < 3; a++)
        if (step[a] != 0)
            lo = ray_crossing(start[a], step[a], step[a] > 0 ? 0 : whole_vox[a], lo, hi);
    return lo;
}

/* A ray without samples, whose places lie in the first of the voxels at hand. */
KERNEL kernel_ray ray_none(const kernel_part *part)
{
    kernel_ray ray = {{0.5, 0.5, 0.5}, {0, 0, 0}, 0, 0, 0};
    for (int a = 0; a < 3; a++)
        ray.start[a] = part->origin_vox[a] + 0.5;
    return ray;
}

/* The ray of pixel (x, y) of the part of the picture that is drawn. */
KERNEL kernel_ray ray_make(const kernel_frame *f, int32_t x, int32_t y)
{
    const reference_camera *c = &f->camera;
    const kernel_part *part = &f->part;
    kernel_ray ray = ray_none(part);
    x += c->first_px[0];
    y += c->first_px[1];
    int64_t lo = 0, hi = c->most;
    double o[3], d[3], square = 0;
    for (int a = 0; a < 3; a++) {
        o[a] = ray_along(ray_along(c->origin[0][a], x, c->origin[1][a]), y, c->origin[2][a]);
        d[a] = ray_along(ray_along(c->direction[0][a], x, c->direction[1][a]), y, c->direction[2][a]);
        double length = d[a] * c->spacing_vox[a];
        square = ray_along(square, length, length);
    }
    if (c->by_length) {
        double length = sqrt(square), near = ceil((length - c->first) / c->spacing);
        lo = near > 0 ? (int64_t)fmin(near, (double)hi) : 0;
        for (int a = 0; a < 3; a++)
            d[a] = d[a] / length;
    }
    for (int a = 0; a < 3; a++) {
        o[a] = ray_along(o[a], c->first, d[a]);
        d[a] = c->spacing * d[a];
    }
    int64_t enter = lo;
    for (int a = 0; a < 3 && lo < hi; a++)
        ray_clip(o[a], d[a], part->lo_vox[a], part->hi_vox[a], &lo, &hi);
    if (lo >= hi)
        return ray;
    enter = part->boxed ? ray_enter(o, d, part->whole_vox, enter, lo) : lo;
    ray.count = (int32_t)(hi - lo);
    ray.skipped = (int32_t)(lo - enter);
    ray.first = (int32_t)lo;
    for (int a = 0; a < 3; a++) {
        ray.start[a] = ray_along(o[a], (double)enter, d[a]);
        ray.step[a] = d[a];
    }
    return ray;
}

#endif
