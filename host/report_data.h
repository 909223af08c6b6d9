/* report_data.h - what a report tells, and the part of it that is not in the statistics, as JSON for its page. */
#ifndef HOST_REPORT_DATA_H
#define HOST_REPORT_DATA_H

#include <jansson.h>

#include "draw.h"
#include "report_trace.h"
#include "scene.h"
#include "view_options.h"

enum { REPORT_PEERS = 3 };

/* The same frame on one of the paper's machines. */
typedef struct report_peer {
    const char *machine;
    bool same_frame; /* to the byte */
    vodr_counters counters;
} report_peer;

/* Nothing in it is owned. */
typedef struct report {
    const scene *scene;
    const view_options *options;
    const result *result;
    const report_trace *trace;
    const report_peer *peers; /* REPORT_PEERS */
    const char *command;      /* that repeats it, quoted for a shell */
} report;

/* The machine that a report's parameters are compared with. */
#define REPORT_BASELINE "paper-16"

/* Made for the script of report_script.c alone; NULL when memory is out. */
json_t *report_json(const report *r);

#endif
