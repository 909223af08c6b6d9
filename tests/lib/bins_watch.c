#include "bins_watch.h"

#include <stdlib.h>

#include "pixel_word.h"

/* ---- what happens ---- */

static void watch_link(bins_link *l, bool valid, bool ready)
{
    bool moved = valid && ready;
    l->twice = moved && l->moved;
    l->moved = moved;
    l->waited = valid && !ready;
    l->moves += moved;
}

static void watch_links(bins_watch *w)
{
    const block_outs *o = w->before;
    watch_link(&w->brick, o->volume_divider.brick.valid, o->slice_generator.brick.ready);
    watch_link(&w->slice, o->slice_generator.slice.valid, o->rasterizer.slice.ready);
    watch_link(&w->fragment, o->rasterizer.fragment.valid, o->texture_unit.fragment.ready);
    watch_link(&w->load, o->texture_unit.load.valid, o->frame_buffer.load.ready);
    watch_link(&w->colour, o->texture_unit.colour.valid, o->pixel_cache.door.ready);
}

/* Colours wait from the door to their pixel, in order; the dead leave at the door. */
static void watch_blend(bins_watch *w)
{
    const pixel_cache_out *cache = &w->before->pixel_cache;
    w->blends = cache->pixel.valid;
    if (w->blends) {
        w->source = w->own.colours[w->own.blended++ % BINS_WAITING];
        w->pixel = cache->pixel.pixel;
    }
    if (cache->door.gone && !w->own.door_dead) {
        w->own.colours[w->own.gone++ % BINS_WAITING] = w->own.door_colour;
    }
    if (w->colour.moved) {
        w->own.door_colour = w->before->texture_unit.colour.colour;
        w->own.door_dead = w->before->texture_unit.colour.dead;
    }
}

static void watch_memory(bins_watch *w)
{
    const pixel_cache_out *cache = &w->now->pixel_cache;
    const frame_buffer_out *memory = &w->now->frame_buffer;
    const beat_port *beat = &memory->memory;
    w->fills += cache->fill.valid - memory->filled.valid;
    w->writes += cache->write.valid - memory->written.valid;
    w->flushed = cache->pixel.valid ? 0 : w->flushed + cache->write.valid;
    bool goes_on = w->own.beat && w->own.write == beat->write && w->own.next_beat == beat->address;
    w->begins = beat->valid && (w->own.row_cycles || !goes_on);
    w->row_cycles = w->own.row_cycles;
    w->own.row_cycles = bins_stalled(&memory->report, VODR_STALL_DRAM_ROW) ? w->own.row_cycles + 1 : 0;
    w->own.beat = beat->valid;
    w->own.write = beat->write;
    w->own.next_beat = beat->address + beat->bytes;
}

void bins_watch_cycle(bins_watch *w, const block_outs *before, const block_outs *now)
{
    w->before = before;
    w->now = now;
    watch_links(w);
    watch_blend(w);
    watch_memory(w);
}

/* ---- the view ---- */

bool bins_octant(const bins_watch *w, int octant)
{
    const vodr_view *v = &w->c->view;
    int found = 0;
    for (int c = 0; c < 3; c++) {
        found |= (v->step_s[c] < 0) << c;
    }
    return !v->perspective && found == octant;
}

bool bins_eye(const bins_watch *w, int c, int place)
{
    const vodr_view *v = &w->c->view;
    int64_t at = v->base[c] >> VODR_POSITION_BITS;
    return v->perspective && place == (v->base[c] < 0 ? -1 : at >= w->c->input.dims_vox[c] ? 1 : 0);
}

/* How far slices go along an axis. */
static int64_t along(const vodr_view *v, int c)
{
    int64_t across = (v->width_px - 1) * v->step_u[c] + (v->height_px - 1) * v->step_v[c];
    return llabs(v->perspective ? 2 * v->step_s[c] + across : v->step_s[c]);
}

bool bins_dominant(const bins_watch *w, int c)
{
    int largest = 0;
    for (int i = 1; i < 3; i++) {
        largest = along(&w->c->view, i) >= along(&w->c->view, largest) ? i : largest;
    }
    return largest == c;
}

bool bins_tie(const bins_watch *w)
{
    int alike = 0;
    for (int c = 0; c < 3; c++) {
        for (int other = 0; other < c; other++) {
            bool both = along(&w->c->view, c) == along(&w->c->view, other);
            alike += both && (bins_dominant(w, c) || bins_dominant(w, other));
        }
    }
    return alike > 0;
}

/* ---- a cycle ---- */

bool bins_stalled(const report_port *report, vodr_stall cause)
{
    return report->status == BLOCK_STALLED + cause;
}

static int64_t position(const bins_watch *w, int c)
{
    const vodr_view *v = &w->c->view;
    return v->base[c] + (w->before->rasterizer.fragment.a[c] >> v->shift);
}

/* Of the fragment's eight voxels the first, in 1/2^24 voxel. */
static int64_t corner(const bins_watch *w, int c)
{
    return position(w, c) - ((int64_t)1 << (VODR_POSITION_BITS - 1));
}

static bool filters(const bins_watch *w)
{
    return w->fragment.moved && w->machine->filter == VODR_FILTER_LINEAR;
}

bool bins_clamps(const bins_watch *w, bool far)
{
    bool any = false;
    for (int c = 0; filters(w) && c < 3; c++) {
        int64_t first = corner(w, c) >> VODR_POSITION_BITS;
        any |= far ? first + 1 >= w->c->input.dims_vox[c] : first < 0;
    }
    return any;
}

bool bins_weight(const bins_watch *w, bool largest)
{
    int64_t bits = w->machine->weight_bits, all = ((int64_t)1 << bits) - 1;
    bool any = false;
    for (int c = 0; filters(w) && c < 3; c++) {
        any |= (corner(w, c) >> (VODR_POSITION_BITS - bits) & all) == (largest ? all : 0);
    }
    return any;
}

bool bins_on_border(const bins_watch *w)
{
    bool any = false;
    for (int c = 0; w->fragment.moved && c < 3; c++) {
        any |= position(w, c) % ((int64_t)1 << VODR_POSITION_BITS) == 0;
    }
    return any;
}

static int how_much(const bins_watch *w, uint64_t word)
{
    int32_t alpha = pixel_of_word(w->machine, word).a, full = (1 << w->machine->fb_bits) - 1;
    return alpha == 0 ? 0 : alpha == full ? 2 : 1;
}

bool bins_blend(const bins_watch *w, vodr_blend mode, int source, int pixel)
{
    return w->blends && w->machine->blend == (int32_t)mode && how_much(w, w->source) == source &&
           how_much(w, w->pixel) == pixel;
}

bool bins_opaque_without(const bins_watch *w)
{
    const vodr_rgba source = pixel_of_word(w->machine, w->source);
    bool opaque = w->blends && w->machine->blend != VODR_BLEND_MIP && how_much(w, w->source) == 2;
    return opaque && (source.r == 0 || source.g == 0 || source.b == 0);
}

static bool is_mip(const bins_watch *w, bool written)
{
    return w->blends && w->machine->blend == VODR_BLEND_MIP &&
           (w->pixel & PIXEL_WORD_WRITTEN) == written * PIXEL_WORD_WRITTEN;
}

bool bins_first(const bins_watch *w)
{
    return is_mip(w, false);
}

bool bins_maximum(const bins_watch *w, int order)
{
    uint16_t source = (uint16_t)w->source, pixel = (uint16_t)w->pixel;
    return is_mip(w, true) && order == (source > pixel) - (source < pixel);
}
