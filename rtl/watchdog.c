#include "watchdog.h"

#include <inttypes.h>
#include <stdio.h>

/* ---- links ---- */

typedef struct link {
    const char *name, *from, *to;
    bool valid, ready;
} link;

static void links_of(const block_outs *o, link links[WATCHDOG_LINKS])
{
    const link all[WATCHDOG_LINKS] = {
        {"brick", "volume_divider", "slice_generator", o->volume_divider.brick.valid, o->slice_generator.brick.ready},
        {"slice", "slice_generator", "rasterizer", o->slice_generator.slice.valid, o->rasterizer.slice.ready},
        {"fragment", "rasterizer", "texture_unit", o->rasterizer.fragment.valid, o->texture_unit.fragment.ready},
        {"colour", "texture_unit", "pixel_cache", o->texture_unit.colour.valid, o->pixel_cache.door.ready},
        {"load", "texture_unit", "frame_buffer", o->texture_unit.load.valid, o->frame_buffer.load.ready},
    };
    for (int i = 0; i < WATCHDOG_LINKS; i++)
        links[i] = all[i];
}

/* Whether something was handed on that no link carries. */
static bool strobes(const block_outs *o)
{
    return o->volume_divider.brick.fresh || o->rasterizer.fragment.visit_done || o->texture_unit.fetch.valid ||
           o->alpha_blender.blended.known || o->alpha_blender.blended.valid || o->pixel_cache.door.gone ||
           o->pixel_cache.pixel.valid || o->pixel_cache.fill.valid || o->pixel_cache.write.valid ||
           o->frame_buffer.filled.valid || o->frame_buffer.written.valid || o->frame_buffer.load.granted ||
           o->frame_buffer.load.data_valid || o->voxel_memory.voxels.valid;
}

uint64_t watchdog_limit(const vodr_machine *machine)
{
    /* A divider that finds nothing looks at boxes and at slices, at least a million of which should have led somewhere;
     * a memory is silent for a latency or a refresh. */
    return (uint64_t)1000000 + 65536u * (uint64_t)machine->brick_setup_cycles;
}

void watchdog_cycle(watchdog *w, uint64_t cycle, const block_outs *before, const block_outs *after)
{
    link was[WATCHDOG_LINKS], is[WATCHDOG_LINKS];
    bool moves = strobes(after);
    links_of(before, was);
    links_of(after, is);
    for (int i = 0; i < WATCHDOG_LINKS; i++) {
        bool taken = was[i].valid && was[i].ready;
        moves |= taken;
        if (taken || !was[i].valid)
            w->since[i] = cycle;
    }
    if (moves)
        w->moved = cycle;
}

void watchdog_tell(const watchdog *w, const block_outs *outs, char *text, size_t size)
{
    link links[WATCHDOG_LINKS];
    links_of(outs, links);
    for (int i = WATCHDOG_LINKS - 1; i >= 0; i--)
        if (links[i].valid && !links[i].ready) {
            snprintf(text, size,
                     "nothing has moved since cycle %" PRIu64 ": %s offers on link %s since cycle %" PRIu64
                     " (%s_valid is up), and %s does not take it (%s_ready is down)",
                     w->moved, links[i].from, links[i].name, w->since[i], links[i].name, links[i].to, links[i].name);
            return;
        }
    snprintf(text, size,
             "nothing has moved since cycle %" PRIu64 ": no link offers anything, but not all blocks are idle",
             w->moved);
}
