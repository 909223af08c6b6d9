/* cpu_cubic.h - private to the CPU device: what the cubic filters need of the volume, and their kernels. */
#ifndef REFERENCE_CPU_CUBIC_H
#define REFERENCE_CPU_CUBIC_H

#include "cpu_march.h"
#include "device.h"
#include "hull.h"

extern const cpu_kernels cpu_cubic_float, cpu_cubic_double;
extern const cpu_kernels cpu_cubic_avx2, cpu_cubic_avx512;

/* The kernels of the instructions that cpu_kernels_best() chooses; *rows: what bounds their samples. */
const cpu_kernels *cpu_cubic_best(vodr_simd simd, const hull_rows **rows);

/* A volume as one filter reads it. */
typedef struct cpu_cubic {
    reference_volume volume; /* the voxels, or coefficients of B-splines */
    float *coefficients;     /* owned; NULL until a frame needs them */
    uint16_t *codes;         /* owned; of cells; NULL until a frame needs them */
    hull_scale scale;
    bool has_scale;
} cpu_cubic;

/* Makes the volume that a filter reads, once. */
reference_status cpu_cubic_volume(cpu_cubic *c, const reference_volume *v, bool spline, int32_t threads,
                                  reference_stats *stats, vodr_error *error);

/* What device_ops.ranges does. */
reference_status cpu_cubic_ranges(cpu_cubic *c, const reference_volume *v, const device_ranges *r, int32_t threads,
                                  const hull_rows *rows, reference_stats *stats, vodr_error *error);

void cpu_cubic_free(cpu_cubic *c);

#endif
