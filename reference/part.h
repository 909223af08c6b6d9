/* part.h - private to reference/: parts of a volume (reference.h, reference_volume and reference_march_job). */
#ifndef REFERENCE_PART_H
#define REFERENCE_PART_H

#include "kernel_types.h"

#ifdef __cplusplus
extern "C" {
#endif

reference_status part_check_volume(const reference_volume *v, vodr_error *error);

/* Fills *p; refuses a box that the voxels at hand do not hold with the border that its samples need. */
reference_status part_of(const reference_volume *v, const reference_march_job *job, kernel_part *p, vodr_error *error);

/* Whether all samples are drawn, of voxels that are the whole volume's. */
bool part_is_whole(const kernel_part *p, const int32_t dims_vox[3]);

/* What reference_show_stored() does, with its job's table. */
void part_show_stored(const kernel_table *table, reference_numbers numbers, double *rgba, size_t count);

#ifdef __cplusplus
}
#endif

#endif
