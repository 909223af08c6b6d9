/* state.h - private to reference/: what a reference holds between frames. */
#ifndef REFERENCE_STATE_H
#define REFERENCE_STATE_H

#include "blocks.h"
#include "device.h"

/* What ranges of blocks are made of. */
typedef struct blocks_kind {
    reference_filter filter; /* a cubic, or what stands for the others */
    int32_t edge_vox;
    hull_bound bound;
    bool cells;
} blocks_kind;

struct reference {
    const device_ops *ops;
    void *state;
    reference_volume volume;
    blocks blocks;    /* the last asked for */
    blocks_kind kind; /* what they are of */
    hull_scale scale; /* of blocks of a cubic */
    void *shown;      /* owned; of the last frame: what shows of cells, or codes of blocks */
    float largest;    /* magnitude of a float, once a cubic needs it */
    bool has_largest;
    char name[DEVICE_NAME_CHARS];
};

/* Allocates the pixels of a frame of 8 or 16 bits a channel; vodr_frame_free() them. Zeroes *frame when it fails. */
reference_status reference_frame_make(int32_t width_px, int32_t height_px, int32_t bits, vodr_frame *frame,
                                      vodr_error *error);

/* Channel i of all, four a pixel. */
void reference_frame_set(vodr_frame *frame, size_t i, uint16_t value);

#endif
