/* report_trace.c - what a report remembers of a frame as it is drawn: where misses fell, and the order of visits. */
#include "report_trace.h"

#include <stdlib.h>

static void on_miss(void *context, int32_t x_px, int32_t y_px)
{
    report_trace *t = context;
    t->misses++;
    t->tile_misses[(size_t)(y_px / REPORT_TILE_PX) * (size_t)t->columns + (size_t)(x_px / REPORT_TILE_PX)]++;
}

static void on_visit(void *context, const vodr_visit *visit)
{
    report_trace *t = context;
    uint64_t number = t->visits++;
    if (number % t->stride != 0)
        return;
    if (t->count == REPORT_VISITS) {
        for (size_t i = 0; i < REPORT_VISITS / 2; i++)
            t->kept[i] = t->kept[2 * i];
        t->count = REPORT_VISITS / 2;
        t->stride *= 2;
    }
    t->kept[t->count++] = (report_visit){visit->brick, visit->x0_px, visit->y0_px, t->misses};
}

host_status report_trace_start(report_trace *t, const vodr_view *view, host_error *error)
{
    *t = (report_trace){.columns = (view->width_px + REPORT_TILE_PX - 1) / REPORT_TILE_PX,
                        .rows = (view->height_px + REPORT_TILE_PX - 1) / REPORT_TILE_PX,
                        .stride = 1};
    t->tile_misses = calloc((size_t)t->columns * (size_t)t->rows, sizeof *t->tile_misses);
    t->kept = malloc(REPORT_VISITS * sizeof *t->kept);
    if (t->tile_misses && t->kept)
        return HOST_OK;
    report_trace_free(t);
    return host_fail(error, HOST_ENVIRONMENT, "no memory for the report's record of visits and misses");
}

void report_trace_free(report_trace *t)
{
    free(t->tile_misses);
    free(t->kept);
    *t = (report_trace){0};
}

vodr_observer report_trace_observer(report_trace *t)
{
    return (vodr_observer){.context = t, .visit = on_visit, .miss = on_miss};
}
