/* balance.c - static division, octree alone and the paper's planes; sums over nodes. */
#include "balance.h"

#include <stddef.h>

typedef struct division {
    const balance_input *in;
    kd_tree *tree;
    cluster_balance method;
} division;

int32_t balance_plane(const sums *weight, const box *b, int axis, int32_t left, int32_t right)
{
    int32_t lo = b->lo[axis], hi = b->hi[axis];
    double below = 0, above = 0;
    while (lo < hi) {
        if (below * right <= above * left) {
            below += sums_between(weight, b, axis, lo, lo + 1);
            lo++;
        } else {
            hi--;
            above += sums_between(weight, b, axis, hi, hi + 1);
        }
    }
    return lo;
}

static int longest_axis(const box *b)
{
    int longest = 0;
    for (int a = 1; a < 3; a++)
        if (b->hi[a] - b->lo[a] > b->hi[longest] - b->lo[longest])
            longest = a;
    return longest;
}

/* The axis whose turn it is, or the next that can be divided at all. */
static int turn(const box *b, int depth)
{
    for (int i = 0; i < 3; i++)
        if (b->hi[(depth + i) % 3] - b->lo[(depth + i) % 3] > 1)
            return (depth + i) % 3;
    return depth % 3;
}

/* Divides a leaf among the nodes from `first` on. */
static cluster_status divide(const division *d, int32_t leaf, int32_t first, int32_t nodes, int depth,
                             vodr_error *error)
{
    const box b = d->tree->node[leaf].box;
    d->tree->node[leaf].owner = first;
    if (nodes == 1)
        return CLUSTER_OK;
    const int32_t left = nodes / 2, right = nodes - left;
    const int axis = d->method == CLUSTER_STATIC ? longest_axis(&b) : turn(&b, depth);
    const int32_t size = b.hi[axis] - b.lo[axis];
    const int32_t at = d->method == CLUSTER_PAPER ? balance_plane(d->in->weight, &b, axis, left, right)
                                                  : b.lo[axis] + (int32_t)((int64_t)size * left / nodes);
    cluster_status status = kd_tree_split(d->tree, leaf, axis, at, error);
    if (status == CLUSTER_OK)
        status = divide(d, d->tree->node[leaf].child[0], first, left, depth + 1, error);
    if (status == CLUSTER_OK)
        status = divide(d, d->tree->node[leaf].child[1], first + left, right, depth + 1, error);
    return status;
}

cluster_status balance_make(cluster_balance method, const balance_input *in, kd_tree *t, vodr_error *error)
{
    const box all = sums_all(in->occupied);
    const division d = {in, t, method};
    if (method == CLUSTER_BEST)
        return balance_best(in, t, error);
    cluster_status status = kd_tree_make(&all, t, error);
    return status == CLUSTER_OK ? divide(&d, 0, 0, in->nodes, 0, error) : status;
}

/* ---- what nodes have ---- */

void balance_total(const kd_tree *t, const sums *s, int32_t nodes, double *total)
{
    for (int32_t i = 0; i < nodes; i++)
        total[i] = 0;
    for (int32_t i = 0; i < t->count; i++)
        if (t->node[i].axis == KD_LEAF && t->node[i].owner != KD_NOBODY)
            total[t->node[i].owner] += sums_of(s, &t->node[i].box);
}

void balance_leaves(const kd_tree *t, const sums *occupied, int32_t nodes, int32_t *leaves)
{
    for (int32_t i = 0; i < nodes; i++)
        leaves[i] = 0;
    for (int32_t i = 0; i < t->count; i++)
        if (t->node[i].axis == KD_LEAF && t->node[i].owner != KD_NOBODY && sums_of(occupied, &t->node[i].box) > 0)
            leaves[t->node[i].owner]++;
}

double balance_ratio(const double *total, int32_t nodes)
{
    double least = total[0], most = total[0];
    for (int32_t i = 1; i < nodes; i++) {
        least = total[i] < least ? total[i] : least;
        most = total[i] > most ? total[i] : most;
    }
    return most > 0 ? least / most : 0;
}
