/* spline.h - the coefficients that the machine weights with filter=bspline (docs/architecture.md, section 11). */
#ifndef HOST_SPLINE_H
#define HOST_SPLINE_H

#include "host.h"
#include "vodr.h"

/* Of the cubic B-spline through the densities of a volume, `density_bits` (8 or 12) wide; `coefficients` has room for
 * one a voxel. Needs 4 bytes of memory a voxel on the way. */
host_status spline_coefficients(const vodr_volume *densities, int32_t density_bits, int16_t *coefficients,
                                host_error *error);

#endif
