/* device_cpu.c - the CPU as a device: bands of rows, or of layers, dealt out to threads. */
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "bounds.h"
#include "cells.h"
#include "cpu_cubic.h"
#include "cpu_job.h"
#include "cpu_layout.h"
#include "kernel_fixed.h"
#include "pages.h"

enum { ALIGNED_BAND = 4 * BAND };

typedef struct cpu_state {
    int32_t threads;
    vodr_simd simd;
    reference_volume volume;
    void *cells; /* owned; NULL until a frame needs them */
    bounds_code code;
    bool has_code;
    kernel_bounds bounds;  /* codes owned; NULL until a search needs them */
    uint16_t *block_codes; /* owned; of the last edge asked for */
    int32_t block_edge_vox;
    cpu_cubic cubic[2];              /* of cardinal splines, of B-splines */
    cpu_layout layouts[CPU_LAYOUTS]; /* the coefficients of B-splines, in copies that suit alignment */
} cpu_state;

static void fixed_rows(const cpu_job *job, int32_t y0, int32_t y1, uint64_t *samples)
{
    const kernel_fixed *f = job->input;
    vodr_rgba *pixels = job->output;
    for (int32_t y = y0; y < y1; y++)
        for (int32_t x = 0; x < f->view.width_px; x++) {
            uint32_t fragments = 0;
            pixels[(size_t)y * (size_t)f->view.width_px + (size_t)x] = fixed_pixel(f, x, y, &fragments);
            *samples += fragments;
        }
}

static void march_rows(const cpu_job *job, int32_t y0, int32_t y1, uint64_t *samples)
{
    job->march_rows(job->input, y0, y1, job->output, samples);
}

static void fill_layers(const cpu_job *job, int32_t z0, int32_t z1, uint64_t *samples)
{
    (void)samples;
    cells_fill(job->input, z0, z1, job->output);
}

static void fill_blocks(const cpu_job *job, int32_t l0, int32_t l1, uint64_t *samples)
{
    const cpu_state *s = job->input;
    (void)samples;
    bounds_fill(&s->volume, &s->code, job->grid, l0, l1, job->output);
}

static void fill_cells(const cpu_job *job, int32_t r0, int32_t r1, uint64_t *samples)
{
    const cpu_state *s = job->input;
    (void)samples;
    bounds_fill_cells(&s->volume, &s->code, &s->bounds, r0, r1, job->output);
}

static void halve_grid(const cpu_job *job, int32_t l0, int32_t l1, uint64_t *samples)
{
    const cpu_state *s = job->input;
    (void)samples;
    bounds_halve(&s->bounds, job->grid, l0, l1, job->output);
}

static void fill_near(const cpu_job *job, int32_t l0, int32_t l1, uint64_t *samples)
{
    const cpu_state *s = job->input;
    (void)samples;
    bounds_fill_near(&s->bounds, l0, l1, s->bounds.codes, job->output);
}

static void widen_layers(const cpu_job *job, int32_t l0, int32_t l1, uint64_t *samples)
{
    const cpu_state *s = job->input;
    (void)samples;
    bounds_widen_layers(&s->bounds, job->grid, l0, l1, job->output);
}

static void widen_rows(const cpu_job *job, int32_t j0, int32_t j1, uint64_t *samples)
{
    const cpu_state *s = job->input;
    (void)samples;
    bounds_widen_rows(&s->bounds, job->grid, j0, j1, job->output);
}

static double run(const cpu_state *s, cpu_job *job)
{
    return cpu_job_run(s->threads, job);
}

static reference_status cpu_open(const reference_options *options, const reference_volume *volume, void **state,
                                 char name[DEVICE_NAME_CHARS], vodr_error *error)
{
    long threads = options->threads > 0 ? options->threads : sysconf(_SC_NPROCESSORS_ONLN);
    cpu_state *s = malloc(sizeof *s);
    if (!s)
        return reference_fail(error, REFERENCE_NO_MEMORY, "no memory for the reference renderer");
    *s = (cpu_state){.threads = (int32_t)(threads < 1             ? 1
                                          : threads > MAX_THREADS ? MAX_THREADS
                                                                  : threads),
                     .simd = options->simd,
                     .volume = *volume};
    snprintf(name, DEVICE_NAME_CHARS, "CPU, %d thread%s, %s", s->threads, s->threads > 1 ? "s" : "",
             cpu_kernels_best(s->simd)->name);
    *state = s;
    return REFERENCE_OK;
}

static reference_status cpu_fixed(void *state, const kernel_fixed *f, vodr_rgba *pixels, reference_stats *stats,
                                  vodr_error *error)
{
    (void)error;
    cpu_job job = {.work = fixed_rows, .input = f, .output = pixels, .rows = f->view.height_px};
    stats->draw_ms = run(state, &job);
    stats->samples = job.samples;
    return REFERENCE_OK;
}

static reference_status need_cells(cpu_state *s, reference_stats *stats, vodr_error *error)
{
    if (s->cells)
        return REFERENCE_OK;
    s->cells = pages_alloc(cells_bytes(&s->volume));
    if (!s->cells)
        return reference_fail(error, REFERENCE_NO_MEMORY, "no memory for %zu MiB of packed cells",
                              (cells_bytes(&s->volume) >> 20) + 1);
    cpu_job job = {.work = fill_layers, .input = &s->volume, .output = s->cells, .rows = s->volume.dims_vox[2] + 1};
    stats->preprocess_ms += run(s, &job);
    return REFERENCE_OK;
}

/* ---- bounds ---- */

static void need_code(cpu_state *s)
{
    if (!s->has_code)
        s->code = bounds_code_of(&s->volume);
    s->has_code = true;
}

/* The codes of blocks for KERNEL_LEAP. */
static reference_status need_blocks(cpu_state *s, kernel_frame *f, vodr_error *error)
{
    const int32_t edge = f->blocks.edge_vox, *count = f->blocks.count;
    if (s->block_edge_vox != edge) {
        size_t codes = (size_t)count[0] * (size_t)count[1] * (size_t)count[2];
        free(s->block_codes);
        s->block_edge_vox = 0;
        s->block_codes = pages_alloc(codes * sizeof *s->block_codes);
        if (!s->block_codes)
            return reference_fail(error, REFERENCE_NO_MEMORY, "no memory for the maxima of %zu blocks", codes);
        cpu_job job = {.work = fill_blocks, .input = s, .output = s->block_codes, .rows = count[2], .grid = edge};
        run(s, &job);
        s->block_edge_vox = edge;
    }
    f->blocks.most = s->block_codes;
    return REFERENCE_OK;
}

static void run_grid(cpu_state *s, void (*work)(const cpu_job *, int32_t, int32_t, uint64_t *), int32_t grid,
                     int32_t rows, uint16_t *codes)
{
    cpu_job job = {.work = work, .input = s, .output = codes, .rows = rows, .grid = grid};
    run(s, &job);
}

/* The grids of KERNEL_SEARCH. A grid is widened once the next is made of its blocks. */
static reference_status need_grids(cpu_state *s, kernel_frame *f, vodr_error *error)
{
    kernel_bounds *b = &s->bounds;
    if (!b->codes) {
        size_t count = bounds_shape(s->volume.dims_vox, true, b);
        const size_t near = (size_t)b->count[1][0] * (size_t)b->count[1][1] * (size_t)b->count[1][2];
        uint16_t *codes = pages_alloc((count + near) * sizeof *codes);
        if (!codes)
            return reference_fail(error, REFERENCE_NO_MEMORY, "no memory for the maxima of %zu cells", count);
        run_grid(s, fill_cells, 0, bounds_bricks(b->count[0][2]), codes);
        b->codes = codes;
        b->near = codes + count;
        run_grid(s, fill_near, 1, b->count[1][2], codes + count);
        for (int32_t k = 2; k <= b->levels; k++) {
            if (k < b->levels)
                run_grid(s, halve_grid, k, b->count[k][2], codes);
            run_grid(s, widen_layers, k - 1, b->count[k - 1][2], codes);
            run_grid(s, widen_rows, k - 1, b->count[k - 1][1], codes);
        }
    }
    f->bounds = *b;
    return REFERENCE_OK;
}

/* What a maximum's ways past its blocks need. */
static reference_status need_bounds(cpu_state *s, kernel_mode mode, kernel_frame *f, reference_stats *stats,
                                    vodr_error *error)
{
    if ((mode != KERNEL_LEAP && mode != KERNEL_SEARCH) || f->filter == KERNEL_CUBIC)
        return REFERENCE_OK;
    const bool known = mode == KERNEL_SEARCH ? s->bounds.codes != NULL : s->block_edge_vox == f->blocks.edge_vox;
    const double begin_ms = reference_now_ms();
    need_code(s);
    reference_status status = mode == KERNEL_LEAP ? need_blocks(s, f, error) : need_grids(s, f, error);
    bounds_decode(&s->code, f->filter, &f->bounds);
    if (!known)
        stats->preprocess_ms += reference_now_ms() - begin_ms;
    return status;
}

/* ---- cubics ---- */

static reference_status cpu_ranges(void *state, const device_ranges *r, reference_stats *stats, vodr_error *error)
{
    cpu_state *s = state;
    const hull_rows *rows;
    cpu_cubic_best(s->simd, &rows);
    return cpu_cubic_ranges(&s->cubic[r->spline], &s->volume, r, s->threads, rows, stats, error);
}

static reference_status need_cubic(cpu_state *s, kernel_frame *f, reference_stats *stats, vodr_error *error)
{
    cpu_cubic *c = &s->cubic[f->volume.spline];
    reference_status status = cpu_cubic_volume(c, &s->volume, f->volume.spline, s->threads, stats, error);
    f->volume.type = c->volume.type;
    f->volume.voxels = c->volume.voxels;
    f->cells.codes = c->codes;
    return status;
}

/* Puts a copy of the coefficients in the place of them. Where there is no memory for one, they are read as they are.
 * The kernels of double read any copy in the order of the volume's axes, as a card does; those of float read rows of x,
 * so that it is the frame's axes that are named after a sorted copy's. */
static void align(cpu_state *s, const device_march *m, const cpu_kernels *k, kernel_frame *f, reference_stats *stats)
{
    const device_alignment *a = &m->alignment;
    const bool strides = m->numbers == REFERENCE_DOUBLE, sorted = a->sorted || strides;
    const kernel_layout layout = k->quads && !sorted ? KERNEL_QUADS : KERNEL_WIDE;
    const int32_t first = sorted ? a->fast_axis : 0;
    stats->copies = 1;
    if (sorted && a->copies == 1)
        return;
    const cpu_layout *copy = cpu_layout_of(s->layouts, &s->cubic[true].volume, layout, first, s->threads, stats);
    if (!copy)
        return;
    if (!strides)
        cpu_layout_turn_axes(f, first);
    for (int n = 0; n < 3; n++)
        f->volume.stride[strides ? (first + n) % 3 : n] = copy->stride[n];
    f->volume.layout = layout;
    f->volume.voxels = copy->first;
    stats->copies = sorted ? 3 : 1;
}

static const cpu_kernels *kernels_of(const cpu_state *s, const device_march *m)
{
    const bool is_double = m->numbers == REFERENCE_DOUBLE;
    const hull_rows *rows;
    if (m->frame.filter == KERNEL_CUBIC)
        return is_double ? &cpu_cubic_double : cpu_cubic_best(s->simd, &rows);
    if (m->numbers == REFERENCE_FLOAT && m->frame.filter == KERNEL_LINEAR && cells_suit(&s->volume))
        return cpu_kernels_best(s->simd);
    return is_double ? &cpu_kernels_double : &cpu_kernels_float;
}

/* Rows of a band: as many as share what is in a cache, but no fewer bands than keep all threads at work. */
static int32_t aligned_band(const cpu_state *s, int32_t rows)
{
    const int32_t share = rows / (4 * s->threads) / BAND * BAND;
    return share < BAND ? BAND : share > ALIGNED_BAND ? ALIGNED_BAND : share;
}

static reference_status cpu_march(void *state, const device_march *m, double *rgba, reference_stats *stats,
                                  vodr_error *error)
{
    cpu_state *s = state;
    const cpu_kernels *k = kernels_of(s, m);
    kernel_frame f = m->frame;
    reference_status status = need_bounds(s, m->mode, &f, stats, error);
    if (status == REFERENCE_OK && k->cells && m->mode != KERNEL_SEARCH) {
        status = need_cells(s, stats, error);
        f.filter = KERNEL_CELLS;
        f.volume.cells = s->cells;
    }
    if (status == REFERENCE_OK && f.filter == KERNEL_CUBIC)
        status = need_cubic(s, &f, stats, error);
    if (status != REFERENCE_OK)
        return status;
    if (m->alignment.wanted)
        align(s, m, k, &f, stats);
    cpu_job job = {.work = march_rows,
                   .input = &f,
                   .output = rgba,
                   .march_rows = k->march[m->mode],
                   .rows = f.order.rows,
                   .band = m->alignment.wanted ? aligned_band(s, f.order.rows) : BAND};
    stats->draw_ms = run(s, &job);
    stats->samples = job.samples;
    return REFERENCE_OK;
}

static void cpu_close(void *state)
{
    cpu_state *s = state;
    free(s->cells);
    free((void *)s->bounds.codes);
    free(s->block_codes);
    for (int i = 0; i < 2; i++)
        cpu_cubic_free(&s->cubic[i]);
    for (int i = 0; i < CPU_LAYOUTS; i++)
        cpu_layout_free(&s->layouts[i]);
    free(s);
}

const device_ops device_cpu = {cpu_open, cpu_close, cpu_fixed, cpu_march, cpu_ranges};
