/* lockstep.h - a block in Verilog and the same block in C, clocked side by side on the same inputs: every output is
 * compared in every cycle, what is offered as long as its valid is up. The others see the Verilog. */
#ifndef VODR_LOCKSTEP_H
#define VODR_LOCKSTEP_H

#include "block.h"

enum { DIFFERENCE_CHARS = 160 };

/* The first output that differed. */
typedef struct difference {
    bool found;
    const signal_port *port;
    const signal_field *field;
    char expected[DIFFERENCE_CHARS], got[DIFFERENCE_CHARS]; /* as text */
} difference;

/* Bytes as text: in decimal, or in hexadecimal when they are many, from the first on that differs from another's. */
void difference_tell(const uint8_t *value, const uint8_t *other, size_t bytes, char text[DIFFERENCE_CHARS]);

/* Compares what two memories hold of the frame buffer; the first difference is told in *d, which is left alone when
 * there is none. */
void lockstep_compare_memory(const storage *expected, const storage *got, difference *d);

/* DO(NAME, name) for each block. */
#define LOCKSTEP_BLOCKS(DO)                                                                                            \
    DO(VOLUME_DIVIDER, volume_divider)                                                                                 \
    DO(SLICE_GENERATOR, slice_generator)                                                                               \
    DO(RASTERIZER, rasterizer)                                                                                         \
    DO(TEXTURE_UNIT, texture_unit)                                                                                     \
    DO(ALPHA_BLENDER, alpha_blender)                                                                                   \
    DO(PIXEL_CACHE, pixel_cache)                                                                                       \
    DO(FRAME_BUFFER, frame_buffer)

typedef struct lockstep {
    rtl_block rtl;
    block_faces inner;   /* the C block, in its place */
    block_outs expected; /* what it registered, in its place */
    difference first;
    storage behind; /* the frame buffer in C writes here, so that the machine's own memory is the Verilog's */
} lockstep;

/* Puts the Verilog of a block into `faces` and its reset outputs into `outs`, both of a machine before its first cycle;
 * the C block that was there goes on beside it. To be closed on success, before the machine is freed: the C block
 * stands in its place again then. */
rtl_status lockstep_open(lockstep *l, const rtl_source *source, vodr_block block, const block_setup *setup,
                         block_faces *faces, block_outs *outs, vodr_error *error);
void lockstep_close(lockstep *l, block_faces *faces);

/* After the last cycle: whether what the frame buffer's Verilog left in memory is what C left. */
bool lockstep_end(lockstep *l);

/* The record of a block's outputs among all. */
void *lockstep_out(vodr_block block, block_outs *outs);

/* Compares a block's records of outputs; the first difference is told in *d. */
bool lockstep_compare(vodr_block block, const vodr_machine *machine, const void *expected, const void *got,
                      difference *d);

#endif
