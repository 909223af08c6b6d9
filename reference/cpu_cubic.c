/* cpu_cubic.c - what the cubic filters need of the volume on the CPU. */
#include "cpu_cubic.h"

#include <math.h>
#include <stdlib.h>

#include "cpu_job.h"
#include "device.h"
#include "pages.h"
#include "prefilter.h"

static size_t count_of(const int32_t dims[3], int32_t more)
{
    return (size_t)(dims[0] + more) * (size_t)(dims[1] + more) * (size_t)(dims[2] + more);
}

/* ---- coefficients ---- */

/* `samples` of these jobs counts the bands that had no memory. */
static void filter_layers(const cpu_job *job, int32_t z0, int32_t z1, uint64_t *failures)
{
    *failures += !prefilter_layers(job->input, z0, z1, job->output);
}

static void filter_rows(const cpu_job *job, int32_t y0, int32_t y1, uint64_t *failures)
{
    const reference_volume *v = job->input;
    (void)failures;
    prefilter_rows(v->dims_vox, y0, y1, job->output);
}

reference_status cpu_cubic_volume(cpu_cubic *c, const reference_volume *v, bool spline, int32_t threads,
                                  reference_stats *stats, vodr_error *error)
{
    if (c->volume.voxels)
        return REFERENCE_OK;
    if (!spline) {
        c->volume = *v;
        return REFERENCE_OK;
    }
    const size_t bytes = count_of(v->dims_vox, 0) * sizeof *c->coefficients;
    cpu_job layers = {.work = filter_layers, .input = v, .rows = v->dims_vox[2]};
    cpu_job rows = {.work = filter_rows, .input = v, .rows = v->dims_vox[1]};
    layers.output = rows.output = c->coefficients = pages_alloc(bytes);
    if (c->coefficients)
        stats->preprocess_ms += cpu_job_run(threads, &layers);
    if (!c->coefficients || layers.samples > 0) {
        cpu_cubic_free(c);
        return reference_fail(error, REFERENCE_NO_MEMORY, "no memory for %zu MiB of coefficients", (bytes >> 20) + 1);
    }
    stats->preprocess_ms += cpu_job_run(threads, &rows);
    c->volume = (reference_volume){.type = REFERENCE_FLOAT32, .voxels = c->coefficients};
    for (int a = 0; a < 3; a++)
        c->volume.dims_vox[a] = v->dims_vox[a];
    return REFERENCE_OK;
}

/* ---- bounds ---- */

typedef struct bounding {
    const hull_rows *rows;
    hull_job job;
} bounding;

/* Two floats a layer. */
static void find_extremes(const cpu_job *job, int32_t z0, int32_t z1, uint64_t *failures)
{
    const bounding *b = job->input;
    *failures += !b->rows->extremes(&b->job.volume, z0, z1, job->output);
}

static void fill_hull(const cpu_job *job, int32_t l0, int32_t l1, uint64_t *failures)
{
    const bounding *b = job->input;
    *failures += !b->rows->hull(&b->job, l0, l1);
}

static void fill_rival(const cpu_job *job, int32_t l0, int32_t l1, uint64_t *failures)
{
    const bounding *b = job->input;
    *failures += !b->rows->rival(&b->job, l0, l1);
}

static bool find_scale(cpu_cubic *c, const bounding *b, int32_t threads)
{
    const int32_t layers = c->volume.dims_vox[2];
    float *extremes = malloc(2 * (size_t)layers * sizeof *extremes), least = INFINITY, most = -INFINITY;
    cpu_job job = {.work = find_extremes, .input = b, .output = extremes, .rows = layers};
    if (extremes)
        cpu_job_run(threads, &job);
    c->has_scale = extremes && job.samples == 0;
    for (int32_t z = 0; c->has_scale && z < layers; z++) {
        least = fminf(least, extremes[2 * z]);
        most = fmaxf(most, extremes[2 * z + 1]);
    }
    free(extremes);
    if (c->has_scale)
        c->scale = hull_scale_of(b->job.spline, least, most);
    return c->has_scale;
}

reference_status cpu_cubic_ranges(cpu_cubic *c, const reference_volume *v, const device_ranges *r, int32_t threads,
                                  const hull_rows *rows, reference_stats *stats, vodr_error *error)
{
    const size_t cells = count_of(v->dims_vox, 1);
    reference_status status = cpu_cubic_volume(c, v, r->spline, threads, stats, error);
    if (status != REFERENCE_OK)
        return status;
    const double begin_ms = reference_now_ms();
    bounding b = {rows,
                  {.volume = c->volume,
                   .spline = r->spline,
                   .edge_vox = r->edge_vox,
                   .count = {r->count[0], r->count[1], r->count[2]},
                   .share = hull_share(r->bound, r->spline),
                   .least = r->least,
                   .most = r->most}};
    bool good = c->has_scale || find_scale(c, &b, threads);
    b.job.scale = c->scale;
    if (good && r->cells && !c->codes) {
        c->codes = b.job.codes = pages_alloc(cells * sizeof *c->codes);
        good = c->codes != NULL;
    }
    cpu_job job = {
        .work = r->bound == HULL_BEZIER ? fill_hull : fill_rival, .input = &b, .rows = r->count[2], .band = 1};
    if (good)
        cpu_job_run(threads, &job);
    *r->scale = c->scale;
    stats->preprocess_ms += reference_now_ms() - begin_ms;
    if (good && job.samples == 0)
        return REFERENCE_OK;
    if (b.job.codes) {
        free(c->codes);
        c->codes = NULL;
    }
    return reference_fail(error, REFERENCE_NO_MEMORY, "no memory for the bounds of %zu cells", cells);
}

void cpu_cubic_free(cpu_cubic *c)
{
    free(c->coefficients);
    free(c->codes);
    *c = (cpu_cubic){0};
}
