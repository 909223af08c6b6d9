/* reference_options.h - the options of `vodr reference` beyond the view, and which of them go together. */
#ifndef HOST_REFERENCE_OPTIONS_H
#define HOST_REFERENCE_OPTIONS_H

#include "options.h"
#include "reference_scene.h"

/* A choice being made. */
typedef struct reference_wish {
    reference_choice choice;
    const char *machine_filter;                                                   /* of --filter; NULL: not given */
    bool has_accel, has_step, has_block, has_shading, has_termination, has_theta; /* given on the command line */
} reference_wish;

/* Takes a reference_wish as its target. */
extern const option_table option_reference;

/* CPU, slices, float, best. */
reference_wish reference_wish_default(void);

/* Fills in the defaults that depend on others, and the machine's filter; refuses what does not go together, before any
 * work. */
host_status reference_wish_settle(reference_wish *w, view_options *v, host_error *error);

/* The words that the options take. */
const char *reference_device_word(const reference_choice *c);
const char *reference_method_name(const reference_choice *c);
const char *reference_numbers_name(const reference_choice *c);
const char *reference_accel_name(const reference_choice *c);
const char *reference_filter_name(const reference_choice *c, const scene *s);
const char *reference_shading_name(const reference_choice *c);

#endif
