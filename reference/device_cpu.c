/* device_cpu.c - the CPU as a device: bands of rows dealt out to threads. */
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#include "cpu_march.h"
#include "device.h"
#include "kernel_fixed.h"

enum { BAND_PX = 4 * CPU_TILE_PX, MAX_THREADS = 256 };

typedef struct cpu_state {
    int32_t threads;
    vodr_simd simd;
} cpu_state;

/* One frame: `draw` is called for bands of rows until none is left. */
typedef struct cpu_job {
    const kernel_fixed *fixed; /* one of these two */
    const device_march *march;
    cpu_march_rows *march_rows;
    vodr_rgba *pixels;
    double *rgba;
    int32_t height_px;
    pthread_mutex_t lock; /* over what follows */
    int32_t next_px;
    uint64_t samples;
} cpu_job;

static double now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

static void fixed_rows(const kernel_fixed *f, int32_t y0, int32_t y1, vodr_rgba *pixels, uint64_t *samples)
{
    for (int32_t y = y0; y < y1; y++)
        for (int32_t x = 0; x < f->view.width_px; x++) {
            uint32_t fragments = 0;
            pixels[(size_t)y * (size_t)f->view.width_px + (size_t)x] = fixed_pixel(f, x, y, &fragments);
            *samples += fragments;
        }
}

static void *thread_main(void *context)
{
    cpu_job *job = context;
    uint64_t samples = 0;
    for (;;) {
        pthread_mutex_lock(&job->lock);
        int32_t y0 = job->next_px, y1 = job->height_px - y0 > BAND_PX ? y0 + BAND_PX : job->height_px;
        job->next_px = y1;
        if (y0 == y1)
            job->samples += samples;
        pthread_mutex_unlock(&job->lock);
        if (y0 == y1)
            return NULL;
        if (job->march)
            job->march_rows(&job->march->frame, y0, y1, job->rgba, &samples);
        else
            fixed_rows(job->fixed, y0, y1, job->pixels, &samples);
    }
}

/* A thread that cannot be started is done without. */
static void run(const cpu_state *s, cpu_job *job, reference_stats *stats)
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
    stats->draw_ms = now_ms() - begin_ms;
    stats->samples = job->samples;
}

static reference_status cpu_open(const reference_options *options, const reference_volume *volume, void **state,
                                 char name[DEVICE_NAME_CHARS], vodr_error *error)
{
    (void)volume;
    long threads = options->threads > 0 ? options->threads : sysconf(_SC_NPROCESSORS_ONLN);
    cpu_state *s = malloc(sizeof *s);
    if (!s)
        return reference_fail(error, REFERENCE_NO_MEMORY, "no memory for the reference renderer");
    *s = (cpu_state){(int32_t)(threads < 1 ? 1 : threads > MAX_THREADS ? MAX_THREADS : threads), options->simd};
    snprintf(name, DEVICE_NAME_CHARS, "CPU, %d thread%s, %s", s->threads, s->threads > 1 ? "s" : "",
             cpu_kernels_float(s->simd)->name);
    *state = s;
    return REFERENCE_OK;
}

static reference_status cpu_fixed(void *state, const kernel_fixed *f, vodr_rgba *pixels, reference_stats *stats,
                                  vodr_error *error)
{
    (void)error;
    cpu_job job = {.fixed = f, .pixels = pixels, .height_px = f->view.height_px};
    run(state, &job, stats);
    return REFERENCE_OK;
}

static reference_status cpu_march(void *state, const device_march *m, double *rgba, reference_stats *stats,
                                  vodr_error *error)
{
    (void)error;
    const cpu_state *s = state;
    const cpu_kernels *k = m->numbers == REFERENCE_DOUBLE ? cpu_kernels_double(s->simd) : cpu_kernels_float(s->simd);
    cpu_job job = {
        .march = m, .march_rows = k->march[m->mode][m->skip], .rgba = rgba, .height_px = m->frame.camera.height_px};
    run(s, &job, stats);
    return REFERENCE_OK;
}

const device_ops device_cpu = {cpu_open, free, cpu_fixed, cpu_march};
