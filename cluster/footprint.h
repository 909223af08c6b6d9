/* footprint.h - private to cluster/: where in the picture a box of voxels may show. */
#ifndef CLUSTER_FOOTPRINT_H
#define CLUSTER_FOOTPRINT_H

#include "layer.h"

/* A rectangle that holds all pixels whose rays meet the box. */
rectangle footprint_of(const reference_camera *c, const int32_t lo_vox[3], const int32_t hi_vox[3]);

/* Samples a voxel at a point, of rays one pixel apart; 0 outside the picture. */
double footprint_samples(const reference_camera *c, const double point[3]);

#endif
