/* report_trace.h - what a report remembers of a frame as it is drawn: where misses fell, and the order of visits. */
#ifndef HOST_REPORT_TRACE_H
#define HOST_REPORT_TRACE_H

#include "host.h"
#include "vodr.h"

/* Misses are counted in tiles of this edge; of many visits at most REPORT_VISITS are kept, evenly spread. */
enum { REPORT_TILE_PX = 32, REPORT_VISITS = 20000 };

typedef struct report_visit {
    uint64_t brick;
    int32_t x0_px, y0_px;   /* of what its fragments are clipped to */
    uint64_t misses_before; /* of the frame, when it began */
} report_visit;

typedef struct report_trace {
    int32_t columns, rows; /* of tiles */
    uint64_t *tile_misses; /* row by row; owned */
    uint64_t misses, visits;
    uint64_t stride;    /* kept[i] is visit i*stride */
    report_visit *kept; /* owned */
    size_t count;
} report_trace;

/* Makes room for a frame of the view; report_trace_free() on success. */
host_status report_trace_start(report_trace *t, const vodr_view *view, host_error *error);
void report_trace_free(report_trace *t);

/* Fills *t, which must outlive it, from one frame. */
vodr_observer report_trace_observer(report_trace *t);

#endif
