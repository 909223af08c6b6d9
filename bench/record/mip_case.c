/* mip_case.c - random cases of the maximum, made of those of tests/lib/cases.h. */
#include "mip_case.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *mip_accel_name(reference_accel accel)
{
    static const char *const names[] = {"none", "block", "bisect", "seed", "best"};
    return names[accel];
}

void mip_fill_ramp(double *rgba)
{
    for (int i = 0; i < MIP_COLUMNS; i++) {
        for (int c = 0; c < 3; c++)
            rgba[4 * i + c] = i / (MIP_COLUMNS - 1.0);
        rgba[4 * i + 3] = 1;
    }
}

/* ---- a case ---- */

static float *as_floats(test_case *c)
{
    const int32_t *dims = c->input.dims_vox;
    const size_t count = (size_t)dims[0] * (size_t)dims[1] * (size_t)dims[2];
    float *values = malloc(count * sizeof *values);
    const double scale = rng_real(&c->random, 1e-3, 10);
    const double offset = rng_real(&c->random, -1e5, 1e4);
    for (size_t i = 0; values && i < count; i++) {
        double stored = c->input.voxel_bytes == 1 ? ((uint8_t *)c->input.voxels)[i] : ((uint16_t *)c->input.voxels)[i];
        values[i] = (float)(stored * scale + offset);
    }
    return values;
}

static void choose_edges(test_case *c, int32_t edges_vox[MIP_EDGES])
{
    int32_t longest = 2;
    for (int a = 0; a < 3; a++)
        longest = c->input.dims_vox[a] > longest ? c->input.dims_vox[a] : longest;
    edges_vox[0] = 2;
    edges_vox[1] = (int32_t)rng_int(&c->random, 3, 20);
    edges_vox[2] = longest;
    edges_vox[3] = longest + 100;
}

static reference_march_job choose_job(test_case *c, const double *table)
{
    rng *r = &c->random;
    double spacing[3], finest = fmin(c->geometry.spacing[0], fmin(c->geometry.spacing[1], c->geometry.spacing[2]));
    for (int a = 0; a < 3; a++)
        spacing[a] = c->geometry.spacing[a] / finest;
    const bool rays = rng_one_in(r, 2);
    const double step = rays ? rng_real(r, 0.1, 2) : 0;
    const bool texture = rng_one_in(r, 3);
    const bool nearest = rng_one_in(r, 5);
    return (reference_march_job){.camera = rays ? reference_camera_rays(&c->view, spacing, step)
                                                : reference_camera_slices(&c->view),
                                 .blend = REFERENCE_MIP,
                                 .numbers = texture ? REFERENCE_TEXTURE : REFERENCE_FLOAT,
                                 .filter = nearest ? REFERENCE_NEAREST : REFERENCE_LINEAR,
                                 .termination = 2,
                                 .table = {.columns = MIP_COLUMNS, .rows = 1, .rgba = table},
                                 .window_scale = 1 / (c->input.voxel_bytes == 1 ? 255.0 : 65535.0)};
}

bool mip_case_make(uint64_t seed, mip_case *c)
{
    c->floats = NULL;
    if (!case_make(seed, &c->base))
        return false;
    const bool floats = rng_one_in(&c->base.random, 4);
    if (floats && !(c->floats = as_floats(&c->base)))
        return false;
    c->volume = (reference_volume){.type = floats                           ? REFERENCE_FLOAT32
                                           : c->base.input.voxel_bytes == 1 ? REFERENCE_UINT8
                                                                            : REFERENCE_UINT16,
                                   .voxels = floats ? c->floats : c->base.input.voxels};
    memcpy(c->volume.dims_vox, c->base.input.dims_vox, sizeof c->volume.dims_vox);
    mip_fill_ramp(c->table);
    choose_edges(&c->base, c->edges_vox);
    c->job = choose_job(&c->base, c->table);
    return true;
}

void mip_case_free(mip_case *c)
{
    free(c->floats);
    case_free(&c->base);
}

/* ---- drawn ---- */

static size_t channels_of(const mip_case *c)
{
    return 4 * (size_t)c->base.view.width_px * (size_t)c->base.view.height_px;
}

static bool draw(const mip_case *c, reference *r, reference_accel accel, int32_t edge_vox, double *rgba,
                 reference_stats *stats, FILE *file)
{
    reference_march_job job = c->job;
    vodr_error error;
    job.accel = accel;
    job.block_vox = edge_vox;
    if (reference_march(r, &job, rgba, stats, &error) == REFERENCE_OK)
        return true;
    fprintf(file, "  %s: %s\n", mip_accel_name(accel), error.text);
    return false;
}

static bool draw_none(const mip_case *c, reference *r, double *none, FILE *file, mip_tally *t)
{
    reference_stats stats;
    if (!draw(c, r, REFERENCE_ACCEL_NONE, 2, none, &stats, file))
        return false;
    t->cases++;
    t->samples[REFERENCE_ACCEL_NONE] += stats.samples;
    t->sum = 0;
    for (size_t i = 0; i < channels_of(c); i += 4)
        t->sum += none[i];
    return true;
}

/* Draws by every other --accel and holds it against none[]. */
static bool draw_others(const mip_case *c, reference *r, const double *none, double *other, FILE *file, mip_tally *t)
{
    reference_stats stats;
    for (int accel = REFERENCE_ACCEL_BLOCK; accel <= REFERENCE_ACCEL_BEST; accel++)
        for (int e = 0; e < (accel == REFERENCE_ACCEL_BEST ? 1 : MIP_EDGES); e++) {
            if (!draw(c, r, (reference_accel)accel, c->edges_vox[e], other, &stats, file))
                return false;
            t->frames++;
            t->samples[accel] += e == 0 ? stats.samples : 0;
            if (memcmp(none, other, channels_of(c) * sizeof *none) == 0)
                continue;
            t->differ++;
            fprintf(file, "  %s, blocks of %d: not the picture of none\n", mip_accel_name((reference_accel)accel),
                    c->edges_vox[e]);
            case_print(file, &c->base, &c->base.machine);
        }
    return true;
}

static bool draw_all(const mip_case *c, const reference_options *options, bool others, FILE *file, mip_tally *t)
{
    double *none = malloc(channels_of(c) * sizeof *none), *other = malloc(channels_of(c) * sizeof *other);
    reference *r = NULL;
    vodr_error error;
    bool good = none && other && reference_open(options, &c->volume, &r, &error) == REFERENCE_OK;
    if (none && other && !good)
        fprintf(file, "  open: %s\n", error.text);
    good = good && draw_none(c, r, none, file, t) && (!others || draw_others(c, r, none, other, file, t));
    reference_close(r);
    free(none);
    free(other);
    return good;
}

bool mip_case_hold(const mip_case *c, const reference_options *options, FILE *file, mip_tally *t)
{
    return draw_all(c, options, true, file, t);
}

bool mip_case_draw(const mip_case *c, const reference_options *options, FILE *file, mip_tally *t)
{
    return draw_all(c, options, false, file, t);
}
