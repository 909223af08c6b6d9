/* kd_tree.h - the tree of planes that divides the sub-volumes among nodes, and each node's among its clusters; walked
 * in the order of sight (Lee, Park, Han, sections 4.2 to 4.4: the global and the local BSP trees are one here). */
#ifndef CLUSTER_KD_TREE_H
#define CLUSTER_KD_TREE_H

#include "sums.h"

enum { KD_LEAF = -1, KD_NOBODY = -1 };

typedef struct kd_node {
    box box;
    int32_t axis;     /* of its plane; KD_LEAF: it has none */
    int32_t at;       /* the plane: sub-volumes below it are of child[0] */
    int32_t child[2]; /* numbers of nodes */
    int32_t owner;    /* leaves: the node that draws it, or KD_NOBODY: it is empty */
} kd_node;

/* Node 0 is the root. */
typedef struct kd_tree {
    kd_node *node; /* owned */
    int32_t count, room;
} kd_tree;

/* A tree of one leaf that nobody owns. */
cluster_status kd_tree_make(const box *all, kd_tree *t, vodr_error *error);
void kd_tree_free(kd_tree *t);
cluster_status kd_tree_copy(const kd_tree *from, kd_tree *t, vodr_error *error);

/* Divides a leaf by a plane inside its box or at its side; both halves are its owner's. */
cluster_status kd_tree_split(kd_tree *t, int32_t leaf, int axis, int32_t at, vodr_error *error);

/* Where the eye is: with `parallel` the direction of sight, else a point, in voxels. */
typedef struct kd_eye {
    bool parallel;
    double at[3];
} kd_eye;

/* The eye of a camera. */
kd_eye kd_eye_of(const reference_camera *c);

/* The numbers of the leaves that have an owner, front to back, into leaves[], which has room for t->count. Returns how
 * many. */
int32_t kd_tree_order(const kd_tree *t, const kd_eye *eye, int32_t edge_vox, int32_t *leaves);

#endif
