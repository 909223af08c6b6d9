/* cpu_cubic_float.c - the marching kernels of the cubic filters in float, and what bounds their samples, for any
 * computer; and the choice among instruction sets. */
#define REAL float
#define LANES_OF_FLOAT
#include "cpu_cubic.h"
#include "cpu_march_kernels.h"
#include "hull_rows.h"

DEFINE_MARCH(cpu_cubic_float, portable, false, KERNEL_CUBIC, NULL);
const hull_rows hull_rows_portable = {hull_ranges, rival_ranges, find_extremes};

const cpu_kernels *cpu_cubic_best(vodr_simd simd, const hull_rows **rows)
{
#if defined(__x86_64__)
    const cpu_kernels *best = cpu_kernels_best(simd);
    if (best == &cpu_kernels_avx512) {
        *rows = &hull_rows_avx512;
        return &cpu_cubic_avx512;
    }
    if (best == &cpu_kernels_avx2) {
        *rows = &hull_rows_avx2;
        return &cpu_cubic_avx2;
    }
#endif
    (void)simd;
    *rows = &hull_rows_portable;
    return &cpu_cubic_float;
}
