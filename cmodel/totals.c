#include "totals.h"

static void close_block(vodr_cycles *n, vodr_block block, uint64_t stalled)
{
    n->blocks[block].stalled = stalled;
    n->blocks[block].idle = n->total - n->blocks[block].busy - stalled;
}

void totals_close(vodr_cycles *n, const memory *bus, int64_t last)
{
    uint64_t *stalls = n->stalls;
    n->total = (uint64_t)(last + 1);
    n->blocks[VODR_BLOCK_FRAME_BUFFER].busy = bus->busy_cycles;
    stalls[VODR_STALL_DRAM_ROW] = bus->row_cycles;
    stalls[VODR_STALL_DRAM_REFRESH] = bus->refresh_cycles;
    /* A fragment that the texture unit does not accept keeps the rasterizer waiting too. */
    uint64_t door = stalls[VODR_STALL_TEXTURE_LOAD] + stalls[VODR_STALL_FRAGMENT_FIFO];
    uint64_t blender = stalls[VODR_STALL_CACHE], cache = stalls[VODR_STALL_WRITE_BACK] + stalls[VODR_STALL_FILL];
    /* Hazards hold what reads the pixel: the blender's pop, or behind a non-blocking cache's tags its data stage. */
    *(bus->machine->nonblocking ? &cache : &blender) += stalls[VODR_STALL_HAZARD];
    close_block(n, VODR_BLOCK_VOLUME_DIVIDER, stalls[VODR_STALL_DIVIDER]);
    close_block(n, VODR_BLOCK_SLICE_GENERATOR, stalls[VODR_STALL_SLICE]);
    close_block(n, VODR_BLOCK_RASTERIZER, door + stalls[VODR_STALL_TEXTURE_FETCH]);
    close_block(n, VODR_BLOCK_TEXTURE_UNIT, door);
    close_block(n, VODR_BLOCK_ALPHA_BLENDER, blender);
    close_block(n, VODR_BLOCK_PIXEL_CACHE, cache);
    close_block(n, VODR_BLOCK_FRAME_BUFFER, stalls[VODR_STALL_DRAM_ROW] + stalls[VODR_STALL_DRAM_REFRESH]);
}
