/* clocked_volume_divider.c - the divider, clocked: looks for the next brick with a fragment, works for as many cycles
 * as that takes, hands it on. */
#include "clocked_machine.h"

/* Rows of a slice that are looked at: all, or up to the first that has a fragment. */
int64_t clocked_probe_slice(const brick_slice *slice, const px_rect *bound, bool *found)
{
    rasterizer rows;
    span s;
    rasterizer_start(&rows, slice, bound);
    int32_t first = rows.bound.y0;
    *found = rasterizer_next(&rows, &s);
    return *found ? s.y + 1 - first : rows.bound.y1 - first;
}

/* Looks for the next brick with a fragment; the work is done at once here and takes its cycles afterwards. */
void clocked_search(clocked *c)
{
    brick_visit v = {.divided = CLOCKED_NEVER, .loaded = CLOCKED_NEVER, .drained = CLOCKED_NEVER};
    bool found = false;
    while (!found && volume_divider_next(&c->divider, &v.brick)) {
        slice_generator slices =
            slice_generator_start(c->view, &v.brick.box, v.brick.k0, v.brick.k1, c->m->blend == VODR_BLEND_UNDER);
        brick_slice slice;
        while (!found && slice_generator_next(&slices, &slice))
            v.work_cycles += clocked_probe_slice(&slice, &v.brick.bound, &found);
    }
    v.work_cycles += volume_divider_work(&c->divider);
    c->work_left = v.work_cycles;
    c->last_found = !found;
    if (!found)
        return;
    v.load_address = c->pixels.layout.lines * line_bytes(c->m) +
                     (int64_t)v.brick.brick * brick_room_bytes(c->m, c->divider.edge_vox);
    v.load_bytes = (int64_t)texture_unit_load(&c->books, v.brick.brick, &v.brick.box);
    c->counters.texture_load_bytes += (uint64_t)v.load_bytes;
    *visit_at(c, ++c->found) = v;
}

void clock_volume_divider(clocked *c)
{
    if (c->work_left) {
        c->work_left--;
        busy(c, VODR_BLOCK_VOLUME_DIVIDER);
    } else if (!c->last_found) {
        if (!can_push(c, &c->bricks)) {
            c->n.stalls[VODR_STALL_DIVIDER]++;
            return;
        }
        c->bricks.full = true;
        c->bricks.pushed = c->now;
        visit_at(c, ++c->pushed)->divided = c->now;
        busy(c, VODR_BLOCK_VOLUME_DIVIDER);
        clocked_search(c);
    }
}
