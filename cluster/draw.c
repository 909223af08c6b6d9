/* draw.c - a frame: each node draws its boxes front to back into layers, one for each stretch of the order of sight
 * that is its own; the layers are composited. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "balance.h"
#include "fail.h"
#include "footprint.h"
#include "state.h"

/* A frame being drawn. */
typedef struct frame {
    cluster *cluster;
    const reference_march_job *job;
    int32_t *leaf;  /* owned; front to back */
    int32_t *place; /* owned; of each of them: the stretch it belongs to */
    int32_t count, places;
    int32_t y0, y1;         /* rows in which anything may show */
    double *rgba;           /* owned; of one box */
    composite_piece *piece; /* owned; of each node that this process draws */
    int32_t pieces;
} frame;

static void free_frame(frame *f)
{
    for (int32_t i = 0; f->piece && i < f->pieces; i++)
        layers_free(&f->piece[i].layers);
    free(f->piece);
    free(f->leaf);
    free(f->place);
    free(f->rgba);
}

static rectangle leaf_area(const frame *f, int32_t i)
{
    int32_t lo[3], hi[3];
    bricks_box(f->cluster, f->leaf[i], lo, hi);
    return footprint_of(&f->job->camera, lo, hi);
}

/* Leaves in order, stretches, rows. */
static cluster_status begin_frame(frame *f, vodr_error *error)
{
    cluster *c = f->cluster;
    const reference_camera *camera = &f->job->camera;
    const kd_eye eye = kd_eye_of(camera);
    const bool mip = f->job->blend == REFERENCE_MIP;
    rectangle all = {0, 0, 0, 0};
    f->pieces = c->options.nodes > 0 ? c->nodes : 1;
    f->leaf = malloc((size_t)c->tree.count * sizeof *f->leaf);
    f->place = malloc((size_t)c->tree.count * sizeof *f->place);
    f->rgba = malloc(4 * (size_t)camera->width_px * (size_t)camera->height_px * sizeof *f->rgba);
    f->piece = calloc((size_t)f->pieces, sizeof *f->piece);
    if (!f->leaf || !f->place || !f->rgba || !f->piece)
        return cluster_fail(error, CLUSTER_ENVIRONMENT, "no memory for a picture of %dx%d pixels", camera->width_px,
                            camera->height_px);
    f->count = kd_tree_order(&c->tree, &eye, c->grid.edge_vox, f->leaf);
    for (int32_t i = 0; i < f->count; i++) {
        const int32_t owner = c->tree.node[f->leaf[i]].owner;
        f->places += i == 0 || c->tree.node[f->leaf[i - 1]].owner != owner;
        f->place[i] = f->places - 1;
        all = rectangle_union(all, leaf_area(f, i));
    }
    f->y0 = all.y0;
    f->y1 = all.y1;
    for (int32_t i = 0; i < f->pieces; i++)
        f->piece[i] = (composite_piece){{.mip = mip, .bits = c->options.pixel_bits}, f->y0, f->y1, 0};
    return CLUSTER_OK;
}

/* The least so far, 0 being none: what else a computer does only adds to a time. */
static double least_of(double so_far_s, double seconds)
{
    return so_far_s > 0 && so_far_s < seconds ? so_far_s : seconds;
}

/* The area of a box by the reference renderer. */
static cluster_status march(const frame *f, const brick *b, rectangle area, bool stored, cluster_share *share,
                            vodr_error *error)
{
    reference_march_job job = *f->job;
    reference_stats stats;
    job.camera.first_px[0] = area.x0;
    job.camera.first_px[1] = area.y0;
    job.camera.width_px = area.x1 - area.x0;
    job.camera.height_px = area.y1 - area.y0;
    memcpy(job.lo_vox, b->lo_vox, sizeof job.lo_vox);
    memcpy(job.hi_vox, b->hi_vox, sizeof job.hi_vox);
    job.stored = stored;
    reference_status status = reference_march(b->renderer, &job, f->rgba, &stats, error);
    if (status != REFERENCE_OK)
        return status == REFERENCE_INVALID ? CLUSTER_INVALID : CLUSTER_ENVIRONMENT;
    share->samples += stats.samples;
    return CLUSTER_OK;
}

static cluster_status draw_leaf(frame *f, int32_t i, layers *l, cluster_share *share, vodr_error *error)
{
    const cluster_options *o = &f->cluster->options;
    brick *b = &f->cluster->bricks.brick[f->leaf[i]];
    const rectangle area = leaf_area(f, i);
    const double begin_s = cluster_cpu_s();
    if (rectangle_is_empty(area))
        return CLUSTER_OK;
    cluster_status status =
        o->machine ? draw_by_machine(o, b, area, f->rgba, share, error) : march(f, b, area, l->mip, share, error);
    if (status != CLUSTER_OK)
        return status;
    layers_march(l, l->count - 1, area, f->rgba);
    b->cpu_s = least_of(b->cpu_s, cluster_cpu_s() - begin_s);
    return CLUSTER_OK;
}

/* The stretches of one node. */
static cluster_status draw_node(frame *f, int32_t owner, layers *l, vodr_error *error)
{
    cluster *c = f->cluster;
    cluster_share *share = &c->share[owner];
    const double begin_s = cluster_now_s(), begin_cpu_s = cluster_cpu_s();
    cluster_status status = CLUSTER_OK;
    share->samples = share->cycles = 0;
    for (int32_t i = 0, end; status == CLUSTER_OK && i < f->count; i = end) {
        rectangle area = {0, 0, 0, 0};
        for (end = i; end < f->count && f->place[end] == f->place[i]; end++)
            area = rectangle_union(area, leaf_area(f, end));
        if (c->tree.node[f->leaf[i]].owner != owner)
            continue;
        status = layers_add(l, f->place[i], f->place[i] + 1, area, error);
        for (int32_t j = i; status == CLUSTER_OK && j < end; j++)
            status = draw_leaf(f, j, l, share, error);
    }
    share->render_s = cluster_now_s() - begin_s;
    share->cpu_s = least_of(share->cpu_s, cluster_cpu_s() - begin_cpu_s);
    return status;
}

static cluster_status draw_nodes(frame *f, vodr_error *error)
{
    cluster *c = f->cluster;
    if (c->options.nodes == 0)
        return draw_node(f, c->node->rank, &f->piece[0].layers, error);
    cluster_status status = CLUSTER_OK;
    for (int32_t i = 0; status == CLUSTER_OK && i < c->nodes; i++)
        status = draw_node(f, i, &f->piece[i].layers, error);
    return status;
}

/* ---- compositing, and what it all took ---- */

static cluster_status composite(frame *f, double *composite_s, vodr_error *error)
{
    cluster *c = f->cluster;
    const cluster_options *o = &c->options;
    const double begin_s = cluster_now_s();
    const composite_model seconds = {o->latency_s, o->bytes_per_s}, cycles = {o->latency_cycles, o->bytes_per_cycle};
    const composite_model *model = o->machine ? &cycles : &seconds;
    double took = 0;
    cluster_status status = o->nodes > 0 ? composite_simulate(o->composite, c->nodes, f->piece, model, &took, error)
                                         : composite_run(c->node, o->composite, &f->piece[0], model, &took, error);
    *composite_s = o->nodes > 0 && !o->machine ? took : cluster_now_s() - begin_s;
    c->report.network_cycles = o->machine ? took : 0;
    return status;
}

static void report(frame *f, double composite_s)
{
    cluster *c = f->cluster;
    double fastest = INFINITY, slowest = 0, least = INFINITY, most = 0;
    c->report.slowest_cycles = 0;
    for (int32_t i = 0; i < c->nodes; i++) {
        const cluster_share *s = &c->share[i];
        const double took_s = c->options.nodes > 0 ? s->cpu_s : s->render_s; /* others run beside a simulation */
        fastest = fmin(fastest, took_s);
        slowest = fmax(slowest, took_s);
        least = fmin(least, s->cpu_s);
        most = fmax(most, s->cpu_s);
        if (s->cycles > c->report.slowest_cycles)
            c->report.slowest_cycles = s->cycles;
    }
    c->report.slowest_s = slowest;
    c->report.barrier_share = slowest > 0 ? (slowest - fastest) / slowest : 0;
    c->report.lbr_time = most > 0 ? least / most : 0;
    if (c->options.nodes > 0)
        c->report.frame_s = slowest + composite_s;
}

/* Each node tells its share. */
static cluster_status gather_shares(frame *f, double composite_s, vodr_error *error)
{
    cluster *c = f->cluster;
    for (int32_t i = 0; i < f->pieces; i++) {
        cluster_share *s = &c->share[c->options.nodes > 0 ? i : c->node->rank];
        s->composite_s = composite_s;
        s->sent_bytes = f->piece[i].sent_bytes;
    }
    if (c->options.nodes > 0)
        return CLUSTER_OK;
    const cluster_share own = c->share[c->node->rank];
    return node_gather(c->node, &own, sizeof own, c->share, error);
}

static cluster_status finish(frame *f, double *rgba, vodr_error *error)
{
    const reference_camera *camera = &f->job->camera;
    const size_t pixels = (size_t)camera->width_px * (size_t)camera->height_px;
    if (f->cluster->node->rank != 0)
        return CLUSTER_OK;
    memset(rgba, 0, 4 * pixels * sizeof *rgba);
    cluster_status status = composite_write(&f->piece[0], f->places, camera->width_px, rgba, error);
    if (status == CLUSTER_OK && f->job->blend == REFERENCE_MIP &&
        reference_show_stored(f->job, rgba, pixels, error) != REFERENCE_OK)
        status = CLUSTER_ENVIRONMENT;
    return status;
}

cluster_status cluster_draw(cluster *c, const reference_march_job *job, double *rgba, vodr_error *error)
{
    frame f = {.cluster = c, .job = job};
    double composite_s = 0;
    const double begin_s = cluster_now_s();
    cluster_status status = cluster_agree(c->node, begin_frame(&f, error), error);
    if (status == CLUSTER_OK) {
        status = draw_nodes(&f, error);
        if (status != CLUSTER_OK)
            c->node->broken = true; /* the others wait for its layers */
    }
    if (status == CLUSTER_OK)
        status = composite(&f, &composite_s, error);
    if (status == CLUSTER_OK)
        status = cluster_agree(c->node, finish(&f, rgba, error), error);
    c->report.frame_s = cluster_now_s() - begin_s;
    if (status == CLUSTER_OK)
        status = gather_shares(&f, composite_s, error);
    c->frames++;
    if (status == CLUSTER_OK && c->options.weight == CLUSTER_TIME && c->frames >= CLUSTER_TIMED_FRAMES)
        status = weights_measure(c, &job->camera, error);
    report(&f, composite_s);
    free_frame(&f);
    return status;
}
