/* view.c - which registers the machine accepts. */
#include "view.h"

#include <inttypes.h>

#include "error.h"

#define POSITION_LIMIT ((int64_t)1 << 42) /* Q19.24 */
#define NUMERATOR_LIMIT ((int64_t)1 << 62)

static const char axis_name[] = "xyz";

static bool below(int64_t value, int64_t limit)
{
    return value > -limit && value < limit;
}

/* a*b + c, false when it does not fit 62 bits and a sign. */
static bool multiply_add(int64_t a, int64_t b, int64_t c, int64_t *result)
{
    return !__builtin_mul_overflow(a, b, result) && below(*result, NUMERATOR_LIMIT) &&
           !__builtin_add_overflow(*result, c, result) && below(*result, NUMERATOR_LIMIT);
}

/* The numerator of component c at a pixel of a slice, checked term by term. */
static bool numerator(const vodr_view *v, int c, int32_t x, int32_t y, int32_t k, int64_t *a)
{
    int64_t z = v->perspective ? slice_depth(v, k) : 1, u, w;
    bool ok = v->perspective ? multiply_add(z, v->step_s[c], 0, a) : multiply_add(k, v->step_s[c], 0, a);
    return ok && below(v->step_s[c], NUMERATOR_LIMIT) && multiply_add(z, v->step_u[c], 0, &u) &&
           multiply_add(z, v->step_v[c], 0, &w) && multiply_add(x, u, *a, a) && multiply_add(y, w, *a, a);
}

static vodr_status check_positions(const vodr_view *v, int c, vodr_error *error)
{
    for (int corner = 0; corner < 8; corner++) {
        int32_t x = corner & 1 ? v->width_px - 1 : 0, y = corner & 2 ? v->height_px - 1 : 0;
        int32_t k = corner & 4 ? v->slices - 1 : 0;
        int64_t a;
        if (!numerator(v, c, x, y, k, &a) || !below(v->base[c] + (a >> v->shift), POSITION_LIMIT))
            return vodr_fail(error, VODR_INVALID,
                             "the %c position of pixel (%" PRId32 ",%" PRId32 ") on slice %" PRId32
                             " does not fit Q19.24: positions go from -262144 to 262144 voxels",
                             axis_name[c], x, y, k);
    }
    return VODR_OK;
}

static vodr_status check_depths(const vodr_view *v, vodr_error *error)
{
    if (!v->perspective)
        return v->shift == 0
                   ? VODR_OK
                   : vodr_fail(error, VODR_INVALID, "shift is %" PRId32 " but must be 0 in a parallel view", v->shift);
    int64_t limit = (int64_t)1 << 40;
    if (v->shift < 0 || v->shift > 30)
        return vodr_fail(error, VODR_INVALID, "shift is %" PRId32 " but must be 0 to 30", v->shift);
    if (!below(v->depth_first, limit) || v->depth_step > 0 || v->depth_step <= -limit)
        return vodr_fail(error, VODR_INVALID,
                         "depth_first %" PRId64 " and depth_step %" PRId64
                         " must be below 2^40, the step zero or negative: slice 0 is the farthest",
                         v->depth_first, v->depth_step);
    if (slice_depth(v, v->slices - 1) < 1)
        return vodr_fail(error, VODR_INVALID, "slice %" PRId32 " has depth %" PRId64 " but must be in front of the eye",
                         v->slices - 1, slice_depth(v, v->slices - 1));
    return VODR_OK;
}

vodr_status vodr_view_check(const vodr_view *v, const int32_t dims_vox[3], vodr_error *error)
{
    if (v->width_px < 1 || v->width_px > VODR_MAX_SIZE_PX || v->height_px < 1 || v->height_px > VODR_MAX_SIZE_PX)
        return vodr_fail(error, VODR_INVALID, "the frame is %" PRId32 "x%" PRId32 " pixels but must be 1x1 to %dx%d",
                         v->width_px, v->height_px, VODR_MAX_SIZE_PX, VODR_MAX_SIZE_PX);
    if (v->slices < 1 || v->slices > VODR_MAX_SLICES)
        return vodr_fail(error, VODR_INVALID, "the view has %" PRId32 " slices but must have 1 to %d", v->slices,
                         VODR_MAX_SLICES);
    if (v->footprint < 1)
        return vodr_fail(error, VODR_INVALID, "footprint is 0 but must be at least 1");
    vodr_status status = check_depths(v, error);
    for (int c = 0; c < 3 && status == VODR_OK; c++) {
        int64_t scale = (int64_t)1 << v->shift, border;
        if (!below(v->base[c], POSITION_LIMIT) || !multiply_add(-v->base[c], scale, 0, &border) ||
            !multiply_add(((int64_t)dims_vox[c] << VODR_POSITION_BITS) - v->base[c], scale, 0, &border))
            return vodr_fail(error, VODR_INVALID,
                             "base_%c %" PRId64 " with shift %" PRId32
                             " does not fit its format: its magnitude must be below 2^42, and its distance to the"
                             " volume's sides, shifted, below 2^62",
                             axis_name[c], v->base[c], v->shift);
        status = check_positions(v, c, error);
    }
    return status;
}
