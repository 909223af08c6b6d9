/* balance.h - which node draws which sub-volumes. */
#ifndef CLUSTER_BALANCE_H
#define CLUSTER_BALANCE_H

#include "kd_tree.h"

/* Parts of one node at most, with CLUSTER_BEST. */
enum { BALANCE_PARTS = 4 };

/* What is to be divided. */
typedef struct balance_input {
    const sums *occupied; /* 1 for each sub-volume that is not empty */
    const sums *weight;   /* what drawing it costs; 0 for empty ones */
    int32_t nodes;
} balance_input;

/* Nodes are equal enough for a division from scratch. */
static const double balance_enough = 0.99;

/* Divides all sub-volumes among the nodes: leaves with owners from 0 on, numbered as the tree's walk from one side has
 * them. A node may get nothing where there are not enough sub-volumes.
 *
 * static: parts as equal in space as can be, the longest axis first. octree: halves in space, axes in turn, as the root
 * of an octree has children; more than eight parts are halves of those. paper: planes by signature lists, axes in turn
 * (Lee, Park, Han, figure 6). best: the three axes tried, and where no plane divides the weight well, a further part is
 * cut off beside: balance_best.c. All but best are one part a node. */
cluster_status balance_make(cluster_balance method, const balance_input *in, kd_tree *t, vodr_error *error);

/* The method CLUSTER_BEST. */
cluster_status balance_best(const balance_input *in, kd_tree *t, vodr_error *error);

/* What it ends with: pieces change owner until the least of the nodes' weights is `enough` of the greatest, or no piece
 * helps, or all have BALANCE_PARTS parts. */
cluster_status balance_trade(const balance_input *in, double enough, kd_tree *t, vodr_error *error);

/* Makes a division with CLUSTER_BEST, of the same nodes, even for other weights: first planes move, then pieces change
 * owner, until the ratio is `enough` or nothing helps. Boxes come to hold all that planes leave them, empty or not. */
cluster_status balance_adjust(const balance_input *in, double enough, kd_tree *t, vodr_error *error);

/* Gives leaves all that planes leave them, and an owner each, so that they cover `all`. */
void balance_widen(kd_tree *t, const box *all);

/* The place of the plane that divides the weight in a box as left:right, by walking from both ends, always on the side
 * that has less of its share. Between lo and hi of the axis, both included. */
int32_t balance_plane(const sums *weight, const box *b, int axis, int32_t left, int32_t right);

/* What each node has: sums over its leaves into total[nodes]. */
void balance_total(const kd_tree *t, const sums *s, int32_t nodes, double *total);

/* Leaves of each node that hold something. */
void balance_leaves(const kd_tree *t, const sums *occupied, int32_t nodes, int32_t *leaves);

/* The least over the greatest, 0 where both are 0 (Lee, Park, Han, equation 4). */
double balance_ratio(const double *total, int32_t nodes);

#endif
