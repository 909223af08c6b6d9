/* cpu_layout.h - private to the CPU device: copies of the coefficients of B-splines, as KERNEL_WIDE and KERNEL_QUADS
 * have them, each made once. */
#ifndef REFERENCE_CPU_LAYOUT_H
#define REFERENCE_CPU_LAYOUT_H

#include "kernel_types.h"

/* KERNEL_WIDE sorted by each axis, and KERNEL_QUADS. */
enum { CPU_LAYOUTS = 4 };

typedef struct cpu_layout {
    float *memory;      /* owned; NULL until a frame needs it */
    const float *first; /* coefficient 0, 0, 0 */
    int32_t stride[3];
} cpu_layout;

/* The copy of floats whose axes are first_axis and those that follow it, in the order x, y, z, x; quads begin with x.
 * NULL where there is no memory for it, or where it has more voxels than a whole number of a kernel counts. */
const cpu_layout *cpu_layout_of(cpu_layout copies[CPU_LAYOUTS], const reference_volume *v, kernel_layout layout,
                                int32_t first_axis, int32_t threads, reference_stats *stats);

/* Names the axes of a frame without blocks anew, first_axis x, as such a copy has them. */
void cpu_layout_turn_axes(kernel_frame *f, int32_t first_axis);

void cpu_layout_free(cpu_layout *copy);

#endif
