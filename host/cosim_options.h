/* cosim_options.h - the options of co-simulation: which blocks are drawn in Verilog, and what they are held against. */
#ifndef HOST_COSIM_OPTIONS_H
#define HOST_COSIM_OPTIONS_H

#include "cosim.h"
#include "options.h"
#include "output.h"

typedef struct cosim_choice {
    bool any; /* a block is in Verilog */
    bool compare_given;
    cosim_options cosim;
    char *words, *waveform; /* owned */
} cosim_choice;

/* Takes a cosim_choice. */
extern const option_table option_cosim;

cosim_choice cosim_choice_default(void);
void cosim_choice_free(cosim_choice *c);

/* Whether the options go together; a difference leaves its waveform beside `picture` (NULL: in the working directory).
 */
host_status cosim_choice_check(cosim_choice *c, const char *picture, host_error *error);

#endif
