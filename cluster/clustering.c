/* clustering.c - tight boxes around what is not empty: at a plane of nothing, else where the signature bends most (Lee,
 * Park, Han, equations 2 and 3). */
#include "clustering.h"

#include <math.h>

typedef struct plane {
    int axis; /* -1: none */
    int32_t at;
} plane;

static double signature(const sums *s, const box *b, int axis, int32_t i)
{
    return sums_between(s, b, axis, i, i + 1);
}

/* A plane beside an empty slab, the one nearest the middle of the box. */
static plane find_gap(const sums *s, const box *b)
{
    plane best = {-1, 0};
    double nearest = INFINITY;
    for (int a = 0; a < 3; a++)
        for (int32_t i = b->lo[a] + 1; i < b->hi[a] - 1; i++) {
            const double off = fabs(i + 0.5 - (b->lo[a] + b->hi[a]) / 2.0);
            if (off < nearest && signature(s, b, a, i) == 0) {
                nearest = off;
                best = (plane){a, i};
            }
        }
    return best;
}

/* The plane between two slabs where the second difference of the signature changes sign by most. */
static plane find_bend(const sums *s, const box *b)
{
    plane best = {-1, 0};
    double greatest = 0;
    for (int a = 0; a < 3; a++) {
        double bend[2] = {0, 0};
        for (int32_t i = b->lo[a] + 1; i < b->hi[a] - 1; i++) {
            bend[0] = bend[1];
            bend[1] = signature(s, b, a, i + 1) - 2 * signature(s, b, a, i) + signature(s, b, a, i - 1);
            const double step = fabs(bend[1] - bend[0]);
            if (i > b->lo[a] + 1 && bend[0] * bend[1] < 0 && step > greatest) {
                greatest = step;
                best = (plane){a, i};
            }
        }
    }
    return best;
}

static plane find_middle(const box *b)
{
    int longest = 0;
    for (int a = 1; a < 3; a++)
        if (b->hi[a] - b->lo[a] > b->hi[longest] - b->lo[longest])
            longest = a;
    return (plane){longest, (b->lo[longest] + b->hi[longest]) / 2};
}

static cluster_status refine(kd_tree *t, int32_t leaf, const sums *occupied, double efficiency, int32_t least,
                             vodr_error *error)
{
    box *b = &t->node[leaf].box;
    *b = sums_shrink(occupied, b);
    const int64_t size = box_size(b);
    if (size == 0)
        t->node[leaf].owner = KD_NOBODY;
    if (size < least || sums_of(occupied, b) >= efficiency * (double)size)
        return CLUSTER_OK;
    plane p = find_gap(occupied, b);
    if (p.axis < 0)
        p = find_bend(occupied, b);
    if (p.axis < 0)
        p = find_middle(b);
    cluster_status status = kd_tree_split(t, leaf, p.axis, p.at, error);
    for (int side = 0; status == CLUSTER_OK && side < 2; side++)
        status = refine(t, t->node[leaf].child[side], occupied, efficiency, least, error);
    return status;
}

cluster_status clustering_refine(kd_tree *t, const sums *occupied, double efficiency, int32_t least, vodr_error *error)
{
    cluster_status status = CLUSTER_OK;
    for (int32_t i = 0, count = t->count; status == CLUSTER_OK && i < count; i++)
        if (t->node[i].axis == KD_LEAF && t->node[i].owner != KD_NOBODY)
            status = refine(t, i, occupied, efficiency, least, error);
    return status;
}
