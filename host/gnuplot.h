/* gnuplot.h - runs gnuplot, which draws the plots of a sweep. */
#ifndef HOST_GNUPLOT_H
#define HOST_GNUPLOT_H

#include <stdio.h>

#include "host.h"

/* Whether gnuplot is there; HOST_ENVIRONMENT when not. */
host_status gnuplot_check(host_error *error);

/* Runs a script, rewound first; what gnuplot writes to its standard output goes to `out`. */
host_status gnuplot_run(FILE *script, FILE *out, host_error *error);

/* Writes text as a gnuplot string. */
void gnuplot_quote(FILE *script, const char *text);

#endif
