/* cpu_float.c - the marching kernels in float: for any computer, and a copy an instruction set of the frequent ones. */
#define REAL float
#define LANES_OF_FLOAT
#include "cpu_march_kernels.h"

DEFINE_MARCH(, cpu_kernels_float, portable, , false, NOT_CELLS);

#if defined(__x86_64__)
DEFINE_MARCH(static, kernels_avx2, avx2, __attribute__((target("avx2"))), true, KERNEL_CELLS);
DEFINE_MARCH(static, kernels_avx512, avx512, __attribute__((target("avx512f,avx512bw,avx512dq,avx512vl"))), true,
             KERNEL_CELLS);

const cpu_kernels *cpu_kernels_best(vodr_simd simd)
{
    bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                  __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
    if ((simd == VODR_SIMD_BEST || simd == VODR_SIMD_AVX512) && avx512)
        return &kernels_avx512;
    if (simd != VODR_SIMD_PORTABLE && __builtin_cpu_supports("avx2"))
        return &kernels_avx2;
    return &cpu_kernels_float;
}
#else
const cpu_kernels *cpu_kernels_best(vodr_simd simd)
{
    (void)simd;
    return &cpu_kernels_float;
}
#endif
