/* enlarge.h - a volume resampled by Catmull-Rom cubics to another size, in 16 bits. */
#ifndef BENCH_ENLARGE_H
#define BENCH_ENLARGE_H

#include <stdbool.h>
#include <stdint.h>

/* Fills out[] of to[0]*to[1]*to[2] voxels, x fastest, as both are: voxels are cells, so that both volumes cover the
 * same box; beyond a side its voxels go on. `lo` becomes 0 and `hi` 65535, what is beyond is cut off. Each size of to[]
 * is at least that of from[]. False when the host is out of memory. */
bool enlarge(const float *voxels, const int32_t from[3], const int32_t to[3], float lo, float hi, uint16_t *out);

#endif
