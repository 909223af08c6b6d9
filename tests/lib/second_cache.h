/* second_cache.h - the second implementation's pixel cache: tags only, a plain list of lines. */
#ifndef TESTS_SECOND_CACHE_H
#define TESTS_SECOND_CACHE_H

#include "vodr.h"

typedef struct second_line {
    bool valid, dirty;
    uint64_t number;
    uint64_t filled_at, used_at; /* accesses counted since the frame's start */
} second_line;

typedef struct second_cache {
    const vodr_machine *machine;
    int32_t width_px;
    uint64_t line_bytes, pixel_bytes;
    uint64_t sets, ways;
    second_line *lines; /* sets*ways, the ways of a set side by side */
    bool *missed;       /* one a frame-buffer line: it has missed in this frame */
    uint64_t now;
    uint32_t random;
} second_cache;

/* VODR_INVALID when the cache has no whole number of sets. After any outcome second_cache_free() may be called. */
vodr_status second_cache_make(second_cache *cache, const vodr_machine *machine, int32_t width_px, int32_t height_px);
void second_cache_free(second_cache *cache);

/* One access to the line of pixel (x, y), which is read; `written` says whether it was also written. */
void second_cache_access(second_cache *cache, int32_t x, int32_t y, bool written, vodr_counters *counters);

/* The frame's end: every dirty line is written back. */
void second_cache_flush(second_cache *cache, vodr_counters *counters);

#endif
