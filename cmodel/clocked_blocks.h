/* clocked_blocks.h - our own clocked blocks: each makes its state and what its ports hold at reset. It joins them all
 * for whoever starts a machine; a block itself takes no more of it than its own. */
#ifndef VODR_CLOCKED_BLOCKS_H
#define VODR_CLOCKED_BLOCKS_H

#include "blocks.h"
#include "storage.h"

enum { CLOCKED_PIPELINES = 16 }; /* the most that parameters allow */

struct volume_divider;
struct texture_unit;

/* What blocks are made from. All of it outlives them. */
typedef struct block_setup {
    const vodr_machine *machine;
    const vodr_view *view;
    const vodr_volume *volume;
    int32_t edge_vox[3];               /* of a brick */
    struct volume_divider *walk;       /* the bricks in their order, at the start */
    const struct texture_unit *tables; /* colours of densities */
    storage *storage;                  /* what lies in memory */
} block_setup;

/* False when there is no memory for the state. */
bool clocked_volume_divider(const block_setup *setup, volume_divider_face *face, volume_divider_out *reset);
bool clocked_slice_generator(const block_setup *setup, slice_generator_face *face, slice_generator_out *reset);
bool clocked_rasterizer(const block_setup *setup, rasterizer_face *face, rasterizer_out *reset);
bool clocked_texture_unit(const block_setup *setup, texture_unit_face *face, texture_unit_out *reset);
bool clocked_alpha_blender(const block_setup *setup, alpha_blender_face *face, alpha_blender_out *reset);
bool clocked_pixel_cache(const block_setup *setup, pixel_cache_face *face, pixel_cache_out *reset);
bool clocked_frame_buffer(const block_setup *setup, frame_buffer_face *face, frame_buffer_out *reset);
bool clocked_voxel_memory(const block_setup *setup, voxel_memory_face *face, voxel_memory_out *reset);

/* A cycle of a frame buffer behind several pipelines: what it sees and registers at the port of each. Its face
 * serves one alone. */
void clocked_frame_buffer_ports(void *state, const frame_buffer_in *const in[], frame_buffer_out *const out[]);

#endif
