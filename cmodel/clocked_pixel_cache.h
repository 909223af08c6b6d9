/* clocked_pixel_cache.h - the state of the clocked pixel cache. */
#ifndef VODR_CLOCKED_PIXEL_CACHE_H
#define VODR_CLOCKED_PIXEL_CACHE_H

#include "clocked_blocks.h"
#include "pixel_cache.h"
#include "ring.h"

/* An access between its look-up and its read. */
typedef struct cache_access {
    int32_t x, y;
    int64_t line, victim;
    int32_t at; /* which of the cache's lines */
    int32_t offset;
    bool miss, reads, replaces; /* the line is read, not filled with zeros; a valid line was replaced */
    bool evicted;               /* what was replaced is out of the way, its fill requested */
} cache_access;

/* A pixel that was read and is being blended. */
typedef struct cache_blend {
    int32_t x, y, line, offset;
    int64_t number, cycle; /* of the read */
    bool replaced;         /* its line is not in the cache any more */
} cache_blend;

/* A blend whose result came in the cycle before. */
typedef struct cache_settled {
    bool valid, writes;
    uint64_t pixel;
    cache_blend blend;
} cache_settled;

/* A place of the write FIFO. */
typedef struct cache_place {
    int64_t line;
    bool taken;
} cache_place;

RING(cache_access_ring, cache_access)
RING(cache_place_ring, cache_place *)

typedef struct cache_state {
    const vodr_machine *machine;
    fb_layout layout;
    int32_t line_bytes, pixel_bytes, misses;
    bool through;
    int64_t now;
    pixel_cache tags; /* tags alone: which lines are dirty is known later here */
    bool *dirty;
    uint8_t *data, *filled; /* the cache's lines; lines that came and wait for their miss's turn, a ring */
    colour_port door;       /* the fragment at the door */
    int64_t door_line;
    bool gone;               /* it goes in this cycle */
    int64_t wanted;          /* non-blocking: the line to ask for in this cycle; -1 */
    cache_access_ring queue; /* looked up, not read */
    int64_t accesses, reads, misses_seen, miss_reads, fills_come, fills_used, last_read;
    cache_blend *blends; /* the last reads, blend_cycles of them or more, a ring by number of the read */
    int64_t blend_mask;
    int64_t known, done; /* reads of which it is known whether they are written; that are blended */
    cache_settled settled;
    bool write_pending; /* the write buffer holds write_line */
    int64_t write_line;
    cache_place *places;      /* by number of the access, a ring */
    cache_place_ring writing; /* whose write waits for the bus */
    int32_t flushed;          /* lines before it are clean */
} cache_state;

#endif
