/* cluster.c - a cluster: values of the sub-volumes found together, the volume divided, each node's part loaded. */
#include <stdlib.h>
#include <string.h>

#include "balance.h"
#include "clustering.h"
#include "fail.h"
#include "state.h"

enum { CLUSTER_LEAST = 15, REDUCED = 4096 };

/* A box this full of sub-volumes that are not empty is not divided further: as the paper has it, and with best, as rays
 * pass over what is empty, but cost something in each box. */
static const double efficiency = 0.8, best_efficiency = 0.4;

/* By time, the volume is not divided anew while the nodes are as even as this. */
static const double even = 0.92;

/* ---- opening ---- */

/* Each node knows its own layers; afterwards all know all. */
static cluster_status share_values(cluster *c, float *value, size_t count, bool most, vodr_error *error)
{
    double chunk[REDUCED];
    cluster_status status = CLUSTER_OK;
    for (size_t done = 0; status == CLUSTER_OK && c->node->ranks > 1 && done < count; done += REDUCED) {
        const size_t now = count - done < REDUCED ? count - done : REDUCED;
        for (size_t i = 0; i < now; i++)
            chunk[i] = (double)value[done + i];
        status = cluster_reduce(c->node, chunk, now, most, error);
        for (size_t i = 0; i < now; i++)
            value[done + i] = (float)chunk[i];
    }
    return status;
}

static cluster_status scan(cluster *c, vodr_error *error)
{
    subvolumes *s = &c->grid;
    const int64_t deep = s->count[2], rank = c->node->rank, ranks = c->node->ranks;
    const int32_t first = (int32_t)(deep * rank / ranks), end = (int32_t)(deep * (rank + 1) / ranks);
    const size_t across = (size_t)s->count[0] * (size_t)s->count[1], total = subvolumes_total(s->count);
    cluster_status status = CLUSTER_OK;
    if (first < end)
        status = c->source.scan(c->source.context, s->edge_vox, first, end, s->least + across * (size_t)first,
                                s->most + across * (size_t)first, error);
    status = cluster_agree(c->node, status, error);
    if (status == CLUSTER_OK)
        status = share_values(c, s->least, total, false, error);
    return status == CLUSTER_OK ? share_values(c, s->most, total, true, error) : status;
}

static cluster_status make(cluster *c, vodr_error *error)
{
    cluster_status status = subvolumes_make(c->source.dims_vox, c->options.subvolume_vox, &c->grid, error);
    if (status == CLUSTER_OK) {
        const size_t total = subvolumes_total(c->grid.count);
        c->occupied = malloc(total);
        c->weight = malloc(total * sizeof *c->weight);
        c->share = calloc((size_t)c->nodes, sizeof *c->share);
        if (!c->occupied || !c->weight || !c->share)
            status = cluster_no_memory(error);
    }
    status = cluster_agree(c->node, status, error);
    if (status == CLUSTER_OK)
        status = scan(c, error);
    return status == CLUSTER_OK ? cluster_agree(c->node, octree_make(&c->grid, &c->octree, error), error) : status;
}

cluster_status cluster_open(const cluster_options *options, const cluster_source *source, cluster_node *node,
                            cluster **out, vodr_error *error)
{
    *out = NULL;
    if (options->nodes > 0 && node->ranks > 1)
        return cluster_fail(error, CLUSTER_INVALID, "--nodes %d simulates nodes in one process, but mpirun started %d",
                            options->nodes, node->ranks);
    cluster *c = calloc(1, sizeof *c);
    if (!c) {
        node->broken = true;
        return cluster_no_memory(error);
    }
    c->options = *options;
    c->source = *source;
    c->node = node;
    c->nodes = options->nodes > 0 ? options->nodes : node->ranks;
    const double begin_s = cluster_now_s();
    cluster_status status = make(c, error);
    c->scan_s = cluster_now_s() - begin_s;
    if (status == CLUSTER_OK)
        *out = c;
    else
        cluster_close(c);
    return status;
}

static void free_division(cluster *c)
{
    kd_tree_free(&c->tree);
    sums_free(&c->counts);
    sums_free(&c->weights);
}

void cluster_close(cluster *c)
{
    if (!c)
        return;
    bricks_free(&c->source, &c->bricks);
    free_division(c);
    octree_free(&c->octree);
    subvolumes_free(&c->grid);
    free(c->occupied);
    free(c->weight);
    free(c->measured);
    free(c->share);
    free(c);
}

/* ---- dividing ---- */

/* What the table of a job shows. */
static cluster_status function_of(const reference_march_job *job, double lo, double hi, cluster_function *f,
                                  vodr_error *error)
{
    const reference_table *t = &job->table;
    int32_t *visible = calloc((size_t)t->columns + 1, sizeof *visible);
    if (!visible)
        return cluster_no_memory(error);
    for (int32_t i = 0; i < t->columns; i++) {
        bool shows = false;
        for (int32_t row = 0; row < t->rows; row++)
            shows |= t->rgba[4 * ((size_t)row * (size_t)t->columns + (size_t)i) + 3] > 0;
        visible[i + 1] = visible[i] + shows;
    }
    *f = (cluster_function){t->columns, visible, lo, hi, job->blend == REFERENCE_MIP};
    return CLUSTER_OK;
}

static cluster_status sum_up(cluster *c, vodr_error *error)
{
    const size_t total = subvolumes_total(c->grid.count);
    double *count = malloc(total * sizeof *count);
    if (!count)
        return cluster_no_memory(error);
    for (size_t i = 0; i < total; i++)
        count[i] = c->occupied[i];
    cluster_status status = sums_make(c->grid.count, count, &c->counts, error);
    if (status == CLUSTER_OK)
        status = sums_make(c->grid.count, c->weight, &c->weights, error);
    free(count);
    return status;
}

/* What each node has of the tree, before its parts are made clusters. */
static cluster_status tell_shares(cluster *c, vodr_error *error)
{
    double *total = malloc((size_t)c->nodes * sizeof *total);
    int32_t *leaves = malloc((size_t)c->nodes * sizeof *leaves);
    if (total && leaves) {
        balance_leaves(&c->tree, c->nodes, leaves);
        balance_total(&c->tree, &c->counts, c->nodes, total);
        c->report.lbr = balance_ratio(total, c->nodes);
        for (int32_t i = 0; i < c->nodes; i++)
            c->share[i] = (cluster_share){.subvolumes = total[i], .parts = leaves[i], .scan_s = c->scan_s};
        balance_total(&c->tree, &c->weights, c->nodes, total);
        c->report.lbr_weight = balance_ratio(total, c->nodes);
        for (int32_t i = 0; i < c->nodes; i++)
            c->share[i].weight = total[i];
    }
    cluster_status status = total && leaves ? CLUSTER_OK : cluster_no_memory(error);
    free(total);
    free(leaves);
    return status;
}

static cluster_status divide(cluster *c, const reference_march_job *job, double lo, double hi, vodr_error *error)
{
    cluster_function f;
    free_division(c);
    cluster_status status = function_of(job, lo, hi, &f, error);
    if (status != CLUSTER_OK)
        return status;
    c->occupied_count = octree_occupied(&c->octree, &f, c->occupied);
    free((void *)f.visible);
    weights_fill(c, &job->camera, c->weight);
    status = sum_up(c, error);
    const balance_input in = {&c->counts, &c->weights, c->nodes};
    if (status == CLUSTER_OK)
        status = balance_make(c->options.balance, &in, &c->tree, error);
    if (status == CLUSTER_OK)
        status = tell_shares(c, error);
    if (status == CLUSTER_OK && c->options.balance != CLUSTER_STATIC)
        status =
            clustering_refine(&c->tree, &c->counts, c->options.balance == CLUSTER_BEST ? best_efficiency : efficiency,
                              CLUSTER_LEAST, error);
    return status;
}

cluster_status cluster_place(cluster *c, const reference_march_job *job, double lo, double hi, vodr_error *error)
{
    const double begin_s = cluster_now_s();
    const bool timing = c->frames > 0 && c->frames < CLUSTER_TIMED_FRAMES;
    double told_even = c->options.weight == CLUSTER_TIME && (timing || (c->measured && c->report.lbr_time >= even));
    cluster_status status = cluster_reduce(c->node, &told_even, 1, false, error); /* they time the same, but round */
    if (status != CLUSTER_OK || told_even > 0)
        return status;
    c->frames = 0;
    status = cluster_agree(c->node, divide(c, job, lo, hi, error), error);
    if (status != CLUSTER_OK)
        return status;
    const double divided_s = cluster_now_s();
    bricks old = c->bricks;
    status = cluster_agree(c->node, bricks_load(c, &old, reference_border_vox(job), error), error);
    for (int32_t i = 0; i < c->nodes; i++) {
        c->share[i].divide_s = divided_s - begin_s;
        c->share[i].load_s = cluster_now_s() - divided_s;
    }
    return status;
}

cluster_report cluster_reported(const cluster *c)
{
    cluster_report r = c->report;
    r.nodes = c->nodes;
    r.simulated = c->options.nodes > 0;
    r.subvolumes = (int64_t)subvolumes_total(c->grid.count);
    r.occupied = c->occupied_count;
    r.share = c->share;
    return r;
}
