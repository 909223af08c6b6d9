/* volume_options.h - the options of the command line that say how to read a volume. */
#ifndef HOST_VOLUME_OPTIONS_H
#define HOST_VOLUME_OPTIONS_H

#include "volume.h"

/* Parses one option: dims XxYxZ, type NAME, spacing X,Y,Z, endian little|big, crop x0:x1,y0:y1,z0:z1, no-orient (value
 * NULL). *known is false, and *o untouched, for any other name. */
host_status volume_option(volume_options *o, const char *name, const char *value, bool *known, host_error *error);

#endif
