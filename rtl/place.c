#include "place.h"

#include <inttypes.h>
#include <stdio.h>

static bool moves(bool valid, bool ready)
{
    return valid && ready;
}

/* From the last block to the first, so that each takes what the one before it had. */
void places_cycle(places *p, const block_outs *before, const block_outs *after)
{
    const fragment_port *f = &before->rasterizer.fragment;
    bool slice_moves = moves(before->slice_generator.slice.valid, before->rasterizer.slice.ready);
    if (moves(before->texture_unit.colour.valid, before->pixel_cache.door.ready) && p->shaded.count) {
        p->gone = *place_ring_front(&p->shaded);
        place_ring_pop(&p->shaded);
    }
    if (moves(f->valid, before->texture_unit.fragment.ready)) {
        place *last = place_ring_add(&p->shaded);
        p->failed |= !last;
        if (last)
            *last = (place){PLACE_PIXEL, p->drawn.brick, p->drawn.slice, f->x, f->y};
    }
    if (slice_moves)
        p->drawn = p->linked;
    if (after->rasterizer.fragment.valid) {
        p->drawn.depth = PLACE_PIXEL;
        p->drawn.x = after->rasterizer.fragment.x;
        p->drawn.y = after->rasterizer.fragment.y;
    }
    if (after->slice_generator.slice.valid && (!before->slice_generator.slice.valid || slice_moves)) {
        p->linked = p->generated;
        p->linked.depth = PLACE_SLICE;
        p->linked.slice = after->slice_generator.slice.slice.k;
    }
    if (moves(before->volume_divider.brick.valid, before->slice_generator.brick.ready))
        p->generated = (place){.depth = PLACE_BRICK, .brick = before->volume_divider.brick.brick};
    if (after->volume_divider.brick.fresh)
        p->divided = (place){.depth = PLACE_BRICK, .brick = after->volume_divider.brick.brick};
}

place places_of(const places *p, vodr_block block)
{
    switch (block) {
    case VODR_BLOCK_VOLUME_DIVIDER: return p->divided;
    case VODR_BLOCK_SLICE_GENERATOR:
        return p->linked.depth && p->linked.brick == p->generated.brick ? p->linked : p->generated;
    case VODR_BLOCK_RASTERIZER:
    case VODR_BLOCK_TEXTURE_UNIT: return p->drawn;
    default: return p->gone;
    }
}

void place_tell(const place *p, char *text, size_t size)
{
    switch (p->depth) {
    case PLACE_NOWHERE: snprintf(text, size, "before the first of its bricks"); break;
    case PLACE_BRICK: snprintf(text, size, "brick %" PRIu64, p->brick); break;
    case PLACE_SLICE: snprintf(text, size, "brick %" PRIu64 ", slice %" PRId32, p->brick, p->slice); break;
    case PLACE_PIXEL:
        snprintf(text, size, "brick %" PRIu64 ", slice %" PRId32 ", pixel (%" PRId32 ", %" PRId32 ")", p->brick,
                 p->slice, p->x, p->y);
        break;
    }
}

void places_finish(places *p)
{
    place_ring_free(&p->shaded);
}
