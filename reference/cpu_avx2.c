/* cpu_avx2.c - the marching kernels in float with AVX2 instructions, with which make compiles this file alone: vectors
 * are cut to the file's instructions before functions are inlined, so a function's own target comes too late. */
#if defined(__x86_64__)
#define REAL float
#define LANES_OF_FLOAT
#include "cpu_march_kernels.h"

DEFINE_ONE(avx2, KERNEL_LINEAR, KERNEL_SEARCH)
DEFINE_MARCH(cpu_kernels_avx2, avx2, true, KERNEL_CELLS, avx2_KERNEL_SEARCH);
#endif
