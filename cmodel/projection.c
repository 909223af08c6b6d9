/* projection.c - conservative bounds in floating point: rounding can only make them wider than the exact ones. */
#include "projection.h"

#include <float.h>
#include <math.h>

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double norm1(const double a[3])
{
    return fabs(a[0]) + fabs(a[1]) + fabs(a[2]);
}

projection projection_of(const vodr_view *view)
{
    projection p = {.view = view};
    double unit = ldexp(1.0, -VODR_POSITION_BITS), u[3], v[3], s[3];
    for (int c = 0; c < 3; c++) {
        u[c] = ldexp((double)view->step_u[c], -view->shift) * unit;
        v[c] = ldexp((double)view->step_v[c], -view->shift) * unit;
        s[c] = ldexp((double)view->step_s[c], -view->shift) * unit;
        p.base[c] = (double)view->base[c] * unit;
    }
    cross(v, s, p.to_x);
    cross(s, u, p.to_y);
    cross(u, v, p.to_depth);
    double det = dot(u, p.to_x);
    p.usable = fabs(det) > 1e-6 * norm1(u) * norm1(v) * norm1(s) && fabs(det) > DBL_MIN;
    if (!p.usable)
        return p;
    for (int c = 0; c < 3; c++) {
        p.to_x[c] /= det;
        p.to_y[c] /= det;
        p.to_depth[c] /= det;
    }
    p.margin_k = 1 + norm1(p.to_depth) * 4 * unit;
    p.margin_eye = 0.5 + 0.01 * norm1(p.to_depth);
    p.margin_px = 1 + (norm1(p.to_x) + norm1(p.to_y)) * 4 * unit / (view->perspective ? p.margin_eye : 1);
    return p;
}

/* Slices of a perspective view whose depth can lie in [near, far]. */
static void depth_to_slices(const vodr_view *v, double near, double far, double *k0, double *k1)
{
    double first = ldexp((double)v->depth_first, -VODR_DEPTH_BITS),
           step = ldexp((double)v->depth_step, -VODR_DEPTH_BITS);
    *k0 = 0;
    *k1 = v->slices;
    if (step < 0) {
        *k0 = (first - far - 1) / -step;
        *k1 = (first - near + 1) / -step;
    }
}

static int32_t clamp_floor(double value, int32_t lo, int32_t hi)
{
    return value <= lo ? lo : value >= hi ? hi : (int32_t)floor(value);
}

bool projection_bound(const projection *p, const vox_box *box, const px_rect *clip, px_rect *bound, int32_t *k0,
                      int32_t *k1)
{
    const vodr_view *view = p->view;
    *bound = *clip;
    *k0 = 0;
    *k1 = view->slices;
    if (!p->usable)
        return true;
    double lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3] = {-INFINITY, -INFINITY, -INFINITY};
    bool reaches_eye = false;
    for (int corner = 0; corner < 8; corner++) {
        double q[3];
        for (int c = 0; c < 3; c++)
            q[c] = (corner >> c & 1 ? box->hi[c] : box->lo[c]) - p->base[c];
        double at[3] = {dot(p->to_x, q), dot(p->to_y, q), dot(p->to_depth, q)};
        if (view->perspective) {
            reaches_eye |= at[2] < p->margin_eye;
            at[0] /= at[2];
            at[1] /= at[2];
        }
        for (int i = 0; i < 3; i++) {
            lo[i] = fmin(lo[i], at[i]);
            hi[i] = fmax(hi[i], at[i]);
        }
    }
    double from = lo[2], to = hi[2];
    if (view->perspective)
        depth_to_slices(view, lo[2] - 1, hi[2] + 1, &from, &to);
    *k0 = clamp_floor(from - p->margin_k, 0, view->slices);
    *k1 = clamp_floor(to + p->margin_k + 1, 0, view->slices);
    if (!reaches_eye) {
        double m = p->margin_px;
        bound->x0 = clamp_floor(lo[0] - m, clip->x0, clip->x1);
        bound->x1 = clamp_floor(hi[0] + m + 1, clip->x0, clip->x1);
        bound->y0 = clamp_floor(lo[1] - m, clip->y0, clip->y1);
        bound->y1 = clamp_floor(hi[1] + m + 1, clip->y0, clip->y1);
    }
    return bound->x0 < bound->x1 && bound->y0 < bound->y1 && *k0 < *k1;
}
