/* cells.h - private to reference/: the volume as the CPU's packed cells (kernel_types.h, lanes_cpu_float.h). */
#ifndef REFERENCE_CELLS_H
#define REFERENCE_CELLS_H

#include <stdbool.h>
#include <stddef.h>

#include "kernel_types.h"

/* Whether a volume can be packed: integers, few enough. */
bool cells_suit(const reference_volume *v);
size_t cells_bytes(const reference_volume *v);

/* Fills the layers [z0, z1) of dims_vox[2] + 1, in memory of cells_bytes() for all of them. */
void cells_fill(const reference_volume *v, int32_t z0, int32_t z1, void *cells);

#endif
