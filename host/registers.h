/* registers.h - everything the machine is given for a frame but the voxels, as JSON (--registers). */
#ifndef HOST_REGISTERS_H
#define HOST_REGISTERS_H

#include "output.h"
#include "scene.h"

/* Writes {"schema": "vodr-registers-1", "registers": {every register of hw/registers.txt}, "machine": {every
 * parameter}, "volume": {file, crop and the window that densities are made with}, "table": [[r, g, b, a], ...]
 * premultiplied}. */
host_status registers_write(output *o, const scene *s, const view_options *options, host_error *error);

#endif
