/* screen.h - from the volume to the screen: the view's registers turned round. */
#ifndef HOST_SCREEN_H
#define HOST_SCREEN_H

#include "vodr.h"

/* With (X, Y, W) = row . (p, 1), a point p of the volume (voxels) is seen at x = X/W, y = Y/W pixels of the frame;
 * pixel i covers [i, i+1). In parallel views W is 1, in perspective it is the depth in units of depth_first >> 16. What
 * lies at W < near is in front of all slices and is not seen. */
typedef struct screen_map {
    double row[3][4];
    double near;
} screen_map;

/* The map of a view. Where the view squeezes the volume into a plane, W is 0 and nothing is seen. */
screen_map screen_map_of(const vodr_view *view);

#endif
