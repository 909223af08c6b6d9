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
    free(b->made);
    *b = (brick){.owner = KD_NOBODY};
}

void bricks_free(const cluster_source *source, bricks *b)
{
    for (int32_t i = 0; i < b->count; i++)
        free_brick(source, &b->brick[i]);
    free(b->brick);
    *b = (bricks){0};
}

/* Whether two bricks are of the same box and node. */
static bool is_same(const brick *a, const brick *b)
{
    return a->owner == b->owner && a->border_vox == b->border_vox &&
           memcmp(a->lo_vox, b->lo_vox, sizeof a->lo_vox) == 0 && memcmp(a->hi_vox, b->hi_vox, sizeof a->hi_vox) == 0;
}

bool bricks_stay(const bricks *old, const brick *b)
{
    for (int32_t i = 0; i < old->count; i++)
        if (is_same(&old->brick[i], b))
            return true;
    return false;
}

/* Takes a brick of the same box over; it is not loaded in `old` then. */
static bool take_over(bricks *old, brick *b)
{
    for (int32_t i = 0; i < old->count; i++) {
        brick *o = &old->brick[i];
        if (o->renderer && is_same(o, b)) {
            b->made = o->made;
            b->voxels = o->voxels;
            b->volume = o->volume;
            b->renderer = o->renderer;
            *o = (brick){.owner = KD_NOBODY};
            return true;
        }
    }
    return false;
}

void bricks_border(const cluster *c, const brick *b, int32_t lo[3], int32_t hi[3])
{
    for (int a = 0; a < 3; a++) {
        const int32_t size = c->grid.dims_vox[a];
        lo[a] = b->lo_vox[a] > b->border_vox ? b->lo_vox[a] - b->border_vox : 0;
        hi[a] = b->hi_vox[a] < size - b->border_vox ? b->hi_vox[a] + b->border_vox : size;
    }
}

static cluster_status open_renderer(const cluster *c, brick *b, vodr_error *error)
{
    reference_status opened = reference_open(&c->options.renderer, &b->volume, &b->renderer, error);
    return opened == REFERENCE_OK ? CLUSTER_OK : opened == REFERENCE_INVALID ? CLUSTER_INVALID : CLUSTER_ENVIRONMENT;
}

static cluster_status load(const cluster *c, brick *b, vodr_error *error)
{
    int32_t lo[3], hi[3];
    bricks_border(c, b, lo, hi);
    cluster_status status = c->source.load(c->source.context, lo, hi, &b->volume, &b->voxels, error);
    if (status != CLUSTER_OK)
        return status;
    for (int a = 0; a < 3; a++) {
        b->volume.whole_vox[a] = c->grid.dims_vox[a];
        b->volume.origin_vox[a] = lo[a];
    }
    return open_renderer(c, b, error);
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
        bricks_border(c, b, lo, hi);
        b->held_bytes =
            (size_t)(hi[0] - lo[0]) * (size_t)(hi[1] - lo[1]) * (size_t)(hi[2] - lo[2]) * (size_t)c->source.voxel_bytes;
        c->share[b->owner].held_bytes += b->held_bytes;
        c->share[b->owner].clusters++;
    }
}

static bool is_missing(const cluster *c, const brick *b)
{
    return b->owner != KD_NOBODY && cluster_holds(c, b->owner) && !b->renderer;
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
        bricks_border(c, b, own[0], own[1]);
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

/* Whether no node would hold too much while it holds what it had and what it gets. */
static bool both_fit(const cluster *c, const bricks *old)
{
    bool fit = true;
    for (int32_t n = 0; c->options.memory_bytes && n < c->nodes; n++) {
        size_t bytes = c->share[n].held_bytes;
        for (int32_t i = 0; i < old->count; i++)
            bytes += old->brick[i].owner == n ? old->brick[i].held_bytes : 0;
        fit = fit && bytes <= c->options.memory_bytes;
    }
    return fit;
}

/* Puts the bricks together of what nodes hold, those that stay as they are left alone. */
static cluster_status load_from_nodes(cluster *c, bricks *old, vodr_error *error)
{
    cluster_status status = exchange_bricks(c, old, error);
    for (int32_t i = 0; status == CLUSTER_OK && i < c->bricks.count; i++) {
        brick *b = &c->bricks.brick[i];
        if (is_missing(c, b) && !take_over(old, b))
            status = open_renderer(c, b, error);
    }
    return status;
}

cluster_status bricks_load(cluster *c, bricks *old, int32_t border_vox, vodr_error *error)
{
    c->report.change = (cluster_change){0};
    c->bricks = (bricks){c->tree.count, calloc((size_t)c->tree.count, sizeof *c->bricks.brick)};
    const bool room = c->bricks.brick != NULL;
    if (room)
        plan(c, border_vox);
    else
        c->bricks.count = 0;
    cluster_status status = cluster_agree(c->node, room ? check_memory(c, error) : cluster_no_memory(error), error);
    const bool exchanges = old->count > 0 && both_fit(c, old);
    if (status == CLUSTER_OK && exchanges)
        status = load_from_nodes(c, old, error);
    bricks_free(&c->source, old);
    return status == CLUSTER_OK && !exchanges ? load_missing(c, error) : status;
}
