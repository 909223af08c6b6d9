/* vodr_rtl.h - the contract of co-simulation: what a Verilated block looks like from C.
 *
 * scripts/rtl-library makes a shared library of one Verilog module, ours or another. It has one function, which makes a
 * model; a model has ports by name, and is evaluated. Which ports a block has to have, and what they mean, is cmodel's
 * ports.h (docs/cosimulation.md); this header knows neither blocks nor the machine. */
#ifndef VODR_RTL_H
#define VODR_RTL_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A port of the module. Its value lies at `data` as Verilator keeps it: in 1, 2, 4 or 8 bytes when it has up to 8, 16,
 * 32 or 64 bits, else in words of 32 bits, lowest first; bits beyond width_bits are 0, and have to be. */
typedef struct vodr_rtl_port {
    const char *name;
    int32_t width_bits;
    bool output;
    void *data;
} vodr_rtl_port;

/* A model of the module, and what can be done with it. Its ports stand as long as it does. */
typedef struct vodr_rtl_model {
    void *state;
    const vodr_rtl_port *ports;
    int32_t port_count;
    void (*eval)(void *state); /* settles outputs after inputs, the clock among them, were changed */

    /* Of libraries made with --trace, else NULL: begins a waveform (FST) before the first eval(); false when the file
     * cannot be written. Adds what all signals hold now, at a time of its own unit, growing. */
    bool (*trace)(void *state, const char *path);
    void (*dump)(void *state, uint64_t time);

    void (*finish)(void *state); /* frees the model, and closes its waveform */
} vodr_rtl_model;

/* A model before its first eval(), all inputs 0; false when there is no memory. Any number can be made. What registers
 * and memories hold then is anything, from the seed: a reset that is missing shows. */
typedef bool vodr_rtl_open_function(vodr_rtl_model *model, uint32_t seed);
#define VODR_RTL_OPEN "vodr_rtl_open"

#ifdef __cplusplus
}
#endif

#endif
