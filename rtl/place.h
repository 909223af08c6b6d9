/* place.h - which brick, slice and pixel each block works on in a cycle, from what moves through the ports: so that a
 * difference can be told by its place in the picture. */
#ifndef VODR_PLACE_H
#define VODR_PLACE_H

#include "blocks.h"
#include "ring.h"

/* How much of it is known. */
typedef enum place_depth { PLACE_NOWHERE, PLACE_BRICK, PLACE_SLICE, PLACE_PIXEL } place_depth;

typedef struct place {
    place_depth depth;
    uint64_t brick;
    int32_t slice, x, y;
} place;

RING(place_ring, place)

typedef struct places {
    place divided, generated, linked, drawn, gone; /* at the divider, the generator, between it and the rasterizer, at
                                                      the rasterizer, at the pixel cache's door */
    place_ring shaded;                             /* fragments between rasterizer and door */
    bool failed;                                   /* no memory */
} places;

/* Goes on by a cycle: what all blocks registered before and after it. `*p` begins zeroed. */
void places_cycle(places *p, const block_outs *before, const block_outs *after);

/* Where a block is. */
place places_of(const places *p, vodr_block block);

/* As words: "at brick 3, slice 17, pixel (12, 40)"; "before the first brick". */
void place_tell(const place *p, char *text, size_t size);

void places_finish(places *p);

#endif
