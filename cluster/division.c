/* division.c - a volume divided for what is to be seen of it, and each node's part loaded. */
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
static const double efficiency = 0.8, best_efficiency = 0.2;

/* A division whose nodes are less even than this, after all that its planes can do, is made anew. */
static const double bearable = 0.9;

void division_free(cluster *c)
{
    kd_tree_free(&c->tree);
    kd_tree_free(&c->planes);
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

/* Makes the sums of sub-volumes and of their weights. */
static cluster_status sum_up(cluster *c, vodr_error *error)
{
    const size_t total = subvolumes_total(c->grid.count);
    double *count = malloc(total * sizeof *count);
    if (!count)
        return cluster_no_memory(error);
    for (size_t i = 0; i < total; i++)
        count[i] = c->occupied[i];
    sums_free(&c->counts);
    sums_free(&c->weights);
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

/* What each node has. */
static cluster_status tell_shares(cluster *c, vodr_error *error)
{
    double *total = malloc((size_t)c->nodes * sizeof *total);
    int32_t *leaves = malloc((size_t)c->nodes * sizeof *leaves);
    if (total && leaves) {
        balance_leaves(&c->planes, &c->counts, c->nodes, leaves);
        balance_total(&c->planes, &c->counts, c->nodes, total);
        for (int32_t i = 0; i < c->nodes; i++)
            c->share[i] = (cluster_share){.subvolumes = total[i], .parts = leaves[i], .scan_s = c->scan_s};
        balance_total(&c->planes, &c->weights, c->nodes, total);
        for (int32_t i = 0; i < c->nodes; i++)
            c->share[i].weight = total[i];
        tell_ratios(c);
    }
    cluster_status status = total && leaves ? CLUSTER_OK : cluster_no_memory(error);
    free(total);
    free(leaves);
    return status;
}

/* Finds what is not empty, and weighs it. */
static cluster_status weigh(cluster *c, const reference_march_job *job, double lo, double hi, vodr_error *error)
{
    cluster_function f;
    cluster_status status = function_of(job, lo, hi, &f, error);
    if (status != CLUSTER_OK)
        return status;
    c->occupied_count = octree_occupied(&c->octree, &f, c->occupied);
    free((void *)f.visible);
    weights_fill(c, &job->camera, c->weight);
    return sum_up(c, error);
}

/* Makes parts of c->planes clusters, which are c->tree. */
static cluster_status make_clusters(cluster *c, vodr_error *error)
{
    const bool best = c->options.balance == CLUSTER_BEST;
    kd_tree_free(&c->tree);
    cluster_status status = kd_tree_copy(&c->planes, &c->tree, error);
    if (status == CLUSTER_OK)
        status = tell_shares(c, error);
    if (status == CLUSTER_OK && c->options.balance != CLUSTER_STATIC)
        status = clustering_refine(&c->tree, &c->counts, best ? best_efficiency : efficiency, CLUSTER_LEAST, error);
    return status;
}

cluster_status division_load(cluster *c, const reference_march_job *job, double begin_s, vodr_error *error)
{
    cluster_status status = cluster_agree(c->node, make_clusters(c, error), error);
    if (status != CLUSTER_OK)
        return status;
    const double divided_s = cluster_now_s();
    bricks old = c->bricks;
    status = cluster_agree(c->node, bricks_load(c, &old, reference_border_vox(job), error), error);
    for (int32_t i = 0; i < c->nodes; i++) {
        c->share[i].divide_s = divided_s - begin_s;
        c->share[i].load_s = cluster_now_s() - divided_s;
    }
    c->frames = 0;
    return status;
}

/* How even the nodes are with c->planes. */
static cluster_status ratio_of(const cluster *c, double *ratio, vodr_error *error)
{
    double *total = malloc((size_t)c->nodes * sizeof *total);
    if (!total)
        return cluster_no_memory(error);
    balance_total(&c->planes, &c->weights, c->nodes, total);
    *ratio = balance_ratio(total, c->nodes);
    free(total);
    return CLUSTER_OK;
}

/* Divides from scratch, or, where there is a division by best, moves its planes if that does. */
static cluster_status divide(cluster *c, const balance_input *in, double wanted, vodr_error *error)
{
    double ratio = 0;
    cluster_status status = CLUSTER_OK;
    if (c->planes.count > 0 && c->options.balance == CLUSTER_BEST) {
        status = balance_adjust(in, wanted, &c->planes, error);
        if (status == CLUSTER_OK)
            status = ratio_of(c, &ratio, error);
    }
    if (status != CLUSTER_OK || ratio >= bearable)
        return status;
    kd_tree_free(&c->planes);
    return balance_make(c->options.balance, in, &c->planes, error);
}

static cluster_status place(cluster *c, const reference_march_job *job, double lo, double hi, double wanted,
                            vodr_error *error)
{
    const double begin_s = cluster_now_s();
    cluster_status status = weigh(c, job, lo, hi, error);
    const balance_input in = {&c->counts, &c->weights, c->nodes};
    if (status == CLUSTER_OK)
        status = divide(c, &in, wanted, error);
    status = cluster_agree(c->node, status, error);
    return status == CLUSTER_OK ? division_load(c, job, begin_s, error) : status;
}

cluster_status cluster_place(cluster *c, const reference_march_job *job, double lo, double hi, vodr_error *error)
{
    bool stays = false;
    cluster_status status = CLUSTER_OK;
    if (c->options.weight == CLUSTER_TIME && c->tree.count > 0)
        status = timing_look(c, job, &stays, error);
    return status != CLUSTER_OK || stays ? status : place(c, job, lo, hi, balance_enough, error);
}

cluster_status cluster_change_function(cluster *c, const reference_march_job *job, double lo, double hi,
                                       vodr_error *error)
{
    timing_forget(c);
    return place(c, job, lo, hi, bearable, error);
}
