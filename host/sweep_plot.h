/* sweep_plot.h - a sweep as a drawing (--plot): what lies along which side, what is averaged. */
#ifndef HOST_SWEEP_PLOT_H
#define HOST_SWEEP_PLOT_H

#include "sweep_end.h"

typedef enum sweep_plot_type {
    SWEEP_PLOT_AUTO,
    SWEEP_PLOT_LINE,   /* over an axis of numbers, a line a value of a second axis */
    SWEEP_PLOT_BAR,    /* the same over an axis of words */
    SWEEP_PLOT_HEAT,   /* over two axes */
    SWEEP_PLOT_PARETO, /* the first two objectives, point by point */
} sweep_plot_type;

typedef struct sweep_plot {
    const char *path, *type_given, *y; /* NULL: not given */
    sweep_plot_type type;
    size_t column; /* what it shows */
    size_t across; /* axis along x */
    size_t series; /* axis of the lines, or along y; the number of axes: none */
} sweep_plot;

/* Stores --plot, --plot-type, --plot-y. */
host_status sweep_plot_option(sweep_plot *p, const option *o, const char *value, host_error *error);

/* Chooses type, axes and column; whether gnuplot is there. Does nothing without a path. */
host_status sweep_plot_prepare(sweep_plot *p, const sweep_plan *plan, const sweep_columns *c, const sweep_objectives *o,
                               host_error *error);

/* Draws it. The rows' values are the objectives', then the plot's column. */
host_status sweep_plot_write(const sweep_plot *p, const sweep_plan *plan, const sweep_columns *c,
                             const sweep_objectives *o, const sweep_rows *r, host_error *error);

/* ---- what sweep_plot.c and sweep_plot_script.c share ---- */

/* The number that value i of an axis stands for: itself, or a view's azimuth; not a number where it is a word. */
double sweep_plot_number(const sweep_plan *plan, size_t axis, size_t i);

/* Whether all values of an axis are numbers, of views: azimuths at one elevation. */
bool sweep_plot_is_numeric(const sweep_plan *plan, size_t axis);

/* Writes the script of a plot, data and all. */
host_status sweep_plot_script(FILE *script, const sweep_plot *p, const sweep_plan *plan, const sweep_columns *c,
                              const sweep_objectives *o, const sweep_rows *r, host_error *error);

#endif
