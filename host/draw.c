/* draw.c - a scene drawn on a machine and timed, with a progress line on a terminal. */
#include "draw.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static double now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + (double)t.tv_nsec * 1e-9;
}

typedef struct progress_line {
    const char *label;
    double begin_s;
    int percent; /* as shown; -1: nothing yet */
} progress_line;

static void show_progress(void *context, double done)
{
    progress_line *line = context;
    int percent = (int)(100 * done);
    if (percent == line->percent || now_s() - line->begin_s < 1)
        return;
    fprintf(stderr, "\r%s: %3d %%", line->label, percent);
    line->percent = percent;
}

static void clear_progress(const progress_line *line)
{
    if (line->percent >= 0)
        fprintf(stderr, "\r%*s\r", (int)strlen(line->label) + 7, "");
}

static int compare_times(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *times, int count)
{
    qsort(times, (size_t)count, sizeof *times, compare_times);
    return (times[(count - 1) / 2] + times[count / 2]) / 2;
}

static host_status draw_once(const scene *s, const vodr_machine *machine, const vodr_options *how, result *r,
                             double *wall_s, host_error *error)
{
    vodr_error reason;
    vodr_frame_free(&r->frame);
    double begin_s = now_s();
    vodr_status status =
        vodr_render(machine, &s->densities, &s->table, &s->view, how, &r->frame, &r->counters, &reason);
    *wall_s = now_s() - begin_s;
    if (status == VODR_OK)
        return HOST_OK;
    return host_fail(error, status == VODR_NO_MEMORY ? HOST_ENVIRONMENT : HOST_BAD_INPUT, "%s", reason.text);
}

host_status draw(const scene *s, const vodr_machine *machine, const draw_options *how, result *r, host_error *error)
{
    progress_line line = {.label = how->label, .begin_s = now_s(), .percent = -1};
    vodr_options options = {.threads = how->threads,
                            .path = how->path,
                            .simd = how->simd,
                            .cycles = how->cycles,
                            .observer = how->observer};
    if (isatty(STDERR_FILENO)) {
        options.progress = show_progress;
        options.progress_context = &line;
    }
    double *times = malloc((size_t)how->repeat * sizeof *times);
    if (!times)
        return host_fail(error, HOST_ENVIRONMENT, "no memory");
    host_status status = HOST_OK;
    for (int i = 0; status == HOST_OK && i < how->repeat; i++)
        status = draw_once(s, machine, &options, r, &times[i], error);
    clear_progress(&line);
    if (status == HOST_OK)
        r->wall_s = median(times, how->repeat);
    r->repeat = how->repeat;
    free(times);
    return status == HOST_OK ? digest_frame(&r->frame, r->frame_sha256, error) : status;
}
