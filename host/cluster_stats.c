/* cluster_stats.c - what a frame of several nodes took, as JSON (--stats). */
#include "cluster_stats.h"

#include "json.h"
#include "stats.h"

/* An array with a value of each node. */
typedef json_t *value_of(const cluster_share *s);

static json_t *subvolumes(const cluster_share *s)
{
    return json_integer((json_int_t)s->subvolumes);
}

static json_t *weight(const cluster_share *s)
{
    return json_real(s->weight);
}

static json_t *parts(const cluster_share *s)
{
    return json_integer(s->parts);
}

static json_t *clusters(const cluster_share *s)
{
    return json_integer(s->clusters);
}

static json_t *held_bytes(const cluster_share *s)
{
    return json_integer((json_int_t)s->held_bytes);
}

static json_t *samples(const cluster_share *s)
{
    return json_integer((json_int_t)s->samples);
}

static json_t *cycles(const cluster_share *s)
{
    return json_integer((json_int_t)s->cycles);
}

static json_t *render_s(const cluster_share *s)
{
    return json_real(s->render_s);
}

static json_t *cpu_s(const cluster_share *s)
{
    return json_real(s->cpu_s);
}

static json_t *composite_s(const cluster_share *s)
{
    return json_real(s->composite_s);
}

static json_t *sent_bytes(const cluster_share *s)
{
    return json_integer((json_int_t)s->sent_bytes);
}

static json_t *scan_s(const cluster_share *s)
{
    return json_real(s->scan_s);
}

static json_t *divide_s(const cluster_share *s)
{
    return json_real(s->divide_s);
}

static json_t *load_s(const cluster_share *s)
{
    return json_real(s->load_s);
}

static json_t *per_rank(const cluster_report *r)
{
    static const struct {
        const char *name;
        value_of *value;
    } rows[] = {{"subvolumes", subvolumes},   {"weight", weight},         {"parts", parts},
                {"clusters", clusters},       {"held_bytes", held_bytes}, {"samples", samples},
                {"cycles", cycles},           {"render_s", render_s},     {"cpu_s", cpu_s},
                {"composite_s", composite_s}, {"sent_bytes", sent_bytes}, {"scan_s", scan_s},
                {"divide_s", divide_s},       {"load_s", load_s}};
    json_t *object = json_object();
    int failed = 0;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        json_t *array = json_array();
        for (int32_t n = 0; n < r->nodes; n++)
            failed |= json_array_append_new(array, rows[i].value(&r->share[n]));
        failed |= json_object_set_new(object, rows[i].name, array);
    }
    if (!failed)
        return object;
    json_decref(object);
    return NULL;
}

static json_t *cluster_object(const cluster_options *o, const cluster_report *r)
{
    return json_pack("{s:i, s:b, s:s, s:s, s:s, s:i, s:i, s:I, s:I, s:f, s:f}", "nodes", (int)r->nodes, "simulated",
                     r->simulated, "balance", cluster_balance_name(o->balance), "weight",
                     cluster_weight_name(o->weight), "composite", cluster_composite_name(o->composite), "channel_bits",
                     (int)o->pixel_bits, "subvolume_vox", (int)o->subvolume_vox, "subvolumes",
                     (json_int_t)r->subvolumes, "nonempty_subvolumes", (json_int_t)r->occupied, "latency_s",
                     o->latency_s, "bytes_per_s", o->bytes_per_s);
}

static json_t *changes(const cluster_result *r)
{
    json_t *array = json_array();
    for (int i = 0; i < r->changes; i++) {
        const cluster_changed *c = &r->change[i];
        const cluster_change *bytes = &c->report.change;
        json_array_append_new(array, json_pack("{s:o, s:f, s:f, s:f, s:I, s:I, s:I}", "tf", json_text(c->transfer),
                                               "change_s", c->seconds, "lbr", c->report.lbr, "lbr_weight",
                                               c->report.lbr_weight, "moved_bytes", (json_int_t)bytes->moved_bytes,
                                               "read_bytes", (json_int_t)bytes->read_bytes, "scatter_bytes",
                                               (json_int_t)bytes->scatter_bytes));
    }
    return array;
}

static uint64_t total_samples(const cluster_report *r)
{
    uint64_t total = 0;
    for (int32_t n = 0; n < r->nodes; n++)
        total += r->share[n].samples;
    return total;
}

host_status cluster_stats_write(output *o, const scene *s, const view_options *v, const cluster_options *options,
                                const reference_choice *choice, const cluster_result *r, host_error *error)
{
    const cluster_report *p = &r->report;
    json_t *root =
        json_pack("{s:s, s:s, s:o, s:o, s:o, s:o, s:s, s:s, s:i, s:I, s:s, s:i, s:f}", "schema", "vodr-cluster-stats-1",
                  "version", VODR_VERSION, "cluster", cluster_object(options, p), "machine",
                  json_machine(s->machine_name, &s->machine), "volume", json_volume(s, v), "view", stats_view(s),
                  "method", reference_method_name(choice), "numbers", reference_numbers_name(choice), "slices",
                  (int)s->view.slices, "samples", (json_int_t)total_samples(p), "frame_sha256", r->frame_sha256,
                  "repeat", r->repeat, "wall_s", r->wall_s);
    json_t *balance = json_pack("{s:f, s:f, s:f, s:f, s:f, s:f, s:o, s:o}", "lbr", p->lbr, "lbr_weight", p->lbr_weight,
                                "lbr_time", p->lbr_time, "slowest_s", p->slowest_s, "barrier_share", p->barrier_share,
                                "frame_s", p->frame_s, "per_rank", per_rank(p), "changes", changes(r));
    if (options->machine)
        json_object_set_new(balance, "cycles",
                            json_pack("{s:f, s:I, s:f}", "total", (double)p->slowest_cycles + p->network_cycles,
                                      "slowest", (json_int_t)p->slowest_cycles, "network", p->network_cycles));
    if (json_object_update(root, balance) != 0) {
        json_decref(root);
        root = NULL;
    }
    json_decref(balance);
    return json_write(o, root, error);
}
