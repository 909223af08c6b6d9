/* clocked_voxel_memory.c - the external memory that `whole` fetches voxels from: a port of its own, always free. */
#include <stdlib.h>

#include "clocked_blocks.h"
#include "layout.h"
#include "voxels.h"

typedef struct memory_state {
    const vodr_volume *volume;
    int32_t stored_bits;
    int32_t at, latency;
    voxels_port *ring; /* answers, by the cycle in which they were asked for; `at`: in this one */
    voxel_memory_out out;
} memory_state;

static void clock(void *state, const voxel_memory_in *in, voxel_memory_out *out)
{
    memory_state *s = state;
    const fetch_port *f = in->fetch;
    voxels_port *v = &s->ring[s->at];
    v->valid = f->valid;
    for (int i = 0; i < 8 && f->valid; i++) {
        size_t voxel = voxel_index(s->volume->dims_vox, i & 1 ? f->hi[0] : f->lo[0], i & 2 ? f->hi[1] : f->lo[1],
                                   i & 4 ? f->hi[2] : f->lo[2]);
        voxels_row(s->volume, s->stored_bits, voxel, 1, &v->density[i]);
    }
    s->at = s->at + 1 < s->latency ? s->at + 1 : 0;
    out->voxels.valid = s->ring[s->at].valid;
    if (out->voxels.valid)
        out->voxels = s->ring[s->at];
}

static void finish(void *state)
{
    memory_state *s = state;
    free(s->ring);
    free(s);
}

bool clocked_voxel_memory(const block_setup *setup, voxel_memory_face *face, voxel_memory_out *reset)
{
    memory_state *s = calloc(1, sizeof *s);
    *face = (voxel_memory_face){.state = s, .clock = clock, .finish = finish};
    if (!s)
        return false;
    s->volume = setup->volume;
    s->stored_bits = stored_bits(setup->machine);
    s->latency = setup->machine->mem_latency_cycles;
    s->ring = calloc((size_t)s->latency, sizeof *s->ring);
    *reset = s->out;
    return s->ring != NULL;
}
