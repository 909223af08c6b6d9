/* sweep_plan.h - the points of a sweep: the product of axes, each a list of values of one name, or of several names
 * that vary together (--list). */
#ifndef HOST_SWEEP_PLAN_H
#define HOST_SWEEP_PLAN_H

#include "host.h"
#include "options.h"
#include "view_options.h"

typedef enum sweep_kind {
    SWEEP_VOLUME,
    SWEEP_VIEW,      /* an option of option_view, or `machine`; its target is a view_options */
    SWEEP_CROP,      /* its target is a volume_options */
    SWEEP_PARAMETER, /* of the machine */
} sweep_kind;

/* What varies, as it is called on the command line and in the CSV. */
typedef struct sweep_name {
    char *name; /* owned */
    sweep_kind kind;
    const option *option;            /* SWEEP_VIEW, SWEEP_CROP */
    const vodr_parameter *parameter; /* SWEEP_PARAMETER */
    size_t axis, column;             /* which of the axes, which of its names */
} sweep_name;

typedef struct sweep_axis {
    size_t names, count;
    char **values; /* value i of name n is values[i*names + n]; owned */
    size_t cells;  /* of values: names*count, more while a line is read */
} sweep_axis;

enum { SWEEP_AXES = 64 };

typedef struct sweep_plan {
    sweep_axis axes[SWEEP_AXES];
    size_t axis_count;
    sweep_name names[SWEEP_AXES]; /* in the order of the command line, a volume axis of operands first */
    size_t name_count;
    size_t slow_first[SWEEP_AXES]; /* axes, those that change what is loaded before the others */
    uint64_t points;
} sweep_plan;

#define SWEEP_MAX_POINTS UINT64_C(100000000)

/* Adds an axis: `PARAM=V1,V2,...`. Values are parted by ';' where there is one, or where the option's values have
 * commas of their own (view, crop). `view=orbit:N[:EL]` is N views around. Every value but a volume's is checked. */
host_status sweep_plan_over(sweep_plan *p, const char *text, host_error *error);

/* Adds an axis of several names from a file: a line of names, then a line of values a point, parted by blanks. */
host_status sweep_plan_list(sweep_plan *p, const char *path, host_error *error);

/* Adds the volumes as the first, slowest axis. */
host_status sweep_plan_volumes(sweep_plan *p, const char *const *paths, size_t count, host_error *error);

/* Counts the points; to be called last. */
host_status sweep_plan_close(sweep_plan *p, host_error *error);

void sweep_plan_free(sweep_plan *p);

/* The value of name n at a point, of axis a. Points are numbered with the last axis fastest. */
size_t sweep_plan_index(const sweep_plan *p, size_t axis, uint64_t point);
const char *sweep_plan_value(const sweep_plan *p, size_t name, uint64_t point);

/* The names' index; name_count when there is none. */
size_t sweep_plan_find(const sweep_plan *p, const char *name);

/* The point to be drawn at turn 0, 1, ...: all points with one volume, crop, window, density follow each other, so that
 * few volumes need be in memory. */
uint64_t sweep_plan_turn(const sweep_plan *p, uint64_t turn);

#endif
