/* cpu_cubic_avx512.c - the marching kernels of the cubic filters in float, and what bounds their samples, with AVX-512
 * instructions, as cpu_avx512.c has those of the others. */
#if defined(__x86_64__)
#define REAL float
#define LANES_OF_FLOAT
#include "cpu_cubic.h"
#include "cpu_march_kernels.h"
#include "hull_rows.h"

DEFINE_MARCH(cpu_cubic_avx512, avx512, false, KERNEL_CUBIC, NULL);
const hull_rows hull_rows_avx512 = {hull_ranges, rival_ranges, find_extremes};
#endif
