/* cpu_cubic_double.c - the marching kernels of the cubic filters in double. */
#define REAL double
#include "cpu_cubic.h"
#include "cpu_march_kernels.h"

DEFINE_MARCH(cpu_cubic_double, portable, false, KERNEL_CUBIC, NULL);
