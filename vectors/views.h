/* views.h - made-up views in integers alone: the same registers from the same seed on every computer. Cameras turn by
 * integer quaternions, whose rotations are exact fractions. */
#ifndef VECTORS_VIEWS_H
#define VECTORS_VIEWS_H

#include "rng.h"
#include "vodr.h"

/* Where a camera stands: turned by the quaternion, `across` voxels at the volume's centre being `pixels` pixels. */
typedef struct views_camera {
    int32_t quaternion[4]; /* any but 0: w, x, y, z; (1, 0, 0, 0) looks along -z with x right and y up */
    bool perspective;
    int32_t focal_px; /* perspective: the distance of the image, in its pixels */
    int32_t pixels, across;
    int32_t width_px, height_px, slices;
} views_camera;

/* The camera's registers; false when they do not fit their formats. */
bool views_of_camera(const views_camera *camera, const int32_t dims_vox[3], vodr_view *view);

/* A view of the volume: mostly of a camera whose pixels and slices the volume fills a good part of, in all directions;
 * now and then moved onto borders of voxels, with long sides, or wild. */
vodr_view views_any(rng *r, const int32_t dims_vox[3]);

/* Registers that the check accepts and no camera would write: skewed, degenerate, far off, coarse or fine. */
vodr_view views_wild(rng *r, const int32_t dims_vox[3], bool perspective);

/* The same of a frame of any size there can be: what registers can hold. */
vodr_view views_large(rng *r, const int32_t dims_vox[3]);

#endif
