/* bricks.c - the voxels that a node holds: those of its boxes and the borders that samples in them read. */
#include <stdlib.h>
#include <string.h>

#include "fail.h"
#include "state.h"

void bricks_box(const cluster *c, int32_t leaf, int32_t lo_vox[3], int32_t hi_vox[3])
{
    const box *b = &c->tree.node[leaf].box;
    const subvolumes *s = &c->grid;
    for (int a = 0; a < 3; a++) {
        const int32_t end = b->hi[a] * s->edge_vox;
        lo_vox[a] = b->lo[a] * s->edge_vox;
        hi_vox[a] = end < s->dims_vox[a] ? end : s->dims_vox[a];
    }
}

static void free_brick(const cluster_source *source, brick *b)
{
    reference_close(b->renderer);
    if (b->voxels)
        source->release(source->context, b->voxels);
    *b = (brick){.owner = KD_NOBODY};
}

void bricks_free(const cluster_source *source, bricks *b)
{
    for (int32_t i = 0; i < b->count; i++)
        free_brick(source, &b->brick[i]);
    free(b->brick);
    *b = (bricks){0};
}

/* Takes a brick of the same box over; it is not loaded in `old` then. */
static bool take_over(bricks *old, brick *b)
{
    for (int32_t i = 0; i < old->count; i++) {
        brick *o = &old->brick[i];
        if (o->voxels && o->border_vox == b->border_vox && memcmp(o->lo_vox, b->lo_vox, sizeof b->lo_vox) == 0 &&
            memcmp(o->hi_vox, b->hi_vox, sizeof b->hi_vox) == 0) {
            b->voxels = o->voxels;
            b->renderer = o->renderer;
            *o = (brick){.owner = KD_NOBODY};
            return true;
        }
    }
    return false;
}

static void with_border(const cluster *c, const brick *b, int32_t lo[3], int32_t hi[3])
{
    for (int a = 0; a < 3; a++) {
        const int32_t size = c->grid.dims_vox[a];
        lo[a] = b->lo_vox[a] > b->border_vox ? b->lo_vox[a] - b->border_vox : 0;
        hi[a] = b->hi_vox[a] < size - b->border_vox ? b->hi_vox[a] + b->border_vox : size;
    }
}

static cluster_status load(const cluster *c, brick *b, vodr_error *error)
{
    int32_t lo[3], hi[3];
    reference_volume v = {0};
    with_border(c, b, lo, hi);
    cluster_status status = c->source.load(c->source.context, lo, hi, &v, &b->voxels, error);
    if (status != CLUSTER_OK)
        return status;
    for (int a = 0; a < 3; a++) {
        v.whole_vox[a] = c->grid.dims_vox[a];
        v.origin_vox[a] = lo[a];
    }
    reference_status opened = reference_open(&c->options.renderer, &v, &b->renderer, error);
    return opened == REFERENCE_OK ? CLUSTER_OK : opened == REFERENCE_INVALID ? CLUSTER_INVALID : CLUSTER_ENVIRONMENT;
}

/* Refuses what a node must not hold, before anything is loaded. */
static cluster_status check_memory(const cluster *c, vodr_error *error)
{
    for (int32_t i = 0; i < c->nodes; i++)
        if (c->options.memory_bytes && c->share[i].held_bytes > c->options.memory_bytes)
            return cluster_fail(
                error, CLUSTER_INVALID,
                "node %d of %d must hold %llu bytes of voxels, but %zu are allowed: more nodes, smaller "
                "sub-volumes or --balance best need less",
                i, c->nodes, (unsigned long long)c->share[i].held_bytes, c->options.memory_bytes);
    return CLUSTER_OK;
}

static void plan(cluster *c, int32_t border_vox)
{
    for (int32_t leaf = 0; leaf < c->tree.count; leaf++) {
        const kd_node *n = &c->tree.node[leaf];
        brick *b = &c->bricks.brick[leaf];
        *b = (brick){.owner = n->axis == KD_LEAF ? n->owner : KD_NOBODY, .border_vox = border_vox};
        if (b->owner == KD_NOBODY)
            continue;
        int32_t lo[3], hi[3];
        bricks_box(c, leaf, b->lo_vox, b->hi_vox);
        with_border(c, b, lo, hi);
        b->held_bytes =
            (size_t)(hi[0] - lo[0]) * (size_t)(hi[1] - lo[1]) * (size_t)(hi[2] - lo[2]) * (size_t)c->source.voxel_bytes;
        c->share[b->owner].held_bytes += b->held_bytes;
        c->share[b->owner].clusters++;
    }
}

static bool is_missing(const cluster *c, const brick *b)
{
    return b->owner != KD_NOBODY && cluster_holds(c, b->owner) && !b->voxels;
}

/* Says what will be loaded, where there is room for the box around it. */
static cluster_status expect(const cluster *c, vodr_error *error)
{
    int32_t lo[3] = {INT32_MAX, INT32_MAX, INT32_MAX}, hi[3] = {0, 0, 0};
    size_t bytes = (size_t)c->source.voxel_bytes, held = 0;
    for (int32_t i = 0; i < c->bricks.count; i++) {
        const brick *b = &c->bricks.brick[i];
        int32_t own[2][3];
        held += b->owner != KD_NOBODY && cluster_holds(c, b->owner) ? b->held_bytes : 0;
        if (!is_missing(c, b))
            continue;
        with_border(c, b, own[0], own[1]);
        for (int a = 0; a < 3; a++) {
            lo[a] = own[0][a] < lo[a] ? own[0][a] : lo[a];
            hi[a] = own[1][a] > hi[a] ? own[1][a] : hi[a];
        }
    }
    for (int a = 0; a < 3; a++)
        bytes *= hi[a] > lo[a] ? (size_t)(hi[a] - lo[a]) : 0;
    if (bytes == 0 || (c->options.memory_bytes && held + bytes > c->options.memory_bytes))
        return CLUSTER_OK;
    return c->source.expect(c->source.context, lo, hi, error);
}

static cluster_status load_missing(cluster *c, vodr_error *error)
{
    cluster_status status = expect(c, error);
    for (int32_t i = 0; status == CLUSTER_OK && i < c->bricks.count; i++)
        if (is_missing(c, &c->bricks.brick[i]))
            status = load(c, &c->bricks.brick[i], error);
    c->source.forget(c->source.context);
    return status;
}

cluster_status bricks_load(cluster *c, bricks *old, int32_t border_vox, vodr_error *error)
{
    c->bricks = (bricks){c->tree.count, calloc((size_t)c->tree.count, sizeof *c->bricks.brick)};
    if (!c->bricks.brick) {
        c->bricks.count = 0;
        return cluster_no_memory(error);
    }
    plan(c, border_vox);
    cluster_status status = check_memory(c, error);
    for (int32_t i = 0; status == CLUSTER_OK && i < c->bricks.count; i++) {
        brick *b = &c->bricks.brick[i];
        b->voxels = NULL;
        if (b->owner != KD_NOBODY && cluster_holds(c, b->owner))
            take_over(old, b);
    }
    bricks_free(&c->source, old);
    return status == CLUSTER_OK ? load_missing(c, error) : status;
}
