/* pixel_cache.h - the cache between alpha blender and frame buffer: set-associative lines of pixels (Figure 2 and Table
 * 1 of the paper). */
#ifndef VODR_PIXEL_CACHE_H
#define VODR_PIXEL_CACHE_H

#include "vodr.h"

typedef struct cache_line {
    int64_t number; /* of the line it holds; -1: none */
    uint64_t stamp; /* lru: of the last access, fifo: of the fill; 0: none yet */
    bool dirty;
} cache_line;

/* What the cache asks of the memory behind it. */
typedef struct cache_memory {
    void *context;
    void (*read_line)(void *context, int64_t line, vodr_rgba *pixels);
    void (*write_line)(void *context, int64_t line, const vodr_rgba *pixels);
} cache_memory;

typedef struct pixel_cache {
    cache_memory memory;
    int32_t sets, ways, line_pixels;
    int32_t set_bits;
    bool xor_index, through, clear_on_first_touch;
    vodr_replacement replacement;
    cache_line *lines; /* set after set */
    vodr_rgba *pixels; /* of each line; NULL when only tags are kept */
    int32_t *where;    /* by line number: which of the cache's lines holds it, -1: none */
    uint8_t *touched;  /* by line number: whether it missed before in this frame; clear_on_first_touch only */
    uint64_t clock;
    uint32_t lfsr;
    cache_line *last;                 /* of the last access */
    bool missed, evicted_dirty, read; /* the last access: missed; a dirty line left; its own was read, not cleared */
    int64_t victim;                   /* the dirty line that left */
    uint64_t hits, misses, evictions, writebacks;
} pixel_cache;

/* An empty cache over a frame buffer of `frame_lines` lines; with `picture` false it keeps tags only. Free with
 * pixel_cache_finish() in either case. */
vodr_status pixel_cache_start(pixel_cache *c, const vodr_machine *m, int64_t frame_lines, bool picture,
                              cache_memory memory, vodr_error *error);

/* `count` accesses in a row to one line. Returns the line's pixels, valid until the next access; NULL without a
 * picture. */
vodr_rgba *pixel_cache_access(pixel_cache *c, int64_t line, int32_t count);

/* The same where the cache holds the line; else false, and nothing happened. */
static inline bool pixel_cache_hit(pixel_cache *c, int64_t line, int32_t count)
{
    int32_t at = c->where[line];
    if (at < 0)
        return false;
    c->missed = false;
    c->hits += (uint64_t)count;
    c->last = &c->lines[at];
    c->clock++;
    if (c->replacement == VODR_REPLACEMENT_LRU)
        c->last->stamp = c->clock;
    return true;
}

/* The line of the last access was written. */
static inline void pixel_cache_written(pixel_cache *c)
{
    c->last->dirty = !c->through;
}

/* Writes every dirty line back, at the frame's end. */
void pixel_cache_flush(pixel_cache *c);

/* Forgets every line; what is counted stays. For another pipeline's cache over other lines of the same frame buffer. */
void pixel_cache_empty(pixel_cache *c);

void pixel_cache_finish(pixel_cache *c);

#endif
