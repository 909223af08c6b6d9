/* cubic_cases.c - random volumes, transfer functions and views through the cubic filters. */
#include "cubic_cases.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const reference_accel accels[] = {REFERENCE_ACCEL_NONE,  REFERENCE_ACCEL_RIVAL,   REFERENCE_ACCEL_HULL,
                                         REFERENCE_ACCEL_BEST,  REFERENCE_ACCEL_ALIGNED, REFERENCE_ACCEL_ALIGNED_BEST,
                                         REFERENCE_ACCEL_UNSAFE};

const char *cubic_accel_name(reference_accel accel)
{
    switch (accel) {
    case REFERENCE_ACCEL_NONE: return "none";
    case REFERENCE_ACCEL_RIVAL: return "rival";
    case REFERENCE_ACCEL_HULL: return "hull";
    case REFERENCE_ACCEL_BEST: return "best";
    case REFERENCE_ACCEL_ALIGNED: return "aligned";
    case REFERENCE_ACCEL_ALIGNED_BEST: return "aligned-best";
    case REFERENCE_ACCEL_ALIGNED_PAPER: return "aligned-paper";
    default: return "unsafe";
    }
}

/* The case's voxels as floats, some below zero; NULL when the host is out of memory. */
static float *as_floats(test_case *c, double *scale, double *offset)
{
    const int32_t *dims = c->input.dims_vox;
    const size_t count = (size_t)dims[0] * (size_t)dims[1] * (size_t)dims[2];
    float *values = malloc(count * sizeof *values);
    *scale = rng_real(&c->random, 1e-3, 10);
    *offset = rng_real(&c->random, -1e5, 1e4);
    for (size_t i = 0; values && i < count; i++) {
        const double stored =
            c->input.voxel_bytes == 1 ? ((uint8_t *)c->input.voxels)[i] : ((uint16_t *)c->input.voxels)[i];
        values[i] = (float)(stored * *scale + *offset);
    }
    return values;
}

/* The window reaches beyond the voxels' range, as samples do. */
static reference_march_job random_job(test_case *c, double scale, double offset, double *rgba)
{
    rng *r = &c->random;
    const double most = c->input.voxel_bytes == 1 ? 255 : 65535, width = most * rng_real(r, 0.2, 2.2);
    const double finest = fmin(c->geometry.spacing[0], fmin(c->geometry.spacing[1], c->geometry.spacing[2]));
    const bool by_gradient = rng_one_in(r, 5);
    double spacing_vox[3];
    for (int a = 0; a < 3; a++)
        spacing_vox[a] = c->geometry.spacing[a] / finest;
    case_fill_rgba(r, rgba);
    const double low = most * rng_real(r, -0.6, 0.9);
    reference_march_job job = {.numbers = REFERENCE_FLOAT,
                               .termination = 2,
                               .table = {CASE_COLUMNS, by_gradient ? CASE_ROWS : 1, rgba, 0},
                               .window_scale = 1 / (width * scale),
                               .window_offset = -(low * scale + offset) / (width * scale)};
    job.camera = rng_one_in(r, 2) ? reference_camera_rays(&c->view, spacing_vox, rng_real(r, 0.3, 2))
                                  : reference_camera_slices(&c->view);
    job.blend = rng_one_in(r, 3) ? REFERENCE_MIP : REFERENCE_OVER;
    job.filter = rng_one_in(r, 2) ? REFERENCE_BSPLINE : REFERENCE_CARDINAL;
    job.shading = job.blend == REFERENCE_OVER && rng_one_in(r, 6) ? REFERENCE_PHONG : REFERENCE_UNLIT;
    job.block_vox = (int32_t)(rng_one_in(r, 5) ? rng_int(r, 2, 200) : rng_int(r, 2, 9));
    if (!rng_one_in(r, 3))
        job.termination = rng_real(r, 0.3, 1);
    if (rng_one_in(r, 5)) { /* a function that runs the other way */
        job.window_scale = -job.window_scale;
        job.window_offset = 1 - job.window_offset;
    }
    job.copies = rng_one_in(r, 4) ? 1 : 0;
    if (by_gradient)
        job.table.gradient_most = rng_real(r, 0.05, 1);
    return job;
}

static bool draw(reference *r, reference_march_job job, reference_accel accel, double *rgba, cubic_tally *t, FILE *file)
{
    reference_stats stats;
    vodr_error error;
    job.accel = accel;
    if (reference_march(r, &job, rgba, &stats, &error) != REFERENCE_OK) {
        fprintf(file, "  %s: %s\n", cubic_accel_name(accel), error.text);
        return false;
    }
    t->samples[accel] += stats.samples;
    t->frames++;
    return true;
}

/* Every accel of one way, the first of all being none. */
static bool hold_way(test_case *c, reference *r, const reference_march_job *job, bool first, double *none,
                     double *other, FILE *file, cubic_tally *t)
{
    const size_t bytes = 4 * (size_t)c->view.width_px * (size_t)c->view.height_px * sizeof *none;
    bool same = true;
    for (size_t i = 0; i < sizeof accels / sizeof *accels; i++) {
        double *rgba = first && i == 0 ? none : other;
        if (!reference_accel_suits(accels[i], job->blend, job->filter))
            continue;
        if (!draw(r, *job, accels[i], rgba, t, file))
            return false;
        const bool differs = memcmp(none, rgba, bytes) != 0;
        if (accels[i] == REFERENCE_ACCEL_UNSAFE) {
            t->unsafe_frames++;
            t->unsafe += differs;
        } else if (differs) {
            t->differ++;
            same = false;
            fprintf(file,
                    "  %s, %s: not the picture of none; filter %d, numbers %d, blend %d, shading %d, blocks of %d\n",
                    reference_device_name(r), cubic_accel_name(accels[i]), job->filter, job->numbers, job->blend,
                    job->shading, job->block_vox);
        }
    }
    return same;
}

bool cubic_case_hold(test_case *c, const reference_options *ways, int count, FILE *file, cubic_tally *t)
{
    double table[4 * CASE_COLUMNS * CASE_ROWS], scale = 1, offset = 0;
    const bool is_float = rng_one_in(&c->random, 4);
    float *floats = is_float ? as_floats(c, &scale, &offset) : NULL;
    const reference_march_job job = random_job(c, scale, offset, table);
    reference_volume v = {.type = floats                      ? REFERENCE_FLOAT32
                                  : c->input.voxel_bytes == 1 ? REFERENCE_UINT8
                                                              : REFERENCE_UINT16,
                          .voxels = floats ? floats : c->input.voxels};
    memcpy(v.dims_vox, c->input.dims_vox, sizeof v.dims_vox);
    const size_t channels = 4 * (size_t)c->view.width_px * (size_t)c->view.height_px;
    double *none = malloc(channels * sizeof *none), *other = malloc(channels * sizeof *other);
    bool good = none && other && (floats || !is_float), same = true;
    for (int i = 0; good && i < count; i++) {
        reference *r = NULL;
        vodr_error error;
        good = reference_open(&ways[i], &v, &r, &error) == REFERENCE_OK;
        if (good)
            same = hold_way(c, r, &job, i == 0, none, other, file, t) && same;
        else
            fprintf(file, "  open: %s\n", error.text);
        reference_close(r);
    }
    t->cases++;
    if (!same)
        case_print(file, c, &c->machine);
    free(none);
    free(other);
    free(floats);
    return good && same;
}
