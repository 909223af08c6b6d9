/* hull.c - what bounds of cubic filters are measured in. */
#include "hull.h"

#include <float.h>
#include <math.h>

/* At the middle of a cell the weights of a cardinal spline along an axis are -1/16, 9/16, 9/16 and -1/16, 5/4 without
 * their signs; in three axes the negative ones sum to ((5/4)^3 - 1)/2, along one to 1/8. Those of a B-spline are none.
 */
static const float overshoot = 0.4765625F, overshoot_of_axis = 0.125F;

float hull_share(hull_bound bound, bool spline)
{
    return spline ? 0 : bound == HULL_UNSAFE ? overshoot_of_axis : overshoot;
}

/* A sample is a sum of 64 products of three weights, each a few roundings off, by voxels: with weights' signs aside
 * summing to less than 2, it is off by less than 2^-16 of the largest voxel in floats; bounds are by far less. */
hull_scale hull_scale_of(bool spline, float least, float most)
{
    const float margin = fmaxf(0x1p-16F * fmaxf(fabsf(least), fabsf(most)), FLT_MIN * 0x1p24F);
    const float beyond = hull_share(HULL_RIVAL, spline) * (most - least) + margin;
    const hull_scale s = {.least = least - beyond, .most = most + beyond, .margin = margin};
    return (hull_scale){s.least, s.most, 255 / (s.most - s.least), margin};
}

double hull_least(hull_scale s, uint32_t code)
{
    return (double)s.least + (code - 1 / 1024.0) / (double)s.inverse;
}

double hull_greatest(hull_scale s, uint32_t code)
{
    return (double)s.most - (255 - 1 / 1024.0 - code) / (double)s.inverse;
}
