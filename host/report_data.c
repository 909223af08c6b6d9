/* report_data.c - what a report tells beyond the statistics, as JSON for its page. */
#include "report_data.h"

#include <string.h>

#include "json.h"
#include "screen.h"
#include "stats.h"

static json_t *json_count(uint64_t n)
{
    return json_integer((json_int_t)n);
}

static json_t *screen_object(const scene *s)
{
    screen_map m = screen_map_of(&s->view);
    json_t *rows = json_array();
    for (int i = 0; i < 3; i++)
        json_array_append_new(rows, json_pack("[f,f,f,f]", m.row[i][0], m.row[i][1], m.row[i][2], m.row[i][3]));
    return json_pack("{s:o, s:f}", "rows", rows, "near", m.near);
}

static json_t *misses_object(const report_trace *t)
{
    json_t *counts = json_array();
    for (size_t i = 0; i < (size_t)t->columns * (size_t)t->rows; i++)
        json_array_append_new(counts, json_count(t->tile_misses[i]));
    return json_pack("{s:i, s:i, s:i, s:o}", "tile_px", REPORT_TILE_PX, "columns", (int)t->columns, "rows",
                     (int)t->rows, "counts", counts);
}

/* Arrays side by side: JSON names every member of every object. */
static json_t *visits_object(const report_trace *t, bool tiles)
{
    json_t *brick = json_array(), *x0 = json_array(), *y0 = json_array(), *before = json_array();
    for (size_t i = 0; i < t->count; i++) {
        const report_visit *v = &t->kept[i];
        json_array_append_new(brick, json_count(v->brick));
        json_array_append_new(before, json_count(v->misses_before));
        if (tiles) {
            json_array_append_new(x0, json_integer(v->x0_px));
            json_array_append_new(y0, json_integer(v->y0_px));
        }
    }
    return json_pack("{s:o, s:o, s:b, s:o, s:o, s:o, s:o}", "total", json_count(t->visits), "stride",
                     json_count(t->stride), "tiles", (int)tiles, "brick", brick, "x0", x0, "y0", y0, "misses_before",
                     before);
}

static json_t *peers_array(const report_peer *peers)
{
    json_t *array = json_array();
    for (int i = 0; i < REPORT_PEERS; i++)
        json_array_append_new(array,
                              json_pack("{s:s, s:b, s:o, s:o}", "machine", peers[i].machine, "same_frame",
                                        (int)peers[i].same_frame, "cycles", json_count(peers[i].counters.cycles.total),
                                        "counters", stats_counters(&peers[i].counters)));
    return array;
}

static json_t *parameters_array(const vodr_machine *machine)
{
    size_t count;
    const vodr_parameter *parameters = vodr_parameters(&count);
    vodr_machine baseline = vodr_machine_default();
    vodr_machine_named(REPORT_BASELINE, &baseline, &(vodr_error){""});
    json_t *array = json_array();
    for (size_t i = 0; i < count; i++) {
        const vodr_parameter *p = &parameters[i];
        char value[64], usual[64];
        vodr_machine_get(machine, p, value, sizeof value);
        vodr_machine_get(&baseline, p, usual, sizeof usual);
        json_array_append_new(array, json_pack("{s:s, s:s, s:s, s:s, s:s, s:s, s:s, s:s}", "name", p->name, "value",
                                               value, "baseline", usual, "unit", strcmp(p->unit, "-") ? p->unit : "",
                                               "kind", p->picture ? "picture" : "organisation", "block", p->block,
                                               "values", p->values, "meaning", p->meaning));
    }
    return array;
}

/* What the command line set on top of the machine, as name=value. */
static json_t *overrides_array(const view_options *options)
{
    json_t *array = json_array();
    for (size_t i = 0; i < options->override_count; i++)
        json_array_append_new(array,
                              json_sprintf("%s=%s", options->overrides[i].parameter, options->overrides[i].value));
    return array;
}

json_t *report_json(const report *r)
{
    const scene *s = r->scene;
    const int32_t *dims = s->densities.dims_vox;
    return json_pack("{s:o, s:s, s:o, s:[i,i,i], s:o, s:o, s:o, s:o, s:o}", "command", json_text(r->command),
                     "baseline", REPORT_BASELINE, "screen", screen_object(s), "dims_vox", (int)dims[0], (int)dims[1],
                     (int)dims[2], "overrides", overrides_array(r->options), "misses", misses_object(r->trace),
                     "visits", visits_object(r->trace, s->machine.traversal == VODR_TRAVERSAL_TILE), "peers",
                     peers_array(r->peers), "parameters", parameters_array(&s->machine));
}
