/* cycles_front.c - from the divider to the texture unit's door: bricks, slices, rows and runs in the order in which the
 * rasterizer meets them. */
#include "cycles_state.h"

/* The slice generator takes the current brick; then the divider can hand on the next. */
void cycles_enter_visit(cycles *c)
{
    visit_state *v = visit_at(c, ++c->current);
    c->brick_taken = max64(v->divided + 1, c->slice_made + 1);
    c->slice_made = c->brick_taken;
    c->n.blocks[VODR_BLOCK_SLICE_GENERATOR].busy++;
    c->loading = true;
    happened(c, c->brick_taken);
}

void cycles_divide(cycles *c, int64_t number)
{
    visit_state *v = visit_at(c, number), *before = visit_at(c, number - 1);
    int64_t ready = (number ? before->divided : -1) + 1 + v->visit.work_cycles;
    v->divided = number ? max64(ready, c->brick_taken + 1) : ready;
    c->n.stalls[VODR_STALL_DIVIDER] += (uint64_t)(v->divided - ready);
    c->n.blocks[VODR_BLOCK_VOLUME_DIVIDER].busy += (uint64_t)v->visit.work_cycles + 1;
    happened(c, v->divided);
}

/* Lets room in the FIFO delay the rasterizer, for all fragments that glided since it was last asked about: fragment n
 * is accepted in max(accepted(n-1), taken(n - FIFO)) + 1, and as no cycle takes two, what delays the last of a row of
 * fragments delays it by all that any of them waits. */
static void settle_raster(cycles *c)
{
    int64_t room = c->accepted - 1 - c->fifo, length, raster = c->raster;
    if (!c->glided)
        return;
    c->glided = false;
    if (room >= 0)
        raster = max64(raster, stretch_cycle(&c->pops, room, &length) + 2);
    c->n.stalls[VODR_STALL_FRAGMENT_FIFO] += (uint64_t)(raster - c->raster);
    c->raster = raster;
}

static void take_slice(cycles *c)
{
    settle_raster(c);
    int64_t ready = c->slice_made + c->m->slice_setup_cycles + 1;
    c->slice_made = max64(ready, c->slice_taken + 1);
    c->n.stalls[VODR_STALL_SLICE] += (uint64_t)(c->slice_made - ready);
    c->n.blocks[VODR_BLOCK_SLICE_GENERATOR].busy += (uint64_t)c->m->slice_setup_cycles + 1;
    c->slice_taken = max64(c->raster, c->slice_made + 1);
    c->raster = c->slice_taken + 1;
    c->n.blocks[VODR_BLOCK_RASTERIZER].busy++;
}

/* Offers the rest of a run; false when it is unknown when the texture unit accepts it. */
static bool offer(cycles *c, const cycle_op *op)
{
    settle_raster(c);
    int64_t idle = max64(c->raster, c->fetched), cycle = idle, number = c->accepted - c->fifo;
    int64_t length = c->fetch_cycles == 1 ? op->px.count - c->op_done : 1;
    if (c->loading) {
        const visit_state *v = visit_at(c, c->current);
        if (v->loaded == CYCLE_UNKNOWN)
            return false;
        cycle = max64(cycle, v->loaded + 1);
    }
    int64_t open = cycle, slope = -number;
    if (number >= 0) {
        if (number >= c->popped)
            return false;
        open = max64(cycle, stretch_cycle(&c->pops, number, &slope) + 1);
    }
    length = slope < length ? slope : length;
    c->n.stalls[VODR_STALL_TEXTURE_FETCH] += (uint64_t)(idle - c->raster);
    c->n.stalls[VODR_STALL_TEXTURE_LOAD] += (uint64_t)(cycle - idle);
    c->n.stalls[VODR_STALL_FRAGMENT_FIFO] += (uint64_t)(open - cycle);
    c->loading = false;
    segment *s = segment_ring_add(&c->door);
    keep(c, s != NULL);
    if (!s)
        return false;
    *s = (segment){.px = op->px,
                   .access = op->access,
                   .killed = op->killed,
                   .slice_start = op->slice_start && !c->op_done,
                   .offset = c->op_done,
                   .count = (int32_t)length,
                   .cycle = open};
    c->accepted += length;
    c->visit_accepted += length;
    c->raster = open + length;
    c->fetched = c->raster - 1 + c->fetch_cycles;
    c->op_done += (int32_t)length;
    return true;
}

/* Whether the first of `count` accesses from (x, y) on could find their pixel still being blended. */
static bool may_conflict(const cycles *c, int32_t x, int32_t y, bool slice_start, int64_t count)
{
    int64_t window = c->m->blend_cycles, reads = slice_start ? 0 : c->slice_reads, seen = 0;
    if (reads >= window)
        return false;
    int64_t end = x + (count < window - reads ? count : window - reads);
    for (int64_t n = c->recent_count - 1; n >= 0 && seen < window; n--) {
        const recent *r = &c->recents[n & c->recent_mask];
        if (r->y == y && r->x < end && r->x + r->count > x)
            return true;
        seen += r->count;
    }
    return false;
}

/* The visit's first fragment waits for its brick. When that is loaded is known then: the visits before are drained, so
 * nothing that has not happened keeps its load back. */
static void wait_for_load(cycles *c)
{
    cycles_finish_load(c);
    int64_t ready = max64(c->raster, visit_at(c, c->current)->loaded + 1);
    c->n.stalls[VODR_STALL_TEXTURE_LOAD] += (uint64_t)(ready - c->raster);
    c->raster = ready;
    c->loading = false;
}

/* The next fragments are accepted and go on into the cache; the cycle in which it takes the first. */
static int64_t take(cycles *c, int32_t count)
{
    int64_t head = max64(c->raster + c->latency, c->last_pop + 1), cycle = max64(head, c->cache_free);
    c->n.stalls[VODR_STALL_CACHE] += (uint64_t)(cycle - head);
    c->raster += count;
    c->accepted += count;
    c->visit_accepted += count;
    c->tag_count += count;
    pop(c, count, cycle);
    return cycle;
}

/* A miss, and behind its fill its write-back: nobody else can ask for the bus before both are served. A write-back
 * without a fill can be late, and meet the next miss. */
static void see_miss_through(cycles *c, const cycle_op *op, bool slice_start, int64_t cycle)
{
    const cycle_access *access = &op->access;
    if (!c->write_pending && (access->reads || !access->evicts)) {
        cycles_miss_at_once(c, access, &op->px, slice_start, cycle);
        return;
    }
    cycles_begin_miss(c, cycle);
    while (!cycles_resolve_miss(c, access, &op->px, slice_start) && cycles_grant(c))
        ;
    while (access->reads && c->write_pending && cycles_grant(c))
        ;
}

/* Moves the rest of a run of hits, or a miss, from the rasterizer into a blocking cache at once; false when it has to
 * go step by step. Nothing may be on the way before it. Then, the FIFO being longer than the way to the blender, its
 * room is what delays acceptance but never a pop: pop(n - FIFO) + 1 + latency <= pop(n - FIFO) + FIFO <= pop(n). So the
 * rasterizer is told of the delay later, by settle_raster(). A miss can be seen through to its end when the rasterizer
 * cannot come to the visit's last fragment meanwhile: nothing else it does asks for the bus. */
static bool glide(cycles *c, const cycle_op *op)
{
    if (!c->glides || c->door.count || c->miss != MISS_NONE || op->killed)
        return false;
    bool miss = op->access.miss && c->op_done == 0;
    int32_t rest = op->px.count - c->op_done;
    if (miss && !c->eager && c->visit_fragments - c->visit_accepted <= c->fifo + 1)
        return false;
    if (c->loading)
        wait_for_load(c);
    bool slice_start = c->slice_starts || (op->slice_start && c->op_done == 0);
    if (may_conflict(c, op->px.x + c->op_done, op->px.y, slice_start, miss ? 1 : rest))
        return false;
    c->slice_starts = false;
    c->glided = true;
    if (miss) {
        see_miss_through(c, op, slice_start, take(c, 1));
        c->op_done = 1;
        if (--rest == 0 || may_conflict(c, op->px.x + 1, op->px.y, false, rest))
            return true;
        slice_start = false;
    }
    read_pixels(c, &op->px, c->op_done, slice_start, rest, take(c, rest));
    c->op_done += rest;
    return true;
}

bool cycles_advance_raster(cycles *c)
{
    bool moved = false;
    cycles_settle_loads(c);
    while (!c->failed && c->op_next < c->op_count) {
        const cycle_op *op = &c->ops[c->op_next];
        if (op->kind == OP_SLICE) {
            take_slice(c);
        } else if (op->kind == OP_ROWS) {
            settle_raster(c);
            c->raster += op->px.count;
            c->n.blocks[VODR_BLOCK_RASTERIZER].busy += (uint64_t)op->px.count;
        } else if (!glide(c, op) && !offer(c, op)) {
            return moved;
        }
        moved = true;
        if (op->kind == OP_RUN && c->op_done < op->px.count)
            continue;
        c->op_done = 0;
        c->op_next++;
    }
    if (c->failed)
        return moved;
    settle_raster(c);
    if (c->current >= 0 && !c->eager)
        visit_at(c, c->current)->drained = max64(c->raster, c->fetched) - 1;
    return moved;
}
