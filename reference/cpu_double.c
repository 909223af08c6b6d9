/* cpu_double.c - the marching kernels in double, the quality reference: exactness before speed. */
#define REAL double
#include "cpu_march_kernels.h"

DEFINE_ONE(portable, NOT_CELLS, KERNEL_SEARCH)
DEFINE_MARCH(cpu_kernels_double, portable, false, NOT_CELLS, portable_KERNEL_SEARCH);
