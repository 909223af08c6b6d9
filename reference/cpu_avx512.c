/* cpu_avx512.c - the marching kernels in float with AVX-512 instructions, with which make compiles this file alone:
 * vectors are cut to the file's instructions before functions are inlined, so a function's own target comes too late.
 */
#if defined(__x86_64__)
#define REAL float
#define LANES_OF_FLOAT
#include "cpu_march_kernels.h"

DEFINE_ONE(avx512, KERNEL_LINEAR, KERNEL_SEARCH)
DEFINE_MARCH(cpu_kernels_avx512, avx512, true, KERNEL_CELLS, avx512_KERNEL_SEARCH);
#endif
