/* balance_trade.c - pieces that change owner after a division: one with too much gives a corner of one of its boxes to
 * one with too little, as long as both end up between. A corner is cut off by one to three planes of the tree. */
#include "balance.h"

#include <math.h>
#include <stdlib.h>

#include "fail.h"

enum { PLANES = 3 };

/* A slab at a side of a box, of that one at a side of its own, and so on. */
typedef struct corner {
    int32_t leaf;
    int planes; /* 0: none found */
    int axis[PLANES], side[PLANES];
    int32_t at[PLANES];
    double off; /* from what is wanted */
} corner;

typedef struct trade {
    const sums *weight;
    kd_tree *tree;
    int32_t nodes;
    double enough;
    double *total;  /* of each node */
    int32_t *parts; /* of each node */
} trade;

/* The part of a box that lies on one side of a plane. */
static box beside(const box *b, int axis, int side, int32_t at)
{
    box part = *b;
    *(side ? part.lo + axis : part.hi + axis) = at;
    return part;
}

/* Keeps a corner of less than `most` that is nearer to what is wanted than the best. */
static void keep(const corner *c, double weight, double wanted, double most, corner *best)
{
    corner found = *c;
    found.off = fabs(weight - wanted);
    if (weight > 0 && weight < most && (!best->planes || found.off < best->off))
        *best = found;
}

/* Tries all corners of a box whose first planes are those of *c up to `depth`. */
static void try_corners(const trade *t, const box *b, int depth, corner *c, double wanted, double most, corner *best)
{
    for (int a = 0; a < 3; a++) {
        if ((depth > 0 && a == c->axis[0]) || (depth > 1 && a == c->axis[1]))
            continue;
        c->axis[depth] = a;
        for (int32_t at = b->lo[a] + 1; at < b->hi[a]; at++)
            for (int side = 0; side < 2; side++) {
                const box part = beside(b, a, side, at);
                c->at[depth] = at;
                c->side[depth] = side;
                if (depth + 1 < c->planes && depth + 1 < PLANES)
                    try_corners(t, &part, depth + 1, c, wanted, most, best);
                else
                    keep(c, sums_of(t->weight, &part), wanted, most, best);
            }
    }
}

/* The corner of a node's boxes that is nearest to half of what it has more than another. Three planes are a last
 * resort. */
static corner find_corner(const trade *t, int32_t from, int32_t to)
{
    const double more = t->total[from] - t->total[to];
    corner best = {0};
    for (int planes = 1; planes <= PLANES && t->parts[from] + planes - 1 <= BALANCE_PARTS; planes++)
        for (int32_t i = 0; (planes < PLANES || !best.planes) && i < t->tree->count; i++)
            if (t->tree->node[i].axis == KD_LEAF && t->tree->node[i].owner == from)
                try_corners(t, &t->tree->node[i].box, 0, &(corner){.leaf = i, .planes = planes}, more / 2, more, &best);
    return best;
}

static cluster_status give(trade *t, const corner *c, int32_t to, vodr_error *error)
{
    int32_t leaf = c->leaf;
    const int32_t from = t->tree->node[leaf].owner;
    for (int i = 0; i < c->planes; i++) {
        cluster_status status = kd_tree_split(t->tree, leaf, c->axis[i], c->at[i], error);
        if (status != CLUSTER_OK)
            return status;
        leaf = t->tree->node[leaf].child[c->side[i]];
    }
    const double weight = sums_of(t->weight, &t->tree->node[leaf].box);
    t->tree->node[leaf].owner = to;
    t->total[from] -= weight;
    t->total[to] += weight;
    t->parts[from] += c->planes - 1;
    t->parts[to]++;
    return CLUSTER_OK;
}

/* The node with the least, or the most; `spare`: of those that may have a part more. -1: none. */
static int32_t extreme(const trade *t, bool most, bool spare)
{
    int32_t best = -1;
    for (int32_t i = 0; i < t->nodes; i++)
        if ((!spare || t->parts[i] < BALANCE_PARTS) &&
            (best < 0 || (most ? t->total[i] > t->total[best] : t->total[i] < t->total[best])))
            best = i;
    return best;
}

/* One trade, of the node with the most or to the one with the least; *done: there was one. */
static cluster_status trade_once(trade *t, bool *done, vodr_error *error)
{
    const int32_t most = extreme(t, true, false), least = extreme(t, false, false);
    *done = false;
    if (t->total[least] >= t->enough * t->total[most])
        return CLUSTER_OK;
    for (int32_t i = 0; i <= t->nodes;
         i++) { /* of the node with the most to whom it can; then of anyone to the least */
        const int32_t from = i == 0 ? most : i - 1, to = i == 0 ? extreme(t, false, true) : least;
        if (to < 0 || from == to || t->parts[to] >= BALANCE_PARTS)
            continue;
        const corner c = find_corner(t, from, to);
        if (!c.planes)
            continue;
        *done = true;
        return give(t, &c, to, error);
    }
    return CLUSTER_OK;
}

cluster_status balance_trade(const balance_input *in, double enough, kd_tree *tree, vodr_error *error)
{
    trade t = {.weight = in->weight, .tree = tree, .nodes = in->nodes, .enough = enough};
    cluster_status status = CLUSTER_OK;
    t.total = malloc((size_t)in->nodes * sizeof *t.total);
    t.parts = malloc((size_t)in->nodes * sizeof *t.parts);
    if (t.total && t.parts) {
        bool done = true;
        balance_total(tree, in->weight, in->nodes, t.total);
        balance_leaves(tree, in->occupied, in->nodes, t.parts);
        for (int32_t i = 0; status == CLUSTER_OK && done && i < 4 * in->nodes; i++)
            status = trade_once(&t, &done, error);
    } else {
        status = cluster_no_memory(error);
    }
    free(t.total);
    free(t.parts);
    return status;
}
