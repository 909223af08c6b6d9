/* clocked.c - joins the blocks as pipeline.c does, but cycle by cycle. Whatever a block registers carries the cycle in
 * which it did, and the others see it from the next one on: so the order in which blocks are clocked within a cycle
 * does not matter. */
#include "clocked.h"

#include <stdlib.h>

#include "clocked_machine.h"
#include "error.h"
#include "totals.h"

/* Everything drawn, nothing on its way; the divider may still be looking for more bricks in vain. */
static bool drained(const clocked *c)
{
    return c->last_found && c->drawn == c->found && !c->generating && !c->slice_link.full && !c->rastering &&
           !c->door.count && !c->tagged.count;
}

static void run(clocked *c)
{
    bool going = true;
    clocked_search(c);
    for (c->now = 0; going && !c->failed; c->now++) {
        clock_volume_divider(c);
        clock_slice_generator(c);
        clock_rasterizer(c);
        clock_texture_loader(c);
        clock_alpha_blender(c);
        clock_pixel_cache(c);
        going = !drained(c) || clock_flush(c) || c->write_requests.count || c->work_left;
        clock_frame_buffer(c);
    }
}

static void gather(clocked *c)
{
    totals_close(&c->n, &c->memory, c->last);
    pixel_cache_flush(&c->cache);
    vodr_counters *out = &c->counters;
    out->hits = c->cache.hits;
    out->misses = c->cache.misses;
    out->evictions = c->cache.evictions;
    out->writebacks = c->cache.writebacks;
    out->fb_read_bytes = c->pixels.read_bytes;
    out->fb_write_bytes = c->pixels.write_bytes;
    out->skipped_bricks = c->divider.empty_bricks;
    out->cycles = c->n;
}

static void read_line(void *context, int64_t line, vodr_rgba *pixels)
{
    frame_buffer_read_line(context, line, pixels);
}

static void write_line(void *context, int64_t line, const vodr_rgba *pixels)
{
    frame_buffer_write_line(context, line, pixels);
}

static vodr_status start(clocked *c, const vodr_volume *volume, const vodr_table *table, vodr_error *error)
{
    const vodr_machine *m = c->m;
    px_rect window = {0, 0, c->view->width_px, c->view->height_px};
    int32_t edge = volume_divider_edge(m, c->view);
    const int32_t edges[3] = {edge ? edge : volume->dims_vox[0], edge ? edge : volume->dims_vox[1],
                              edge ? edge : volume->dims_vox[2]};
    c->blender = alpha_blender_of(m);
    c->counters.tile_px = tile_px(m);
    c->counters.brick_vox = edge;
    vodr_status status = texture_unit_start(&c->texture, m, volume, table, c->view, error);
    c->books = c->texture;
    if (status == VODR_OK && edge)
        status = volume_divider_check(m, volume->dims_vox, edge, error);
    if (status == VODR_OK)
        status =
            volume_divider_start(&c->divider, m, volume, c->view, edges, &window, c->texture.transparent_to, error);
    if (status == VODR_OK)
        status = texture_unit_reserve(&c->texture, edge, error);
    if (status == VODR_OK)
        status = frame_buffer_start(&c->pixels, m, c->view, true, error);
    cache_memory behind = {.context = &c->pixels, .read_line = read_line, .write_line = write_line};
    if (status == VODR_OK)
        status = pixel_cache_start(&c->cache, m, c->pixels.layout.lines, true, behind, error);
    if (status != VODR_OK)
        return status;
    size_t bricks = 1;
    for (int i = 0; i < 3; i++)
        bricks *= (size_t)c->divider.bricks[i];
    c->seen = calloc(bricks, 1);
    c->stages = calloc((size_t)m->blend_cycles, sizeof *c->stages);
    return c->seen && c->stages ? VODR_OK : vodr_fail(error, VODR_NO_MEMORY, "no memory for the bookkeeping of bricks");
}

static void finish(clocked *c)
{
    free(c->seen);
    free(c->stages);
    fragment_ring_free(&c->door);
    fragment_ring_free(&c->tagged);
    transaction_ring_free(&c->fill_requests);
    transaction_ring_free(&c->write_requests);
    release_ring_free(&c->releases);
    pixel_cache_finish(&c->cache);
    frame_buffer_finish(&c->pixels);
    volume_divider_finish(&c->divider);
    texture_unit_finish(&c->texture);
}

vodr_status clocked_render(const vodr_machine *machine, const vodr_volume *volume, const vodr_table *table,
                           const vodr_view *view, vodr_frame *frame, vodr_counters *counters, vodr_error *error)
{
    clocked *c = calloc(1, sizeof *c);
    if (!c)
        return vodr_fail(error, VODR_NO_MEMORY, "no memory for the clocked machine");
    c->m = machine;
    c->view = view;
    c->memory = memory_of(machine);
    c->last = c->found = c->pushed = c->drawn = c->drawn_slice_visit = c->slice_visit = -1;
    c->bricks.popped = c->slice_link.popped = c->load_grant = c->write_granted = c->last_pop = -1;
    c->last_miss_read = -1;
    c->last_read = -machine->blend_cycles;
    vodr_status status = start(c, volume, table, error);
    if (status == VODR_OK) {
        run(c);
        gather(c);
        status = frame_buffer_readout(&c->pixels, machine, machine->blend == VODR_BLEND_MIP ? c->texture.readout : NULL,
                                      frame, error);
    }
    if (status == VODR_OK && c->failed)
        status = vodr_fail(error, VODR_NO_MEMORY, "no memory for what is under way");
    if (status == VODR_OK)
        *counters = c->counters;
    else
        vodr_frame_free(frame);
    finish(c);
    free(c);
    return status;
}
