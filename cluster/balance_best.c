/* balance_best.c - division by the best plane of all three axes; where the slabs are too thick for any plane to divide
 * the weight well, a slab at a side of the box is first cut off as a further part of one node, so that two planes
 * together do. Both are planes of the tree, whose order of sight holds. */
#include "balance.h"

#include <math.h>
#include <stdlib.h>

#include "fail.h"

/* A node's load may be off by this share of it, if that saves a further part. */
static const double slack = 0.004;

/* A way to divide a box: a slab [.., peel_at) or [peel_at, ..) of an axis for one node, and a plane through the rest.
 */
typedef struct cut {
    int peel_axis, peel_side; /* axis -1: no slab; side 0: the lower one */
    int32_t peel_at;
    int32_t peel_owner;
    int axis;
    int32_t at;
    double off;  /* weight on the wrong side of the plane */
    double area; /* sub-volumes that the planes cut through */
} cut;

typedef struct search {
    const balance_input *in;
    kd_tree *tree;
    double *target; /* of each node: weight it is still to get */
    int32_t *parts; /* of each node so far, its last not counted */
} search;

static double sum_of(const double *value, int32_t first, int32_t count)
{
    double sum = 0;
    for (int32_t i = first; i < first + count; i++)
        sum += value[i];
    return sum;
}

/* Whether a is better than b. `fine`: weight that may be off. */
static bool better(const cut *a, const cut *b, double fine)
{
    const double off[2] = {fmax(a->off, fine), fmax(b->off, fine)};
    return off[0] != off[1] ? off[0] < off[1] : a->area < b->area;
}

static double face(const box *b, int axis)
{
    return (double)(b->hi[(axis + 1) % 3] - b->lo[(axis + 1) % 3]) * (b->hi[(axis + 2) % 3] - b->lo[(axis + 2) % 3]);
}

/* The least plane of an axis with at least `weight` below it. */
static int32_t plane_of(const sums *s, const box *b, int axis, double weight)
{
    int32_t lo = b->lo[axis], hi = b->hi[axis];
    while (lo < hi) {
        const int32_t middle = lo + (hi - lo) / 2;
        if (sums_between(s, b, axis, b->lo[axis], middle) >= weight)
            hi = middle;
        else
            lo = middle + 1;
    }
    return lo;
}

/* Tries the two planes of an axis next to `weight` below. */
static void try_planes(const sums *s, const box *b, double weight, double fine, cut c, cut *best)
{
    const double area = c.area;
    for (c.axis = 0; c.axis < 3; c.axis++) {
        const int32_t at = plane_of(s, b, c.axis, weight);
        c.area = area + face(b, c.axis);
        for (c.at = at - 1; c.at <= at; c.at++) {
            if (c.at < b->lo[c.axis])
                continue;
            c.off = fabs(sums_between(s, b, c.axis, b->lo[c.axis], c.at) - weight);
            if (best->axis < 0 || better(&c, best, fine))
                *best = c;
        }
    }
}

/* The node of [first, first + count) that takes a slab of so much: it has room for it and a further part, and the
 * fewest parts; -1: none. */
static int32_t taker(const search *s, int32_t first, int32_t count, double weight)
{
    int32_t best = -1;
    for (int32_t i = first; i < first + count; i++)
        if (s->parts[i] + 1 < BALANCE_PARTS && s->target[i] > weight * 1.25 &&
            (best < 0 || s->parts[i] < s->parts[best]))
            best = i;
    return best;
}

/* Tries a slab for either half of the nodes, and planes through the rest. */
static void try_peel(const search *s, const box *b, int32_t first, int32_t left, int32_t right, cut c, double fine,
                     cut *best)
{
    box slab = *b, rest = *b;
    *(c.peel_side ? slab.lo + c.peel_axis : slab.hi + c.peel_axis) = c.peel_at;
    *(c.peel_side ? rest.hi + c.peel_axis : rest.lo + c.peel_axis) = c.peel_at;
    const double weight = sums_of(s->in->weight, &slab), wanted = sum_of(s->target, first, left);
    if (weight == 0)
        return;
    c.area = face(b, c.peel_axis);
    for (int half = 0; half < 2; half++) {
        c.peel_owner = half ? taker(s, first + left, right, weight) : taker(s, first, left, weight);
        if (c.peel_owner >= 0)
            try_planes(s->in->weight, &rest, half ? wanted : wanted - weight, fine, c, best);
    }
}

static cut find_cut(const search *s, const box *b, int32_t first, int32_t left, int32_t right)
{
    const double wanted = sum_of(s->target, first, left), fine = slack * wanted / left;
    cut best = {.axis = -1};
    try_planes(s->in->weight, b, wanted, fine, (cut){.peel_axis = -1}, &best);
    if (best.off <= fine)
        return best;
    for (int axis = 0; axis < 3; axis++)
        for (int32_t at = b->lo[axis] + 1; at < b->hi[axis]; at++)
            for (int side = 0; side < 2; side++)
                try_peel(s, b, first, left, right, (cut){.peel_axis = axis, .peel_side = side, .peel_at = at}, fine,
                         &best);
    return best;
}

/* Scales what nodes are still to get to what there is for them. */
static void settle(search *s, int32_t first, int32_t count, double weight)
{
    const double wanted = sum_of(s->target, first, count);
    for (int32_t i = first; wanted > 0 && i < first + count; i++)
        s->target[i] *= weight / wanted;
}

/* Cuts the slab off; *leaf becomes what is left. */
static cluster_status peel(search *s, const cut *c, int32_t *leaf, vodr_error *error)
{
    cluster_status status = kd_tree_split(s->tree, *leaf, c->peel_axis, c->peel_at, error);
    if (status != CLUSTER_OK)
        return status;
    const int32_t slab = s->tree->node[*leaf].child[c->peel_side];
    *leaf = s->tree->node[*leaf].child[1 - c->peel_side];
    s->tree->node[slab].owner = c->peel_owner;
    s->target[c->peel_owner] -= sums_of(s->in->weight, &s->tree->node[slab].box);
    s->parts[c->peel_owner]++;
    return CLUSTER_OK;
}

static cluster_status divide(search *s, int32_t leaf, int32_t first, int32_t nodes, vodr_error *error)
{
    box *b = &s->tree->node[leaf].box;
    *b = sums_shrink(s->in->occupied, b);
    s->tree->node[leaf].owner = box_is_empty(b) ? KD_NOBODY : first;
    if (nodes == 1 || box_is_empty(b))
        return CLUSTER_OK;
    settle(s, first, nodes, sums_of(s->in->weight, b));
    const int32_t left = nodes / 2, right = nodes - left;
    const cut c = find_cut(s, b, first, left, right);
    cluster_status status = c.peel_axis < 0 ? CLUSTER_OK : peel(s, &c, &leaf, error);
    if (status == CLUSTER_OK)
        status = kd_tree_split(s->tree, leaf, c.axis, c.at, error);
    if (status == CLUSTER_OK)
        status = divide(s, s->tree->node[leaf].child[0], first, left, error);
    if (status == CLUSTER_OK)
        status = divide(s, s->tree->node[leaf].child[1], first + left, right, error);
    return status;
}

cluster_status balance_best(const balance_input *in, kd_tree *t, vodr_error *error)
{
    const box all = sums_all(in->occupied);
    search s = {.in = in, .tree = t};
    cluster_status status = kd_tree_make(&all, t, error);
    if (status != CLUSTER_OK)
        return status;
    s.target = malloc((size_t)in->nodes * sizeof *s.target);
    s.parts = calloc((size_t)in->nodes, sizeof *s.parts);
    for (int32_t i = 0; s.target && i < in->nodes; i++)
        s.target[i] = 1;
    if (s.target && s.parts)
        status = divide(&s, 0, 0, in->nodes, error);
    else
        status = cluster_no_memory(error);
    free(s.target);
    free(s.parts);
    return status == CLUSTER_OK ? balance_trade(in, balance_enough, t, error) : status;
}
