/* stats.c - the statistics of a frame as JSON (--stats). */
#include "stats.h"

#include "costs.h"
#include "cycle_stats.h"
#include "json.h"

double stats_hit_rate(const vodr_counters *c)
{
    uint64_t accesses = c->hits + c->misses;
    return accesses ? (double)c->hits / (double)accesses : -1;
}

double stats_fragments_per_s(const result *r)
{
    return r->wall_s > 0 ? (double)r->counters.fragments / r->wall_s : 0;
}

json_t *stats_view(const scene *s)
{
    const camera *c = &s->camera;
    return json_pack("{s:[f,f,f], s:s, s:o, s:f, s:i, s:i, s:i, s:f, s:o}", "angles_deg", c->azimuth_deg,
                     c->elevation_deg, c->roll_deg, "projection", c->perspective ? "perspective" : "parallel",
                     "fov_deg", c->perspective ? json_real(c->fov_deg) : json_null(), "zoom", c->zoom, "width_px",
                     (int)s->view.width_px, "height_px", (int)s->view.height_px, "slices", (int)s->view.slices,
                     "slice_depth_vox", s->depth_vox, "tf", json_text(s->transfer.name));
}

static json_t *integer(uint64_t value)
{
    return json_integer((json_int_t)value);
}

json_t *stats_counters(const vodr_counters *c)
{
    json_t *object = json_object();
    double hit_rate = stats_hit_rate(c);
    const struct {
        const char *name;
        json_t *value;
    } rows[] = {
        {"fragments", integer(c->fragments)},
        {"killed_fragments", integer(c->killed_fragments)},
        {"terminated_fragments", integer(c->terminated_fragments)},
        {"hits", integer(c->hits)},
        {"misses", integer(c->misses)},
        {"hit_rate", hit_rate < 0 ? json_null() : json_real(hit_rate)},
        {"evictions", integer(c->evictions)},
        {"writebacks", integer(c->writebacks)},
        {"fb_read_bytes", integer(c->fb_read_bytes)},
        {"fb_write_bytes", integer(c->fb_write_bytes)},
        {"texture_load_bytes", integer(c->texture_load_bytes)},
        {"bricks", integer(c->bricks)},
        {"brick_visits", integer(c->brick_visits)},
        {"brick_slices", integer(c->brick_slices)},
        {"brick_overflows", integer(c->brick_overflows)},
        {"skipped_bricks", integer(c->skipped_bricks)},
        {"brick_vox", json_integer(c->brick_vox)},
        {"tile_px", json_integer(c->tile_px)},
    };
    int failed = 0;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        failed |= json_object_set_new(object, rows[i].name, rows[i].value);
    if (!failed)
        return object;
    json_decref(object);
    return NULL;
}

json_t *stats_json(const scene *s, const view_options *options, const result *r)
{
    json_t *root =
        json_pack("{s:s, s:s, s:o, s:o, s:o}", "schema", "vodr-stats-1", "version", VODR_VERSION, "machine",
                  json_machine(s->machine_name, &s->machine), "volume", json_volume(s, options), "view", stats_view(s));
    json_t *counters = stats_counters(&r->counters);
    const vodr_cycles *cycles = options->cycles ? &r->counters.cycles : NULL;
    char bottleneck[192];
    if (cycles)
        cycle_stats_bottleneck(cycles, bottleneck, sizeof bottleneck);
    const costs c = costs_of(&s->machine, &s->view, &r->counters, &s->tables);
    json_t *rest = json_pack(
        "{s:i, s:o, s:o, s:s?, s:o, s:s, s:i, s:i, s:f, s:f}", "slices", (int)s->view.slices, "cycles",
        cycles ? cycle_stats_blocks(cycles) : json_null(), "stalls", cycles ? cycle_stats_stalls(cycles) : json_null(),
        "bottleneck", cycles ? bottleneck : NULL, "costs", costs_json(&c), "frame_sha256", r->frame_sha256, "threads",
        (int)options->threads, "repeat", r->repeat, "wall_s", r->wall_s, "fragments_per_s", stats_fragments_per_s(r));
    if (json_object_update(root, counters) != 0 || json_object_update(root, rest) != 0) {
        json_decref(root);
        root = NULL;
    }
    json_decref(counters);
    json_decref(rest);
    return root;
}

host_status stats_write(output *o, const scene *s, const view_options *options, const result *r, host_error *error)
{
    return json_write(o, stats_json(s, options, r), error);
}
