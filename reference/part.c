/* part.c - parts of a volume: which samples are drawn of one, what voxels they need, and how maxima of several become
 * one picture. */
#include "part.h"

#include <math.h>
#include <string.h>

#include "device.h"

static bool is_zero(const int32_t v[3])
{
    return v[0] == 0 && v[1] == 0 && v[2] == 0;
}

bool part_is_whole(const kernel_part *p, const int32_t dims_vox[3])
{
    return !p->boxed && memcmp(p->whole_vox, dims_vox, sizeof p->whole_vox) == 0;
}

int32_t reference_border_vox(const reference_march_job *job)
{
    const bool lit = job->blend == REFERENCE_OVER && (job->shading == REFERENCE_PHONG || job->table.rows > 1);
    return (job->filter == REFERENCE_NEAREST ? 0 : 1) + (lit ? 1 : 0);
}

reference_status part_check_volume(const reference_volume *v, vodr_error *error)
{
    if (is_zero(v->whole_vox) && is_zero(v->origin_vox))
        return REFERENCE_OK;
    for (int a = 0; a < 3; a++) {
        const int32_t whole = v->whole_vox[a], origin = v->origin_vox[a], size = v->dims_vox[a];
        if (whole < 1 || whole > VODR_MAX_DIM_VOX || origin < 0 || origin > whole - size)
            return reference_fail(error, REFERENCE_INVALID,
                                  "the part's voxels along %c are %d to %lld, must lie within a whole of 1 to %d that "
                                  "has %d",
                                  "xyz"[a], origin, (long long)origin + size, VODR_MAX_DIM_VOX, whole);
    }
    return REFERENCE_OK;
}

reference_status part_of(const reference_volume *v, const reference_march_job *job, kernel_part *p, vodr_error *error)
{
    const int32_t border = reference_border_vox(job);
    const bool is_part = !is_zero(v->whole_vox);
    *p = (kernel_part){.boxed = !is_zero(job->hi_vox)};
    for (int a = 0; a < 3; a++) {
        const int32_t origin = v->origin_vox[a], end = origin + v->dims_vox[a];
        const int32_t whole = is_part ? v->whole_vox[a] : end;
        const int32_t lo = p->boxed ? job->lo_vox[a] : 0, hi = p->boxed ? job->hi_vox[a] : whole;
        if (lo < 0 || hi <= lo || hi > whole)
            return reference_fail(error, REFERENCE_INVALID, "the box along %c is %d to %d, must lie within 0 to %d",
                                  "xyz"[a], lo, hi, whole);
        if (origin > (lo > border ? lo - border : 0) || end < (hi < whole - border ? hi + border : whole))
            return reference_fail(
                error, REFERENCE_INVALID,
                "the box along %c is %d to %d with a border of %d, but the voxels at hand are %d to %d", "xyz"[a], lo,
                hi, border, origin, end);
        p->whole_vox[a] = whole;
        p->origin_vox[a] = origin;
        p->lo_vox[a] = lo;
        p->hi_vox[a] = hi;
    }
    return REFERENCE_OK;
}

/* ---- maxima ---- */

/* Defines a function that shows a pixel as march_greatest() of kernel_march.h does in lanes of `real`. */
#define DEFINE_SHOW(name, real)                                                                                        \
    static void name(const kernel_table *t, double rgba[4])                                                            \
    {                                                                                                                  \
        const real *entries = t->rgba;                                                                                 \
        real at = (real)rgba[0] * (real)t->scale + (real)t->offset;                                                    \
        at = at > 0 ? at : 0;                                                                                          \
        at = (at < 1 ? at : 1) * (real)(t->columns - 1);                                                               \
        const int32_t column = (int32_t)at;                                                                            \
        const real share = at - (real)column;                                                                          \
        for (int c = 0; c < 4; c++) {                                                                                  \
            const real entry = entries[4 * column + c], next = entries[4 * column + 4 + c];                            \
            rgba[c] = (double)(entry + (next - entry) * share);                                                        \
        }                                                                                                              \
    }

DEFINE_SHOW(show_float, float)
DEFINE_SHOW(show_double, double)

void part_show_stored(const kernel_table *table, reference_numbers numbers, double *rgba, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (rgba[4 * i + 3] == 0)
            memset(rgba + 4 * i, 0, 4 * sizeof *rgba);
        else if (numbers == REFERENCE_DOUBLE)
            show_double(table, rgba + 4 * i);
        else
            show_float(table, rgba + 4 * i);
    }
}
