/* layout.h - what follows from a machine's parameters alone: sizes of pixels, lines and sets, and where the frame
 * buffer keeps a pixel (docs/architecture.md, "Frame buffer"). Shared by the blocks that must agree on it. */
#ifndef VODR_LAYOUT_H
#define VODR_LAYOUT_H

#include "vodr.h"

enum { FB_TILE_PX = 32 };

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

/* T: the edge of the largest square whose pixels the cache holds. */
static inline int32_t tile_px(const vodr_machine *m)
{
    int32_t pixels = m->cache_bytes / pixel_bytes(m), t = 0;
    while ((t + 1) * (t + 1) <= pixels)
        t++;
    return t;
}

/* Voxels that a sample needs beyond its brick, on each side. */
static inline int32_t filter_border_vox(const vodr_machine *m)
{
    return m->filter == VODR_FILTER_LINEAR ? 1 : 0;
}

/* Bytes of one density in texture memory. */
static inline int32_t density_bytes(const vodr_machine *m)
{
    return m->density_bits > 8 ? 2 : 1;
}

/* The frame buffer as lines: line (x, y) of pixels is number line_number(), its pixels row-major inside it. */
typedef struct fb_layout {
    int32_t line_w_px, line_h_px;
    int32_t columns; /* lines across the frame; tiled: across a tile */
    int32_t tiles;   /* tiled: tiles across the frame; 0 when linear */
    int32_t tile_lines;
    int64_t lines; /* in the whole frame buffer */
} fb_layout;

static inline int32_t ceil_div32(int32_t a, int32_t b)
{
    return (a + b - 1) / b;
}

static inline fb_layout fb_layout_of(const vodr_machine *m, int32_t width_px, int32_t height_px)
{
    fb_layout l = {.line_w_px = m->line_px.width, .line_h_px = m->line_px.height};
    if (m->fb_layout == VODR_FB_LAYOUT_TILED) {
        l.columns = FB_TILE_PX / l.line_w_px;
        l.tiles = ceil_div32(width_px, FB_TILE_PX);
        l.tile_lines = l.columns * (FB_TILE_PX / l.line_h_px);
        l.lines = (int64_t)l.tiles * ceil_div32(height_px, FB_TILE_PX) * l.tile_lines;
    } else {
        l.columns = ceil_div32(width_px, l.line_w_px);
        l.lines = (int64_t)l.columns * ceil_div32(height_px, l.line_h_px);
    }
    return l;
}

static inline int64_t line_number(const fb_layout *l, int32_t x, int32_t y)
{
    if (!l->tiles)
        return (int64_t)(y / l->line_h_px) * l->columns + x / l->line_w_px;
    int64_t tile = (int64_t)(y / FB_TILE_PX) * l->tiles + x / FB_TILE_PX;
    int32_t row = y % FB_TILE_PX / l->line_h_px, column = x % FB_TILE_PX / l->line_w_px;
    return tile * l->tile_lines + row * l->columns + column;
}

/* Index of a pixel within its line. */
static inline int32_t line_offset(const fb_layout *l, int32_t x, int32_t y)
{
    return y % l->line_h_px * l->line_w_px + x % l->line_w_px;
}

#endif
