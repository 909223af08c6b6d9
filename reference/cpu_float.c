/* cpu_float.c - the marching kernels in float, a copy an instruction set. */
#define REAL float
#include "cpu_march_kernels.h"

DEFINE_MARCH(portable, );

#if defined(__x86_64__)
DEFINE_MARCH(avx2, __attribute__((target("avx2"))));
DEFINE_MARCH(avx512, __attribute__((target("avx512f,avx512bw,avx512dq,avx512vl"))));

const cpu_kernels *cpu_kernels_float(vodr_simd simd)
{
    bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                  __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
    if ((simd == VODR_SIMD_BEST || simd == VODR_SIMD_AVX512) && avx512)
        return &kernels_avx512;
    if (simd != VODR_SIMD_PORTABLE && __builtin_cpu_supports("avx2"))
        return &kernels_avx2;
    return &kernels_portable;
}
#else
const cpu_kernels *cpu_kernels_float(vodr_simd simd)
{
    (void)simd;
    return &kernels_portable;
}
#endif
