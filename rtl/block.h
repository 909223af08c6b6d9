/* block.h - a Verilog block in the shape of a clocked block: its ports set from and read into cmodel's records, its
 * registers held, its tables loaded. */
#ifndef VODR_RTL_BLOCK_H
#define VODR_RTL_BLOCK_H

#include "external_memory.h"
#include "library.h"

enum { RTL_MAX_WIRES = 64 };

/* One field of a port and where the model keeps it. */
typedef struct rtl_wire {
    const signal_port *port;
    const signal_field *field;
    void *data;
    int32_t width_bits;
} rtl_wire;

typedef struct rtl_block {
    vodr_block block;
    const vodr_machine *machine;
    rtl_library library;
    rtl_wire inputs[RTL_MAX_WIRES], outputs[RTL_MAX_WIRES];
    int32_t input_count, output_count;
    uint8_t *clk, *rst;
    external_memory memory; /* the frame buffer's */
    bool dumps;             /* add what signals hold to the waveform, at `time` and the unit after */
    uint64_t time;
    struct {
        const uint8_t *read, *write, *write_data;
        const void *address, *write_bytes;
        uint8_t *read_data;
        int32_t address_bits, write_bytes_bits;
    } memory_ports;
} rtl_block;

/* Makes a block of Verilog, resets it, and writes its reset outputs into `out`, the block's record of outputs. To be
 * closed on success; outlives the setup but neither its machine nor its storage. */
rtl_status rtl_block_open(rtl_block *b, const rtl_source *source, vodr_block block, const block_setup *setup, void *out,
                          vodr_error *error);

/* A cycle without its outputs. */
void rtl_block_tick(rtl_block *b, const void *in);

/* Writes what an output holds into its port's record. */
void rtl_wire_sample(const rtl_wire *w, void *record);

/* A cycle: `in` and `out` are the block's records (blocks.h). */
void rtl_block_clock(rtl_block *b, const void *in, void *out);

void rtl_block_close(rtl_block *b);

#endif
