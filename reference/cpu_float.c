/* cpu_float.c - the marching kernels in float for any computer, and the choice among instruction sets. */
#define REAL float
#define LANES_OF_FLOAT
#include "cpu_march_kernels.h"

DEFINE_ONE(portable, NOT_CELLS, KERNEL_SEARCH)
DEFINE_MARCH(cpu_kernels_float, portable, false, NOT_CELLS, portable_KERNEL_SEARCH);

const cpu_kernels *cpu_kernels_best(vodr_simd simd)
{
#if defined(__x86_64__)
    bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                  __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
    if ((simd == VODR_SIMD_BEST || simd == VODR_SIMD_AVX512) && avx512)
        return &cpu_kernels_avx512;
    if (simd != VODR_SIMD_PORTABLE && __builtin_cpu_supports("avx2"))
        return &cpu_kernels_avx2;
#endif
    (void)simd;
    return &cpu_kernels_float;
}
