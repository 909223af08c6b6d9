/* camera.c - the rays of a frame from the machine's registers (docs/architecture.md, section 2). */
#include <math.h>

#include "reference.h"

enum { MOST_SAMPLES = 1 << 24 }; /* on a ray, within the volume or not: the volume ends it */

/* Registers of `bits` fraction bits, in voxels. */
static void in_voxels(const int64_t fixed[3], int32_t bits, double voxels[3])
{
    for (int a = 0; a < 3; a++)
        voxels[a] = ldexp((double)fixed[a], -bits);
}

static reference_camera camera_of(const vodr_view *v)
{
    reference_camera c = {.width_px = v->width_px, .height_px = v->height_px, .spacing_vox = {1, 1, 1}};
    in_voxels(v->base, VODR_POSITION_BITS, c.origin[0]);
    if (v->perspective) {
        in_voxels(v->step_s, VODR_POSITION_BITS + v->shift, c.direction[0]);
        in_voxels(v->step_u, VODR_POSITION_BITS + v->shift, c.direction[1]);
        in_voxels(v->step_v, VODR_POSITION_BITS + v->shift, c.direction[2]);
    } else {
        in_voxels(v->step_s, VODR_POSITION_BITS, c.direction[0]);
        in_voxels(v->step_u, VODR_POSITION_BITS, c.origin[1]);
        in_voxels(v->step_v, VODR_POSITION_BITS, c.origin[2]);
    }
    return c;
}

reference_camera reference_camera_slices(const vodr_view *v)
{
    reference_camera c = camera_of(v);
    c.most = v->slices;
    c.first = v->slices - 1;
    c.spacing = -1;
    if (v->perspective) {
        c.first = ldexp((double)(v->depth_first + (v->slices - 1) * v->depth_step), -VODR_DEPTH_BITS);
        c.spacing = ldexp((double)-v->depth_step, -VODR_DEPTH_BITS);
    }
    return c;
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Finest voxels that the pixel directions' shared part reaches at right angles to the image. */
static double unit_of_depth(const reference_camera *c)
{
    double metric[3][3], normal[3];
    for (int i = 0; i < 3; i++)
        for (int a = 0; a < 3; a++)
            metric[i][a] = c->direction[i][a] * c->spacing_vox[a];
    cross(metric[1], metric[2], normal);
    return fabs(dot(metric[0], normal)) / sqrt(dot(normal, normal));
}

reference_camera reference_camera_rays(const vodr_view *v, const double spacing_vox[3], double step_vox)
{
    reference_camera c = camera_of(v);
    double square = 0;
    for (int a = 0; a < 3; a++) {
        c.spacing_vox[a] = spacing_vox[a];
        square += c.direction[0][a] * spacing_vox[a] * c.direction[0][a] * spacing_vox[a];
    }
    c.by_length = v->perspective;
    c.spacing = step_vox;
    c.first = step_vox / 2;
    c.most = MOST_SAMPLES;
    double unit = v->perspective ? unit_of_depth(&c) : sqrt(square);
    for (int a = 0; a < 3; a++) {
        if (!v->perspective) /* the nearest slice lies in the middle of its share of the depth */
            c.origin[0][a] += (v->slices - 0.5) * c.direction[0][a];
        for (int i = 0; i < 3; i++)
            c.direction[i][a] /= v->perspective ? unit : -unit;
    }
    return c;
}
