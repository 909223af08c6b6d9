/* draw.c - a scene drawn on a machine and timed, with a progress line on a terminal. */
#include "draw.h"

#include <stdlib.h>

#include "progress.h"

static int compare_times(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double draw_median(double *times, int count)
{
    qsort(times, (size_t)count, sizeof *times, compare_times);
    return (times[(count - 1) / 2] + times[count / 2]) / 2;
}

static void begin(void *begin_s)
{
    *(double *)begin_s = progress_now_s();
}

/* *begin_s becomes when drawing began: building libraries is no part of it. */
static host_status draw_cosim(const scene *s, const vodr_machine *machine, const vodr_options *how,
                              const cosim_options *cosim, result *r, double *begin_s, host_error *error)
{
    static const host_status of[] = {[RTL_OK] = HOST_OK,
                                     [RTL_DIFFERS] = HOST_DIFFERENT,
                                     [RTL_INVALID] = HOST_BAD_INPUT,
                                     [RTL_NO_MEMORY] = HOST_ENVIRONMENT,
                                     [RTL_ENVIRONMENT] = HOST_ENVIRONMENT};
    vodr_error reason;
    cosim_options options = *cosim;
    options.begin = begin;
    options.begin_context = begin_s;
    options.progress = how->progress;
    options.progress_context = how->progress_context;
    options.observer = how->observer;
    rtl_status status =
        cosim_render(machine, &s->densities, &s->table, &s->view, &options, &r->frame, &r->counters, &reason);
    return status == RTL_OK ? HOST_OK : host_fail(error, of[status], "%s", reason.text);
}

static host_status draw_c(const scene *s, const vodr_machine *machine, const vodr_options *how, result *r,
                          host_error *error)
{
    vodr_error reason;
    vodr_status status =
        vodr_render(machine, &s->densities, &s->table, &s->view, how, &r->frame, &r->counters, &reason);
    if (status == VODR_OK)
        return HOST_OK;
    return host_fail(error, status == VODR_NO_MEMORY ? HOST_ENVIRONMENT : HOST_BAD_INPUT, "%s", reason.text);
}

static host_status draw_once(const scene *s, const vodr_machine *machine, const vodr_options *how,
                             const cosim_options *cosim, result *r, double *wall_s, host_error *error)
{
    vodr_frame_free(&r->frame);
    double begin_s = progress_now_s();
    host_status status =
        cosim ? draw_cosim(s, machine, how, cosim, r, &begin_s, error) : draw_c(s, machine, how, r, error);
    *wall_s = progress_now_s() - begin_s;
    return status;
}

host_status draw(const scene *s, const vodr_machine *machine, const draw_options *how, result *r, host_error *error)
{
    progress line = progress_begin(how->label);
    vodr_options options = {.threads = how->threads,
                            .path = how->path,
                            .simd = how->simd,
                            .cycles = how->cycles,
                            .observer = how->observer};
    if (line.shown) {
        options.progress = progress_show;
        options.progress_context = &line;
    }
    double *times = malloc((size_t)how->repeat * sizeof *times);
    if (!times)
        return host_fail(error, HOST_ENVIRONMENT, "no memory");
    host_status status = HOST_OK;
    for (int i = 0; status == HOST_OK && i < how->repeat; i++)
        status = draw_once(s, machine, &options, how->cosim, r, &times[i], error);
    progress_end(&line);
    if (status == HOST_OK)
        r->wall_s = draw_median(times, how->repeat);
    r->repeat = how->repeat;
    free(times);
    return status == HOST_OK ? digest_frame(&r->frame, r->frame_sha256, error) : status;
}
