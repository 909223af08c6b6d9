#include "top.h"

#include <stdlib.h>

/* ---- faces ---- */

static void sample(const top *t, vodr_block block, void *out)
{
    const char *outs = (const char *)out - rtl_top_record(block);
    for (int32_t i = t->first_output[block]; i < t->first_output[block + 1]; i++)
        rtl_wire_sample(&t->rtl.outputs[i], (char *)outs + t->rtl.outputs[i].port->record);
}

/* The texture unit's call is the first of a cycle: it sees the one input that vodr_top has from C. */
#define CLOCK(NAME, name)                                                                                              \
    static void clock_##name(void *state, const name##_in *in, name##_out *out)                                        \
    {                                                                                                                  \
        top *t = state;                                                                                                \
        if (VODR_BLOCK_##NAME == VODR_BLOCK_TEXTURE_UNIT)                                                              \
            rtl_block_tick(&t->rtl, in);                                                                               \
        sample(t, VODR_BLOCK_##NAME, out);                                                                             \
    }
LOCKSTEP_BLOCKS(CLOCK)

static const uint8_t order[CLOCKED_BLOCKS] = {
    VODR_BLOCK_TEXTURE_UNIT,  VODR_BLOCK_VOLUME_DIVIDER, VODR_BLOCK_SLICE_GENERATOR, VODR_BLOCK_RASTERIZER,
    VODR_BLOCK_ALPHA_BLENDER, VODR_BLOCK_PIXEL_CACHE,    VODR_BLOCK_FRAME_BUFFER,    VODR_BLOCK_COUNT};

bool top_step(top *t)
{
    return clocked_step(t->machine, order);
}

static int compare_records(const void *a, const void *b)
{
    const rtl_wire *x = a, *y = b;
    return (x->port->record > y->port->record) - (x->port->record < y->port->record);
}

rtl_status top_open(top *t, const rtl_source *source, clocked *machine, vodr_error *error)
{
    *t = (top){.machine = machine};
    block_faces *faces = clocked_faces(machine);
    rtl_status status = rtl_block_open(&t->rtl, source, RTL_TOP, clocked_setup(machine), clocked_reset(machine), error);
    if (status != RTL_OK)
        return status;
    qsort(t->rtl.outputs, (size_t)t->rtl.output_count, sizeof *t->rtl.outputs, compare_records);
    int32_t output = 0;
    for (int b = 0; b <= VODR_BLOCK_COUNT; b++) {
        t->first_output[b] = output;
        while (b < VODR_BLOCK_COUNT && output < t->rtl.output_count &&
               t->rtl.outputs[output].port->record < rtl_top_record(b + 1))
            output++;
    }
#define TAKE(NAME, name)                                                                                               \
    t->inner.name = faces->name;                                                                                       \
    faces->name = (name##_face){.state = t, .clock = clock_##name};
    LOCKSTEP_BLOCKS(TAKE)
    return RTL_OK;
}

void top_close(top *t)
{
    block_faces *faces = clocked_faces(t->machine);
#define GIVE(NAME, name) faces->name = t->inner.name;
    LOCKSTEP_BLOCKS(GIVE)
    rtl_block_close(&t->rtl);
}

void top_compare(top *t, const clocked *expected)
{
    if (t->first.found ||
        lockstep_compare(RTL_TOP, t->rtl.machine, clocked_outs(expected), clocked_outs(t->machine), &t->first))
        return;
    t->block = VODR_BLOCK_VOLUME_DIVIDER;
    while (t->first.port->record >= rtl_top_record(t->block + 1))
        t->block++;
}

void top_end(top *t, const clocked *expected)
{
    const storage *mine = clocked_setup(t->machine)->storage;
    if (t->first.found)
        return;
    t->block = VODR_BLOCK_FRAME_BUFFER;
    lockstep_compare_memory(clocked_setup(expected)->storage, mine, &t->first);
}
