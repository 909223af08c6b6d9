/* screen.c - from the volume to the screen: the view's registers turned round.
 *
 * A sample is at base + k*s + x*u + y*v, in perspective at base + z*(s + x*u + y*v). The cross products of u, v and s
 * are the rows of the inverse of the matrix (u v s), times its determinant. */
#include "screen.h"

#include <math.h>

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Makes row . (p, 1) = scale * direction . (p - base). */
static void set_row(double row[4], const double direction[3], const double base[3], double scale)
{
    for (int i = 0; i < 3; i++)
        row[i] = direction[i] * scale;
    row[3] = -dot(row, base);
}

screen_map screen_map_of(const vodr_view *view)
{
    screen_map m = {.near = 0.5};
    double u[3], v[3], s[3], base[3], to_x[3], to_y[3], to_depth[3];
    for (int i = 0; i < 3; i++) {
        u[i] = ldexp((double)view->step_u[i], -VODR_POSITION_BITS - view->shift);
        v[i] = ldexp((double)view->step_v[i], -VODR_POSITION_BITS - view->shift);
        s[i] = ldexp((double)view->step_s[i], -VODR_POSITION_BITS - view->shift);
        base[i] = ldexp((double)view->base[i], -VODR_POSITION_BITS);
    }
    cross(v, s, to_x);
    cross(s, u, to_y);
    cross(u, v, to_depth);
    double scale = 1 / dot(u, to_x);
    if (!isfinite(scale))
        return m;
    set_row(m.row[0], to_x, base, scale);
    set_row(m.row[1], to_y, base, scale);
    if (view->perspective) {
        set_row(m.row[2], to_depth, base, scale);
        m.near = (double)((view->depth_first + (view->slices - 1) * view->depth_step) >> VODR_DEPTH_BITS);
    } else {
        m.row[2][3] = 1;
    }
    for (int i = 0; i < 4; i++) {
        m.row[0][i] += 0.5 * m.row[2][i];
        m.row[1][i] += 0.5 * m.row[2][i];
    }
    return m;
}
