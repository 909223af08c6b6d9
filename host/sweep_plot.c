/* sweep_plot.c - a sweep as a drawing: chooses it, and has gnuplot draw it. */
#include "sweep_plot.h"

#include <errno.h>
#include <math.h>
#include <string.h>

#include "gnuplot.h"
#include "output.h"
#include "text.h"

enum { HEAT_LEAST = 4, MOST_SERIES = 8 };

static const char *const type_names[] = {
    [SWEEP_PLOT_LINE] = "line", [SWEEP_PLOT_BAR] = "bar", [SWEEP_PLOT_HEAT] = "heat", [SWEEP_PLOT_PARETO] = "pareto"};

host_status sweep_plot_option(sweep_plot *p, const option *o, const char *value, host_error *error)
{
    if (strcmp(o->name, "plot") == 0) {
        p->path = value;
        return HOST_OK;
    }
    if (strcmp(o->name, "plot-y") == 0) {
        p->y = value;
        return HOST_OK;
    }
    p->type_given = value;
    for (int i = SWEEP_PLOT_LINE; i <= SWEEP_PLOT_PARETO; i++)
        if (strcmp(type_names[i], value) == 0) {
            p->type = (sweep_plot_type)i;
            return HOST_OK;
        }
    return option_refuse(o, value, "line, bar, heat or pareto", error);
}

static bool is_view(const sweep_plan *plan, size_t axis)
{
    const size_t n = sweep_plan_find(plan, "view");
    return n < plan->name_count && plan->names[n].axis == axis;
}

double sweep_plot_number(const sweep_plan *plan, size_t axis, size_t i)
{
    const sweep_axis *a = &plan->axes[axis];
    double number[3];
    if (a->names != 1)
        return NAN;
    if (is_view(plan, axis))
        return text_numbers(a->values[i], ',', 2, 3, number) ? number[0] : NAN;
    return text_number(a->values[i], -HUGE_VAL, HUGE_VAL, number) ? number[0] : NAN;
}

bool sweep_plot_is_numeric(const sweep_plan *plan, size_t axis)
{
    const sweep_axis *a = &plan->axes[axis];
    double first[3] = {0}, other[3];
    for (size_t i = 0; i < a->count; i++) {
        if (isnan(sweep_plot_number(plan, axis, i)))
            return false;
        if (!is_view(plan, axis))
            continue;
        memset(other, 0, sizeof other);
        text_numbers(a->values[i], ',', 2, 3, i ? other : first);
        if (i && (other[1] != first[1] || other[2] != first[2]))
            return false;
    }
    return true;
}

/* The axis with the most values of those that `fits`, but `except`; the number of axes when there is none. */
static size_t longest(const sweep_plan *plan, bool numeric, size_t except, size_t most)
{
    size_t best = plan->axis_count;
    for (size_t a = 0; a < plan->axis_count; a++) {
        const size_t count = plan->axes[a].count;
        if (a == except || count < 2 || count > most || (numeric && !sweep_plot_is_numeric(plan, a)))
            continue;
        if (best == plan->axis_count || count > plan->axes[best].count)
            best = a;
    }
    return best;
}

static void choose_axes(sweep_plot *p, const sweep_plan *plan)
{
    const size_t none = plan->axis_count;
    p->across = p->type == SWEEP_PLOT_BAR ? none : longest(plan, true, none, SIZE_MAX);
    if (p->across == none)
        p->across = longest(plan, false, none, SIZE_MAX);
    if (p->across == none)
        p->across = 0;
    size_t heat = longest(plan, p->type != SWEEP_PLOT_HEAT, p->across, SIZE_MAX);
    const bool numeric = sweep_plot_is_numeric(plan, p->across);
    const bool two_long =
        heat != none && plan->axes[heat].count >= HEAT_LEAST && plan->axes[p->across].count >= HEAT_LEAST && numeric;
    if (p->type == SWEEP_PLOT_AUTO)
        p->type = two_long ? SWEEP_PLOT_HEAT : numeric ? SWEEP_PLOT_LINE : SWEEP_PLOT_BAR;
    p->series = p->type == SWEEP_PLOT_HEAT ? heat : longest(plan, false, p->across, MOST_SERIES);
}

static host_status choose_column(sweep_plot *p, const sweep_plan *plan, const sweep_columns *c,
                                 const sweep_objectives *o, host_error *error)
{
    const char *name = p->y;
    if (!name && o->count)
        name = c->names[o->column[0]];
    if (!name)
        name = sweep_columns_find(c, "cycles") < c->count ? "cycles" : "offchip_bytes";
    p->column = sweep_columns_find(c, name);
    if (p->column == c->count || !sweep_column_is_number(c, plan, p->column))
        return host_fail(error, HOST_BAD_INPUT, "--plot-y: there is no column '%.64s' of numbers", name);
    return HOST_OK;
}

host_status sweep_plot_prepare(sweep_plot *p, const sweep_plan *plan, const sweep_columns *c, const sweep_objectives *o,
                               host_error *error)
{
    if (!p->path)
        return p->type_given || p->y
                   ? host_fail(error, HOST_BAD_INPUT, "--plot-%s needs --plot OUT.svg", p->type_given ? "type" : "y")
                   : HOST_OK;
    if (p->type == SWEEP_PLOT_PARETO && o->count < 2)
        return host_fail(error, HOST_BAD_INPUT, "--plot-type 'pareto': needs two columns in --objective");
    if (p->type == SWEEP_PLOT_AUTO && o->count >= 2 && !p->y)
        p->type = SWEEP_PLOT_PARETO;
    if (p->type != SWEEP_PLOT_PARETO)
        choose_axes(p, plan);
    if (p->type == SWEEP_PLOT_HEAT && p->series == plan->axis_count)
        return host_fail(error, HOST_BAD_INPUT, "--plot-type 'heat': needs two axes that vary");
    if (p->type == SWEEP_PLOT_LINE && !sweep_plot_is_numeric(plan, p->across))
        return host_fail(error, HOST_BAD_INPUT, "--plot-type 'line': needs an axis of numbers");
    host_status status = choose_column(p, plan, c, o, error);
    return status == HOST_OK ? gnuplot_check(error) : status;
}

static host_status draw(void *script, output *o, host_error *error)
{
    return gnuplot_run(script, o->file, error);
}

host_status sweep_plot_write(const sweep_plot *p, const sweep_plan *plan, const sweep_columns *c,
                             const sweep_objectives *o, const sweep_rows *r, host_error *error)
{
    FILE *script = tmpfile();
    if (!script)
        return host_fail(error, HOST_ENVIRONMENT, "cannot write a file for gnuplot: %s", strerror(errno));
    host_status status = sweep_plot_script(script, p, plan, c, o, r, error);
    if (status == HOST_OK && fflush(script) != 0)
        status = host_fail(error, HOST_ENVIRONMENT, "cannot write a file for gnuplot: %s", strerror(errno));
    if (status == HOST_OK)
        status = output_write(p->path, draw, script, error);
    fclose(script);
    return status;
}
