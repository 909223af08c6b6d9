/* device_cpu.c - the CPU as a device: bands of rows, or of layers, dealt out to threads. */
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#include "cells.h"
#include "cpu_march.h"
#include "device.h"
#include "kernel_fixed.h"

enum { BAND = CPU_TILE_PX, MAX_THREADS = 256 };

typedef struct cpu_state {
    int32_t threads;
    vodr_simd simd;
    reference_volume volume;
    void *cells; /* owned; NULL until a frame needs them */
} cpu_state;

/* Work in rows: `work` is called for bands of them until none is left. */
typedef struct cpu_job cpu_job;
struct cpu_job {
    void (*work)(const cpu_job *job, int32_t begin, int32_t end, uint64_t *samples);
    const void *input; /* what the work is on: a kernel_fixed, a kernel_frame or a reference_volume */
    void *output;
    cpu_march_rows *march_rows;
    int32_t rows;
    pthread_mutex_t lock; /* over what follows */
    int32_t next;
    uint64_t samples;
};

static double now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

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

static void *thread_main(void *context)
{
    cpu_job *job = context;
    uint64_t samples = 0;
    for (;;) {
        pthread_mutex_lock(&job->lock);
        int32_t begin = job->next, end = job->rows - begin > BAND ? begin + BAND : job->rows;
        job->next = end;
        if (begin == end)
            job->samples += samples;
        pthread_mutex_unlock(&job->lock);
        if (begin == end)
            return NULL;
        job->work(job, begin, end, &samples);
    }
}

/* Returns milliseconds. A thread that cannot be started is done without. */
static double run(const cpu_state *s, cpu_job *job)
{
    pthread_t threads[MAX_THREADS];
    int32_t started = 0;
    double begin_ms = now_ms();
    pthread_mutex_init(&job->lock, NULL);
    while (started < s->threads - 1 && pthread_create(&threads[started], NULL, thread_main, job) == 0)
        started++;
    thread_main(job);
    while (started > 0)
        pthread_join(threads[--started], NULL);
    pthread_mutex_destroy(&job->lock);
    return now_ms() - begin_ms;
}

static reference_status cpu_open(const reference_options *options, const reference_volume *volume, void **state,
                                 char name[DEVICE_NAME_CHARS], vodr_error *error)
{
    long threads = options->threads > 0 ? options->threads : sysconf(_SC_NPROCESSORS_ONLN);
    cpu_state *s = malloc(sizeof *s);
    if (!s)
        return reference_fail(error, REFERENCE_NO_MEMORY, "no memory for the reference renderer");
    *s = (cpu_state){(int32_t)(threads < 1             ? 1
                               : threads > MAX_THREADS ? MAX_THREADS
                                                       : threads),
                     options->simd, *volume, NULL};
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
    s->cells = cells_alloc(&s->volume);
    if (!s->cells)
        return reference_fail(error, REFERENCE_NO_MEMORY, "no memory for %zu MiB of packed cells",
                              (cells_bytes(&s->volume) >> 20) + 1);
    cpu_job job = {.work = fill_layers, .input = &s->volume, .output = s->cells, .rows = s->volume.dims_vox[2] + 1};
    stats->preprocess_ms += run(s, &job);
    return REFERENCE_OK;
}

static reference_status cpu_march(void *state, const device_march *m, double *rgba, reference_stats *stats,
                                  vodr_error *error)
{
    cpu_state *s = state;
    const cpu_kernels *k = m->numbers == REFERENCE_DOUBLE ? &cpu_kernels_double : &cpu_kernels_float;
    kernel_frame f = m->frame;
    if (m->numbers == REFERENCE_FLOAT && f.filter == KERNEL_LINEAR && cells_suit(&s->volume))
        k = cpu_kernels_best(s->simd);
    if (k->cells) {
        reference_status status = need_cells(s, stats, error);
        if (status != REFERENCE_OK)
            return status;
        f.filter = KERNEL_CELLS;
        f.volume.cells = s->cells;
    }
    cpu_job job = {
        .work = march_rows, .input = &f, .output = rgba, .march_rows = k->march[m->mode], .rows = f.camera.height_px};
    stats->draw_ms = run(s, &job);
    stats->samples = job.samples;
    return REFERENCE_OK;
}

static void cpu_close(void *state)
{
    cpu_state *s = state;
    free(s->cells);
    free(s);
}

const device_ops device_cpu = {cpu_open, cpu_close, cpu_fixed, cpu_march};
