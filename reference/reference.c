/* reference.c - the reference renderer's front: inputs checked, tables made, a frame handed to the device. */
#include "reference.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "aligned.h"
#include "bounds.h"
#include "part.h"
#include "state.h"

enum { MAX_TABLE = 1 << 20, MAX_COLUMNS = 4096, MOST_SAMPLES = 1 << 24 };

/* A gradient of the whole window over this many finest voxels makes a whole surface. */
static const double surface_vox = 1024;

reference_status reference_fail(vodr_error *error, reference_status status, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    if (error)
        vsnprintf(error->text, sizeof error->text, format, arguments);
    va_end(arguments);
    return status;
}

double reference_now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

/* ---- a reference ---- */

static reference_status check_volume(const reference_volume *v, vodr_error *error)
{
    for (int a = 0; a < 3; a++)
        if (v->dims_vox[a] < 1 || v->dims_vox[a] > VODR_MAX_DIM_VOX)
            return reference_fail(error, REFERENCE_INVALID, "the volume's size along %c is %d, must be 1 to %d voxels",
                                  "xyz"[a], v -> dims_vox[a], VODR_MAX_DIM_VOX);
    return part_check_volume(v, error);
}

reference_status reference_open(const reference_options *options, const reference_volume *volume, reference **out,
                                vodr_error *error)
{
    *out = NULL;
    reference_status status = check_volume(volume, error);
    if (status != REFERENCE_OK)
        return status;
    const device_ops *ops = options->device == REFERENCE_CUDA ? device_cuda() : &device_cpu;
    if (!ops)
        return reference_fail(error, REFERENCE_NO_DEVICE, "this build has no CUDA: make found no nvcc");
    reference *r = calloc(1, sizeof *r);
    if (!r)
        return reference_fail(error, REFERENCE_NO_MEMORY, "no memory for the reference renderer");
    r->ops = ops;
    r->volume = *volume;
    status = ops->open(options, volume, &r->state, r->name, error);
    if (status == REFERENCE_OK)
        *out = r;
    else
        free(r);
    return status;
}

void reference_close(reference *r)
{
    if (!r)
        return;
    r->ops->close(r->state);
    blocks_free(&r->blocks);
    free(r->shown);
    free(r);
}

const char *reference_device_name(const reference *r)
{
    return r->name;
}

/* ---- floating point ---- */

static reference_status check_march(const reference *r, const reference_march_job *job, vodr_error *error)
{
    const reference_table *t = &job->table;
    int64_t voxels = (int64_t)r->volume.dims_vox[0] * r->volume.dims_vox[1] * r->volume.dims_vox[2];
    if (voxels > INT32_MAX)
        return reference_fail(error, REFERENCE_INVALID, "the volume has %lld voxels, must have at most %d in float",
                              (long long)voxels, INT32_MAX);
    if (job->numbers == REFERENCE_DOUBLE && r->ops != &device_cpu)
        return reference_fail(error, REFERENCE_INVALID, "double numbers are drawn on the CPU only");
    if (t->columns < 2 || t->columns > MAX_COLUMNS || t->rows < 1 || (int64_t)t->columns * t->rows > MAX_TABLE)
        return reference_fail(error, REFERENCE_INVALID,
                              "the table is %dx%d, must have 2 to %d columns and at most %d entries", t->columns,
                              t->rows, MAX_COLUMNS, MAX_TABLE);
    if (job->block_vox < 2 || job->block_vox > VODR_MAX_DIM_VOX)
        return reference_fail(error, REFERENCE_INVALID, "a block has %d voxels a side, must have 2 to %d",
                              job->block_vox, VODR_MAX_DIM_VOX);
    if (!reference_accel_suits(job->accel, job->blend, job->filter))
        return reference_fail(
            error, REFERENCE_INVALID,
            "bisection and seeds are of the maximum of nearest and linear samples, hulls and rivals of "
            "cubic ones, alignment of B-splines");
    if (job->copies != 0 && job->copies != 1 && job->copies != 3)
        return reference_fail(error, REFERENCE_INVALID,
                              "copies are %d, must be 1, 3 or, of the two what there is room for, 0", job->copies);
    if (reference_is_cubic(job->filter) && job->numbers == REFERENCE_TEXTURE)
        return reference_fail(error, REFERENCE_INVALID,
                              "a texture unit's weights are of nearest and linear, not of cubics");
    if (job->camera.most > MOST_SAMPLES)
        return reference_fail(error, REFERENCE_INVALID, "a ray has %lld samples, must have at most %d",
                              (long long)job->camera.most, MOST_SAMPLES);
    return REFERENCE_OK;
}

/* Leaps count from where a ray enters the voxels at hand, so they are not of parts. */
static reference_status check_part(const reference *r, const reference_march_job *job, kernel_part *part,
                                   vodr_error *error)
{
    reference_status status = part_of(&r->volume, job, part, error);
    const bool leaps =
        job->blend == REFERENCE_MIP && job->accel != REFERENCE_ACCEL_NONE && job->accel != REFERENCE_ACCEL_BEST;
    if (status == REFERENCE_OK && reference_is_cubic(job->filter) && !part_is_whole(part, r->volume.dims_vox))
        return reference_fail(error, REFERENCE_INVALID, "of a part there is no cubic filter");
    if (status == REFERENCE_OK && leaps && !part_is_whole(part, r->volume.dims_vox))
        return reference_fail(error, REFERENCE_INVALID, "of a part, mip has no accel but none and best");
    return status;
}

/* Sums of 64 voxels, and bounds of them, must be finite: floats are looked through once. */
static reference_status check_cubic(reference *r, vodr_error *error)
{
    static const float most = 1e36F;
    const float *values = r->volume.voxels;
    const int32_t *dims = r->volume.dims_vox;
    const size_t count = (size_t)dims[0] * (size_t)dims[1] * (size_t)dims[2];
    for (size_t i = 0; r->volume.type == REFERENCE_FLOAT32 && !r->has_largest && i < count; i++)
        r->largest = fmaxf(r->largest, fabsf(values[i]));
    r->has_largest = true;
    if (r->largest <= most)
        return REFERENCE_OK;
    return reference_fail(error, REFERENCE_INVALID,
                          "the volume has a voxel of magnitude %g, must have at most %g for a cubic filter",
                          (double)r->largest, (double)most);
}

/* The table in the numbers it is used in, with copies of its last entries behind (kernel_types.h). */
static void *convert_table(const reference_march_job *job)
{
    const reference_table *t = &job->table;
    const bool wide = job->numbers == REFERENCE_DOUBLE;
    size_t across = (size_t)t->columns + 1, down = (size_t)t->rows + 1;
    void *rgba = malloc(4 * across * down * (wide ? sizeof(double) : sizeof(float)));
    for (size_t i = 0; rgba && i < 4 * across * down; i++) {
        size_t column = i / 4 % across, row = i / 4 / across;
        column -= column == across - 1;
        row -= row == down - 1;
        double value = t->rgba[4 * (row * (across - 1) + column) + i % 4];
        if (wide)
            ((double *)rgba)[i] = value;
        else
            ((float *)rgba)[i] = (float)value;
    }
    return rgba;
}

static bool column_shows(const reference_table *t, int32_t column)
{
    for (int32_t row = 0; row < t->rows; row++)
        if (t->rgba[4 * ((size_t)row * (size_t)t->columns + (size_t)column) + 3] > 0)
            return true;
    return false;
}

/* The columns at which the function begins and ceases to show something; far outside where it does so at its end. */
static void find_visible(const reference_table *t, double *first, double *last)
{
    int32_t lo = 0, hi = t->columns - 1;
    while (lo < t->columns && !column_shows(t, lo))
        lo++;
    while (hi >= 0 && !column_shows(t, hi))
        hi--;
    *first = lo == 0 ? -1e30 : lo - 1;
    *last = hi == t->columns - 1 ? 1e30 : hi + 1;
}

/* ---- what is passed over ---- */

enum { CUBIC_BLOCK_VOX = 8 }; /* of best */

/* What the blocks of a job are made of. */
static blocks_kind kind_of(const reference *r, const reference_march_job *job)
{
    const int32_t *dims = r->volume.dims_vox;
    const bool cubic = reference_is_cubic(job->filter), best = job->accel == REFERENCE_ACCEL_BEST;
    const int64_t cells = ((int64_t)dims[0] + 1) * (dims[1] + 1) * (dims[2] + 1);
    return (blocks_kind){
        .filter = cubic ? job->filter : REFERENCE_LINEAR,
        .edge_vox = cubic && best ? CUBIC_BLOCK_VOX : job->block_vox,
        .bound = job->accel == REFERENCE_ACCEL_RIVAL    ? HULL_RIVAL
                 : job->accel == REFERENCE_ACCEL_UNSAFE ? HULL_UNSAFE
                                                        : HULL_BEZIER,
        .cells = cubic && best && cells <= INT32_MAX,
    };
}

static reference_status need_ranges(reference *r, blocks_kind k, reference_stats *stats, vodr_error *error)
{
    reference_status status = blocks_alloc(&r->volume, k.edge_vox, &r->blocks, error);
    if (status != REFERENCE_OK)
        return status;
    blocks *b = &r->blocks;
    const device_ranges ranges = {.spline = k.filter == REFERENCE_BSPLINE,
                                  .cells = k.cells,
                                  .bound = k.bound,
                                  .edge_vox = k.edge_vox,
                                  .count = {b->count[0], b->count[1], b->count[2]},
                                  .least = b->least,
                                  .most = b->most,
                                  .scale = &r->scale};
    return r->ops->ranges(r->state, &ranges, stats, error);
}

static reference_status need_blocks(reference *r, const reference_march_job *job, reference_stats *stats,
                                    vodr_error *error)
{
    const blocks_kind k = kind_of(r, job);
    const blocks_kind *had = &r->kind;
    reference_status status;
    if (r->blocks.least && had->filter == k.filter && had->edge_vox == k.edge_vox && had->bound == k.bound &&
        (had->cells || !k.cells))
        return REFERENCE_OK;
    blocks_free(&r->blocks);
    r->kind = k;
    if (reference_is_cubic(k.filter)) {
        status = need_ranges(r, k, stats, error);
    } else {
        const double begin_ms = reference_now_ms();
        status = blocks_make(&r->volume, k.edge_vox, &r->blocks, error);
        stats->preprocess_ms += reference_now_ms() - begin_ms;
    }
    if (status != REFERENCE_OK)
        blocks_free(&r->blocks);
    return status;
}

/* Whether a job needs blocks from here: those of a maximum of linear samples are the device's own. */
static bool has_blocks(const reference_march_job *job)
{
    return job->accel != REFERENCE_ACCEL_NONE && (job->blend != REFERENCE_MIP || reference_is_cubic(job->filter));
}

/* What a transfer function, or a maximum, makes of the blocks of a job. r->shown has room for the codes of both. */
static reference_status classify_blocks(reference *r, const reference_march_job *job, kernel_frame *f,
                                        vodr_error *error)
{
    const blocks_kind k = r->kind;
    blocks *b = &r->blocks;
    f->blocks.edge_vox = b->edge_vox;
    memcpy(f->blocks.count, b->count, sizeof b->count);
    if (job->blend == REFERENCE_MIP) {
        free(r->shown);
        r->shown = malloc(blocks_count(b) * sizeof(uint16_t));
        if (!r->shown)
            return reference_fail(error, REFERENCE_NO_MEMORY, "no memory for %zu blocks", blocks_count(b));
        blocks_encode(b, r->scale, r->shown, &f->bounds);
        f->blocks.most = r->shown;
        f->blocks.seeds = job->accel == REFERENCE_ACCEL_BEST;
        if (k.cells && job->accel == REFERENCE_ACCEL_BEST) {
            f->cells.step = 1 / (double)r->scale.inverse;
            f->cells.base = hull_greatest(r->scale, 0);
        }
        return REFERENCE_OK;
    }
    reference_status status = blocks_classify(b, &job->table, job->window_scale, job->window_offset,
                                              job->accel == REFERENCE_ACCEL_BEST, error);
    f->blocks.distance = b->distance;
    f->skip = KERNEL_SKIP_EMPTY;
    if (status != REFERENCE_OK || job->accel != REFERENCE_ACCEL_BEST || !k.cells)
        return status;
    free(r->shown);
    r->shown = malloc(CELL_CODES);
    if (!r->shown)
        return reference_fail(error, REFERENCE_NO_MEMORY, "no memory for the codes of cells");
    f->skip = KERNEL_SKIP_CELLS;
    f->cells.shows = r->shown;
    return blocks_classify_cells(r->scale, &job->table, job->window_scale, job->window_offset, r->shown, error);
}

/* ---- a frame ---- */

static kernel_table table_of(const reference_march_job *job, const void *rgba)
{
    const reference_table *t = &job->table;
    kernel_table k = {.columns = t->columns,
                      .rows = t->rows,
                      .rgba = rgba,
                      .scale = job->window_scale,
                      .offset = job->window_offset,
                      .gradient_scale = t->rows > 1 ? fabs(job->window_scale) / t->gradient_most : 0};
    find_visible(t, &k.first, &k.last);
    return k;
}

static kernel_mode mode_of(const reference *r, const reference_march_job *job, const kernel_part *part)
{
    kernel_bounds bounds;
    if (job->blend == REFERENCE_MIP && job->accel == REFERENCE_ACCEL_NONE)
        return KERNEL_MIP;
    if (job->blend == REFERENCE_MIP && job->accel == REFERENCE_ACCEL_BEST && !reference_is_cubic(job->filter) &&
        bounds_shape(r->volume.dims_vox, true, &bounds) > 0)
        return KERNEL_SEARCH;
    if (job->blend == REFERENCE_MIP)
        return part_is_whole(part, r->volume.dims_vox) ? KERNEL_LEAP : KERNEL_MIP;
    return job->shading == REFERENCE_PHONG || job->table.rows > 1 ? KERNEL_LIT : KERNEL_OVER;
}

static kernel_filter filter_of(const reference_march_job *job)
{
    if (job->filter == REFERENCE_NEAREST)
        return KERNEL_NEAREST;
    if (reference_is_cubic(job->filter))
        return KERNEL_CUBIC;
    return job->numbers == REFERENCE_TEXTURE ? KERNEL_TEXTURE : KERNEL_LINEAR;
}

/* The blocks that a device makes itself. */
static kernel_blocks blocks_of(const reference *r, const reference_march_job *job)
{
    kernel_blocks b = {.edge_vox = job->block_vox,
                       .bisects = job->accel >= REFERENCE_ACCEL_BISECT,
                       .seeds = job->accel >= REFERENCE_ACCEL_SEED};
    for (int a = 0; a < 3; a++)
        b.count[a] = bounds_count(r->volume.dims_vox[a], job->block_vox);
    return b;
}

/* A frame of a job whose accel says nothing of alignment. */
static reference_status march(reference *r, const reference_march_job *job, const device_alignment *alignment,
                              const kernel_order *order, double *rgba, reference_stats *stats, vodr_error *error)
{
    kernel_part part;
    reference_status status = check_part(r, job, &part, error);
    if (status == REFERENCE_OK && reference_is_cubic(job->filter))
        status = check_cubic(r, error);
    if (status == REFERENCE_OK && has_blocks(job))
        status = need_blocks(r, job, stats, error);
    if (status != REFERENCE_OK)
        return status;
    const double begin_ms = reference_now_ms();
    void *table = convert_table(job);
    if (!table)
        return reference_fail(error, REFERENCE_NO_MEMORY, "no memory for the tables of the frame");
    const int32_t *dims = r->volume.dims_vox;
    device_march m = {.frame = {.camera = job->camera,
                                .order = *order,
                                .volume = {.dims_vox = {dims[0], dims[1], dims[2]},
                                           .type = r->volume.type,
                                           .voxels = r->volume.voxels,
                                           .stride = {1, dims[0], dims[0] * dims[1]},
                                           .spline = job->filter == REFERENCE_BSPLINE},
                                .part = part,
                                .table = table_of(job, table),
                                .filter = filter_of(job),
                                .termination = job->termination,
                                .phong = job->shading == REFERENCE_PHONG,
                                .stored = job->stored,
                                .surface_scale = fabs(job->window_scale) * surface_vox},
                      .alignment = *alignment,
                      .numbers = job->numbers,
                      .mode = mode_of(r, job, &part)};
    m.frame.blocks = blocks_of(r, job);
    if (has_blocks(job))
        status = classify_blocks(r, job, &m.frame, error);
    stats->prepare_ms = reference_now_ms() - begin_ms;
    if (status == REFERENCE_OK)
        status = r->ops->march(r->state, &m, rgba, stats, error);
    free(table);
    return status;
}

/* Draws the job's picture turned, and turns it back. */
static reference_status march_turned(reference *r, const reference_march_job *job, const device_alignment *alignment,
                                     double theta, double *rgba, reference_stats *stats, vodr_error *error)
{
    reference_march_job turned = *job;
    turned.camera = aligned_turn(&job->camera, theta);
    const size_t pixels = (size_t)turned.camera.width_px * (size_t)turned.camera.height_px;
    double *picture = malloc(4 * pixels * sizeof *picture);
    if (!picture)
        return reference_fail(error, REFERENCE_NO_MEMORY, "no memory for %zu pixels", pixels);
    const kernel_order order = aligned_order_usual(&turned.camera);
    reference_status status = march(r, &turned, alignment, &order, picture, stats, error);
    const double begin_ms = reference_now_ms();
    if (status == REFERENCE_OK)
        aligned_turn_back(&job->camera, &turned.camera, theta, picture, rgba);
    stats->turn_ms = reference_now_ms() - begin_ms;
    stats->theta_deg = theta * 180 / acos(-1);
    free(picture);
    return status;
}

reference_status reference_march(reference *r, const reference_march_job *job, double *rgba, reference_stats *stats,
                                 vodr_error *error)
{
    *stats = (reference_stats){0};
    reference_status status = check_march(r, job, error);
    if (status != REFERENCE_OK)
        return status;
    const bool paper = job->accel == REFERENCE_ACCEL_ALIGNED_PAPER;
    reference_march_job plain = *job;
    kernel_order order = aligned_order_usual(&job->camera);
    device_alignment alignment = {.copies = job->copies};
    if (reference_accel_is_aligned(job->accel)) {
        const reference_theta kind = paper ? job->theta : REFERENCE_THETA_BOX;
        const aligned_view view = aligned_view_of(&job->camera, r->volume.dims_vox, kind);
        plain.accel = job->accel == REFERENCE_ACCEL_ALIGNED_BEST ? REFERENCE_ACCEL_BEST : REFERENCE_ACCEL_NONE;
        alignment.wanted = true;
        alignment.sorted = paper;
        alignment.fast_axis = view.fast_axis;
        if (paper)
            return march_turned(r, &plain, &alignment, view.theta, rgba, stats, error);
        order = aligned_order_of(&job->camera, view.theta);
    }
    return march(r, &plain, &alignment, &order, rgba, stats, error);
}

reference_status reference_show_stored(const reference_march_job *job, double *rgba, size_t count, vodr_error *error)
{
    void *entries = convert_table(job);
    if (!entries)
        return reference_fail(error, REFERENCE_NO_MEMORY, "no memory for the tables of the frame");
    const kernel_table table = table_of(job, entries);
    part_show_stored(&table, job->numbers, rgba, count);
    free(entries);
    return REFERENCE_OK;
}
