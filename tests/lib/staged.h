/* staged.h - scenes made in memory, as scene_open_stored() makes them of files. */
#ifndef TESTS_STAGED_H
#define TESTS_STAGED_H

#include "scene.h"

/* Stages a volume, which the scene then owns, under a transfer function, seen by a camera through a machine given as
 * "name=value ...". The window is the volume's default one. To be closed by scene_close(). */
void staged_open(scene *s, volume *v, const char *transfer, const char *machine, const camera *eye);

/* What the scene's picture is without any number format of the machine or of reference/: slices blended over in double
 * precision. 4*width_px*height_px channels, to be freed. Before the scene's voxels are converted. */
double *staged_ideal(const scene *s);

/* Decibels between pictures of `channels` channels, peak 1; 999 when equal. */
double staged_psnr(const double *a, const double *b, size_t channels);

#endif
