/* report_page.h - a report as one HTML page that needs nothing but itself. */
#ifndef HOST_REPORT_PAGE_H
#define HOST_REPORT_PAGE_H

#include "output.h"
#include "report_data.h"

/* Writes the page: the picture and all data lie in it, and its policy forbids the browser to load anything else. */
host_status report_page_write(output *o, const report *r, host_error *error);

/* The page's style sheet and script (report_style.c, report_script.c). */
extern const char report_style[], report_script[];

#endif
