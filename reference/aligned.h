/* aligned.h - private to reference/: the thread-aligned projection of Kim N.-Y., "GPU thread-aligned projection for
 * accelerating high-quality volume visualization" (Hansung University): which axis of the volume neighbouring pixels
 * should run along, by how much the picture is turned for it (equations 8 to 15), and lines of pixels of the usual
 * picture that do the same without. */
#ifndef REFERENCE_ALIGNED_H
#define REFERENCE_ALIGNED_H

#include "kernel_types.h"

/* How the pixels' rays lie to a volume of these dimensions, at the picture's middle. */
typedef struct aligned_view {
    int32_t dominant_axis; /* along which the ray in the middle goes farthest, in voxels; of equals the last */
    int32_t fast_axis;     /* the next, in the order x, y, z, x: the fastest of the copy for this view */
    double theta; /* radians, -pi/2 to pi/2: the direction in the picture, from x towards y, of neighbours along
                     fast_axis */
} aligned_view;

aligned_view aligned_view_of(const reference_camera *c, const int32_t dims_vox[3], reference_theta theta);

/* The frame's own rows. */
kernel_order aligned_order_usual(const reference_camera *c);

/* Rows along theta. */
kernel_order aligned_order_of(const reference_camera *c, double theta);

/* The camera of a picture turned by theta about the middle of c's, as large as it takes to hold all of it. */
reference_camera aligned_turn(const reference_camera *c, double theta);

/* c's picture of that turned one's, by bilinear interpolation. */
void aligned_turn_back(const reference_camera *c, const reference_camera *turned, double theta, const double *from,
                       double *rgba);

#endif
