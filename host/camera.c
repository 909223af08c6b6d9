/* camera.c - a turntable camera, rounded once into the machine's registers.
 *
 * World coordinates have their origin at the volume's centre, axes as in volume.h, and the finest voxel as unit. */
#include "camera.h"

#include <inttypes.h>
#include <math.h>

enum { DEFAULT_MAX_PX = 512 };

static const double radians_per_degree = 0.017453292519943295;

camera camera_default(void)
{
    return (camera){.fov_deg = 40, .zoom = 1};
}

/* The eye's frame of reference: unit vectors to the right, up, and from the volume towards the eye. */
typedef struct basis {
    double right[3], up[3], eye[3];
} basis;

/* A volume in the world. */
typedef struct placement {
    const volume *v;
    double scale[3];  /* file axis: finest voxels a voxel is long */
    double extent[3]; /* world axis: finest voxels */
} placement;

/* Exact at multiples of 90 degrees, where a rounded pi would not be. */
static void sine_cosine(double degrees, double *sine, double *cosine)
{
    int quadrant;
    double angle = remquo(degrees, 90, &quadrant) * radians_per_degree, s = sin(angle), c = cos(angle);
    const double quarter[4][2] = {{s, c}, {c, -s}, {-s, -c}, {-c, s}};
    *sine = quarter[quadrant & 3][0];
    *cosine = quarter[quadrant & 3][1];
}

static basis camera_basis(const camera *c)
{
    double sa, ca, se, ce, sr, cr;
    sine_cosine(c->azimuth_deg, &sa, &ca);
    sine_cosine(c->elevation_deg, &se, &ce);
    sine_cosine(c->roll_deg, &sr, &cr);
    const double right[3] = {ca, 0, -sa}, up[3] = {-sa * se, ce, -ca * se};
    basis b = {.eye = {sa * ce, se, ca * ce}};
    for (int i = 0; i < 3; i++) {
        b.right[i] = cr * right[i] - sr * up[i];
        b.up[i] = sr * right[i] + cr * up[i];
    }
    return b;
}

static placement place(const volume *v)
{
    placement p = {.v = v};
    double finest = fmin(v->spacing[0], fmin(v->spacing[1], v->spacing[2]));
    for (int c = 0; c < 3; c++)
        p.scale[c] = v->spacing[c] / finest;
    for (int w = 0; w < 3; w++)
        p.extent[w] = v->dims_vox[v->axis[w]] * p.scale[v->axis[w]];
    return p;
}

/* A world vector in voxels of the file's axes. */
static void to_voxels(const placement *p, const double world[3], double voxels[3])
{
    for (int w = 0; w < 3; w++) {
        int axis = p->v->axis[w];
        voxels[axis] = p->v->sign[w] * world[w] / p->scale[axis];
    }
}

/* The world vector right*x + up*y + eye*z in voxels. */
static void combine(const placement *p, const basis *b, double x, double y, double z, double voxels[3])
{
    double world[3];
    for (int i = 0; i < 3; i++)
        world[i] = x * b->right[i] + y * b->up[i] + z * b->eye[i];
    to_voxels(p, world, voxels);
}

/* Rounds to nearest at `bits` fraction bits; false when the result is beyond what any register holds. */
static bool to_fixed(double value, int bits, int64_t *fixed)
{
    double scaled = ldexp(value, bits);
    if (!(fabs(scaled) < 4e18))
        return false;
    *fixed = llround(scaled);
    return true;
}

static bool to_fixed3(const double value[3], int bits, int64_t fixed[3])
{
    return to_fixed(value[0], bits, &fixed[0]) && to_fixed(value[1], bits, &fixed[1]) &&
           to_fixed(value[2], bits, &fixed[2]);
}

/* Depth of the volume's box along the view, finest voxels. */
static double view_depth(const placement *p, const basis *b)
{
    return fabs(b->eye[0]) * p->extent[0] + fabs(b->eye[1]) * p->extent[1] + fabs(b->eye[2]) * p->extent[2];
}

static bool parallel_view(const camera *c, const placement *p, const basis *b, vodr_view *view, double *spacing)
{
    double step = 1 / c->zoom, depth = view_depth(p, b), u[3], v[3], s[3], base[3];
    *spacing = depth / view->slices;
    combine(p, b, step, 0, 0, u);
    combine(p, b, 0, -step, 0, v);
    combine(p, b, 0, 0, *spacing, s);
    combine(p, b, (0.5 - view->width_px * 0.5) * step, (view->height_px * 0.5 - 0.5) * step,
            (0.5 - view->slices * 0.5) * *spacing, base);
    for (int i = 0; i < 3; i++)
        base[i] += p->v->dims_vox[i] * 0.5;
    return to_fixed3(base, VODR_POSITION_BITS, view->base) && to_fixed3(u, VODR_POSITION_BITS, view->step_u) &&
           to_fixed3(v, VODR_POSITION_BITS, view->step_v) && to_fixed3(s, VODR_POSITION_BITS, view->step_s);
}

/* Bits that an integer as large as value needs; at least 0. */
static int integer_bits(double value)
{
    int exponent;
    frexp(value, &exponent);
    return exponent > 0 ? exponent : 0;
}

static bool perspective_view(const camera *c, const placement *p, const basis *b, vodr_view *view, double *spacing)
{
    double sine, cosine, reach = 0, eye[3], corner[4][3], u[3], v[3];
    sine_cosine(c->fov_deg * 0.5, &sine, &cosine);
    double focal_px = view->height_px * 0.5 * cosine / sine, distance = focal_px / c->zoom;
    double half = view_depth(p, b) * 0.5, near = fmax(distance - half, 1), far = fmax(distance + half, near);
    *spacing = (far - near) / view->slices;
    combine(p, b, 0, 0, distance, eye);
    combine(p, b, 1 / focal_px, 0, 0, u);
    combine(p, b, 0, -1 / focal_px, 0, v);
    for (int i = 0; i < 4; i++)
        combine(p, b, ((i & 1 ? view->width_px - 1 : 0) + 0.5 - view->width_px * 0.5) / focal_px,
                (view->height_px * 0.5 - 0.5 - (i & 2 ? view->height_px - 1 : 0)) / focal_px, -1, corner[i]);
    for (int a = 0; a < 3; a++) {
        eye[a] += p->v->dims_vox[a] * 0.5;
        reach = fmax(reach, fmax(fabs(eye[a]), fabs(p->v->dims_vox[a] - eye[a])));
        reach = fmax(reach, fmax(fabs(u[a]), fabs(v[a])) * far); /* more than the corners' on a frame of one pixel */
        for (int i = 0; i < 4; i++)
            reach = fmax(reach, fabs(corner[i][a]) * far);
    }
    /* A product of depth and direction gets as many fraction bits as 62 bits have room for. */
    int depth_bits = 24 - integer_bits(far), shift = 36 - integer_bits(reach);
    if (depth_bits < 0 || shift < 0)
        return false;
    depth_bits = depth_bits > 20 ? 20 : depth_bits;
    view->shift = shift > 30 ? 30 : shift;
    int step_bits = VODR_POSITION_BITS + view->shift - depth_bits;
    return to_fixed3(eye, VODR_POSITION_BITS, view->base) && to_fixed3(u, step_bits, view->step_u) &&
           to_fixed3(v, step_bits, view->step_v) && to_fixed3(corner[0], step_bits, view->step_s) &&
           to_fixed(far - *spacing * 0.5, depth_bits + VODR_DEPTH_BITS, &view->depth_first) &&
           to_fixed(-*spacing, depth_bits + VODR_DEPTH_BITS, &view->depth_step);
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/* Pixels that a step of one voxel along every axis covers on a screen axis, at most: the sum of the magnitudes of
 * (numerator - at*depth) / z, the derivative of pixel `at` by position. */
static double covered(const double numerator[3], const double depth[3], double at, double det, double z)
{
    double sum = 0;
    for (int i = 0; i < 3; i++)
        sum += fabs(numerator[i] - at * depth[i]);
    return sum / (fabs(det) * z);
}

/* The footprint register: the paper's Figure 3 asks how large a brick's projection gets. In perspective that is at the
 * nearest slice, at the frame's edge. Rounded up, but for the noise of these very lines. */
static uint32_t footprint(const vodr_view *view)
{
    double u[3], v[3], s[3], to_x[3], to_y[3], to_depth[3], largest = 0;
    for (int i = 0; i < 3; i++) {
        u[i] = ldexp((double)view->step_u[i], -VODR_POSITION_BITS - view->shift);
        v[i] = ldexp((double)view->step_v[i], -VODR_POSITION_BITS - view->shift);
        s[i] = ldexp((double)view->step_s[i], -VODR_POSITION_BITS - view->shift);
    }
    cross(v, s, to_x);
    cross(s, u, to_y);
    cross(u, v, to_depth);
    double det = u[0] * to_x[0] + u[1] * to_x[1] + u[2] * to_x[2], z = 1;
    if (view->perspective)
        z = (double)((view->depth_first + (view->slices - 1) * view->depth_step) >> VODR_DEPTH_BITS);
    for (int edge = 0; edge < (view->perspective ? 2 : 1); edge++) {
        double x = edge ? view->width_px - 1 : 0, y = edge ? view->height_px - 1 : 0;
        largest = fmax(largest, fmax(covered(to_x, to_depth, x, det, z), covered(to_y, to_depth, y, det, z)));
    }
    double scaled = ceil(ldexp(largest, VODR_FOOTPRINT_BITS) - 0x1p-10);
    return scaled >= 1 && scaled < UINT32_MAX ? (uint32_t)scaled : scaled < 1 ? 1 : UINT32_MAX;
}

/* A size the user gave, or the volume's own extent. */
static int32_t size_or_extent(int32_t given, double extent)
{
    double rounded = floor(extent + 0.5);
    if (given)
        return given;
    return rounded < 1 ? 1 : rounded > DEFAULT_MAX_PX ? DEFAULT_MAX_PX : (int32_t)rounded;
}

static host_status check_camera(const camera *c, host_error *error)
{
    if (!(fabs(c->azimuth_deg) <= 36000) || !(fabs(c->roll_deg) <= 36000))
        return host_fail(error, HOST_BAD_INPUT, "azimuth %g and roll %g must be -36000 to 36000 degrees",
                         c->azimuth_deg, c->roll_deg);
    if (!(fabs(c->elevation_deg) <= 90))
        return host_fail(error, HOST_BAD_INPUT, "elevation %g must be -90 to 90 degrees", c->elevation_deg);
    if (c->perspective && !(c->fov_deg >= 1 && c->fov_deg <= 150))
        return host_fail(error, HOST_BAD_INPUT, "field of view %g must be 1 to 150 degrees", c->fov_deg);
    if (!(c->zoom > 0 && isfinite(c->zoom)))
        return host_fail(error, HOST_BAD_INPUT, "zoom %g must be positive", c->zoom);
    return HOST_OK;
}

host_status camera_view(const camera *c, const volume *v, vodr_view *view, double *depth_vox, host_error *error)
{
    host_status status = check_camera(c, error);
    if (status != HOST_OK)
        return status;
    placement p = place(v);
    basis b = camera_basis(c);
    *view = (vodr_view){.width_px = size_or_extent(c->width_px, p.extent[0]),
                        .height_px = size_or_extent(c->height_px, p.extent[1]),
                        .slices = size_or_extent(c->slices, p.extent[2]),
                        .perspective = c->perspective};
    bool fits =
        c->perspective ? perspective_view(c, &p, &b, view, depth_vox) : parallel_view(c, &p, &b, view, depth_vox);
    if (!fits)
        return host_fail(error, HOST_BAD_INPUT,
                         "the view's positions do not fit Q19.24 (262144 voxels either side) at zoom %g and %" PRId32
                         "x%" PRId32 " pixels",
                         c->zoom, view->width_px, view->height_px);
    view->footprint = footprint(view);
    vodr_error reason;
    if (vodr_view_check(view, v->dims_vox, &reason) != VODR_OK)
        return host_fail(error, HOST_BAD_INPUT, "at zoom %g and %" PRId32 "x%" PRId32 " pixels %s", c->zoom,
                         view->width_px, view->height_px, reason.text);
    return HOST_OK;
}
