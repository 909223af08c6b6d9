/* exchange.c - boxes put together of what nodes already hold, when a volume is divided anew (Lee, Park, Han,
 * section 4.5): of the voxels that a new box needs, those that its node holds are copied, those that others hold are
 * sent by one of them, and only what no node holds is read from the file. All nodes make the same plan. */
#include <stdlib.h>
#include <string.h>

#include "fail.h"
#include "state.h"

enum { FILE_ITSELF = -1 };

/* What a new box gets from an old one, or from the file. */
typedef struct piece {
    int32_t to, from; /* numbers of bricks */
    box box;
} piece;

typedef struct plan {
    const cluster *cluster;
    const bricks *old;
    piece *piece; /* owned */
    size_t count, room;
    box *left, *next; /* owned: what of a box is still to be found, and what is left of that */
    size_t lefts, nexts, room_left, room_next;
    bool full; /* memory is out */
} plan;

static box common(const box *a, const box *b)
{
    box c;
    for (int i = 0; i < 3; i++) {
        c.lo[i] = a->lo[i] > b->lo[i] ? a->lo[i] : b->lo[i];
        c.hi[i] = a->hi[i] < b->hi[i] ? a->hi[i] : b->hi[i];
    }
    return c;
}

static box held_of(const cluster *c, const brick *b)
{
    box held;
    bricks_border(c, b, held.lo, held.hi);
    return held;
}

/* Makes room for one more; false where memory is out. */
static bool grow(void **list, size_t count, size_t *room, size_t size)
{
    if (count < *room)
        return true;
    void *grown = realloc(*list, (2 * *room + 16) * size);
    if (!grown)
        return false;
    *list = grown;
    *room = 2 * *room + 16;
    return true;
}

static void keep(plan *p, const box *b)
{
    if (box_is_empty(b))
        return;
    if (grow((void **)&p->next, p->nexts, &p->room_next, sizeof *p->next))
        p->next[p->nexts++] = *b;
    else
        p->full = true;
}

static void add_piece(plan *p, int32_t to, int32_t from, const box *b)
{
    if (grow((void **)&p->piece, p->count, &p->room, sizeof *p->piece))
        p->piece[p->count++] = (piece){to, from, *b};
    else
        p->full = true;
}

/* Keeps what is left of a box outside `part` of it, as up to six boxes. */
static void keep_rest(plan *p, box b, const box *part)
{
    for (int a = 0; a < 3; a++) {
        box side = b;
        side.hi[a] = part->lo[a];
        keep(p, &side);
        side = b;
        side.lo[a] = part->hi[a];
        keep(p, &side);
        b.lo[a] = part->lo[a];
        b.hi[a] = part->hi[a];
    }
}

/* Takes what an old box has of what is still to be found. */
static void take_from(plan *p, int32_t to, int32_t from)
{
    const box held = held_of(p->cluster, &p->old->brick[from]);
    p->nexts = 0;
    for (size_t i = 0; i < p->lefts; i++) {
        const box part = common(&p->left[i], &held);
        if (box_is_empty(&part)) {
            keep(p, &p->left[i]);
            continue;
        }
        add_piece(p, to, from, &part);
        keep_rest(p, p->left[i], &part);
    }
    box *const left = p->left;
    const size_t room = p->room_left;
    p->left = p->next;
    p->lefts = p->nexts;
    p->room_left = p->room_next;
    p->next = left;
    p->room_next = room;
}

/* Plans a new box: of its own node's first. */
static void plan_brick(plan *p, int32_t to)
{
    const brick *b = &p->cluster->bricks.brick[to];
    const box all = held_of(p->cluster, b);
    p->nexts = 0;
    keep(p, &all);
    p->lefts = 0;
    if (!p->full && grow((void **)&p->left, 0, &p->room_left, sizeof *p->left))
        p->left[p->lefts++] = all;
    for (int own = 1; own >= 0; own--)
        for (int32_t i = 0; !p->full && p->lefts > 0 && i < p->old->count; i++) {
            const int32_t owner = p->old->brick[i].owner;
            if (owner != KD_NOBODY && (owner == b->owner) == own)
                take_from(p, to, i);
        }
    for (size_t i = 0; i < p->lefts; i++)
        add_piece(p, to, FILE_ITSELF, &p->left[i]);
}

static void make_plan(plan *p)
{
    for (int32_t i = 0; !p->full && i < p->cluster->bricks.count; i++)
        if (p->cluster->bricks.brick[i].owner != KD_NOBODY && !bricks_stay(p->old, &p->cluster->bricks.brick[i]))
            plan_brick(p, i);
}

/* ---- voxels ---- */

/* Copies a box of voxels between volumes, or a volume and a row of bytes (NULL). */
static void copy(const reference_volume *from, const reference_volume *to, const box *b, size_t voxel, char *bytes)
{
    const size_t row = (size_t)(b->hi[0] - b->lo[0]) * voxel;
    for (int32_t z = b->lo[2]; z < b->hi[2]; z++)
        for (int32_t y = b->lo[1]; y < b->hi[1]; y++) {
            char *place[2] = {bytes, bytes};
            for (int i = 0; i < 2; i++) {
                const reference_volume *v = i ? to : from;
                if (v)
                    place[i] =
                        (char *)v->voxels +
                        (((size_t)(z - v->origin_vox[2]) * (size_t)v->dims_vox[1] + (size_t)(y - v->origin_vox[1])) *
                             (size_t)v->dims_vox[0] +
                         (size_t)(b->lo[0] - v->origin_vox[0])) *
                            voxel;
            }
            memcpy(place[1], place[0], row);
            bytes = bytes ? bytes + row : NULL;
        }
}

static int32_t owner_of(const bricks *b, int32_t number)
{
    return b->brick[number].owner;
}

/* Room for the boxes of this process that do not stay. */
static cluster_status make_room(cluster *c, const bricks *old, vodr_error *error)
{
    static const reference_voxel type[] = {[1] = REFERENCE_UINT8, [2] = REFERENCE_UINT16, [4] = REFERENCE_FLOAT32};
    for (int32_t i = 0; i < c->bricks.count; i++) {
        brick *b = &c->bricks.brick[i];
        if (b->owner == KD_NOBODY || !cluster_holds(c, b->owner) || bricks_stay(old, b))
            continue;
        const box held = held_of(c, b);
        b->made = malloc(b->held_bytes);
        if (!b->made)
            return cluster_no_memory(error);
        b->volume = (reference_volume){.type = type[c->source.voxel_bytes], .voxels = b->made};
        for (int a = 0; a < 3; a++) {
            b->volume.dims_vox[a] = held.hi[a] - held.lo[a];
            b->volume.whole_vox[a] = c->grid.dims_vox[a];
            b->volume.origin_vox[a] = held.lo[a];
        }
    }
    return CLUSTER_OK;
}

/* Copies what this process holds, and reads what no node does. */
static cluster_status fill_own(const plan *p, vodr_error *error)
{
    const cluster *c = p->cluster;
    const size_t voxel = (size_t)c->source.voxel_bytes;
    for (size_t i = 0; i < p->count; i++) {
        const piece *n = &p->piece[i];
        const brick *to = &c->bricks.brick[n->to];
        if (!cluster_holds(c, to->owner))
            continue;
        if (n->from != FILE_ITSELF) {
            if (cluster_holds(c, owner_of(p->old, n->from)))
                copy(&p->old->brick[n->from].volume, &to->volume, &n->box, voxel, NULL);
            continue;
        }
        reference_volume v = {0};
        void *owner = NULL;
        cluster_status status = c->source.load(c->source.context, n->box.lo, n->box.hi, &v, &owner, error);
        if (status != CLUSTER_OK)
            return status;
        memcpy(v.origin_vox, n->box.lo, sizeof v.origin_vox);
        copy(&v, &to->volume, &n->box, voxel, NULL);
        c->source.release(c->source.context, owner);
    }
    return CLUSTER_OK;
}

/* Tells the file what will be read of it. */
static cluster_status expect(const plan *p, vodr_error *error)
{
    const cluster *c = p->cluster;
    box all = {{INT32_MAX, INT32_MAX, INT32_MAX}, {0, 0, 0}};
    for (size_t i = 0; i < p->count; i++) {
        const piece *n = &p->piece[i];
        if (n->from != FILE_ITSELF || !cluster_holds(c, owner_of(&c->bricks, n->to)))
            continue;
        for (int a = 0; a < 3; a++) {
            all.lo[a] = n->box.lo[a] < all.lo[a] ? n->box.lo[a] : all.lo[a];
            all.hi[a] = n->box.hi[a] > all.hi[a] ? n->box.hi[a] : all.hi[a];
        }
    }
    if (box_is_empty(&all) || c->options.memory_bytes)
        return CLUSTER_OK;
    return c->source.expect(c->source.context, all.lo, all.hi, error);
}

/* ---- between processes ---- */

/* What of the plan goes from one node to another, in bytes. */
static size_t bytes_between(const plan *p, int32_t from, int32_t to)
{
    size_t voxels = 0;
    for (size_t i = 0; i < p->count; i++) {
        const piece *n = &p->piece[i];
        if (n->from != FILE_ITSELF && owner_of(p->old, n->from) == from && owner_of(&p->cluster->bricks, n->to) == to)
            voxels += (size_t)box_size(&n->box);
    }
    return voxels * (size_t)p->cluster->source.voxel_bytes;
}

/* Copies pieces into a message to a peer, or out of one from it. */
static void go_over(const plan *p, int32_t peer, bool sends, char *bytes)
{
    const cluster *c = p->cluster;
    const int32_t own = c->node->rank;
    const size_t voxel = (size_t)c->source.voxel_bytes;
    for (size_t i = 0; i < p->count; i++) {
        const piece *n = &p->piece[i];
        if (n->from == FILE_ITSELF || owner_of(p->old, n->from) != (sends ? own : peer) ||
            owner_of(&c->bricks, n->to) != (sends ? peer : own))
            continue;
        if (sends)
            copy(&p->old->brick[n->from].volume, NULL, &n->box, voxel, bytes);
        else
            copy(NULL, &c->bricks.brick[n->to].volume, &n->box, voxel, bytes);
        bytes += (size_t)box_size(&n->box) * voxel;
    }
}

typedef struct mail {
    int32_t peers, peer[CLUSTER_MAX_NODES];
    node_message out[CLUSTER_MAX_NODES], in[CLUSTER_MAX_NODES];
} mail;

static cluster_status write_mail(const plan *p, mail *m, vodr_error *error)
{
    const int32_t own = p->cluster->node->rank;
    for (int32_t i = 0; i < p->cluster->node->ranks; i++) {
        const size_t out = i == own ? 0 : bytes_between(p, own, i), in = i == own ? 0 : bytes_between(p, i, own);
        if (out + in == 0)
            continue;
        node_message *message = &m->out[m->peers];
        m->peer[m->peers++] = i;
        *message = (node_message){malloc(out + 1), out};
        if (!message->bytes)
            return cluster_no_memory(error);
        go_over(p, i, true, message->bytes);
    }
    return CLUSTER_OK;
}

static cluster_status send_and_receive(const plan *p, vodr_error *error)
{
    cluster_node *node = p->cluster->node;
    mail *m = calloc(1, sizeof *m);
    cluster_status status = m ? write_mail(p, m, error) : cluster_no_memory(error);
    status = cluster_agree(node, status, error);
    if (status == CLUSTER_OK)
        status = node_exchange(node, m->peers, m->peer, m->out, m->in, error);
    for (int32_t i = 0; m && i < m->peers; i++) {
        if (status == CLUSTER_OK)
            go_over(p, m->peer[i], false, m->in[i].bytes);
        node_message_free(&m->out[i]);
        node_message_free(&m->in[i]);
    }
    free(m);
    return status;
}

/* ---- all of it ---- */

static void tell(const plan *p, cluster_change *change)
{
    const size_t voxel = (size_t)p->cluster->source.voxel_bytes;
    *change = (cluster_change){0};
    for (size_t i = 0; i < p->count; i++) {
        const piece *n = &p->piece[i];
        const uint64_t bytes = (uint64_t)box_size(&n->box) * voxel;
        if (n->from == FILE_ITSELF)
            change->read_bytes += bytes;
        else if (owner_of(p->old, n->from) != owner_of(&p->cluster->bricks, n->to))
            change->moved_bytes += bytes;
    }
    for (int32_t i = 0; i < p->cluster->nodes; i++)
        change->scatter_bytes += p->cluster->share[i].held_bytes;
}

cluster_status exchange_bricks(cluster *c, const bricks *old, vodr_error *error)
{
    plan p = {.cluster = c, .old = old};
    make_plan(&p);
    tell(&p, &c->report.change);
    cluster_status status = p.full ? cluster_no_memory(error) : make_room(c, old, error);
    if (status == CLUSTER_OK)
        status = expect(&p, error);
    if (status == CLUSTER_OK)
        status = fill_own(&p, error);
    c->source.forget(c->source.context);
    status = cluster_agree(c->node, status, error);
    if (status == CLUSTER_OK && c->node->ranks > 1)
        status = send_and_receive(&p, error);
    free(p.piece);
    free(p.left);
    free(p.next);
    return status;
}
