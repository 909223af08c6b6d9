/* projection.c - conservative bounds in integers (docs/timing.md, section 2).
 *
 * With u, v, s the view's steps, a sample at q from the base has x*u + y*v + k*s = q in parallel views, and in
 * perspective x*z*u + y*z*v + z*s = q*2^shift before its one floor, which takes no sample across the border of a voxel.
 * So x, y, k, or x*z, y*z, z, are affine in the position, with factors cross(v, s)/det and so on. Numerators and det
 * are exact here, in 128 bits; only rounding them down into registers loses anything, less than one unit each.
 * Positions in a volume of W x H x D voxels are not negative: a sum of registers is too small by less than W + H + D +
 * 1 units, and never too large.
 */
#include "projection.h"

__extension__ typedef __int128 wide;

enum {
    STEP_BITS = 41,   /* of a step's magnitude: larger ones are not inverted */
    FACTOR_BITS = 31, /* of m's magnitude */
    OFFSET_BITS = 50, /* of lo's and hi's, before margins */
    FRACTION_BITS = 24,
    DEPTH_BITS = 62,         /* of depths on their way to slices, */
    DEPTH_FRACTION_BITS = 60 /* of these */
};

/* An affine function before it is rounded: (n[0]*x + n[1]*y + n[2]*z + n[3])/d at a position in voxels; d > 0. */
typedef struct affine {
    wide n[4], d;
} affine;

static bool below(wide value, int bits)
{
    return value < (wide)1 << bits && value > -((wide)1 << bits);
}

static wide floor_div(wide a, wide b)
{
    return a / b - (a % b < 0);
}

/* Rounds a function down to registers with as many fraction bits, at most `most`, as leave the factors below 2^factor
 * and the constant below 2^offset; false when not even none do. */
static bool round_down(const affine *a, int factor, int offset, int most, wide q[4], int *fraction)
{
    wide rest[4];
    bool fits = true, doubles = true;
    for (int i = 0; i < 4; i++) {
        q[i] = floor_div(a->n[i], a->d);
        rest[i] = a->n[i] - q[i] * a->d;
        fits &= below(q[i], i < 3 ? factor : offset);
    }
    for (*fraction = 0; fits && *fraction < most; *fraction += doubles) {
        for (int i = 0; i < 4; i++)
            doubles &= below(q[i], (i < 3 ? factor : offset) - 1);
        if (!doubles)
            break;
        for (int i = 0; i < 4; i++) {
            bool carry = rest[i] >= a->d - rest[i];
            rest[i] = carry ? rest[i] - (a->d - rest[i]) : 2 * rest[i];
            q[i] = 2 * q[i] + carry;
        }
    }
    return fits;
}

static bound_row row_of(const wide q[4], int fraction, wide below_lo, wide above_hi)
{
    return (bound_row){.m = {(int32_t)q[0], (int32_t)q[1], (int32_t)q[2]},
                       .lo = (int64_t)(q[3] - below_lo),
                       .hi = (int64_t)(q[3] + above_hi),
                       .fraction = fraction};
}

/* A row whose first and last integers are asked for: `slack` is by how much, in 1/d, the function can be less. */
static bound_row integer_row(const affine *a, wide slack, int32_t extent, const bound_row *all)
{
    wide q[4];
    int fraction;
    if (!round_down(a, FACTOR_BITS, OFFSET_BITS, FRACTION_BITS, q, &fraction))
        return *all;
    wide one = (wide)1 << fraction, less = slack ? floor_div(slack << fraction, a->d) + 1 : 0;
    return row_of(q, fraction, less - (one - 1), extent + one);
}

static bound_row all_slices(const vodr_view *v)
{
    return (bound_row){.lo = 0, .hi = v->slices};
}

/* Slices from depths. Slice k has depth z when z <= (depth_first + k*depth_step)/2^16 < z + 1. */
static bound_row slice_row(const vodr_view *v, const affine *depth, int32_t extent)
{
    const bound_row all = all_slices(v);
    wide q[4];
    int fraction;
    if (v->depth_step == 0 || !round_down(depth, DEPTH_BITS, DEPTH_BITS, DEPTH_FRACTION_BITS + v->shift, q, &fraction))
        return all;
    fraction -= v->shift;
    if (fraction < VODR_DEPTH_BITS)
        return all;
    affine slice = {.d = (wide)-v->depth_step << (fraction - VODR_DEPTH_BITS)};
    for (int c = 0; c < 3; c++)
        slice.n[c] = -q[c];
    slice.n[3] = ((wide)v->depth_first << (fraction - VODR_DEPTH_BITS)) - q[3];
    return integer_row(&slice, ((wide)1 << fraction) + extent, extent, &all);
}

static void cross(const int64_t a[3], const int64_t b[3], wide out[3])
{
    for (int c = 0; c < 3; c++) {
        int i = (c + 1) % 3, j = (c + 2) % 3;
        out[c] = (wide)a[i] * b[j] - (wide)a[j] * b[i];
    }
}

/* cross(a, b) . (position - base) / det, in units of 2^-24 of what it is. */
static affine inverse_row(const vodr_view *view, const int64_t a[3], const int64_t b[3], wide det)
{
    affine row = {.d = det < 0 ? -det : det};
    wide by[3];
    cross(a, b, by);
    for (int c = 0; c < 3; c++) {
        by[c] = det < 0 ? -by[c] : by[c];
        row.n[c] = by[c] * ((wide)1 << VODR_POSITION_BITS);
        row.n[3] -= by[c] * view->base[c];
    }
    return row;
}

/* The three numerators of perspective: of their common scale only ratios remain. */
static void ratio_rows(projection *p, affine rows[3], int32_t extent)
{
    bound_row *const out[3] = {&p->x, &p->y, &p->z};
    wide q[4];
    int shift = 0;
    for (int r = 0; r < 3; r++)
        for (int i = 0; i < 4; i++)
            while (!below(rows[r].n[i] >> shift, i < 3 ? FACTOR_BITS : OFFSET_BITS))
                shift++;
    for (int r = 0; r < 3; r++) {
        for (int i = 0; i < 4; i++)
            q[i] = rows[r].n[i] >> shift;
        *out[r] = row_of(q, 0, 0, extent);
    }
}

projection projection_of(const vodr_view *view, const int32_t dims_vox[3])
{
    const bound_row everywhere = {.lo = -VODR_MAX_SIZE_PX, .hi = VODR_MAX_SIZE_PX};
    projection p = {.perspective = view->perspective, .slices = view->slices, .x = everywhere, .y = everywhere};
    p.z = (bound_row){.lo = 1, .hi = 1};
    p.k = all_slices(view);
    int32_t extent = dims_vox[0] + dims_vox[1] + dims_vox[2] + 1;
    const int64_t *u = view->step_u, *v = view->step_v;
    int64_t s[3];
    bool small = true;
    wide det = 0, across[3];
    p.centre_px[0] = view->perspective ? view->width_px / 2 : 0;
    p.centre_px[1] = view->perspective ? view->height_px / 2 : 0;
    for (int c = 0; c < 3 && small; c++) {
        small = below(u[c], STEP_BITS) && below(v[c], STEP_BITS) && below(view->step_s[c], STEP_BITS);
        s[c] = small ? view->step_s[c] + p.centre_px[0] * u[c] + p.centre_px[1] * v[c] : 0;
        small &= below(s[c], STEP_BITS);
    }
    if (!small)
        return p;
    cross(v, s, across);
    for (int c = 0; c < 3; c++)
        det += u[c] * across[c];
    if (det == 0)
        return p;
    affine rows[3] = {inverse_row(view, v, s, det), inverse_row(view, s, u, det), inverse_row(view, u, v, det)};
    if (view->perspective) {
        ratio_rows(&p, rows, extent);
        p.k = slice_row(view, &rows[2], extent);
    } else {
        p.x = integer_row(&rows[0], 0, extent, &everywhere);
        p.y = integer_row(&rows[1], 0, extent, &everywhere);
        p.k = integer_row(&rows[2], 0, extent, &p.k);
    }
    return p;
}

/* ---- a box ---- */

static inline int64_t least(const bound_row *r, const vox_box *b)
{
    int64_t sum = r->lo;
    for (int c = 0; c < 3; c++)
        sum += (int64_t)r->m[c] * (r->m[c] < 0 ? b->hi[c] : b->lo[c]);
    return sum;
}

static inline int64_t greatest(const bound_row *r, const vox_box *b)
{
    int64_t sum = r->hi;
    for (int c = 0; c < 3; c++)
        sum += (int64_t)r->m[c] * (r->m[c] < 0 ? b->lo[c] : b->hi[c]);
    return sum;
}

static inline int32_t cut(int64_t value, int32_t lo, int32_t hi)
{
    return value <= lo ? lo : value >= hi ? hi : (int32_t)value;
}

static inline bool bound_integers(const bound_row *r, const vox_box *box, int32_t from, int32_t to, int32_t *first,
                                  int32_t *end)
{
    *first = cut(least(r, box) >> r->fraction, from, to);
    *end = cut(greatest(r, box) >> r->fraction, from, to);
    return *first < *end;
}

/* Pixels whose distance from `centre` is a numerator over a depth in [near, far], near > 0. Quotients are cut off
 * towards zero. */
static inline bool bound_ratio(const bound_row *r, const vox_box *box, int64_t near, int64_t far, int32_t centre,
                               int32_t from, int32_t to, int32_t *first, int32_t *end)
{
    int64_t lo = least(r, box), hi = greatest(r, box);
    *first = cut(centre + (lo > 0 ? (lo - 1) / far + 1 : lo / near), from, to);
    *end = cut(centre + (hi < 0 ? (hi + 1) / far : hi / near + 1), from, to);
    return *first < *end;
}

bool projection_bound(const projection *p, const vox_box *box, const px_rect *clip, px_rect *bound, int32_t *k0,
                      int32_t *k1)
{
    if (!bound_integers(&p->k, box, 0, p->slices, k0, k1))
        return false;
    if (!p->perspective)
        return bound_integers(&p->x, box, clip->x0, clip->x1, &bound->x0, &bound->x1) &&
               bound_integers(&p->y, box, clip->y0, clip->y1, &bound->y0, &bound->y1);
    int64_t near = least(&p->z, box), far = greatest(&p->z, box);
    *bound = *clip;
    if (near <= 0) /* the box reaches the eye's plane, or lies behind it */
        return far > 0;
    return bound_ratio(&p->x, box, near, far, p->centre_px[0], clip->x0, clip->x1, &bound->x0, &bound->x1) &&
           bound_ratio(&p->y, box, near, far, p->centre_px[1], clip->y0, clip->y1, &bound->y0, &bound->y1);
}
