/* sweep_row.c - the columns of a sweep's file are the keys of --stats laid flat, so that what is counted there is a
 * column here. */
#include "sweep_row.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "costs.h"
#include "csv.h"
#include "cycle_stats.h"
#include "stats.h"
#include "text.h"

/* What a point counted, in the order of the columns; NULL when memory is out. */
static json_t *counted(const sweep_stage *s, const sweep_sample *sample)
{
    json_t *all = json_pack("{s:i, s:i, s:i}", "width_px", (int)sample->view.width_px, "height_px",
                            (int)sample->view.height_px, "slices", (int)sample->view.slices);
    const costs c = costs_of(&sample->machine, &sample->view, &sample->counters, &s->tables);
    json_t *parts[] = {stats_counters(&sample->counters), costs_json(&c), NULL};
    const vodr_cycles *cycles = &sample->counters.cycles;
    char bottleneck[192];
    if (s->fixed->cycles) {
        cycle_stats_bottleneck(cycles, bottleneck, sizeof bottleneck);
        parts[2] = json_pack("{s:o, s:o, s:s}", "cycles", cycle_stats_blocks(cycles), "stalls",
                             cycle_stats_stalls(cycles), "bottleneck", bottleneck);
    }
    int failed = !all || !parts[0] || !parts[1] || (s->fixed->cycles && !parts[2]);
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        if (!failed && parts[i])
            failed = json_object_update(all, parts[i]);
        json_decref(parts[i]);
    }
    if (!failed && sweep_plan_find(s->plan, "slices") < s->plan->name_count)
        failed = json_object_del(all, "slices");
    if (!failed)
        return all;
    json_decref(all);
    return NULL;
}

/* ---- columns ---- */

static bool add_column(sweep_columns *c, const char *name)
{
    char **grown = realloc(c->names, (c->count + 1) * sizeof *grown);
    if (!grown)
        return false;
    c->names = grown;
    grown[c->count] = strdup(name);
    return grown[c->count] && ++c->count;
}

/* The keys of an object, those of objects within it after its own: "cycles" for its total, "cycles_rasterizer_busy". */
static bool add_keys(sweep_columns *c, json_t *object, const char *prefix)
{
    const char *key;
    json_t *value;
    bool good = true;
    json_object_foreach(object, key, value)
    {
        char name[96];
        snprintf(name, sizeof name, "%s%s%s", prefix, *prefix ? "_" : "", key);
        if (*prefix && strcmp(key, "total") == 0)
            snprintf(name, sizeof name, "%s", prefix);
        good = good && (json_is_object(value) ? add_keys(c, value, name) : add_column(c, name));
    }
    return good;
}

host_status sweep_columns_make(sweep_columns *c, const sweep_stage *s, host_error *error)
{
    const sweep_sample nothing = {.machine = vodr_machine_default(), .view = {.width_px = 1, .height_px = 1}};
    *c = (sweep_columns){.coordinates = s->plan->name_count};
    bool good = add_column(c, "point");
    for (size_t i = 0; good && i < s->plan->name_count; i++)
        good = add_column(c, s->plan->names[i].name);
    json_t *all = counted(s, &nothing);
    good = good && all && add_keys(c, all, "");
    json_decref(all);
    if (good && add_column(c, "frame_sha256") && add_column(c, "refused") && add_column(c, "pareto"))
        return HOST_OK;
    sweep_columns_free(c);
    return host_fail(error, HOST_ENVIRONMENT, "no memory for the columns");
}

void sweep_columns_free(sweep_columns *c)
{
    for (size_t i = 0; i < c->count; i++)
        free(c->names[i]);
    free(c->names);
    *c = (sweep_columns){0};
}

size_t sweep_columns_find(const sweep_columns *c, const char *name)
{
    size_t i = 0;
    while (i < c->count && strcmp(c->names[i], name) != 0)
        i++;
    return i;
}

bool sweep_column_is_number(const sweep_columns *c, const sweep_plan *p, size_t column)
{
    static const char *const words[] = {"bottleneck", "frame_sha256", "refused", "pareto"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strcmp(c->names[column], words[i]) == 0)
            return false;
    if (column == 0 || column > c->coordinates)
        return true;
    const sweep_name *n = &p->names[column - 1];
    const sweep_axis *a = &p->axes[n->axis];
    double number;
    for (size_t i = 0; i < a->count; i++)
        if (!text_number(a->values[i * a->names + n->column], -1e300, 1e300, &number))
            return false;
    return true;
}

static bool ends_with(const char *text, const char *end)
{
    size_t n = strlen(text), m = strlen(end);
    return n >= m && strcmp(text + n - m, end) == 0;
}

const char *sweep_column_unit(const sweep_plan *p, const char *name)
{
    static const char *const by_end[][2] = {
        {"_bytes", "bytes"}, {"_bits", "bits"}, {"_pj", "pJ"}, {"_px", "pixels"}, {"_vox", "voxels"}};
    const size_t i = sweep_plan_find(p, name);
    if (i < p->name_count) {
        const vodr_parameter *parameter = p->names[i].parameter;
        return parameter && strcmp(parameter->unit, "-") != 0 ? parameter->unit : "";
    }
    for (size_t e = 0; e < sizeof by_end / sizeof *by_end; e++)
        if (ends_with(name, by_end[e][0]))
            return by_end[e][1];
    return strncmp(name, "cycles", 6) == 0 || strncmp(name, "stalls", 6) == 0 ? "cycles" : "";
}

/* ---- rows ---- */

static void put_value(FILE *file, json_t *value)
{
    putc(',', file);
    if (json_is_integer(value))
        fprintf(file, "%" JSON_INTEGER_FORMAT, json_integer_value(value));
    else if (json_is_real(value))
        fprintf(file, "%.17g", json_real_value(value));
    else if (json_is_string(value))
        csv_put(file, json_string_value(value));
}

/* As add_keys() went through them. */
static void put_values(FILE *file, json_t *object)
{
    const char *key;
    json_t *value;
    json_object_foreach(object, key, value)
    {
        if (json_is_object(value))
            put_values(file, value);
        else
            put_value(file, value);
    }
}

static void put_row(FILE *file, const sweep_columns *c, const sweep_plan *p, uint64_t point, const sweep_sample *sample,
                    json_t *all)
{
    enum { AFTER = 3 }; /* frame_sha256, refused, pareto */
    fprintf(file, "%" PRIu64, point);
    for (size_t i = 0; i < p->name_count; i++) {
        putc(',', file);
        csv_put(file, sweep_plan_value(p, i, point));
    }
    if (all)
        put_values(file, all);
    for (size_t i = 1 + c->coordinates; !all && i + AFTER < c->count; i++)
        putc(',', file);
    fprintf(file, ",%s,", sample->frame_sha256);
    csv_put(file, sample->refused);
    fputs(",\n", file);
}

host_status sweep_row_make(const sweep_columns *c, const sweep_stage *s, uint64_t point, const sweep_sample *sample,
                           char **line, host_error *error)
{
    size_t size;
    json_t *all = sample->refused[0] ? NULL : counted(s, sample);
    FILE *file = sample->refused[0] || all ? open_memstream(line, &size) : NULL;
    if (file)
        put_row(file, c, s->plan, point, sample, all);
    json_decref(all);
    if (!file || fclose(file) != 0)
        return host_fail(error, HOST_ENVIRONMENT, "no memory for a row");
    return HOST_OK;
}
