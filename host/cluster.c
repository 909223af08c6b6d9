/* cluster.c - `vodr cluster`: a volume drawn by several nodes, processes of mpirun or simulated, each its own part. */
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "cluster_scene.h"
#include "cluster_stats.h"
#include "commands.h"
#include "draw.h"
#include "image.h"
#include "progress.h"
#include "text.h"

enum { PNG, RAW, STATS, OUTPUTS };

static const char *const output_option[OUTPUTS] = {"output", "raw", "stats"};

typedef struct command_options {
    view_options view;
    reference_wish wish;
    cluster_wish cluster;
    output_set outputs;
} command_options;

static const option rows[] = {
    {"output", 'o', "OUT.png", false, output_set_path, "the picture, 8 or 16 bits a channel as fb_bits says"},
    {"raw", 0, "OUT.rgba", false, output_set_path,
     "the frame: rows top to bottom, premultiplied RGBA, 8 bits,\n"
     "or 16 bits little endian"},
    {"stats", 0, "OUT.json", false, output_set_path, "what each node had and took, the frame's hash"},
    {"repeat", 0, "N", false, output_set_repeat, "draw N times, 1 to 1000, and report the median time (1)"},
};
static const option_table table = {"Output (none is required):", rows, sizeof rows / sizeof *rows};

/* A run on one of the nodes. */
typedef struct run_state {
    const command_options *options;
    cluster_node *node;
    cluster_scene scene;
    cluster *cluster;
    double *rgba; /* node 0 */
    cluster_result result;
} run_state;

/* What all nodes make of a status of the host. */
static host_status agree(cluster_node *node, host_status status, host_error *error)
{
    vodr_error why = {""};
    snprintf(why.text, sizeof why.text, "%.*s", (int)sizeof why.text - 1, error->text);
    const cluster_status own = status == HOST_OK          ? CLUSTER_OK
                               : status == HOST_BAD_INPUT ? CLUSTER_INVALID
                                                          : CLUSTER_ENVIRONMENT;
    const cluster_status all = cluster_agree(node, own, &why);
    if (all == CLUSTER_OK)
        return HOST_OK;
    return host_fail(error, cluster_scene_status(all), "%s", why.text);
}

static host_status told(cluster_status status, const vodr_error *why, host_error *error)
{
    return status == CLUSTER_OK ? HOST_OK : host_fail(error, cluster_scene_status(status), "%s", why->text);
}

/* ---- drawing ---- */

/* The least and greatest values of all nodes. */
static host_status share_range(run_state *r, host_error *error)
{
    vodr_error why;
    cluster_scene *s = &r->scene;
    cluster_status status = cluster_reduce(r->node, &s->least, 1, false, &why);
    if (status == CLUSTER_OK)
        status = cluster_reduce(r->node, &s->most, 1, true, &why);
    return told(status, &why, error);
}

static host_status prepare(run_state *r, const char *path, host_error *error)
{
    const command_options *o = r->options;
    vodr_error why;
    host_status status =
        agree(r->node, cluster_scene_open(path, &o->view, o->cluster.options.memory_bytes, &r->scene, error), error);
    if (status != HOST_OK)
        return status;
    r->scene.draws_machine = o->cluster.machine;
    const cluster_source source = cluster_scene_source(&r->scene);
    status = told(cluster_open(&o->cluster.options, &source, r->node, &r->cluster, &why), &why, error);
    if (status == HOST_OK)
        status = share_range(r, error);
    if (status == HOST_OK)
        status = agree(r->node, cluster_scene_settle(&r->scene, &o->view, &o->wish.choice, error), error);
    return status;
}

/* Draws one frame; by time, the volume is divided anew after each. */
static host_status draw_once(run_state *r, double *seconds, host_error *error)
{
    vodr_error why;
    const scene *s = &r->scene.scene;
    const reference_march_job *job = &r->scene.job;
    cluster_status status = CLUSTER_OK;
    if (seconds == NULL || r->options->cluster.options.weight == CLUSTER_TIME)
        status = cluster_place(r->cluster, job, s->window_lo, s->window_hi, &why);
    const double begin_s = progress_now_s();
    if (status == CLUSTER_OK && seconds)
        status = cluster_draw(r->cluster, job, r->rgba, &why);
    if (seconds)
        *seconds = progress_now_s() - begin_s;
    return told(status, &why, error);
}

static host_status draw_frames(run_state *r, double *times, host_error *error)
{
    const int repeat = r->options->outputs.repeat;
    host_status status = HOST_OK;
    for (int i = 0; status == HOST_OK && i < repeat; i++)
        status = draw_once(r, &times[i], error);
    if (status == HOST_OK)
        r->result.wall_s = draw_median(times, repeat);
    return status;
}

/* Changes to another transfer function. */
static host_status change(run_state *r, int i, host_error *error)
{
    vodr_error why;
    const command_options *o = r->options;
    const char *function = o->cluster.then[i];
    host_status status =
        agree(r->node, cluster_scene_change(&r->scene, &o->view, function, &o->wish.choice, error), error);
    if (status != HOST_OK)
        return status;
    const scene *s = &r->scene.scene;
    const double begin_s = progress_now_s();
    status = told(cluster_change_function(r->cluster, &r->scene.job, s->window_lo, s->window_hi, &why), &why, error);
    r->result.change[i] = (cluster_changed){function, progress_now_s() - begin_s, cluster_reported(r->cluster)};
    r->result.changes = i + 1;
    return status;
}

static host_status draw_all(run_state *r, host_error *error)
{
    double *times = malloc((size_t)r->options->outputs.repeat * sizeof *times);
    host_status status = draw_once(r, NULL, error);
    if (status == HOST_OK)
        status = agree(r->node, times ? HOST_OK : host_fail(error, HOST_ENVIRONMENT, "no memory"), error);
    if (status == HOST_OK)
        status = draw_frames(r, times, error);
    for (int i = 0; status == HOST_OK && i < r->options->cluster.changes; i++) {
        status = change(r, i, error);
        if (status == HOST_OK)
            status = draw_frames(r, times, error);
    }
    free(times);
    return status;
}

static host_status make_picture(run_state *r, host_error *error)
{
    vodr_error why;
    const scene *s = &r->scene.scene;
    if (cluster_rank(r->node) != 0)
        return HOST_OK;
    r->result.report = cluster_reported(r->cluster);
    reference_status status =
        reference_quantise(&r->scene.job.camera, r->rgba, s->machine.fb_bits, &r->result.frame, &why);
    if (status != REFERENCE_OK)
        return host_fail(error, reference_scene_status(status), "%s", why.text);
    return digest_frame(&r->result.frame, r->result.frame_sha256, error);
}

/* ---- output ---- */

static host_status write_one(void *context, int i, output *o, host_error *error)
{
    const run_state *r = context;
    const view_options *v = &r->options->view;
    switch (i) {
    case PNG: return image_write_png(o, &r->result.frame, &v->style, error);
    case RAW: return image_write_raw(o, &r->result.frame, error);
    default:
        return cluster_stats_write(o, &r->scene.scene, v, &r->options->cluster.options, &r->options->wish.choice,
                                   &r->result, error);
    }
}

static void print_summary(const run_state *r)
{
    const cluster_report *p = &r->result.report;
    const cluster_options *o = &r->options->cluster.options;
    const reference_choice *choice = &r->options->wish.choice;
    const scene *s = &r->scene.scene;
    uint64_t sent = 0, held = 0;
    for (int32_t i = 0; i < p->nodes; i++) {
        sent += p->share[i].sent_bytes;
        held = p->share[i].held_bytes > held ? p->share[i].held_bytes : held;
    }
    scene_print_volume(s);
    printf("frame              %dx%d pixels, ", s->view.width_px, s->view.height_px);
    if (choice->method == REFERENCE_RAYCAST)
        printf("rays of a sample every %g voxels\n", choice->step_vox);
    else
        printf("%d slices\n", s->view.slices);
    printf("nodes              %d%s, balance %s by %s, compositing %s\n", p->nodes, p->simulated ? " simulated" : "",
           cluster_balance_name(o->balance), cluster_weight_name(o->weight), cluster_composite_name(o->composite));
    printf("sub-volumes        %lld of %lld of %d voxels a side are not empty\n", (long long)p->occupied,
           (long long)p->subvolumes, o->subvolume_vox);
    printf("load balance       %.4f by count, %.4f by weight, %.4f by time\n", p->lbr, p->lbr_weight, p->lbr_time);
    for (int i = 0; i < r->result.changes; i++) {
        const cluster_changed *c = &r->result.change[i];
        const cluster_change *bytes = &c->report.change;
        printf("changed to         %s in %.6f s: %llu bytes moved, %llu read, of %llu; load balance %.4f by weight\n",
               c->transfer, c->seconds, (unsigned long long)bytes->moved_bytes, (unsigned long long)bytes->read_bytes,
               (unsigned long long)bytes->scatter_bytes, c->report.lbr_weight);
    }
    text_print_count("held at most", held, " bytes of voxels by a node");
    text_print_count("sent", sent, " bytes of picture");
    if (o->machine)
        printf("cycles             %.0f, the slowest machine %llu, the network %.0f\n",
               (double)p->slowest_cycles + p->network_cycles, (unsigned long long)p->slowest_cycles, p->network_cycles);
    printf("time               %.6f s, rendering of the slowest node %.6f s\n", p->frame_s, p->slowest_s);
    printf("frame_sha256       %s\n", r->result.frame_sha256);
}

static host_status write_all(run_state *r, host_error *error)
{
    const output_set *outputs = &r->options->outputs;
    if (cluster_rank(r->node) != 0)
        return HOST_OK;
    host_status status = output_set_write(outputs, write_one, r, error);
    if (status == HOST_OK && !output_set_takes_stdout(outputs)) {
        print_summary(r);
        output_set_print(outputs);
    }
    return status;
}

/* ---- the command ---- */

static host_status check(run_state *r, command_options *o, const char *path, host_error *error)
{
    host_status status = reference_wish_settle(&o->wish, &o->view, error);
    if (status == HOST_OK)
        status = cluster_options_check(&o->cluster, &o->wish, &o->view, error);
    if (status == HOST_OK && cluster_rank(r->node) == 0)
        status = output_set_check(&o->outputs, &o->view, path, error);
    return status;
}

/* The processes of a computer share its cores; a simulated node has one. */
static void share_cores(run_state *r, command_options *o)
{
    if (o->cluster.machine) { /* and machines send what their frame buffers hold */
        o->cluster.options.machine = &r->scene.machine;
        o->cluster.options.pixel_bits = 16;
    }
    const long shared = sysconf(_SC_NPROCESSORS_ONLN) / cluster_local_ranks(r->node);
    const long cores = o->cluster.options.nodes > 0 ? 1 : shared;
    o->cluster.options.renderer = (reference_options){o->wish.choice.device, o->view.threads, o->view.simd};
    if (o->view.threads == 0)
        o->cluster.options.renderer.threads = cores > 1 ? (int32_t)cores : 1;
}

static host_status draw_and_write(run_state *r, command_options *o, const char *path, host_error *error)
{
    host_status status = agree(r->node, check(r, o, path, error), error);
    if (status != HOST_OK)
        return status;
    share_cores(r, o);
    status = prepare(r, path, error);
    if (status == HOST_OK && cluster_rank(r->node) == 0) {
        const reference_camera *c = &r->scene.job.camera;
        r->rgba = malloc(4 * (size_t)c->width_px * (size_t)c->height_px * sizeof *r->rgba);
        if (!r->rgba)
            status = host_fail(error, HOST_ENVIRONMENT, "no memory for the picture");
    }
    if (r->cluster)
        status = agree(r->node, status, error);
    if (status == HOST_OK)
        status = draw_all(r, error);
    if (status == HOST_OK)
        status = agree(r->node, make_picture(r, error), error);
    if (status == HOST_OK)
        status = agree(r->node, write_all(r, error), error);
    vodr_frame_free(&r->result.frame);
    free(r->rgba);
    cluster_close(r->cluster);
    cluster_scene_close(&r->scene);
    return status;
}

static host_status parse_and_draw(run_state *r, int argc, char **argv, host_error *error)
{
    command_options options = {.view = view_options_default(),
                               .wish = reference_wish_default(),
                               .cluster = cluster_wish_default(),
                               .outputs = {.option = output_option, .count = OUTPUTS, .repeat = 1}};
    void *const targets[] = {&options.outputs, &options.cluster,     &options.wish, &options.view,
                             &options.view,    &options.view.volume, &options.view};
    const char *operands[OPTION_OPERANDS];
    bool help;
    r->options = &options;
    host_status status = options_parse(&command_cluster, argc, argv, targets, operands, &help, error);
    status = agree(r->node, status, error);
    if (status == HOST_OK && !help) {
        r->result.repeat = options.outputs.repeat;
        status = draw_and_write(r, &options, operands[0], error);
    }
    view_options_free(&options.view);
    return status;
}

static host_status run(int argc, char **argv, host_error *error)
{
    run_state r = {0};
    vodr_error why;
    host_status status = told(cluster_join(&r.node, &why), &why, error);
    if (status != HOST_OK)
        return status;
    status = parse_and_draw(&r, argc, argv, error);
    const bool broken = cluster_broken(r.node), speaks = cluster_rank(r.node) == 0 || broken;
    if (status != HOST_OK && broken) { /* the others cannot say which node it is */
        const host_error own = *error;
        host_fail(error, status, "node %d of %d: %.*s", cluster_rank(r.node), cluster_ranks(r.node),
                  (int)sizeof own.text - 40, own.text);
    }
    if (status != HOST_OK && speaks && error->text[0])
        host_say(error); /* before any node ends, upon which mpirun ends the others */
    error->text[0] = '\0';
    cluster_leave(r.node);
    return status;
}

const command command_cluster = {
    .name = "cluster",
    .operands = {"VOLUME"},
    .required = 1,
    .summary = "draw a volume by several nodes, each its own part",
    .example = "  mpirun -np 8 vodr cluster head.nrrd -o head.png --tf skin-bone --view -30,20 --size 512x512\n"
               "  vodr cluster head.nrrd --nodes 64 --stats head.json    # 64 nodes, simulated",
    .tables = {&table, &option_cluster, &option_reference, &option_view, &option_machine, &option_volume,
               &option_picture},
    .run = run,
};
