/* sweep.c - `vodr sweep`: many machines, views and volumes at once, a row of counters and costs for each. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "output.h"
#include "sweep_end.h"
#include "sweep_head.h"
#include "sweep_plot.h"
#include "sweep_run.h"

typedef struct sweep_options {
    view_options view;
    sweep_plan plan;
    const char *path, *list, *objective; /* NULL: not given */
    sweep_plot plot;
} sweep_options;

static host_status set_path(void *target, const option *o, const char *value, host_error *error)
{
    (void)o, (void)error;
    ((sweep_options *)target)->path = value;
    return HOST_OK;
}

static host_status add_axis(void *target, const option *o, const char *value, host_error *error)
{
    (void)o;
    return sweep_plan_over(&((sweep_options *)target)->plan, value, error);
}

static host_status set_list(void *target, const option *o, const char *value, host_error *error)
{
    (void)o;
    ((sweep_options *)target)->list = value;
    return sweep_plan_list(&((sweep_options *)target)->plan, value, error);
}

static host_status set_objective(void *target, const option *o, const char *value, host_error *error)
{
    (void)o, (void)error;
    ((sweep_options *)target)->objective = value;
    return HOST_OK;
}

static host_status set_plot(void *target, const option *o, const char *value, host_error *error)
{
    return sweep_plot_option(&((sweep_options *)target)->plot, o, value, error);
}

static const option rows[] = {
    {"output", 'o', "OUT.csv", false, set_path,
     "the table; it must be given. '#' lines of JSON, a line of\n"
     "columns, a row a point. Where it is there already, the\n"
     "same sweep goes on: what has a row is not drawn again. Any\n"
     "number of processes (mpirun) may fill it together"},
    {"over", 0, "PARAM=V1,V2,...", true, add_axis,
     "what varies: volume, view, projection, zoom, size, slices,\n"
     "tf, window, crop, machine or a parameter of the machine;\n"
     "given several times: all combinations. view=orbit:N[:EL] is\n"
     "N views around. Values that hold commas are parted by ';':\n"
     "view='0,0;30,30'"},
    {"list", 0, "FILE", false, set_list,
     "points from a file: a line of such names, then a line of\n"
     "values a point, parted by blanks"},
    {"objective", 0, "COL[:min|max],...", false, set_objective,
     "columns to be small (or large): when all points are done,\n"
     "column `pareto` is 1 where no other point is as good in all\n"
     "and better in one. May be given later, or another; nothing\n"
     "is drawn again"},
    {"plot", 0, "OUT.svg", false, set_plot, "a drawing of it, by gnuplot"},
    {"plot-type", 0, "TYPE", false, set_plot, "line, bar, heat or pareto (chosen from what varies)"},
    {"plot-y", 0, "COL", false, set_plot,
     "the column that it shows (the first objective, else cycles\n"
     "with --cycles, else offchip_bytes)"},
};
static const option_table table = {"Sweep:", rows, sizeof rows / sizeof *rows};

/* What changes no row is left out of the command that the file repeats. */
static const char *const passing[] = {"output",  "objective", "plot", "plot-type", "plot-y",
                                      "threads", "path",      "simd", NULL};

/* ---- after the last point ---- */

static void print_summary(const sweep_options *options, const sweep_file *f, const sweep_rows *r)
{
    printf("points             %" PRIu64 ", %" PRIu64 " of them there before\n", f->plan->points, f->found);
    if (r->refused)
        printf("refused            %" PRIu64 " (column `refused` says why)\n", r->refused);
    if (options->objective)
        printf("front              %" PRIu64 " (column `pareto` is 1) of %s\n", r->front, options->objective);
    printf("written            %s\n", options->path);
    if (options->plot.path)
        printf("written            %s\n", options->plot.path);
}

static host_status finish(const sweep_options *options, const sweep_columns *c, const sweep_file *f,
                          const sweep_objectives *objectives, host_error *error)
{
    size_t columns[SWEEP_OBJECTIVES + 1];
    memcpy(columns, objectives->column, sizeof objectives->column);
    columns[objectives->count] = options->plot.column;
    sweep_rows r;
    host_status status =
        sweep_rows_read(&r, f, columns, objectives->count + (options->plot.path ? 1 : 0), objectives, error);
    if (status == HOST_OK)
        status = sweep_end(f, &r, options->objective, error);
    if (status == HOST_OK && options->plot.path)
        status = sweep_plot_write(&options->plot, f->plan, c, objectives, &r, error);
    if (status == HOST_OK)
        print_summary(options, f, &r);
    sweep_rows_free(&r);
    return status;
}

/* ---- before the first ---- */

static host_status check_outputs(const sweep_options *options, const sweep_stage *s, host_error *error)
{
    const char *const paths[] = {options->path, options->plot.path};
    host_status status = HOST_OK;
    for (size_t i = 0; status == HOST_OK && i < 2 && paths[i]; i++) {
        if (options->list)
            status = output_spare(paths[i], options->list, error);
        for (size_t n = 0; status == HOST_OK && n < s->file_count; n++)
            status = output_spare(paths[i], s->files[n].path, error);
        for (size_t n = 0; status == HOST_OK && n < s->machine_count; n++)
            status = output_spare(paths[i], s->machines[n].name, error);
        for (size_t n = 0; status == HOST_OK && n < s->transfer_count; n++)
            status = output_spare(paths[i], s->transfers[n].name, error);
        if (status == HOST_OK)
            status = view_options_output(&options->view, NULL, paths[i], error);
    }
    if (status == HOST_OK && paths[1] && strcmp(paths[0], paths[1]) == 0)
        return host_fail(error, HOST_BAD_INPUT, "--output and --plot both name '%s'", paths[0]);
    return status;
}

static host_status open_file(const sweep_options *options, const sweep_stage *s, const sweep_columns *c,
                             const char *repeats, const sweep_rank *rank, sweep_file *f, host_error *error)
{
    char *head, *line;
    size_t size;
    host_status status = sweep_head(s, repeats, &head, error);
    FILE *file = status == HOST_OK ? open_memstream(&line, &size) : NULL;
    if (!file)
        return status == HOST_OK ? host_fail(error, HOST_ENVIRONMENT, "no memory for the columns") : status;
    for (size_t i = 0; i < c->count; i++)
        fprintf(file, "%s%s", i ? "," : "", c->names[i]);
    putc('\n', file);
    fclose(file);
    const uint64_t first = s->plan->points / (uint64_t)rank->ranks * (uint64_t)rank->rank;
    return sweep_file_open(f, options->path, head, line, c->count, s->plan, first, error);
}

static host_status draw_all(sweep_options *options, sweep_stage *s, const char *repeats, host_error *error)
{
    const sweep_rank rank = sweep_rank_here();
    sweep_columns c = {0};
    sweep_objectives objectives = {.count = 0};
    sweep_file f = {.descriptor = -1};
    host_status status = sweep_columns_make(&c, s, error);
    if (status == HOST_OK && options->objective)
        status = sweep_objectives_parse(options->objective, &c, s->plan, &objectives, error);
    if (status == HOST_OK)
        status = sweep_plot_prepare(&options->plot, s->plan, &c, &objectives, error);
    if (status == HOST_OK)
        status = check_outputs(options, s, error);
    if (status == HOST_OK)
        status = open_file(options, s, &c, repeats, &rank, &f, error);
    if (status == HOST_OK)
        status = sweep_run(s, &c, &f, options->view.threads, &rank, error);
    if (status == HOST_OK && rank.rank == 0)
        status = finish(options, &c, &f, &objectives, error);
    sweep_file_close(&f);
    sweep_columns_free(&c);
    return status;
}

/* Volumes stand as operands or vary by --over or --list; *volume receives the one that does not vary. */
static host_status take_volumes(sweep_options *options, const char *const *operands, const char **fixed,
                                host_error *error)
{
    size_t count = 0;
    sweep_plan *p = &options->plan;
    while (operands[count])
        count++;
    const bool vary = sweep_plan_find(p, "volume") < p->name_count;
    if (vary && count)
        return host_fail(error, HOST_BAD_INPUT, "volumes are given twice: as '%s' and by --over or --list",
                         operands[0]);
    if (!vary && !count)
        return host_fail(error, HOST_BAD_INPUT, "sweep needs VOLUME (see `vodr sweep --help`)");
    *fixed = count == 1 ? operands[0] : NULL;
    host_status status = count > 1 ? sweep_plan_volumes(p, operands, count, error) : HOST_OK;
    if (status == HOST_OK && p->axis_count == 0)
        return host_fail(error, HOST_BAD_INPUT, "sweep needs something that varies: --over, --list or several volumes");
    return status == HOST_OK ? sweep_plan_close(p, error) : status;
}

static host_status sweep(sweep_options *options, const char *const *operands, const char *repeats, host_error *error)
{
    const char *fixed = NULL;
    sweep_stage s;
    if (!options->path)
        return host_fail(error, HOST_BAD_INPUT, "sweep needs --output (-o) OUT.csv");
    host_status status = take_volumes(options, operands, &fixed, error);
    if (status != HOST_OK)
        return status;
    status = sweep_stage_open(&s, &options->plan, &options->view, fixed, error);
    if (status == HOST_OK)
        status = draw_all(options, &s, repeats, error);
    sweep_stage_close(&s);
    return status;
}

static host_status run(int argc, char **argv, host_error *error)
{
    sweep_options options = {.view = view_options_default()};
    void *const targets[] = {&options, &options.view, &options.view, &options.view.volume};
    const char **operands = calloc((size_t)argc + OPTION_OPERANDS, sizeof *operands);
    char *repeats = NULL;
    bool help = false;
    host_status status = operands ? options_parse(&command_sweep, argc, argv, targets, operands, &help, error)
                                  : host_fail(error, HOST_ENVIRONMENT, "no memory for the command line");
    if (status == HOST_OK && !help)
        status = options_quote(&command_sweep, argc, argv, passing, &repeats, error);
    if (status == HOST_OK && !help)
        status = sweep(&options, operands, repeats, error);
    free(repeats);
    free(operands);
    sweep_plan_free(&options.plan);
    view_options_free(&options.view);
    return status;
}

const command command_sweep = {
    .name = "sweep",
    .operands = {"VOLUME"},
    .more = true,
    .summary = "draw a volume on many machines and from many sides: a table of what each cost",
    .example = "  vodr sweep head.nrrd --over cache_bytes=1024,2048,4096,8192 --over line_px=16x1,8x2,4x4 \\\n"
               "     --over view=orbit:36 -o head.csv --objective offchip_bytes,onchip_bits --plot head.svg\n"
               "  mpirun -n 8 vodr sweep head.nrrd --list points.txt -o points.csv --cycles",
    .tables = {&table, &option_view, &option_machine, &option_volume},
    .run = run,
};
