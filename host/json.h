/* json.h - pieces of JSON that several outputs share. */
#ifndef HOST_JSON_H
#define HOST_JSON_H

#include <jansson.h>

#include "output.h"
#include "scene.h"

/* A string; bytes outside ASCII become '?' where the text is not UTF-8. */
json_t *json_text(const char *text);

/* {"name": ..., and every parameter: a number, or its word or shape as text}. */
json_t *json_machine(const char *name, const vodr_machine *machine);

/* The volume's path, format, dims, spacing, type, range of values, crop, and window. */
json_t *json_volume(const scene *s, const view_options *options);

/* Writes and frees `root`; NULL, which is what a failed json_pack() gives, is reported as lack of memory. */
host_status json_write(output *o, json_t *root, host_error *error);

#endif
