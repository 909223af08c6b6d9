/* aligned.c - directions in the picture along which voxels are neighbours. */
#include "aligned.h"

#include <math.h>
#include <string.h>

#include "kernel_order.h"

/* Of a pixel's length: what is less across the middle of a picture is no direction at all. */
static const double no_length = 1e-9;

/* ---- the view ---- */

/* What the ray in the middle, and a pixel to the right and one below it, move by, in voxels, where it is nearest to the
 * volume's middle. */
static void middle_of(const reference_camera *c, const int32_t dims_vox[3], double ray[3], double right[3],
                      double down[3])
{
    const double x = c->first_px[0] + c->width_px / 2.0, y = c->first_px[1] + c->height_px / 2.0;
    double along = 0, square = 0;
    for (int a = 0; a < 3; a++) {
        const double o = c->origin[0][a] + x * c->origin[1][a] + y * c->origin[2][a];
        ray[a] = c->direction[0][a] + x * c->direction[1][a] + y * c->direction[2][a];
        along += (dims_vox[a] / 2.0 - o) * ray[a];
        square += ray[a] * ray[a];
    }
    const double depth = square > 0 ? along / square : 0;
    for (int a = 0; a < 3; a++) {
        right[a] = c->origin[1][a] + depth * c->direction[1][a];
        down[a] = c->origin[2][a] + depth * c->direction[2][a];
    }
}

/* The angle of a direction, the same to both sides; 0 where there is none. */
static double angle_of(double x, double y)
{
    if (fabs(x) < no_length && fabs(y) < no_length)
        return 0;
    if (fabs(x) < no_length * fabs(y)) /* one of the two right angles, whatever rounding says */
        return acos(0);
    return atan(y / x);
}

/* Along x*right + y*down = fast axis + delta*ray: where the ray meets the dominant axis's face, the other two of its
 * components vanish, so the third axis alone is to be solved for. Equations 11 to 15. */
static double theta_box(const double ray[3], const double right[3], const double down[3], int third, int dominant)
{
    const double slant = ray[third] / ray[dominant];
    return angle_of(down[third] - down[dominant] * slant, -(right[third] - right[dominant] * slant));
}

/* Without regard to where rays meet the volume. Equations 8 to 10. */
static double theta_plane(const double right[3], const double down[3], int third, int dominant)
{
    if (fabs(right[third]) < no_length && fabs(down[third]) < no_length)
        return angle_of(down[dominant], -right[dominant]);
    return angle_of(down[third], -right[third]);
}

aligned_view aligned_view_of(const reference_camera *c, const int32_t dims_vox[3], reference_theta theta)
{
    double ray[3], right[3], down[3];
    aligned_view v = {.dominant_axis = 2};
    middle_of(c, dims_vox, ray, right, down);
    for (int a = 1; a >= 0; a--)
        if (fabs(ray[a]) > fabs(ray[v.dominant_axis]) * (1 + no_length))
            v.dominant_axis = a;
    v.fast_axis = (v.dominant_axis + 1) % 3;
    const int third = (v.dominant_axis + 2) % 3;
    if (fabs(ray[v.dominant_axis]) > 0)
        v.theta = theta == REFERENCE_THETA_BOX ? theta_box(ray, right, down, third, v.dominant_axis)
                                               : theta_plane(right, down, third, v.dominant_axis);
    return v;
}

/* ---- lines of pixels ---- */

kernel_order aligned_order_usual(const reference_camera *c)
{
    return (kernel_order){.columns = c->width_px, .rows = c->height_px, .tile_log2 = 2};
}

kernel_order aligned_order_of(const reference_camera *c, double theta)
{
    const bool steep = fabs(sin(theta)) > fabs(cos(theta));
    const double slope = steep ? cos(theta) / sin(theta) : sin(theta) / cos(theta);
    kernel_order o = {.steep = steep, .slope = (int32_t)lround(slope * ORDER_ONE), .tile_log2 = 2};
    o.columns = steep ? c->height_px : c->width_px;
    o.rows = steep ? c->width_px : c->height_px;
    const int32_t last = order_shift(&o, o.columns - 1);
    o.first = last > 0 ? -last : 0;
    o.rows += last > 0 ? last : -last;
    return o;
}

/* ---- a turned picture ---- */

static double middle_px(int32_t first, int32_t size)
{
    return first + (size - 1) / 2.0;
}

/* A side that holds `across` pixels, and one at each end to interpolate with; its middle lies on a pixel where that of
 * `like` does, so that by a right angle pixels fall on pixels. */
static int32_t side_px(double across, int32_t like)
{
    const int32_t least = (int32_t)ceil(across - 1e-6) + 3;
    return least + (least - like) % 2;
}

reference_camera aligned_turn(const reference_camera *c, double theta)
{
    const double cosine = cos(theta), sine = sin(theta);
    const double across = c->width_px - 1, down = c->height_px - 1;
    const bool steep = fabs(sine) > fabs(cosine);
    reference_camera t = *c;
    t.width_px = side_px(fabs(cosine) * across + fabs(sine) * down, steep ? c->height_px : c->width_px);
    t.height_px = side_px(fabs(sine) * across + fabs(cosine) * down, steep ? c->width_px : c->height_px);
    t.first_px[0] = t.first_px[1] = 0;
    const double x = middle_px(c->first_px[0], c->width_px), y = middle_px(c->first_px[1], c->height_px);
    for (int a = 0; a < 3; a++)
        for (int i = 0; i < 2; i++) {
            const double(*from)[3] = i ? c->direction : c->origin;
            double(*to)[3] = i ? t.direction : t.origin;
            to[1][a] = cosine * from[1][a] + sine * from[2][a];
            to[2][a] = cosine * from[2][a] - sine * from[1][a];
            to[0][a] = from[0][a] + x * from[1][a] + y * from[2][a] - middle_px(0, t.width_px) * to[1][a] -
                       middle_px(0, t.height_px) * to[2][a];
        }
    return t;
}

void aligned_turn_back(const reference_camera *c, const reference_camera *turned, double theta, const double *from,
                       double *rgba)
{
    const double cosine = cos(theta), sine = sin(theta);
    const size_t row = 4 * (size_t)turned->width_px;
    for (int32_t y = 0; y < c->height_px; y++)
        for (int32_t x = 0; x < c->width_px; x++, rgba += 4) {
            const double right = x - middle_px(0, c->width_px), down = y - middle_px(0, c->height_px);
            const double u = middle_px(0, turned->width_px) + cosine * right + sine * down;
            const double v = middle_px(0, turned->height_px) + cosine * down - sine * right;
            const double i = floor(u), j = floor(v);
            const double *at = from + (size_t)j * row + 4 * (size_t)i;
            for (int n = 0; n < 4; n++) {
                const double above = at[n] + (at[n + 4] - at[n]) * (u - i);
                const double below = at[row + (size_t)n] + (at[row + 4 + (size_t)n] - at[row + (size_t)n]) * (u - i);
                rgba[n] = above + (below - above) * (v - j);
            }
        }
}
