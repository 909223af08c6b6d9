/* waveform.h - the waveform of a block around the cycle in which it differs: an FST file, and a save file for GTKWave
 * that shows the port, the clock and the block's other ports. */
#ifndef VODR_WAVEFORM_H
#define VODR_WAVEFORM_H

#include "lockstep.h"

enum { WAVEFORM_BEFORE_CYCLES = 200, WAVEFORM_AFTER_CYCLES = 4 };

typedef struct waveform {
    rtl_block *block;
    uint64_t first_cycle, end_cycle;
} waveform;

/* Of a block whose library has waveforms, before its machine's first cycle: STEM.fst and STEM.gtkw. A cycle is two
 * units of time, the clock up in the first. */
rtl_status waveform_open(waveform *w, const char *stem, rtl_block *block, const difference *d, uint64_t cycle,
                         vodr_error *error);

/* Before each cycle. */
void waveform_cycle(waveform *w, uint64_t cycle);

#endif
