/* balance_adjust.c - a division carried over to other weights: planes of the tree move a few sub-volumes, so that most
 * of what nodes have stays theirs; what planes cannot do, corners that change owner do (balance_trade.c). */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "balance.h"
#include "fail.h"

/* Sub-volumes that a plane moves at a time; steps at most; nodes of a cluster of which all planes are tried. */
enum { FARTHEST = 3, MOST_STEPS = 512, MOST_NODES = 64 };

typedef struct adjustment {
    const sums *weight;
    kd_tree *tree;
    int32_t nodes;
    double *total, *tried; /* of each node: as it is, and with a plane moved */
    int32_t *parent;       /* of each node of the tree; the root's is -1 */
    double mean;
} adjustment;

/* A plane moved. */
typedef struct shift {
    int32_t number, at; /* number -1: none */
    double unevenness;
} shift;

/* Gives the boxes below a node all that its planes leave them. */
static void spread(kd_tree *t, int32_t number, const box *b)
{
    kd_node *n = &t->node[number];
    n->box = *b;
    for (int side = 0; n->axis != KD_LEAF && side < 2; side++) {
        box half = *b;
        *(side ? half.lo + n->axis : half.hi + n->axis) = n->at;
        spread(t, n->child[side], &half);
    }
}

static int32_t someone(const kd_tree *t, int32_t number)
{
    const kd_node *n = &t->node[number];
    if (n->axis == KD_LEAF)
        return n->owner;
    const int32_t first = someone(t, n->child[0]);
    return first != KD_NOBODY ? first : someone(t, n->child[1]);
}

/* Gives leaves without an owner one of a leaf near by: other weights may find something there. */
static void adopt(kd_tree *t, int32_t number, int32_t heir)
{
    kd_node *n = &t->node[number];
    if (n->axis == KD_LEAF) {
        n->owner = n->owner == KD_NOBODY ? heir : n->owner;
        return;
    }
    for (int side = 0; side < 2; side++) {
        const int32_t own = someone(t, n->child[side]), other = someone(t, n->child[1 - side]);
        adopt(t, n->child[side], own != KD_NOBODY ? own : other != KD_NOBODY ? other : heir);
    }
}

void balance_widen(kd_tree *t, const box *all)
{
    spread(t, 0, all);
    adopt(t, 0, 0);
}

/* Adds what the leaves below a node weigh, times `sign`. */
static void add(const adjustment *a, int32_t number, double sign)
{
    const kd_node *n = &a->tree->node[number];
    if (n->axis == KD_LEAF) {
        if (!box_is_empty(&n->box))
            a->tried[n->owner] += sign * sums_of(a->weight, &n->box);
        return;
    }
    add(a, n->child[0], sign);
    add(a, n->child[1], sign);
}

/* The places between which a plane of `axis` may lie on account of those below a node: not beyond any of the same axis.
 */
static void confine(const kd_tree *t, int32_t number, int axis, int side, int32_t *limit)
{
    const kd_node *n = &t->node[number];
    if (n->axis == KD_LEAF)
        return;
    if (n->axis == axis)
        *limit = side ? (n->at < *limit ? n->at : *limit) : (n->at > *limit ? n->at : *limit);
    confine(t, n->child[0], axis, side, limit);
    confine(t, n->child[1], axis, side, limit);
}

static void move(const adjustment *a, int32_t number, int32_t at)
{
    const box b = a->tree->node[number].box;
    a->tree->node[number].at = at;
    spread(a->tree, number, &b);
}

static double unevenness(const adjustment *a, const double *total)
{
    double sum = 0;
    for (int32_t i = 0; i < a->nodes; i++)
        sum += (total[i] - a->mean) * (total[i] - a->mean);
    return sum;
}

/* Tries the places beside a plane's own. */
static void try_plane(const adjustment *a, int32_t number, shift *best)
{
    const kd_node n = a->tree->node[number];
    int32_t lo = n.box.lo[n.axis], hi = n.box.hi[n.axis];
    confine(a->tree, n.child[0], n.axis, 0, &lo);
    confine(a->tree, n.child[1], n.axis, 1, &hi);
    for (int32_t at = n.at - FARTHEST; at <= n.at + FARTHEST; at++) {
        if (at == n.at || at < lo || at > hi)
            continue;
        memcpy(a->tried, a->total, (size_t)a->nodes * sizeof *a->tried);
        add(a, number, -1);
        move(a, number, at);
        add(a, number, 1);
        const double left = unevenness(a, a->tried);
        if (left < best->unevenness)
            *best = (shift){number, at, left};
    }
    move(a, number, n.at);
}

/* Tries the planes that bound the boxes of a node of the cluster. */
static void try_node(const adjustment *a, int32_t owner, shift *best)
{
    for (int32_t i = 0; i < a->tree->count; i++)
        if (a->tree->node[i].axis == KD_LEAF && a->tree->node[i].owner == owner)
            for (int32_t up = a->parent[i]; up >= 0; up = a->parent[up])
                try_plane(a, up, best);
}

/* Moves the plane that makes nodes most alike, of those beside the node with the most and the one with the least; where
 * none of these helps, of all. */
static bool step(adjustment *a)
{
    int32_t least = 0, most = 0;
    for (int32_t i = 1; i < a->nodes; i++) {
        least = a->total[i] < a->total[least] ? i : least;
        most = a->total[i] > a->total[most] ? i : most;
    }
    shift best = {-1, 0, unevenness(a, a->total) * (1 - 1e-9)};
    try_node(a, most, &best);
    try_node(a, least, &best);
    for (int32_t i = 0; best.number < 0 && a->nodes <= MOST_NODES && i < a->tree->count; i++)
        if (a->tree->node[i].axis != KD_LEAF)
            try_plane(a, i, &best);
    if (best.number < 0)
        return false;
    move(a, best.number, best.at);
    balance_total(a->tree, a->weight, a->nodes, a->total);
    return true;
}

static void find_parents(const kd_tree *t, int32_t *parent)
{
    parent[0] = -1;
    for (int32_t i = 0; i < t->count; i++)
        for (int side = 0; t->node[i].axis != KD_LEAF && side < 2; side++)
            parent[t->node[i].child[side]] = i;
}

cluster_status balance_adjust(const balance_input *in, double enough, kd_tree *t, vodr_error *error)
{
    const box all = sums_all(in->weight);
    adjustment a = {.weight = in->weight, .tree = t, .nodes = in->nodes, .mean = sums_of(in->weight, &all) / in->nodes};
    a.total = malloc((size_t)in->nodes * sizeof *a.total);
    a.tried = malloc((size_t)in->nodes * sizeof *a.tried);
    a.parent = malloc((size_t)t->count * sizeof *a.parent);
    const bool room = a.total && a.tried && a.parent;
    if (room) {
        balance_widen(t, &all);
        find_parents(t, a.parent);
        balance_total(t, in->weight, in->nodes, a.total);
        for (int i = 0; i < MOST_STEPS && balance_ratio(a.total, in->nodes) < enough; i++)
            if (!step(&a))
                break;
    }
    free(a.total);
    free(a.tried);
    free(a.parent);
    return room ? balance_trade(in, enough, t, error) : cluster_no_memory(error);
}
