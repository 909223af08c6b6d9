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

static host_status draw_once(const scene *s, const vodr_machine *machine, const vodr_options *how, result *r,
                             double *wall_s, host_error *error)
{
    vodr_error reason;
    vodr_frame_free(&r->frame);
    double begin_s = progress_now_s();
    vodr_status status =
        vodr_render(machine, &s->densities, &s->table, &s->view, how, &r->frame, &r->counters, &reason);
    *wall_s = progress_now_s() - begin_s;
    if (status == VODR_OK)
        return HOST_OK;
    return host_fail(error, status == VODR_NO_MEMORY ? HOST_ENVIRONMENT : HOST_BAD_INPUT, "%s", reason.text);
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
        status = draw_once(s, machine, &options, r, &times[i], error);
    progress_end(&line);
    if (status == HOST_OK)
        r->wall_s = draw_median(times, how->repeat);
    r->repeat = how->repeat;
    free(times);
    return status == HOST_OK ? digest_frame(&r->frame, r->frame_sha256, error) : status;
}
