/* cycle_stats.c - names of blocks and stall causes, and the bottleneck.
 *
 * A block that waits for the one behind it (divider, slice, fragment_fifo, cache) tells of that one's trouble, not of
 * its own: such stalls are no candidates, but for what the FIFO's full cycles have over the blender's stalls, when
 * fragments in it are still on their way through the texture unit. What remains is work, and waits for the memory and
 * for blends under way. */
#include "cycle_stats.h"

#include <stdio.h>

static const char *const block_names[VODR_BLOCK_COUNT] = {
    [VODR_BLOCK_VOLUME_DIVIDER] = "volume_divider", [VODR_BLOCK_SLICE_GENERATOR] = "slice_generator",
    [VODR_BLOCK_RASTERIZER] = "rasterizer",         [VODR_BLOCK_TEXTURE_UNIT] = "texture_unit",
    [VODR_BLOCK_ALPHA_BLENDER] = "alpha_blender",   [VODR_BLOCK_PIXEL_CACHE] = "pixel_cache",
    [VODR_BLOCK_FRAME_BUFFER] = "frame_buffer",
};

static const char *const stall_names[VODR_STALL_COUNT] = {
    [VODR_STALL_DIVIDER] = "divider",
    [VODR_STALL_SLICE] = "slice",
    [VODR_STALL_TEXTURE_LOAD] = "texture_load",
    [VODR_STALL_FRAGMENT_FIFO] = "fragment_fifo",
    [VODR_STALL_CACHE] = "cache",
    [VODR_STALL_HAZARD] = "hazard",
    [VODR_STALL_WRITE_BACK] = "write_back",
    [VODR_STALL_FILL] = "fill",
    [VODR_STALL_DRAM_ROW] = "dram_row",
    [VODR_STALL_DRAM_REFRESH] = "dram_refresh",
    [VODR_STALL_TEXTURE_FETCH] = "texture_fetch",
};

json_t *cycle_stats_blocks(const vodr_cycles *c)
{
    json_t *object = json_pack("{s:I}", "total", (json_int_t)c->total);
    int failed = !object;
    for (int i = 0; i < VODR_BLOCK_COUNT; i++) {
        const vodr_block_cycles *b = &c->blocks[i];
        json_t *block = json_pack("{s:I, s:I, s:I}", "busy", (json_int_t)b->busy, "stalled", (json_int_t)b->stalled,
                                  "idle", (json_int_t)b->idle);
        failed |= json_object_set_new(object, block_names[i], block);
    }
    if (!failed)
        return object;
    json_decref(object);
    return NULL;
}

json_t *cycle_stats_stalls(const vodr_cycles *c)
{
    json_t *object = json_object();
    int failed = !object;
    for (int i = 0; i < VODR_STALL_COUNT; i++)
        failed |= json_object_set_new(object, stall_names[i], json_integer((json_int_t)c->stalls[i]));
    if (!failed)
        return object;
    json_decref(object);
    return NULL;
}

/* Something that takes cycles, and its reason. */
typedef struct candidate {
    uint64_t cycles;
    const char *what, *why;
} candidate;

/* The largest but `except`; of equals the first. */
static const candidate *largest(const candidate *candidates, size_t count, const candidate *except)
{
    const candidate *most = except == candidates ? candidates + 1 : candidates;
    for (const candidate *c = candidates; c < candidates + count; c++)
        if (c != except && c->cycles > most->cycles)
            most = c;
    return most;
}

void cycle_stats_bottleneck(const vodr_cycles *c, char *text, size_t size)
{
    const vodr_block_cycles *blocks = c->blocks, *bus = &blocks[VODR_BLOCK_FRAME_BUFFER];
    const uint64_t *stalls = c->stalls, full = stalls[VODR_STALL_FRAGMENT_FIFO];
    uint64_t blender_stalled = blocks[VODR_BLOCK_ALPHA_BLENDER].stalled;
    double percent = c->total ? 100 / (double)c->total : 0;
    char memory[64];
    snprintf(memory, sizeof memory, "memory (its bus is taken %.0f %%)", percent * (double)(bus->busy + bus->stalled));
    const candidate candidates[] = {
        {blocks[VODR_BLOCK_RASTERIZER].busy, "rasterizer busy", "one fragment, or one row or slice without, a cycle"},
        {blocks[VODR_BLOCK_SLICE_GENERATOR].busy, "slice_generator busy", "slice_setup_cycles a slice of a brick"},
        {blocks[VODR_BLOCK_VOLUME_DIVIDER].busy, "volume_divider busy", "bricks bounded, rows looked at"},
        {bus->busy + bus->stalled, "frame_buffer's bus taken", "memory bandwidth"},
        {stalls[VODR_STALL_TEXTURE_FETCH] ? blocks[VODR_BLOCK_TEXTURE_UNIT].busy : 0, "texture_unit fetches",
         "a cubic filter's 64 voxels over 8 banks take 8 cycles a fragment"},
        {stalls[VODR_STALL_TEXTURE_LOAD], "texture_unit waits for bricks", memory},
        {full > blender_stalled ? full - blender_stalled : 0, "texture_unit full",
         "fragment_fifo is short for the texture unit's latency"},
        {stalls[VODR_STALL_FILL], "pixel_cache waits for fills", memory},
        {stalls[VODR_STALL_WRITE_BACK], "pixel_cache waits for replaced lines to leave",
         "blends under way, the line before on its way to memory"},
        {stalls[VODR_STALL_HAZARD], "pixels still being blended are waited for", "blend_cycles"},
    };
    const size_t count = sizeof candidates / sizeof *candidates;
    const candidate *first = largest(candidates, count, NULL), *second = largest(candidates, count, first);
    snprintf(text, size, "%s %.0f %% of cycles: %s; next: %s %.0f %%", first->what, percent * (double)first->cycles,
             first->why, second->what, percent * (double)second->cycles);
    if (!c->total)
        snprintf(text, size, "nothing to do: no brick is on the screen");
}
