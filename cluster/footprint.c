/* footprint.c - where in the picture a box of voxels may show: its corners, projected. */
#include "footprint.h"

#include <math.h>

static double triple(const double a[3], const double b[3], const double c[3])
{
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/* Solves p = x*u + y*v + t*w. */
static bool solve(const double u[3], const double v[3], const double w[3], const double p[3], double xyt[3])
{
    const double all = triple(u, v, w);
    if (all == 0)
        return false;
    xyt[0] = triple(p, v, w) / all;
    xyt[1] = triple(u, p, w) / all;
    xyt[2] = triple(u, v, p) / all;
    return true;
}

/* The pixel whose ray goes through a point; false where none does, or the point lies beside or behind the eye. */
static bool project(const reference_camera *c, const double point[3], double xy[2])
{
    double from_origin[3], xyt[3];
    bool parallel = true;
    for (int a = 0; a < 3; a++) {
        from_origin[a] = point[a] - c->origin[0][a];
        parallel &= c->direction[1][a] == 0 && c->direction[2][a] == 0;
    }
    if (parallel) {
        if (!solve(c->origin[1], c->origin[2], c->direction[0], from_origin, xyt))
            return false;
        xy[0] = xyt[0];
        xy[1] = xyt[1];
        return true;
    }
    if (!solve(c->direction[1], c->direction[2], c->direction[0], from_origin, xyt) || !(xyt[2] > 1e-6))
        return false;
    xy[0] = xyt[0] / xyt[2];
    xy[1] = xyt[1] / xyt[2];
    return true;
}

static int32_t within(double value, int32_t most)
{
    return value < 0 ? 0 : value > most ? most : (int32_t)value;
}

rectangle footprint_of(const reference_camera *c, const int32_t lo_vox[3], const int32_t hi_vox[3])
{
    double least[2] = {INFINITY, INFINITY}, most[2] = {-INFINITY, -INFINITY};
    for (int n = 0; n < 8; n++) {
        double point[3], xy[2];
        for (int a = 0; a < 3; a++)
            point[a] = n >> a & 1 ? hi_vox[a] : lo_vox[a];
        if (!project(c, point, xy)) /* the box reaches behind the eye */
            return (rectangle){0, 0, c->width_px, c->height_px};
        for (int i = 0; i < 2; i++) {
            least[i] = fmin(least[i], xy[i]);
            most[i] = fmax(most[i], xy[i]);
        }
    }
    return (rectangle){within(floor(least[0] - 0.01), c->width_px), within(floor(least[1] - 0.01), c->height_px),
                       within(floor(most[0]) + 2, c->width_px), within(floor(most[1]) + 2, c->height_px)};
}

double footprint_samples(const reference_camera *c, const double point[3])
{
    double xy[2], direction[3], square = 0;
    if (!project(c, point, xy) || xy[0] < 0 || xy[1] < 0 || xy[0] >= c->width_px || xy[1] >= c->height_px)
        return 0;
    double depth = 0, length = 0;
    for (int a = 0; a < 3; a++) {
        direction[a] = c->direction[0][a] + xy[0] * c->direction[1][a] + xy[1] * c->direction[2][a];
        const double along = point[a] - c->origin[0][a];
        square += direction[a] * c->spacing_vox[a] * direction[a] * c->spacing_vox[a];
        depth += along * along;
        length += direction[a] * direction[a];
    }
    double voxels = fabs(triple(c->origin[1], c->origin[2], direction) * c->spacing);
    if (voxels == 0) /* perspective: pixels are apart in their directions */
        voxels = fabs(triple(c->direction[1], c->direction[2], c->direction[0]) * c->spacing) * depth / length;
    if (c->by_length)
        voxels /= sqrt(square);
    return voxels > 0 ? 1 / voxels : 0;
}
