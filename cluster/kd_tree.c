/* kd_tree.c - the tree of planes, and its walk in the order of sight. */
#include "kd_tree.h"

#include <stdlib.h>
#include <string.h>

#include "fail.h"

static cluster_status add(kd_tree *t, const box *b, int32_t owner, vodr_error *error)
{
    if (t->count == t->room) {
        const int32_t room = 2 * t->room + 16;
        kd_node *grown = realloc(t->node, (size_t)room * sizeof *grown);
        if (!grown)
            return cluster_fail(error, CLUSTER_ENVIRONMENT, "no memory for a tree of %d nodes", room);
        t->node = grown;
        t->room = room;
    }
    t->node[t->count++] = (kd_node){.box = *b, .axis = KD_LEAF, .owner = owner};
    return CLUSTER_OK;
}

cluster_status kd_tree_make(const box *all, kd_tree *t, vodr_error *error)
{
    *t = (kd_tree){0};
    return add(t, all, KD_NOBODY, error);
}

void kd_tree_free(kd_tree *t)
{
    free(t->node);
    *t = (kd_tree){0};
}

cluster_status kd_tree_copy(const kd_tree *from, kd_tree *t, vodr_error *error)
{
    const size_t bytes = (size_t)from->count * sizeof *from->node;
    *t = (kd_tree){malloc(bytes), from->count, from->count};
    if (!t->node) {
        *t = (kd_tree){0};
        return cluster_fail(error, CLUSTER_ENVIRONMENT, "no memory for a tree of %d nodes", from->count);
    }
    memcpy(t->node, from->node, bytes);
    return CLUSTER_OK;
}

cluster_status kd_tree_split(kd_tree *t, int32_t leaf, int axis, int32_t at, vodr_error *error)
{
    const int32_t owner = t->node[leaf].owner;
    for (int side = 0; side < 2; side++) {
        box half = t->node[leaf].box;
        *(side ? half.lo + axis : half.hi + axis) = at;
        cluster_status status = add(t, &half, owner, error);
        if (status != CLUSTER_OK)
            return status;
        t->node[leaf].child[side] = t->count - 1;
    }
    t->node[leaf].axis = axis;
    t->node[leaf].at = at;
    t->node[leaf].owner = KD_NOBODY;
    return CLUSTER_OK;
}

kd_eye kd_eye_of(const reference_camera *c)
{
    kd_eye eye = {.parallel = true};
    for (int a = 0; a < 3; a++)
        for (int i = 1; i < 3; i++)
            if (c->direction[i][a] != 0)
                eye.parallel = false;
    for (int a = 0; a < 3; a++)
        eye.at[a] = eye.parallel ? c->direction[0][a] * c->spacing : c->origin[0][a];
    return eye;
}

static void walk(const kd_tree *t, int32_t number, const kd_eye *eye, int32_t edge_vox, int32_t *leaves, int32_t *count)
{
    const kd_node *n = &t->node[number];
    if (n->axis == KD_LEAF) {
        if (n->owner != KD_NOBODY)
            leaves[(*count)++] = number;
        return;
    }
    const double at = eye->at[n->axis];
    const int near = eye->parallel ? at < 0 : at >= (double)n->at * edge_vox;
    walk(t, n->child[near], eye, edge_vox, leaves, count);
    walk(t, n->child[1 - near], eye, edge_vox, leaves, count);
}

int32_t kd_tree_order(const kd_tree *t, const kd_eye *eye, int32_t edge_vox, int32_t *leaves)
{
    int32_t count = 0;
    walk(t, 0, eye, edge_vox, leaves, &count);
    return count;
}
