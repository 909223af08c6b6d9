/* storage.h - what lies behind the memory bus of the clocked machine: the frame buffer's lines, then the bricks with
 * their borders, as bytes (docs/timing.md, section 6). When they move is not its matter. */
#ifndef VODR_STORAGE_H
#define VODR_STORAGE_H

#include "layout.h"
#include "view.h"

typedef struct storage {
    const vodr_machine *machine;
    const vodr_volume *volume;
    int32_t edge_vox[3]; /* of a brick */
    int64_t texture_base, brick_room_bytes;
    uint8_t *lines; /* up to texture_base */
} storage;

/* A frame buffer of zeros, and the volume's bricks behind it. False when there is no memory. Free with
 * storage_finish(). */
bool storage_start(storage *s, const vodr_machine *machine, const vodr_view *view, const vodr_volume *volume,
                   const int32_t edge_vox[3]);

/* Bytes from an address on: among the lines, or from a brick's first on. */
void storage_read(const storage *s, int64_t address, int64_t bytes, uint8_t *data);
void storage_write(storage *s, int64_t address, int64_t bytes, const uint8_t *data);

void storage_finish(storage *s);

#endif
