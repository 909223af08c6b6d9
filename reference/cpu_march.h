/* cpu_march.h - private to the CPU device: kernel_march.h compiled for an instruction set and a number type. */
#ifndef REFERENCE_CPU_MARCH_H
#define REFERENCE_CPU_MARCH_H

#include "kernel_types.h"

/* Draws the rows [y0, y1) into rgba, whose rows are the frame's; adds to *samples. */
typedef void cpu_march_rows(const kernel_frame *f, int32_t y0, int32_t y1, double *rgba, uint64_t *samples);

/* The rows a call is best given are multiples of this. */
enum { CPU_TILE_PX = 4 };

typedef struct cpu_kernels {
    const char *name;
    cpu_march_rows *march[KERNEL_MODES][KERNEL_SKIPS];
} cpu_kernels;

/* The kernels of the best instructions that `simd` allows and the computer has. */
const cpu_kernels *cpu_kernels_float(vodr_simd simd);
const cpu_kernels *cpu_kernels_double(vodr_simd simd);

#endif
