/* test_camera.c - from angles, zoom and size to registers (docs/architecture.md, section 11). */
#include "camera.h"

#include <math.h>
#include <string.h>

#include "lib/unit.h"

static const int64_t one = 1 << 24;

static vodr_view view_of(const camera *c, const volume *v, double *depth)
{
    vodr_view view;
    host_error error;
    if (camera_view(c, v, &view, depth, &error) != HOST_OK)
        fail_msg("%s", error.text);
    return view;
}

static void assert_registers(const int64_t got[3], int64_t x, int64_t y, int64_t z)
{
    if (got[0] != x || got[1] != y || got[2] != z)
        fail_msg("%lld %lld %lld instead of %lld %lld %lld", (long long)got[0], (long long)got[1], (long long)got[2],
                 (long long)x, (long long)y, (long long)z);
}

/* View 0,0 of 256^3: pixel (x, y) of slice k is the centre of voxel (x, 255-y, k). */
static void every_voxel_centre_once(void **state)
{
    (void)state;
    volume v = unit_volume(256, 256, 256);
    camera c = camera_default();
    double depth;
    vodr_view view = view_of(&c, &v, &depth);
    assert_int_equal(view.width_px, 256);
    assert_int_equal(view.height_px, 256);
    assert_int_equal(view.slices, 256);
    assert_false(view.perspective);
    assert_int_equal(view.shift, 0);
    assert_registers(view.base, one / 2, 255 * one + one / 2, one / 2);
    assert_registers(view.step_u, one, 0, 0);
    assert_registers(view.step_v, 0, -one, 0);
    assert_registers(view.step_s, 0, 0, one);
    assert_int_equal(view.footprint, 1 << 20);
    assert_true(depth == 1);
}

/* Right angles are exact whole numbers, in every quadrant and out of range ones too. */
static void right_angles(void **state)
{
    (void)state;
    static const int sine[4] = {0, 1, 0, -1}, cosine[4] = {1, 0, -1, 0};
    volume v = unit_volume(16, 16, 16);
    for (int a = -8; a < 8; a++)
        for (int e = -1; e <= 1; e++)
            for (int r = -4; r < 4; r++) {
                camera c = camera_default();
                c.azimuth_deg = 90 * a;
                c.elevation_deg = 90 * e;
                c.roll_deg = 90 * r;
                double depth;
                vodr_view view = view_of(&c, &v, &depth);
                int sa = sine[a & 3], ca = cosine[a & 3], se = sine[e & 3], ce = cosine[e & 3];
                int sr = sine[r & 3], cr = cosine[r & 3];
                const int eye[3] = {sa * ce, se, ca * ce}, right0[3] = {ca, 0, -sa}, up0[3] = {-sa * se, ce, -ca * se};
                int64_t u[3], w[3], s[3], base[3];
                for (int i = 0; i < 3; i++) {
                    u[i] = (cr * right0[i] - sr * up0[i]) * one;
                    w[i] = -(sr * right0[i] + cr * up0[i]) * one;
                    s[i] = eye[i] * one;
                    base[i] = 8 * one - 15 * (u[i] + w[i] + s[i]) / 2;
                }
                assert_registers(view.step_u, u[0], u[1], u[2]);
                assert_registers(view.step_v, w[0], w[1], w[2]);
                assert_registers(view.step_s, s[0], s[1], s[2]);
                assert_registers(view.base, base[0], base[1], base[2]);
                assert_int_equal(view.footprint, 1 << 20);
            }
}

/* From the right one sees +y up and -z to the right; from above, what was up is behind; a camera rolled clockwise by 90
 * degrees has its up where right was. */
static void conventions(void **state)
{
    (void)state;
    volume v = unit_volume(8, 8, 8);
    camera c = camera_default();
    double depth;
    c.azimuth_deg = 90;
    vodr_view view = view_of(&c, &v, &depth);
    assert_registers(view.step_s, one, 0, 0);
    assert_registers(view.step_u, 0, 0, -one);
    assert_registers(view.step_v, 0, -one, 0);
    c = camera_default();
    c.elevation_deg = 90;
    view = view_of(&c, &v, &depth);
    assert_registers(view.step_s, 0, one, 0);
    assert_registers(view.step_u, one, 0, 0);
    assert_registers(view.step_v, 0, 0, one);
    c = camera_default();
    c.roll_deg = 90;
    view = view_of(&c, &v, &depth);
    assert_registers(view.step_v, -one, 0, 0); /* down is left */
    assert_registers(view.step_u, 0, -one, 0);
    c = camera_default();
    c.azimuth_deg = 30;
    c.elevation_deg = 30;
    view = view_of(&c, &v, &depth);
    assert_true(view.step_s[0] > 0 && view.step_s[1] > 0 && view.step_s[2] > view.step_s[0]);
    assert_true(view.step_u[1] == 0 && view.step_v[1] < 0);
    double length = 8 * (sqrt(0.1875) + 0.5 + 0.75); /* |eye| . extent, cut into 8 slices */
    assert_true(fabs(depth - length / 8) < 1e-12);
}

/* A file whose axes are permuted and flipped shows the same picture as one that is stored the way it is seen. */
static void orientation(void **state)
{
    (void)state;
    static const int permutations[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    rng random = {91};
    for (int n = 0; n < 48; n++) {
        const int *axis = permutations[n % 6], world_dims[3] = {20, 30, 42};
        volume seen = unit_volume(20, 30, 42), file = seen;
        const double world_spacing[3] = {1, 2.5, 1.5};
        for (int w = 0; w < 3; w++) {
            file.axis[w] = axis[w];
            file.sign[w] = n / 6 >> w & 1 ? -1 : 1;
            file.dims_vox[axis[w]] = world_dims[w];
            file.spacing[axis[w]] = seen.spacing[w] = world_spacing[w];
        }
        camera c = {.azimuth_deg = (double)rng_int(&random, -180, 180),
                    .elevation_deg = (double)rng_int(&random, -90, 90),
                    .roll_deg = (double)rng_int(&random, 0, 360),
                    .perspective = n & 1,
                    .fov_deg = 40,
                    .zoom = 1.25};
        double depth, depth_seen;
        vodr_view a = view_of(&c, &file, &depth), b = view_of(&c, &seen, &depth_seen);
        assert_true(depth == depth_seen);
        assert_int_equal(a.width_px, 20);
        assert_int_equal(a.height_px, 75);
        assert_int_equal(a.slices, 63);
        assert_true(a.depth_first == b.depth_first && a.depth_step == b.depth_step && a.shift == b.shift);
        assert_int_equal(a.footprint, b.footprint);
        for (int w = 0; w < 3; w++) {
            int64_t sign = file.sign[w], far = sign < 0 ? world_dims[w] * one : 0;
            assert_int_equal(a.step_u[axis[w]], sign * b.step_u[w]);
            assert_int_equal(a.step_v[axis[w]], sign * b.step_v[w]);
            assert_int_equal(a.step_s[axis[w]], sign * b.step_s[w]);
            assert_in_range(a.base[axis[w]] - (far + sign * b.base[w]) + 1, 0, 2); /* one rounding */
        }
    }
}

static void anisotropic_spacing(void **state)
{
    (void)state;
    volume v = unit_volume(10, 12, 7);
    const double spacing[3] = {0.35, 0.35, 0.7};
    memcpy(v.spacing, spacing, sizeof spacing);
    camera c = camera_default();
    double depth;
    vodr_view view = view_of(&c, &v, &depth);
    assert_true(view.width_px == 10 && view.height_px == 12 && view.slices == 14 && depth == 1);
    assert_registers(view.base, one / 2, 11 * one + one / 2, one / 4);
    assert_registers(view.step_s, 0, 0, one / 2);
    c.azimuth_deg = 90;
    c.width_px = 14;
    c.slices = 5;
    view = view_of(&c, &v, &depth);
    assert_true(depth == 2); /* ten voxels of depth in five slices */
    assert_registers(view.base, one, 11 * one + one / 2, 7 * one - one / 4);
    assert_registers(view.step_u, 0, 0, -one / 2);
    assert_registers(view.step_s, 2 * one, 0, 0);
}

static void default_sizes(void **state)
{
    (void)state;
    volume v = unit_volume(1, 2000, 513);
    camera c = camera_default();
    double depth;
    vodr_view view = view_of(&c, &v, &depth);
    assert_true(view.width_px == 1 && view.height_px == 512 && view.slices == 512);
    assert_true(depth == 513.0 / 512);
    v.spacing[0] = 0.4; /* finest: the others are 2.5 voxels of it */
    v.dims_vox[1] = 3;
    view = view_of(&c, &v, &depth);
    assert_true(view.width_px == 1 && view.height_px == 8); /* 7.5, half up */
    c.width_px = 1000;
    c.height_px = 16384;
    c.slices = 1;
    view = view_of(&c, &v, &depth);
    assert_true(view.width_px == 1000 && view.height_px == 16384 && view.slices == 1);
}

typedef struct frame_of_view {
    double right[3], up[3], eye[3], half[3], distance, focal_px, near, far;
} frame_of_view;

/* The page's formulas for a volume of unit spacing. */
static frame_of_view formulas(const camera *c, const volume *v, const vodr_view *view)
{
    double d = acos(-1) / 180, sa = sin(c->azimuth_deg * d), ca = cos(c->azimuth_deg * d);
    double se = sin(c->elevation_deg * d), ce = cos(c->elevation_deg * d);
    double sr = sin(c->roll_deg * d), cr = cos(c->roll_deg * d), reach = 0;
    const double right0[3] = {ca, 0, -sa}, up0[3] = {-sa * se, ce, -ca * se};
    frame_of_view f = {.eye = {sa * ce, se, ca * ce}};
    for (int i = 0; i < 3; i++) {
        f.right[i] = cr * right0[i] - sr * up0[i];
        f.up[i] = sr * right0[i] + cr * up0[i];
        f.half[i] = v->dims_vox[i] * 0.5;
        reach += fabs(f.eye[i]) * f.half[i];
    }
    f.focal_px = view->height_px / 2.0 / tan(c->fov_deg * d / 2);
    f.distance = f.focal_px / c->zoom;
    f.near = fmax(f.distance - reach, 1);
    f.far = fmax(f.distance + reach, f.near);
    if (!c->perspective) {
        f.near = -reach;
        f.far = reach;
    }
    return f;
}

/* The page's footprint: sums of |d pixel / d voxel|, in perspective on the nearest slice at the frame's two ends. */
static double footprint(const camera *c, const frame_of_view *f, const vodr_view *view)
{
    double largest = 0, z = f->near + (f->far - f->near) / view->slices / 2;
    for (int end = -1; end <= 1; end += 2) {
        double x = end * (view->width_px - 1) / 2.0, y = end * (view->height_px - 1) / 2.0, across = 0, down = 0;
        for (int i = 0; i < 3; i++) {
            across +=
                c->perspective ? fabs(f->focal_px * f->right[i] + x * f->eye[i]) / z : fabs(c->zoom * f->right[i]);
            down += c->perspective ? fabs(f->focal_px * f->up[i] + y * f->eye[i]) / z : fabs(c->zoom * f->up[i]);
        }
        largest = fmax(largest, fmax(across, down));
    }
    return ldexp(largest, 20);
}

/* Any sample of any view lies where the formulas put it: the pixel's ray, slice k in the middle of its share of depth.
 */
static void positions_are_the_formulas(void **state)
{
    (void)state;
    rng random = {92};
    for (int n = 0; n < 4000; n++) {
        volume v = unit_volume((int32_t)rng_int(&random, 1, 90), (int32_t)rng_int(&random, 1, 90),
                               (int32_t)rng_int(&random, 1, 90));
        camera c = {.azimuth_deg = rng_real(&random, -400, 400),
                    .elevation_deg = rng_real(&random, -90, 90),
                    .roll_deg = rng_real(&random, -180, 180),
                    .perspective = n & 1,
                    .fov_deg = rng_real(&random, 10, 140),
                    .zoom = rng_real(&random, 0.5, 4),
                    .width_px = (int32_t)rng_int(&random, 1, 99),
                    .height_px = (int32_t)rng_int(&random, 1, 99),
                    .slices = (int32_t)rng_int(&random, 1, 99)};
        double depth;
        vodr_view view = view_of(&c, &v, &depth);
        frame_of_view f = formulas(&c, &v, &view);
        double share = (f.far - f.near) / view.slices;
        assert_true(fabs(depth - share) < 1e-9);
        double rounded = footprint(&c, &f, &view);
        assert_true(fabs(view.footprint - rounded) < 2 + 1e-3 * rounded);
        for (int i = 0; i < 20; i++) {
            int32_t x = (int32_t)rng_int(&random, 0, view.width_px - 1);
            int32_t y = (int32_t)rng_int(&random, 0, view.height_px - 1);
            int32_t k = (int32_t)rng_int(&random, 0, view.slices - 1);
            double at = f.far - (k + 0.5) * share; /* depth before the eye; parallel: before the centre */
            double scale = c.perspective ? at / f.focal_px : 1 / c.zoom;
            double eye = c.perspective ? f.distance - at : -at;
            double right = (x + 0.5 - view.width_px / 2.0) * scale, up = (view.height_px / 2.0 - 0.5 - y) * scale;
            int64_t position[3];
            unit_position(&view, x, y, k, position);
            for (int a = 0; a < 3; a++) {
                double want = f.half[a] + f.right[a] * right + f.up[a] * up + f.eye[a] * eye;
                if (fabs(ldexp((double)position[a], -24) - want) > 2e-3)
                    fail_msg("case %d: component %d is %f, not %f", n, a, ldexp((double)position[a], -24), want);
            }
        }
    }
}

/* At the centre a pixel is 1/zoom voxel wide, and the eye is where that makes the field of view. */
static void perspective_eye_and_zoom(void **state)
{
    (void)state;
    volume v = unit_volume(64, 64, 64);
    camera c = {.perspective = true, .fov_deg = 90, .zoom = 1, .width_px = 65, .height_px = 64, .slices = 65};
    double depth;
    vodr_view view = view_of(&c, &v, &depth);
    assert_registers(view.base, 32 * one, 32 * one, 64 * one); /* tan 45 = 1: 32 pixels from the centre */
    assert_true(depth == 63.0 / 65);                           /* from one voxel before the eye to the far side */
    int64_t a[3], b[3];
    c.slices = 1;
    c.zoom = 0.25; /* the eye at 128, the one slice through the centre */
    view = view_of(&c, &v, &depth);
    assert_registers(view.base, 32 * one, 32 * one, (32 + 128) * one);
    assert_true(depth == 64);
    unit_position(&view, 32, 0, 0, a);
    unit_position(&view, 32, 63, 0, b);
    assert_true(a[0] == 32 * one && a[2] == 32 * one);
    assert_in_range(a[1] - b[1], 63 * 4 * one - 64, 63 * 4 * one + 64);
    c.zoom = 1000; /* deep inside: the near plane is one voxel before the eye */
    view = view_of(&c, &v, &depth);
    assert_in_range(view.base[2], 32 * one, 33 * one);
    assert_true(fabs(depth - (32 + 0.032 - 1)) < 1e-9);
}

/* A brick of n voxels covers at most ceil(n*footprint) columns and rows, wherever it is and wherever one looks from. */
static void footprint_bounds_every_brick(void **state)
{
    (void)state;
    rng random = {93};
    int tight = 0;
    for (int n = 0; n < 400; n++) {
        volume v = unit_volume(24, 24, 24);
        vodr_view view = unit_camera_view(&random, &v, n & 1);
        int32_t lo[3], hi[3], edge = (int32_t)rng_int(&random, 1, 12);
        int32_t x0 = INT32_MAX, x1 = -1, y0 = INT32_MAX, y1 = -1;
        for (int i = 0; i < 3; i++) {
            lo[i] = (int32_t)rng_int(&random, 0, 24 - edge);
            hi[i] = lo[i] + edge;
        }
        for (int32_t k = 0; k < view.slices; k++)
            for (int32_t y = 0; y < view.height_px; y++)
                for (int32_t x = 0; x < view.width_px; x++) {
                    int64_t position[3];
                    unit_position(&view, x, y, k, position);
                    if (!unit_inside(position, lo, hi))
                        continue;
                    x0 = x < x0 ? x : x0;
                    x1 = x > x1 ? x : x1;
                    y0 = y < y0 ? y : y0;
                    y1 = y > y1 ? y : y1;
                }
        int64_t most = ((int64_t)edge * view.footprint + (1 << 20) - 1) >> 20;
        assert_true(x1 < 0 || (x1 - x0 + 1 <= most && y1 - y0 + 1 <= most));
        tight += x1 - x0 + 2 >= most || y1 - y0 + 2 >= most;
    }
    assert_true(tight > 10);
    volume v = unit_volume(64, 64, 64);
    camera c = camera_default();
    double depth;
    c.zoom = 2;
    assert_int_equal(view_of(&c, &v, &depth).footprint, 2 << 20);
    c.azimuth_deg = 45;
    assert_in_range(view_of(&c, &v, &depth).footprint, 2965821 - 2, 2965821 + 2); /* sqrt 8 */
}

/* A frame of one pixel has no corners apart: its steps alone say how large products get. */
static void one_pixel(void **state)
{
    (void)state;
    volume v = unit_volume(48, 40, 30);
    double depth;
    for (double fov = 1; fov <= 150; fov++)
        for (double zoom = 0.05; zoom < 50; zoom *= 2) {
            camera c = {.perspective = true, .fov_deg = fov, .zoom = zoom, .width_px = 1, .height_px = 1, .slices = 40};
            view_of(&c, &v, &depth);
        }
}

static void refuse(camera c, const volume *v, const char *sentence)
{
    vodr_view view;
    double depth;
    host_error error = {"accepted"};
    if (camera_view(&c, v, &view, &depth, &error) != HOST_BAD_INPUT || !strstr(error.text, sentence))
        fail_msg("'%s' does not say '%s'", error.text, sentence);
}

static void refusals(void **state)
{
    (void)state;
    volume v = unit_volume(64, 64, 64);
    camera c = camera_default();
    const double bad[] = {NAN, INFINITY, -INFINITY, 36001};
    for (int i = 0; i < 4; i++) {
        c.azimuth_deg = bad[i];
        refuse(c, &v, "must be -36000 to 36000 degrees");
        c = camera_default();
        c.roll_deg = bad[i];
        refuse(c, &v, "must be -36000 to 36000 degrees");
        c = camera_default();
        c.elevation_deg = bad[i];
        refuse(c, &v, "must be -90 to 90 degrees");
        c = camera_default();
        c.perspective = true;
        c.fov_deg = bad[i];
        refuse(c, &v, "must be 1 to 150 degrees");
        c = camera_default();
    }
    c.elevation_deg = 90.5;
    refuse(c, &v, "elevation 90.5 must be -90 to 90 degrees");
    c = camera_default();
    c.perspective = true;
    c.fov_deg = 0.5;
    refuse(c, &v, "field of view 0.5 must be 1 to 150 degrees");
    c = camera_default();
    const double zooms[] = {0, -1, NAN, INFINITY};
    for (int i = 0; i < 4; i++) {
        c.zoom = zooms[i];
        refuse(c, &v, "must be positive");
    }
    c.zoom = 1e-5;
    refuse(c, &v, "not fit");
    c.zoom = 1e-300;
    refuse(c, &v, "not fit");
    c.perspective = true;
    refuse(c, &v, "not fit");
    c = camera_default();
    c.width_px = 16385;
    refuse(c, &v, "the frame is 16385x64 pixels but must be 1x1 to 16384x16384");
    c.width_px = -5;
    refuse(c, &v, "the frame is -5x64 pixels");
    c = camera_default();
    c.slices = 20000;
    refuse(c, &v, "the view has 20000 slices but must have 1 to 16384");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_voxel_centre_once),
        cmocka_unit_test(right_angles),
        cmocka_unit_test(conventions),
        cmocka_unit_test(orientation),
        cmocka_unit_test(anisotropic_spacing),
        cmocka_unit_test(default_sizes),
        cmocka_unit_test(positions_are_the_formulas),
        cmocka_unit_test(perspective_eye_and_zoom),
        cmocka_unit_test(footprint_bounds_every_brick),
        cmocka_unit_test(one_pixel),
        cmocka_unit_test(refusals),
    };
    return cmocka_run_group_tests_name("camera", tests, NULL, NULL);
}
