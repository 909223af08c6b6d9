/* division.c - a volume divided for what is to be seen of it, each node's part loaded; by time again and again, until
 * nodes are even or the best is found. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "balance.h"
#include "clustering.h"
#include "fail.h"
#include "state.h"

enum { CLUSTER_LEAST = 15 };

/* A box this full of sub-volumes that are not empty is not divided further: as the paper has it, and with best, as rays
 * pass over what is empty, but cost something in each box. */
static const double efficiency = 0.8, best_efficiency = 0.4;

/* By time, the volume is not divided anew while the nodes are as even as this. */
static const double even = 0.92;

void division_free(cluster *c)
{
    kd_tree_free(&c->tree);
    sums_free(&c->counts);
    sums_free(&c->weights);
}

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

static void tell_ratios(cluster *c)
{
    double least[2] = {INFINITY, INFINITY}, most[2] = {0, 0};
    for (int32_t i = 0; i < c->nodes; i++) {
        const double has[2] = {c->share[i].subvolumes, c->share[i].weight};
        for (int k = 0; k < 2; k++) {
            least[k] = fmin(least[k], has[k]);
            most[k] = fmax(most[k], has[k]);
        }
    }
    c->report.lbr = most[0] > 0 ? least[0] / most[0] : 0;
    c->report.lbr_weight = most[1] > 0 ? least[1] / most[1] : 0;
}

/* What each node has of the tree, before its parts are made clusters. */
static cluster_status tell_shares(cluster *c, vodr_error *error)
{
    double *total = malloc((size_t)c->nodes * sizeof *total);
    int32_t *leaves = malloc((size_t)c->nodes * sizeof *leaves);
    if (total && leaves) {
        balance_leaves(&c->tree, c->nodes, leaves);
        balance_total(&c->tree, &c->counts, c->nodes, total);
        for (int32_t i = 0; i < c->nodes; i++)
            c->share[i] = (cluster_share){.subvolumes = total[i], .parts = leaves[i], .scan_s = c->scan_s};
        balance_total(&c->tree, &c->weights, c->nodes, total);
        for (int32_t i = 0; i < c->nodes; i++)
            c->share[i].weight = total[i];
        tell_ratios(c);
    }
    cluster_status status = total && leaves ? CLUSTER_OK : cluster_no_memory(error);
    free(total);
    free(leaves);
    return status;
}

static cluster_status divide(cluster *c, const reference_march_job *job, double lo, double hi, vodr_error *error)
{
    cluster_function f;
    division_free(c);
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

static cluster_status load(cluster *c, const reference_march_job *job, double begin_s, vodr_error *error)
{
    const double divided_s = cluster_now_s();
    bricks old = c->bricks;
    cluster_status status = cluster_agree(c->node, bricks_load(c, &old, reference_border_vox(job), error), error);
    for (int32_t i = 0; i < c->nodes; i++) {
        c->share[i].divide_s = divided_s - begin_s;
        c->share[i].load_s = cluster_now_s() - divided_s;
    }
    c->frames = 0;
    return status;
}

/* ---- by time ---- */

static cluster_status copy_division(cluster *c, vodr_error *error)
{
    const size_t nodes_bytes = (size_t)c->tree.count * sizeof *c->tree.node;
    const size_t share_bytes = (size_t)c->nodes * sizeof *c->share;
    kd_node *node = malloc(nodes_bytes);
    cluster_share *share = malloc(share_bytes);
    if (!node || !share) {
        free(node);
        free(share);
        return cluster_no_memory(error);
    }
    kd_tree_free(&c->best);
    free(c->best_share);
    c->best = (kd_tree){memcpy(node, c->tree.node, nodes_bytes), c->tree.count, c->tree.count};
    c->best_share = memcpy(share, c->share, share_bytes);
    return CLUSTER_OK;
}

/* Looks at the division that was just measured, and keeps it if it is the best so far. */
static cluster_status judge(cluster *c, vodr_error *error)
{
    double slowest_s = 0;
    for (int32_t i = 0; i < c->nodes; i++)
        slowest_s = c->share[i].cpu_s > slowest_s ? c->share[i].cpu_s : slowest_s;
    const bool best = c->tries == 0 || slowest_s < c->best_s;
    c->tries++;
    if (!best)
        return CLUSTER_OK;
    c->best_s = slowest_s;
    return copy_division(c, error);
}

/* Goes back to the best division. */
static cluster_status restore(cluster *c, const reference_march_job *job, vodr_error *error)
{
    const double begin_s = cluster_now_s();
    kd_tree_free(&c->tree);
    c->tree = c->best;
    c->best = (kd_tree){0};
    for (int32_t i = 0; i < c->nodes; i++)
        c->share[i] = (cluster_share){.subvolumes = c->best_share[i].subvolumes,
                                      .weight = c->best_share[i].weight,
                                      .parts = c->best_share[i].parts,
                                      .scan_s = c->scan_s};
    tell_ratios(c);
    return load(c, job, begin_s, error);
}

/* Whether the division stays for the next frame; all nodes know the same times. */
static cluster_status look_again(cluster *c, const reference_march_job *job, bool *stays, vodr_error *error)
{
    *stays = c->frames < CLUSTER_TIMED_FRAMES || c->tries > CLUSTER_TIMED_DIVISIONS || c->report.lbr_time >= even;
    if (*stays)
        return CLUSTER_OK;
    cluster_status status = cluster_agree(c->node, judge(c, error), error);
    if (status == CLUSTER_OK && c->tries == CLUSTER_TIMED_DIVISIONS) {
        *stays = true;
        c->tries++;
        status = restore(c, job, error);
    }
    return status;
}

cluster_status cluster_place(cluster *c, const reference_march_job *job, double lo, double hi, vodr_error *error)
{
    const double begin_s = cluster_now_s();
    bool stays = false;
    cluster_status status = CLUSTER_OK;
    if (c->options.weight == CLUSTER_TIME && c->tree.count > 0)
        status = look_again(c, job, &stays, error);
    if (status != CLUSTER_OK || stays)
        return status;
    status = cluster_agree(c->node, divide(c, job, lo, hi, error), error);
    return status == CLUSTER_OK ? load(c, job, begin_s, error) : status;
}
