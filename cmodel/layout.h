/* layout.h - what follows from a machine's parameters alone: sizes of pixels, lines and sets, and where the frame
 * buffer keeps a pixel (docs/architecture.md, "Frame buffer"). Shared by the blocks that must agree on it. */
#ifndef VODR_LAYOUT_H
#define VODR_LAYOUT_H

#include "vodr.h"

static inline int32_t pixel_bytes(const vodr_machine *m)
{
    return m->fb_bits / 2; /* four channels of fb_bits */
}

static inline int32_t line_pixels(const vodr_machine *m)
{
    return m->line_px.width * m->line_px.height;
}

static inline int32_t line_bytes(const vodr_machine *m)
{
    return line_pixels(m) * pixel_bytes(m);
}

static inline int32_t cache_sets(const vodr_machine *m)
{
    return m->cache_bytes / (m->ways * line_bytes(m));
}

/* T: the edge of the largest square whose pixels the cache holds. Where tiles of that edge are dealt out to several
 * pipelines it is made of whole lines, so that no line belongs to two. */
static inline int32_t tile_px(const vodr_machine *m)
{
    int32_t pixels = m->cache_bytes / pixel_bytes(m), t = 0;
    while ((t + 1) * (t + 1) <= pixels)
        t++;
    if (m->pipelines == 1 || m->traversal != VODR_TRAVERSAL_TILE)
        return t;
    int32_t line = m->line_px.width > m->line_px.height ? m->line_px.width : m->line_px.height;
    return t < line ? line : t - t % line;
}

static inline bool filter_is_cubic(const vodr_machine *m)
{
    return m->filter == VODR_FILTER_CARDINAL || m->filter == VODR_FILTER_BSPLINE;
}

/* Voxels that a sample needs beyond its brick, on each side. */
static inline int32_t filter_border_vox(const vodr_machine *m)
{
    return filter_is_cubic(m) ? 2 : m->filter == VODR_FILTER_LINEAR ? 1 : 0;
}

/* Voxels that a fragment fetches. */
static inline int32_t filter_fetches(const vodr_machine *m)
{
    return filter_is_cubic(m) ? 64 : m->filter == VODR_FILTER_LINEAR ? 8 : 1;
}

/* Cycles that this takes: texture memory has eight banks. */
static inline int32_t filter_fetch_cycles(const vodr_machine *m)
{
    return filter_is_cubic(m) ? 8 : 1;
}

/* What texture memory holds of a voxel: its density, or with filter=bspline its signed coefficient. */
static inline int32_t stored_bits(const vodr_machine *m)
{
    return m->filter == VODR_FILTER_BSPLINE ? 16 : m->density_bits;
}

static inline int32_t density_bytes(const vodr_machine *m)
{
    return stored_bits(m) > 8 ? 2 : 1;
}

/* Memory that a brick of these edges takes, its border with it and whether or not the volume cuts it: whole bursts. */
static inline int64_t brick_room_bytes(const vodr_machine *m, const int32_t edge_vox[3])
{
    int64_t bytes = density_bytes(m), burst = m->texture_burst_bytes;
    for (int c = 0; c < 3; c++)
        bytes *= edge_vox[c] + 2 * filter_border_vox(m);
    return (bytes + burst - 1) / burst * burst;
}

static inline int32_t log2_of(int32_t power_of_two)
{
    int32_t bits = 0;
    while (1 << bits < power_of_two)
        bits++;
    return bits;
}

/* The frame buffer as lines. Every size inside a tile is a power of two, so addresses are shifts and sums. */
typedef struct fb_layout {
    int32_t line_w_bits, line_h_bits; /* logarithms of a line's width and height in pixels */
    bool tiled;
    int32_t tiles;       /* tiled: tiles across the frame */
    int32_t columns;     /* linear: lines across the frame */
    int32_t tile_bits;   /* tiled: logarithm of the lines in a tile */
    int32_t column_mask; /* tiled: lines across a tile, less one */
    int64_t lines;       /* in the whole frame buffer */
} fb_layout;

enum { FB_TILE_BITS = 5, FB_TILE_PX = 1 << FB_TILE_BITS };

static inline int32_t ceil_div32(int32_t a, int32_t b)
{
    return (a + b - 1) / b;
}

static inline fb_layout fb_layout_of(const vodr_machine *m, int32_t width_px, int32_t height_px)
{
    int32_t w = m->line_px.width, h = m->line_px.height;
    fb_layout l = {.line_w_bits = log2_of(w),
                   .line_h_bits = log2_of(h),
                   .tiled = m->fb_layout == VODR_FB_LAYOUT_TILED,
                   .tiles = ceil_div32(width_px, FB_TILE_PX),
                   .columns = ceil_div32(width_px, w)};
    l.tile_bits = 2 * FB_TILE_BITS - l.line_w_bits - l.line_h_bits;
    l.column_mask = (FB_TILE_PX >> l.line_w_bits) - 1;
    int64_t tiles = (int64_t)l.tiles * ceil_div32(height_px, FB_TILE_PX);
    l.lines = l.tiled ? tiles << l.tile_bits : (int64_t)l.columns * ceil_div32(height_px, h);
    return l;
}

/* The lines of a row of pixels: their numbers, but for what x adds. */
static inline int64_t line_row(const fb_layout *l, int32_t y)
{
    int32_t row = y >> l->line_h_bits;
    if (!l->tiled)
        return (int64_t)row * l->columns;
    int32_t across = FB_TILE_BITS - l->line_w_bits, down = FB_TILE_BITS - l->line_h_bits;
    return ((int64_t)(y >> FB_TILE_BITS) * l->tiles << l->tile_bits) + ((row & ((1 << down) - 1)) << across);
}

/* The line of column x in a row. */
static inline int64_t line_in_row(const fb_layout *l, int64_t row, int32_t x)
{
    int32_t column = x >> l->line_w_bits;
    if (!l->tiled)
        return row + column;
    return row + ((int64_t)(x >> FB_TILE_BITS) << l->tile_bits) + (column & l->column_mask);
}

static inline int64_t line_number(const fb_layout *l, int32_t x, int32_t y)
{
    return line_in_row(l, line_row(l, y), x);
}

/* Index of a pixel within its line. */
static inline int32_t line_offset(const fb_layout *l, int32_t x, int32_t y)
{
    return ((y & ((1 << l->line_h_bits) - 1)) << l->line_w_bits) + (x & ((1 << l->line_w_bits) - 1));
}

#endif
