/* baseline.h - the rival that a card's user would start from: a plain ray caster after the CUDA samples' volumeRender.
 */
#ifndef BENCH_BASELINE_H
#define BENCH_BASELINE_H

#include "reference.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Draws an unlit `over` job, 8-bit voxels and a table of one row: tex3D, a look-up by tex1D, front to back, the same
 * steps and termination as the job's, nothing skipped. ms[] receives the kernel's time in each round. */
reference_status baseline_draw(const reference_volume *volume, const reference_march_job *job, double *rgba, double *ms,
                               int rounds, vodr_error *error);

#ifdef __cplusplus
}
#endif

#endif
