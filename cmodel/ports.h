/* ports.h - the ports between the machine's blocks (docs/timing.md, section 13). A port is what one block registers and
 * others see from the next cycle on: in Verilog an `output reg` for each field. Three kinds:
 * - a link has `valid` and its answer `ready`, both registered: in a cycle in which both are up what is offered moves.
 *   Once up, valid stays up, with the same payload, until then;
 * - a strobe is up for one cycle an event, and is never refused;
 * - a level (ready, idle, a report) says how things stand.
 * Fields of a port whose valid is down mean nothing.
 *
 * Pixels travel as words of fb_bits a channel, r lowest, then g, b, a; in `mip` a density, and bit 16 when there is
 * one. Lines and bricks travel as bytes, as they lie in memory, a word's or density's lowest byte first. */
#ifndef VODR_PORTS_H
#define VODR_PORTS_H

#include "view.h"
#include "vodr.h"

enum { PORT_LINE_BYTES = 32 * 32 * 8, PORT_BEAT_BYTES = 256 }; /* the largest that parameters allow */

/* What a block did in a cycle: nothing, work, or it waited; BLOCK_STALLED + s: for the cause s (a vodr_stall). */
typedef enum block_status { BLOCK_IDLE, BLOCK_BUSY, BLOCK_STALLED } block_status;

/* Levels that every block has. idle: nothing is left of what it was given, and all its valids are down. */
typedef struct report_port {
    uint8_t status;
    bool idle;
} report_port;

typedef struct ready_port {
    bool ready;
} ready_port;

/* ---- volume divider ---- */

/* Link, to the slice generator: a visit. fresh: up in the first cycle of valid; a strobe to the texture unit. */
typedef struct brick_port {
    bool valid, fresh;
    uint64_t brick; /* its number, x fastest */
    vox_box box;
    px_rect bound;
    int32_t k0, k1;
} brick_port;

/* ---- slice generator ---- */

/* Link, to the rasterizer: a slice of a visit; last: the visit has no other. */
typedef struct slice_port {
    bool valid, last;
    brick_slice slice;
    px_rect bound;
} slice_port;

/* ---- rasterizer ---- */

/* Link, to the texture unit: a fragment. visit_done: a strobe; the visit's last row was gone through. */
typedef struct fragment_port {
    bool valid, visit_done;
    int32_t x, y;
    int64_t a[3]; /* numerators of its position */
} fragment_port;

/* The texture unit's answer. loading: it is not ready because the brick is not loaded. */
typedef struct accept_port {
    bool ready, loading;
} accept_port;

/* ---- texture unit ---- */

/* Link, to the frame buffer: a brick is wanted, so many bytes from an address on. */
typedef struct load_port {
    bool valid;
    int64_t address, bytes;
} load_port;

/* The frame buffer's answer. granted: a strobe, the last burst of what was wanted has the bus. data_valid: a strobe, so
 * many bytes of it, in order. */
typedef struct loaded_port {
    bool ready, granted, data_valid;
    int32_t bytes;
    uint8_t data[PORT_BEAT_BYTES];
} loaded_port;

/* Strobe, to the external memory of `whole`: voxels lo and hi of each axis are wanted. */
typedef struct fetch_port {
    bool valid;
    int32_t lo[3], hi[3];
} fetch_port;

/* Strobe, mem_latency_cycles after: their densities, x fastest. */
typedef struct voxels_port {
    bool valid;
    uint16_t density[8];
} voxels_port;

/* Link, to the pixel cache, and to the alpha blender, which listens: a fragment with its colour. dead: dropped by
 * kill_transparent. */
typedef struct colour_port {
    bool valid, dead;
    int32_t x, y;
    uint64_t colour;
} colour_port;

/* The pixel cache's answer, to texture unit and alpha blender. The last fragment that moved waits before the cache
 * until `gone` is up: in that cycle it is looked up, or dropped when it is dead. hazard: not gone, and for a hazard
 * alone. */
typedef struct door_port {
    bool ready, gone, hazard;
} door_port;

/* ---- alpha blender ---- */

/* Strobes, to the pixel cache, in the order of reads. known: whether the pixel that was read two cycles before this is
 * seen is written; valid: what became of the one read blend_cycles - 1 cycles before. */
typedef struct blended_port {
    bool known, known_writes;
    bool valid, writes;
    uint64_t pixel;
} blended_port;

/* ---- pixel cache ---- */

/* Strobe, to the alpha blender: a pixel was read, for the oldest fragment that is gone from the door and lives. */
typedef struct pixel_port {
    bool valid;
    uint64_t pixel;
} pixel_port;

/* Strobe, to the frame buffer: a line is wanted. */
typedef struct fill_port {
    bool valid;
    int64_t address;
} fill_port;

/* Strobe, to the frame buffer: a line, or a pixel that is written through, is to be written. */
typedef struct write_port {
    bool valid;
    int64_t address;
    int32_t bytes;
    uint8_t data[PORT_LINE_BYTES];
} write_port;

/* Strobe, for who counts: an access was looked up; it missed; a valid line was replaced. */
typedef struct look_up_port {
    bool valid, miss, replaced;
    int32_t x, y;
} look_up_port;

/* ---- frame buffer ---- */

/* Strobe, to the pixel cache: the line that was asked for first, of those that have not come. */
typedef struct filled_port {
    bool valid;
    uint8_t data[PORT_LINE_BYTES];
} filled_port;

/* Strobe, to the pixel cache: the oldest write that had not the bus has it. */
typedef struct granted_port {
    bool valid;
} granted_port;

/* Strobes, to the memory behind it: a beat is read or written, of so many bytes. In C nobody answers: what was read is
 * known when the bus is granted. */
typedef struct beat_port {
    bool valid, read, write; /* valid: one of the two */
    int64_t address;
    int32_t bytes;
    uint8_t data[PORT_BEAT_BYTES];
} beat_port;

#endif
