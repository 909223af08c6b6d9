/* blocks.h - the face of a clocked block: what a block of ours, or another in its place, has to be. This and ports.h
 * are the contract of co-simulation.
 *
 * A block is a state and a function that clocks it. Each cycle every block is called once, in any order. It reads what
 * the others registered in the cycle before (`in`), moves by one cycle, and writes what it registers itself (`out`),
 * which the others see in the next. It knows nothing else of them. The bank of registers that `out` lies in changes
 * from cycle to cycle: a call writes every valid, strobe and level, and the payload of each that is up.
 *
 * A block's reset state and reset outputs come from whoever makes it; clocked_blocks.h has ours, clocked.h the machine
 * that another is put into. */
#ifndef VODR_BLOCKS_H
#define VODR_BLOCKS_H

#include "ports.h"

#define BLOCK_FACE(block)                                                                                              \
    typedef struct block##_face {                                                                                      \
        void *state;                                                                                                   \
        void (*clock)(void *state, const block##_in *in, block##_out *out);                                            \
        void (*finish)(void *state); /* frees it; NULL: nobody has to */                                               \
    } block##_face

typedef struct volume_divider_in {
    const ready_port *brick;
} volume_divider_in;

typedef struct volume_divider_out {
    brick_port brick;
    report_port report;
} volume_divider_out;

typedef struct slice_generator_in {
    const brick_port *brick;
    const ready_port *slice;
} slice_generator_in;

typedef struct slice_generator_out {
    ready_port brick;
    slice_port slice;
    report_port report;
} slice_generator_out;

typedef struct rasterizer_in {
    const slice_port *slice;
    const accept_port *fragment;
} rasterizer_in;

typedef struct rasterizer_out {
    ready_port slice;
    fragment_port fragment;
    report_port report;
} rasterizer_out;

typedef struct texture_unit_in {
    const brick_port *brick; /* its strobe `fresh` alone */
    const fragment_port *fragment;
    const loaded_port *load;
    const voxels_port *voxels;
    const door_port *colour;
} texture_unit_in;

typedef struct texture_unit_out {
    accept_port fragment;
    load_port load;
    fetch_port fetch;
    colour_port colour;
    report_port report;
} texture_unit_out;

typedef struct alpha_blender_in {
    const colour_port *colour;
    const door_port *door;
    const pixel_port *pixel;
} alpha_blender_in;

typedef struct alpha_blender_out {
    blended_port blended;
    report_port report;
} alpha_blender_out;

typedef struct pixel_cache_in {
    const colour_port *colour;
    const blended_port *blended;
    const filled_port *filled;
    const granted_port *written;
    const report_port *before[4]; /* of the blocks that fragments come through: when all are idle, the flush begins */
} pixel_cache_in;

typedef struct pixel_cache_out {
    door_port door;
    look_up_port look_up;
    pixel_port pixel;
    fill_port fill;
    write_port write;
    report_port report; /* idle: the flush is over, too */
} pixel_cache_out;

typedef struct frame_buffer_in {
    const fill_port *fill;
    const write_port *write;
    const load_port *load;
} frame_buffer_in;

typedef struct frame_buffer_out {
    filled_port filled;
    granted_port written;
    loaded_port load;
    beat_port memory;
    report_port report;
} frame_buffer_out;

/* The external memory of `whole`: no block, but clocked like one. */
typedef struct voxel_memory_in {
    const fetch_port *fetch;
} voxel_memory_in;

typedef struct voxel_memory_out {
    voxels_port voxels;
} voxel_memory_out;

BLOCK_FACE(volume_divider);
BLOCK_FACE(slice_generator);
BLOCK_FACE(rasterizer);
BLOCK_FACE(texture_unit);
BLOCK_FACE(alpha_blender);
BLOCK_FACE(pixel_cache);
BLOCK_FACE(frame_buffer);
BLOCK_FACE(voxel_memory);

/* A machine's blocks. */
typedef struct block_faces {
    volume_divider_face volume_divider;
    slice_generator_face slice_generator;
    rasterizer_face rasterizer;
    texture_unit_face texture_unit;
    alpha_blender_face alpha_blender;
    pixel_cache_face pixel_cache;
    frame_buffer_face frame_buffer;
    voxel_memory_face voxel_memory;
} block_faces;

/* What all blocks registered in a cycle. */
typedef struct block_outs {
    volume_divider_out volume_divider;
    slice_generator_out slice_generator;
    rasterizer_out rasterizer;
    texture_unit_out texture_unit;
    alpha_blender_out alpha_blender;
    pixel_cache_out pixel_cache;
    frame_buffer_out frame_buffer;
    voxel_memory_out voxel_memory;
} block_outs;

#endif
