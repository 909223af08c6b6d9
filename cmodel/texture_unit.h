/* texture_unit.h - the 3D texture mapping unit: address, fetch, filter, classify (Figure 2 of the paper).
 *
 * Texture memory holds the densities of one brick with its border, or of two when double-buffered; a brick that is
 * still there is not loaded again. When the volume is drawn whole, every fragment fetches its voxels from external
 * memory. */
#ifndef VODR_TEXTURE_UNIT_H
#define VODR_TEXTURE_UNIT_H

#include "cubic.h"
#include "view.h"
#include "vodr.h"

typedef struct texture_buffer {
    size_t brick; /* which one it holds */
    bool valid;
    vox_box region;      /* the voxels in it, clipped to the volume */
    uint16_t *densities; /* as voxels_row() makes them, x fastest; NULL when only loads are counted */
} texture_buffer;

typedef struct texture_unit {
    const vodr_volume *volume;
    const vodr_view *view;
    vodr_filter filter;
    int32_t stored_bits, weight_bits, guard_bits;
    cubic cubic;                              /* for the cubic filters */
    int32_t border_vox, voxel_bytes, fetches; /* bytes of a voxel in texture memory, voxels of a fragment */
    bool whole;
    texture_buffer buffers[2];
    int buffer_count, current;
    vodr_rgba *colours;      /* fragment of a density: its colour, or in mip the density itself */
    vodr_rgba *readout;      /* colour of a density, at the frame buffer's width */
    int32_t *transparent_to; /* see volume_divider_start() */
    uint8_t *dead;           /* whether kill_transparent drops a density */
} texture_unit;

/* The table is converted to the frame buffer's width. Free with texture_unit_finish() in
 * either case. */
vodr_status texture_unit_start(texture_unit *t, const vodr_machine *m, const vodr_volume *volume,
                               const vodr_table *table, const vodr_view *view, vodr_error *error);

/* Gives the buffers room for bricks of this edge; 0: the volume is drawn whole and needs none. Without, loads are
 * counted and nothing can be filtered. */
vodr_status texture_unit_reserve(texture_unit *t, int32_t edge_vox, vodr_error *error);

/* Makes `brick` the current one; returns the bytes loaded, 0 when it was still there or the volume is whole. */
uint64_t texture_unit_load(texture_unit *t, size_t brick, const vox_box *box);

/* Forgets the bricks that it holds. */
void texture_unit_empty(texture_unit *t);

/* Bytes that `count` fragments fetch from external memory: 0 unless the volume is drawn whole. */
uint64_t texture_unit_fetched(const texture_unit *t, int32_t count);

/* Filters the fragments of a span: densities[0 .. x1-x0-1]. */
void texture_unit_filter(const texture_unit *t, const brick_slice *slice, const span *s, uint16_t *densities);

void texture_unit_finish(texture_unit *t);

#endif
