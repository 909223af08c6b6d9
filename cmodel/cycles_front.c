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

static void take_slice(cycles *c)
{
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
    int64_t cycle = c->raster, length = op->px.count - c->op_done, number = c->accepted - c->fifo;
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
    c->n.stalls[VODR_STALL_TEXTURE_LOAD] += (uint64_t)(cycle - c->raster);
    c->n.stalls[VODR_STALL_FRAGMENT_FIFO] += (uint64_t)(open - cycle);
    c->loading = false;
    segment *s = segment_ring_add(&c->door);
    keep(c, s != NULL);
    if (!s)
        return false;
    *s = (segment){.px = op->px,
                   .killed = op->killed,
                   .slice_start = op->slice_start && !c->op_done,
                   .offset = c->op_done,
                   .count = (int32_t)length,
                   .cycle = open};
    if (op->detail >= 0)
        s->run = c->details[op->detail];
    c->accepted += length;
    c->visit_accepted += length;
    c->raster = open + length;
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

/* Moves the rest of a run of hits, or a miss, from the rasterizer into a blocking cache at once; false when it has to
 * go step by step. Nothing may be on the way before it. Then, the FIFO being longer than the way to the blender, its
 * room is what delays acceptance but never a pop: pop(n - FIFO) + 1 + latency <= pop(n - FIFO) + FIFO <= pop(n). A miss
 * can be seen through to its end when the rasterizer cannot come to the visit's last fragment meanwhile: nothing else
 * it does asks for the bus. */
static bool glide(cycles *c, const cycle_op *op)
{
    if (!c->glides || c->door.count || c->miss != MISS_NONE || op->killed)
        return false;
    bool miss = op->miss && c->op_done == 0;
    int64_t count = miss ? 1 : op->px.count - c->op_done, ready = c->raster, length;
    if (miss && !c->eager && c->visit_fragments - c->visit_accepted <= c->fifo + 1)
        return false;
    if (c->loading) {
        cycles_finish_load(c);
        int64_t loaded = visit_at(c, c->current)->loaded;
        if (loaded == CYCLE_UNKNOWN)
            return false;
        ready = max64(ready, loaded + 1);
    }
    int32_t x = op->px.x + c->op_done;
    bool slice_start = c->slice_starts || (op->slice_start && c->op_done == 0);
    if (may_conflict(c, x, op->px.y, slice_start, count))
        return false;
    int64_t head = max64(ready + c->latency, c->last_pop + 1), cycle = max64(head, c->cache_free);
    int64_t accept = ready + count - 1, room = c->accepted + count - 1 - c->fifo;
    if (room >= c->popped)
        accept = max64(accept, cycle + (room - c->popped) + 1);
    else if (room >= 0)
        accept = max64(accept, stretch_cycle(&c->pops, room, &length) + 1);
    c->n.stalls[VODR_STALL_TEXTURE_LOAD] += (uint64_t)(ready - c->raster);
    c->n.stalls[VODR_STALL_FRAGMENT_FIFO] += (uint64_t)(accept - (ready + count - 1));
    c->n.stalls[VODR_STALL_CACHE] += (uint64_t)(cycle - head);
    c->loading = c->slice_starts = false;
    c->accepted += count;
    c->visit_accepted += count;
    c->raster = accept + 1;
    pop(c, (int32_t)count, cycle);
    c->tag_count += count;
    c->op_done += (int32_t)count;
    if (!miss) {
        read_pixels(c, &op->px, c->op_done - (int32_t)count, slice_start, (int32_t)count, cycle);
        return true;
    }
    const cycle_run *run = &c->details[op->detail];
    if (!c->write_pending && (run->reads || !run->evicts)) {
        cycles_miss_at_once(c, run, &op->px, slice_start, cycle);
        return true;
    }
    cycles_begin_miss(c, cycle);
    while (!cycles_resolve_miss(c, run, &op->px, slice_start) && cycles_grant(c))
        ;
    return true;
}

bool cycles_advance_raster(cycles *c)
{
    bool moved = false;
    cycles_settle_loads(c);
    while (c->op_next < c->op_count) {
        const cycle_op *op = &c->ops[c->op_next];
        if (op->kind == OP_SLICE) {
            take_slice(c);
        } else if (op->kind == OP_ROWS) {
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
    if (c->current >= 0 && !c->eager)
        visit_at(c, c->current)->drained = c->raster - 1;
    return moved;
}
