/* cluster.c - a cluster opened: the values of the sub-volumes, which nodes find together; and what it reports. */
#include <stdlib.h>
#include <string.h>

#include "fail.h"
#include "state.h"

enum { REDUCED = 4096 };

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
    if (node->ranks > CLUSTER_MAX_NODES)
        return cluster_fail(error, CLUSTER_INVALID, "mpirun started %d processes, must be at most %d", node->ranks,
                            CLUSTER_MAX_NODES);
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

void cluster_close(cluster *c)
{
    if (!c)
        return;
    bricks_free(&c->source, &c->bricks);
    division_free(c);
    octree_free(&c->octree);
    subvolumes_free(&c->grid);
    free(c->occupied);
    free(c->weight);
    free(c->measured);
    free(c->share);
    kd_tree_free(&c->best);
    free(c);
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
