/* cpu_double.c - the marching kernels in double, the quality reference: exactness before speed, so one copy. */
#define REAL double
#include "cpu_march_kernels.h"

DEFINE_MARCH(portable, );

const cpu_kernels *cpu_kernels_double(vodr_simd simd)
{
    (void)simd;
    return &kernels_portable;
}
