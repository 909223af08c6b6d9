/* subvolumes.c - the min/max octree over the sub-volumes, and what is empty in it under a transfer function (Lee, Park,
 * Han, section 4.1). */
#include "subvolumes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fail.h"

cluster_status subvolumes_make(const int32_t dims_vox[3], int32_t edge_vox, subvolumes *s, vodr_error *error)
{
    *s = (subvolumes){.edge_vox = edge_vox};
    for (int a = 0; a < 3; a++) {
        s->dims_vox[a] = dims_vox[a];
        s->count[a] = (dims_vox[a] + edge_vox - 1) / edge_vox;
    }
    const size_t total = subvolumes_total(s->count);
    if (total > INT32_MAX)
        return cluster_fail(error, CLUSTER_INVALID, "%zu sub-volumes of %d voxels: must be at most %d", total, edge_vox,
                            INT32_MAX);
    s->least = malloc(total * sizeof *s->least);
    s->most = malloc(total * sizeof *s->most);
    if (!s->least || !s->most) {
        subvolumes_free(s);
        return cluster_fail(error, CLUSTER_ENVIRONMENT, "no memory for %zu sub-volumes", total);
    }
    for (size_t i = 0; i < total; i++) {
        s->least[i] = INFINITY;
        s->most[i] = -INFINITY;
    }
    return CLUSTER_OK;
}

void subvolumes_free(subvolumes *s)
{
    free(s->least);
    free(s->most);
    *s = (subvolumes){0};
}

/* ---- the octree ---- */

static void widen(octree *o, size_t parent, size_t child)
{
    o->least[parent] = fminf(o->least[parent], o->least[child]);
    o->most[parent] = fmaxf(o->most[parent], o->most[child]);
}

static size_t number(const octree *o, int level, const int32_t at[3])
{
    const int32_t *n = o->count[level];
    return o->offset[level] + ((size_t)at[2] * (size_t)n[1] + (size_t)at[1]) * (size_t)n[0] + (size_t)at[0];
}

static void fill_parents(octree *o, int level)
{
    const int32_t *n = o->count[level];
    int32_t at[3];
    for (at[2] = 0; at[2] < n[2]; at[2]++)
        for (at[1] = 0; at[1] < n[1]; at[1]++)
            for (at[0] = 0; at[0] < n[0]; at[0]++)
                widen(o, number(o, level + 1, (int32_t[]){at[0] / 2, at[1] / 2, at[2] / 2}), number(o, level, at));
}

cluster_status octree_make(const subvolumes *s, octree *o, vodr_error *error)
{
    *o = (octree){.levels = 1};
    memcpy(o->count[0], s->count, sizeof o->count[0]);
    size_t total = subvolumes_total(s->count);
    for (int l = 0; subvolumes_total(o->count[l]) > 1; l++, o->levels++) {
        for (int a = 0; a < 3; a++)
            o->count[l + 1][a] = (o->count[l][a] + 1) / 2;
        o->offset[l + 1] = total;
        total += subvolumes_total(o->count[l + 1]);
    }
    o->least = malloc(total * sizeof *o->least);
    o->most = malloc(total * sizeof *o->most);
    if (!o->least || !o->most) {
        octree_free(o);
        return cluster_fail(error, CLUSTER_ENVIRONMENT, "no memory for an octree of %zu nodes", total);
    }
    const size_t leaves = subvolumes_total(s->count);
    for (size_t i = 0; i < total; i++) {
        o->least[i] = i < leaves ? s->least[i] : INFINITY;
        o->most[i] = i < leaves ? s->most[i] : -INFINITY;
    }
    for (int l = 0; l + 1 < o->levels; l++)
        fill_parents(o, l);
    return CLUSTER_OK;
}

void octree_free(octree *o)
{
    free(o->least);
    free(o->most);
    *o = (octree){0};
}

/* ---- emptiness ---- */

typedef struct test {
    const octree *octree;
    const cluster_function *function;
    uint8_t *occupied;
    int64_t count;
} test;

/* The column of a value, far inside the table's rounding. */
static double column_of(const cluster_function *f, double value)
{
    const double width = f->hi - f->lo, place = width > 0 ? (value - f->lo) / width : 0;
    return fmin(fmax(place, 0), 1) * (f->columns - 1);
}

static bool shows(const cluster_function *f, double least, double most)
{
    if (!(least <= most))
        return false;
    const int32_t end = f->columns - 1;
    const int32_t first = f->mip ? 0 : (int32_t)fmax(floor(column_of(f, least) - 0.01), 0);
    const int32_t last = (int32_t)fmin(floor(column_of(f, most) + 0.01) + 1, end);
    return f->visible[last + 1] > f->visible[first];
}

static void visit(test *t, int level, const int32_t at[3])
{
    const octree *o = t->octree;
    const size_t own = number(o, level, at);
    if (!shows(t->function, (double)o->least[own], (double)o->most[own]))
        return;
    if (level == 0) {
        t->occupied[own] = 1;
        t->count++;
        return;
    }
    const int32_t *n = o->count[level - 1];
    for (int i = 0; i < 8; i++) {
        const int32_t child[3] = {2 * at[0] + (i & 1), 2 * at[1] + (i >> 1 & 1), 2 * at[2] + (i >> 2)};
        if (child[0] < n[0] && child[1] < n[1] && child[2] < n[2])
            visit(t, level - 1, child);
    }
}

int64_t octree_occupied(const octree *o, const cluster_function *f, uint8_t *occupied)
{
    test t = {o, f, occupied, 0};
    memset(occupied, 0, subvolumes_total(o->count[0]));
    visit(&t, o->levels - 1, (int32_t[]){0, 0, 0});
    return t.count;
}
