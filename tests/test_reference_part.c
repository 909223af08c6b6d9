/* test_reference_part.c - parts of a volume in the reference renderer: a volume cut by random planes, each box drawn of
 * a copy that holds only its voxels and their border. The maxima together must be the whole's to the byte, the sums
 * over one another the whole's but for rounding. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lib/unit.h"
#include "reference.h"
#include "rng.h"

enum { W = 33, H = 26, COLUMNS = 64, CUTS = 2, PIECES = CUTS + 1 };

static const int32_t whole_vox[3] = {21, 14, 30};

typedef struct picture {
    double rgba[4 * W * H];
} picture;

typedef struct drawing {
    uint8_t voxels[21 * 14 * 30];
    double table[4 * 2 * COLUMNS];
    reference_march_job job;
} drawing;

/* Rays that go through the volume aslant, front to back along +x -y +z or with random signs. */
static reference_camera random_camera(rng *r, bool perspective)
{
    reference_camera c = {.width_px = W, .height_px = H, .most = 400, .spacing_vox = {1, 1, 1}};
    for (int a = 0; a < 3; a++) {
        const double speed = rng_real(r, 0.2, 1), forward = rng_one_in(r, 2) ? speed : -speed;
        c.origin[0][a] = whole_vox[a] / 2.0 - forward * (perspective ? 40 : 60);
        c.direction[0][a] = forward;
        for (int i = 1; i < 3; i++)
            (perspective ? c.direction : c.origin)[i][a] = rng_real(r, -1, 1) * (perspective ? 0.02 : 1);
    }
    for (int a = 0; a < 3; a++) /* the picture's middle looks at the volume's */
        for (int i = 1; i < 3; i++)
            c.origin[0][a] -= (i == 1 ? W : H) / 2.0 * c.origin[i][a];
    c.spacing = rng_real(r, 0.4, 1.1);
    return c;
}

static void random_drawing(rng *r, reference_blend blend, drawing *d)
{
    for (size_t i = 0; i < sizeof d->voxels; i++)
        d->voxels[i] = (uint8_t)rng_int(r, 0, 255);
    for (int i = 0; i < 2 * COLUMNS; i++) {
        const double alpha = i % COLUMNS < COLUMNS / 3 ? 0 : rng_real(r, 0, 0.2);
        for (int c = 0; c < 4; c++)
            d->table[4 * i + c] = c == 3 ? alpha : rng_real(r, 0, alpha);
    }
    reference_march_job *job = &d->job;
    *job = (reference_march_job){.blend = blend, .block_vox = (int32_t)rng_int(r, 2, 8), .termination = 2};
    job->table = (reference_table){COLUMNS, 1, d->table, 0.5};
    job->window_scale = 1.0 / 255;
    job->camera = random_camera(r, blend == REFERENCE_MIP && rng_one_in(r, 2));
    job->filter = rng_one_in(r, 4) ? REFERENCE_NEAREST : REFERENCE_LINEAR;
    job->accel = rng_one_in(r, 3) ? REFERENCE_ACCEL_NONE : REFERENCE_ACCEL_BEST;
    job->numbers = rng_one_in(r, 4) ? REFERENCE_DOUBLE : REFERENCE_FLOAT;
    if (blend == REFERENCE_OVER && rng_one_in(r, 2))
        job->shading = REFERENCE_PHONG;
    if (blend == REFERENCE_OVER && rng_one_in(r, 2))
        job->table.rows = 2;
}

/* The voxels of [lo, hi) and the border around, as a volume of its own; free() its voxels. */
static reference_volume cut(const uint8_t *voxels, const int32_t lo[3], const int32_t hi[3], int32_t border)
{
    reference_volume v = {.type = REFERENCE_UINT8};
    for (int a = 0; a < 3; a++) {
        const int32_t end = hi[a] + border < whole_vox[a] ? hi[a] + border : whole_vox[a];
        v.origin_vox[a] = lo[a] > border ? lo[a] - border : 0;
        v.dims_vox[a] = end - v.origin_vox[a];
        v.whole_vox[a] = whole_vox[a];
    }
    uint8_t *copy = malloc((size_t)v.dims_vox[0] * (size_t)v.dims_vox[1] * (size_t)v.dims_vox[2]);
    assert_non_null(copy);
    v.voxels = copy;
    for (int32_t z = 0; z < v.dims_vox[2]; z++)
        for (int32_t y = 0; y < v.dims_vox[1]; y++, copy += v.dims_vox[0])
            memcpy(copy,
                   voxels + ((z + v.origin_vox[2]) * whole_vox[1] + y + v.origin_vox[1]) * whole_vox[0] +
                       v.origin_vox[0],
                   (size_t)v.dims_vox[0]);
    return v;
}

static void march(const reference_volume *v, const reference_march_job *job, double *rgba)
{
    const reference_options options = {REFERENCE_CPU, 1, VODR_SIMD_BEST};
    reference *r;
    reference_stats stats;
    vodr_error error;
    if (reference_open(&options, v, &r, &error) != REFERENCE_OK ||
        reference_march(r, job, rgba, &stats, &error) != REFERENCE_OK)
        fail_msg("%s", error.text);
    reference_close(r);
}

/* A box drawn of its own voxels, in two halves of the picture. */
static void march_box(const drawing *d, const int32_t lo[3], const int32_t hi[3], picture *out)
{
    reference_march_job job = d->job;
    reference_volume v = cut(d->voxels, lo, hi, reference_border_vox(&job));
    memcpy(job.lo_vox, lo, sizeof job.lo_vox);
    memcpy(job.hi_vox, hi, sizeof job.hi_vox);
    job.stored = job.blend == REFERENCE_MIP;
    for (int half = 0; half < 2; half++) {
        job.camera.first_px[1] = half * (H / 3);
        job.camera.height_px = half ? H - H / 3 : H / 3;
        march(&v, &job, out->rgba + 4 * W * job.camera.first_px[1]);
    }
    free((void *)v.voxels);
}

/* Puts `back` behind what is there, or keeps the greater. */
static void lay(picture *front, const picture *back, bool mip)
{
    for (int i = 0; i < W * H; i++) {
        double *f = front->rgba + 4 * i;
        const double *b = back->rgba + 4 * i, through = 1 - f[3];
        if (mip && b[3] > 0 && (f[3] == 0 || b[0] > f[0]))
            memcpy(f, b, 4 * sizeof *f);
        for (int c = 0; !mip && c < 4; c++)
            f[c] += through * b[c];
    }
}

/* The volume in PIECES^3 boxes, nearest first. */
static void march_parts(rng *r, const drawing *d, picture *out)
{
    int32_t edge[3][PIECES + 1], lo[3], hi[3];
    static picture part;
    memset(out, 0, sizeof *out);
    for (int a = 0; a < 3; a++) {
        edge[a][0] = 0;
        edge[a][PIECES] = whole_vox[a];
        edge[a][1] = (int32_t)rng_int(r, 1, whole_vox[a] / 2);
        edge[a][2] = (int32_t)rng_int(r, edge[a][1] + 1, whole_vox[a] - 1);
    }
    for (int i = 0; i < PIECES * PIECES * PIECES; i++) {
        const int step[3] = {i % PIECES, i / PIECES % PIECES, i / PIECES / PIECES};
        for (int a = 0; a < 3; a++) {
            const int at = d->job.camera.direction[0][a] > 0 ? step[a] : PIECES - 1 - step[a];
            lo[a] = edge[a][at];
            hi[a] = edge[a][at + 1];
        }
        march_box(d, lo, hi, &part);
        lay(out, &part, d->job.blend == REFERENCE_MIP);
    }
}

static void look(uint64_t seed, reference_blend blend)
{
    static drawing d;
    static picture whole, parts;
    const reference_volume v = {.dims_vox = {21, 14, 30}, .type = REFERENCE_UINT8, .voxels = d.voxels};
    vodr_error error;
    rng r = {seed};
    random_drawing(&r, blend, &d);
    march(&v, &d.job, whole.rgba);
    march_parts(&r, &d, &parts);
    if (blend == REFERENCE_MIP)
        assert_int_equal(reference_show_stored(&d.job, parts.rgba, W * H, &error), REFERENCE_OK);
    double most = 0, light = 0;
    for (int i = 0; i < 4 * W * H; i++) {
        most = fmax(most, fabs(whole.rgba[i] - parts.rgba[i]));
        light += whole.rgba[i];
    }
    assert_true(light > 10);
    if (blend == REFERENCE_MIP ? most > 0 : most > 4e-6)
        fail_msg("seed %llu: parts differ from the whole by %g", (unsigned long long)seed, most);
}

static void test_over(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 24; seed++)
        look(seed, REFERENCE_OVER);
}

static void test_mip(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 24; seed++)
        look(seed, REFERENCE_MIP);
}

static void refuse(const reference_volume *v, const reference_march_job *job, const char *words)
{
    const reference_options options = {REFERENCE_CPU, 1, VODR_SIMD_BEST};
    static picture out;
    reference *r = NULL;
    reference_stats stats;
    vodr_error error;
    reference_status status = reference_open(&options, v, &r, &error);
    if (status == REFERENCE_OK)
        status = reference_march(r, job, out.rgba, &stats, &error);
    assert_int_equal(status, REFERENCE_INVALID);
    if (!strstr(error.text, words))
        fail_msg("'%s' is not in '%s'", words, error.text);
    reference_close(r);
}

static void test_refused(void **state)
{
    (void)state;
    static drawing d;
    rng r = {1};
    random_drawing(&r, REFERENCE_MIP, &d);
    reference_march_job job = d.job;
    reference_volume v = {{10, 14, 30}, REFERENCE_UINT8, d.voxels, {21, 14, 30}, {5, 0, 0}};
    job.filter = REFERENCE_LINEAR;
    job.accel = REFERENCE_ACCEL_NONE;
    refuse(&v, &job, "the box along x is 0 to 21 with a border of 1, but the voxels at hand are 5 to 15");
    memcpy(job.hi_vox, (int32_t[]){15, 14, 30}, sizeof job.hi_vox);
    memcpy(job.lo_vox, (int32_t[]){6, 0, 0}, sizeof job.lo_vox);
    refuse(&v, &job, "the box along x is 6 to 15 with a border of 1");
    job.hi_vox[0] = 6;
    refuse(&v, &job, "the box along x is 6 to 6, must lie within 0 to 21");
    job.hi_vox[0] = 14;
    job.accel = REFERENCE_ACCEL_SEED;
    refuse(&v, &job, "no accel but none and best");
    v.origin_vox[0] = 12;
    refuse(&v, &job, "the part's voxels along x are 12 to 22");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_over),
        cmocka_unit_test(test_mip),
        cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
