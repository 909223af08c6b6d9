/* view.c - the registers by their names, and which the machine accepts. */
#include "view.h"

#include <inttypes.h>
#include <stddef.h>
#include <string.h>

#include "error.h"

#define POSITION_LIMIT ((int64_t)1 << 42) /* Q19.24 */
#define NUMERATOR_LIMIT ((int64_t)1 << 62)

static const char axis_name[] = "xyz";

static bool below(int64_t value, int64_t limit)
{
    return value > -limit && value < limit;
}

/* a*b + c, false when it does not fit 62 bits and a sign, as c does. */
static bool multiply_add(int64_t a, int64_t b, int64_t c, int64_t *result)
{
    if (__builtin_mul_overflow(a, b, result) || !below(*result, NUMERATOR_LIMIT))
        return false;
    *result += c;
    return below(*result, NUMERATOR_LIMIT);
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

/* ---- registers by name ---- */

enum { UNSIGNED_32 = -4 };

/* A register's field; its bytes: 1, a bool; 4, 8, signed; or UNSIGNED_32. */
typedef struct register_field {
    const char *name;
    size_t offset;
    int bytes;
} register_field;

#define FIELD(member, bytes)                                                                                           \
    {                                                                                                                  \
#member, offsetof(vodr_view, member), bytes                                                                    \
    }
#define AXES(member)                                                                                                   \
    {#member "_x", offsetof(vodr_view, member[0]), 8}, {#member "_y", offsetof(vodr_view, member[1]), 8},              \
    {                                                                                                                  \
#member "_z", offsetof(vodr_view, member[2]), 8                                                                \
    }

static const register_field register_fields[] = {
    FIELD(width_px, 4),
    FIELD(height_px, 4),
    FIELD(slices, 4),
    FIELD(perspective, 1),
    FIELD(shift, 4),
    FIELD(footprint, UNSIGNED_32),
    AXES(base),
    AXES(step_u),
    AXES(step_v),
    AXES(step_s),
    FIELD(depth_first, 8),
    FIELD(depth_step, 8),
};

enum { REGISTER_FIELDS = sizeof register_fields / sizeof *register_fields, VOLUME_REGISTERS = 3 };
_Static_assert((int)REGISTER_FIELDS + (int)VOLUME_REGISTERS == (int)VODR_REGISTER_COUNT,
               "a register of hw/registers.txt has no field");

static const register_field *field_of(const char *name)
{
    for (int i = 0; i < REGISTER_FIELDS; i++)
        if (strcmp(register_fields[i].name, name) == 0)
            return &register_fields[i];
    return NULL;
}

static int64_t field_value(const register_field *f, const vodr_view *view)
{
    const void *at = (const char *)view + f->offset;
    switch (f->bytes) {
    case 1: return *(const bool *)at;
    case 4: return *(const int32_t *)at;
    case UNSIGNED_32: return *(const uint32_t *)at;
    default: return *(const int64_t *)at;
    }
}

bool vodr_register_get(const char *name, const vodr_view *view, const int32_t dims_vox[3], int64_t *value)
{
    static const char *const volume[VOLUME_REGISTERS] = {"dim_x", "dim_y", "dim_z"};
    const register_field *f = field_of(name);
    if (f)
        *value = field_value(f, view);
    for (int i = 0; i < VOLUME_REGISTERS && !f; i++)
        if (strcmp(volume[i], name) == 0) {
            *value = dims_vox[i];
            return true;
        }
    return f != NULL;
}

bool vodr_register_set(const char *name, int64_t value, vodr_view *view)
{
    const register_field *f = field_of(name);
    void *at = f ? (char *)view + f->offset : NULL;
    if (!f)
        return false;
    switch (f->bytes) {
    case 1: *(bool *)at = value == 1; break;
    case 4: *(int32_t *)at = (int32_t)value; break;
    case UNSIGNED_32: *(uint32_t *)at = (uint32_t)value; break;
    default: *(int64_t *)at = value;
    }
    return field_value(f, view) == value;
}
