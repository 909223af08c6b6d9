/* check.c - what the blocks in Verilog refuse: machines that the model in C alone can be (docs/cosimulation.md). */
#include <inttypes.h>
#include <string.h>

#include "cosim.h"
#include "layout.h"
#include "signals.h"

/* A parameter's least and largest value for a block; a condition on another says when it counts. */
typedef struct bound {
    vodr_block block;
    const char *name;
    size_t offset;
    int32_t lo, hi;
    bool (*counts)(const vodr_machine *m);
} bound;

static bool is_dram(const vodr_machine *m)
{
    return m->memory == VODR_MEMORY_DRAM;
}

static bool is_fixed(const vodr_machine *m)
{
    return m->memory == VODR_MEMORY_FIXED;
}

#define BOUND(NAME, field, lo, hi, counts)                                                                             \
    {                                                                                                                  \
        VODR_BLOCK_##NAME, #field, offsetof(vodr_machine, field), lo, hi, counts                                       \
    }

static const bound bounds[] = {
    BOUND(VOLUME_DIVIDER, brick_setup_cycles, 29, 65535, NULL),
    BOUND(FRAME_BUFFER, mem_latency_cycles, 3, 65535, is_fixed),
    BOUND(FRAME_BUFFER, dram_tcas_cycles, 3, 255, is_dram),
};

rtl_status cosim_check(vodr_block block, const vodr_machine *machine, vodr_error *error)
{
    if (machine->pipelines != 1)
        return rtl_fail(error, RTL_INVALID,
                        "pipelines=%" PRId32 ": blocks in Verilog take 1 only; the model in C takes it",
                        machine->pipelines);
    if (block == VODR_BLOCK_TEXTURE_UNIT && filter_is_cubic(machine))
        return rtl_fail(error, RTL_INVALID,
                        "filter=%s: texture_unit in Verilog takes nearest and linear only; the model in C takes it",
                        machine->filter == VODR_FILTER_CARDINAL ? "cardinal" : "bspline");
    for (size_t i = 0; i < sizeof bounds / sizeof *bounds; i++) {
        const bound *b = &bounds[i];
        int32_t value;
        memcpy(&value, (const char *)machine + b->offset, sizeof value);
        if (b->block != block || (b->counts && !b->counts(machine)) || (value >= b->lo && value <= b->hi))
            continue;
        return rtl_fail(error, RTL_INVALID,
                        "%s=%" PRId32 ": %s in Verilog takes %" PRId32 " to %" PRId32 " only; the model in C takes it",
                        b->name, value, signals_of(block)->name, b->lo, b->hi);
    }
    return RTL_OK;
}
