/* cpu_cubic_avx2.c - the marching kernels of the cubic filters in float, and what bounds their samples, with AVX2
 * instructions, as cpu_avx2.c has those of the others. */
#if defined(__x86_64__)
#define REAL float
#define LANES_OF_FLOAT
#include "cpu_cubic.h"
#include "cpu_march_kernels.h"
#include "hull_rows.h"

DEFINE_MARCH(cpu_cubic_avx2, avx2, false, KERNEL_CUBIC, NULL);
const hull_rows hull_rows_avx2 = {hull_ranges, rival_ranges, find_extremes};
#endif
