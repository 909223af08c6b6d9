/* camera.h - from a view on the command line to the machine's registers (docs/architecture.md, "The application's
 * side"). */
#ifndef HOST_CAMERA_H
#define HOST_CAMERA_H

#include "host.h"
#include "vodr.h"
#include "volume.h"

typedef struct camera {
    double azimuth_deg, elevation_deg, roll_deg;
    bool perspective;
    double fov_deg; /* vertical, 1 to 150 */
    double zoom;    /* pixels a finest voxel covers, at the volume's centre in perspective; positive */
    int32_t width_px, height_px, slices; /* 0 = the volume's own extent */
} camera;

/* View 0,0, parallel, zoom 1, field of view 40, the volume's own size. */
camera camera_default(void);

/* Fills the registers for a volume (its dimensions, spacing and orientation). *depth_vox receives the distance between
 * slices in finest voxels, for opacity correction. HOST_BAD_INPUT when a value is out of range or a position does not
 * fit its format. */
host_status camera_view(const camera *c, const volume *v, vodr_view *view, double *depth_vox, host_error *error);

#endif
