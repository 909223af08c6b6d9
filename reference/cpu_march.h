/* cpu_march.h - private to the CPU device: kernel_march.h compiled for an instruction set and a number type. */
#ifndef REFERENCE_CPU_MARCH_H
#define REFERENCE_CPU_MARCH_H

#include "kernel_types.h"

/* Draws the rows [j0, j1) of the frame's order into rgba, whose rows are the frame's; adds to *samples. */
typedef void cpu_march_rows(const kernel_frame *f, int32_t j0, int32_t j1, double *rgba, uint64_t *samples);

/* The rows a call is best given are multiples of this. */
enum { CPU_TILE_PX = 4 };

typedef struct cpu_kernels {
    const char *name;
    bool cells; /* KERNEL_CELLS and nothing else, but in KERNEL_SEARCH KERNEL_LINEAR; or each other filter,
                   KERNEL_LINEAR to the same bytes */
    cpu_march_rows *march[KERNEL_MODES];
    bool quads; /* KERNEL_CUBIC reads KERNEL_QUADS */
} cpu_kernels;

/* Portable kernels; and, on x86-64, those of an instruction set. */
extern const cpu_kernels cpu_kernels_float, cpu_kernels_double;
extern const cpu_kernels cpu_kernels_avx2, cpu_kernels_avx512;

/* The kernels of the best instructions that `simd` allows and the computer has; cpu_kernels_float where that is none.
 */
const cpu_kernels *cpu_kernels_best(vodr_simd simd);

#endif
