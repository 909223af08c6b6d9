/* rasterizer.c - coverage in exact integers: on a row each numerator is affine in x, so the pixels with lo <= A < hi
 * are one run, and its ends are two divisions. Half-open boxes make neighbouring bricks' runs a partition: no seam, no
 * overlap.
 *
 * Many rows are divided at once, in doubles: floor(n/d) + 1 is floor((n + d + 1/2)/d), and (n + d + 1/2)/d is half a
 * d-th or more away from any integer, so that an error of less does not show. Where numerators are too large for that,
 * integers divide them. */
#include "rasterizer.h"

#include <math.h>
#include <stdlib.h>

/* With n, d and what n grows by over all rows below this, rounding moves a quotient by a fifth of a d-th. */
#define ROUNDING_LIMIT 0x1p47

/* Rounds towards minus infinity; b > 0. */
static int64_t floor_div(int64_t a, int64_t b)
{
    int64_t q = a / b;
    return q - (a % b < 0);
}

/* Narrows rows to those with lo <= a + y*step < hi. */
static void narrow_rows(int64_t a, int64_t step, int64_t lo, int64_t hi, px_rect *bound)
{
    int64_t y0 = bound->y0, y1 = bound->y1;
    if (step == 0) {
        y1 = a < lo || a >= hi ? y0 : y1;
    } else {
        int64_t first = step > 0 ? floor_div(lo - a - 1, step) + 1 : floor_div(a - hi, -step) + 1;
        int64_t end = step > 0 ? floor_div(hi - a - 1, step) + 1 : floor_div(a - lo, -step) + 1;
        y0 = first > y0 ? first : y0;
        y1 = end < y1 ? end : y1;
    }
    bound->y1 = (int32_t)(y1 > y0 ? y1 : bound->y0);
    bound->y0 = (int32_t)(y1 > y0 ? y0 : bound->y0);
}

static bool can_round(const raster_edge *e, int32_t rows)
{
    return fabs((double)e->n) < ROUNDING_LIMIT && (double)e->divisor < ROUNDING_LIMIT &&
           fabs((double)e->step) * rows < ROUNDING_LIMIT;
}

static raster_line round_edge(const raster_edge *e)
{
    double inverse = 1 / (double)e->divisor;
    return (raster_line){((double)(e->n + e->divisor) + 0.5) * inverse, (double)e->step * inverse};
}

/* Leaves out rows above the first and below the last on which every left bound is left of every right one. The lines
 * err by less than half a pixel. */
static void narrow_to_crossings(rasterizer *r)
{
    double first = 0, end = r->end_y - r->y;
    for (int i = 0; i < r->axes; i++)
        for (int j = 0; j < r->axes; j++) {
            const raster_line *left = &r->left_line[i], *right = &r->right_line[j];
            double gap = right->at - left->at + 0.5, growth = right->step - left->step, row = -gap / growth;
            if (growth > 0)
                first = row > first ? row : first;
            else if (growth < 0)
                end = row < end ? row : end;
            else if (gap <= 0)
                end = 0;
        }
    int32_t top = r->y, bottom = first < end ? top + (int32_t)end + 1 : top;
    r->y = first < end ? top + (int32_t)first : top;
    r->end_y = bottom < r->end_y ? bottom : r->end_y;
}

static void set_lines(rasterizer *r)
{
    int32_t rows = r->end_y - r->y;
    r->rounds = true;
    for (int j = 0; j < r->axes; j++)
        r->rounds &= can_round(&r->left[j], rows) && can_round(&r->right[j], rows);
    if (!r->rounds)
        return;
    for (int j = 0; j < 3; j++) {
        r->left_line[j] = j < r->axes ? round_edge(&r->left[j]) : (raster_line){r->bound.x0, 0};
        r->right_line[j] = j < r->axes ? round_edge(&r->right[j]) : (raster_line){r->bound.x1, 0};
    }
    narrow_to_crossings(r);
}

void rasterizer_start(rasterizer *r, const brick_slice *slice, const px_rect *bound)
{
    const slice_plane *p = &slice->plane;
    r->bound = *bound;
    r->any = false;
    r->axes = 0;
    for (int c = 0; c < 3; c++)
        if (p->step_u[c] == 0)
            narrow_rows(p->origin[c], p->step_v[c], slice->lo[c], slice->hi[c], &r->bound);
    r->y = r->bound.y0;
    r->end_y = r->bound.y1;
    if (r->y >= r->end_y)
        return;
    for (int c = 0; c < 3; c++) {
        int64_t u = p->step_u[c], v = p->step_v[c], a = p->origin[c] + r->y * v;
        if (u == 0)
            continue;
        r->left[r->axes] = (raster_edge){u > 0 ? slice->lo[c] - a - 1 : a - slice->hi[c], u > 0 ? -v : v, llabs(u)};
        r->right[r->axes] = (raster_edge){u > 0 ? slice->hi[c] - a - 1 : a - slice->lo[c], u > 0 ? -v : v, llabs(u)};
        r->axes++;
    }
    set_lines(r);
    r->filled_y0 = r->filled_y1 = r->y;
}

/* ---- many rows at once ---- */

static void fill_rounding(rasterizer *r)
{
    const double first = r->bound.x0, end = r->bound.x1, down = r->filled_y0 - r->bound.y0;
    const int32_t rows = r->filled_y1 - r->filled_y0;
    raster_line left[3], right[3];
    for (int j = 0; j < 3; j++) {
        left[j] = (raster_line){r->left_line[j].at + down * r->left_line[j].step, r->left_line[j].step};
        right[j] = (raster_line){r->right_line[j].at + down * r->right_line[j].step, r->right_line[j].step};
    }
    for (int32_t i = 0; i < rows; i++) {
        double x0 = first, x1 = end;
        for (int j = 0; j < 3; j++) {
            double l = left[j].at + i * left[j].step, h = right[j].at + i * right[j].step;
            x0 = x0 > l ? x0 : l;
            x1 = x1 < h ? x1 : h;
        }
        r->x0[i] = (int32_t)(x0 < end ? x0 : end);
        r->x1[i] = (int32_t)(x1 > first ? x1 : first);
    }
}

/* Quotient and remainder once, and two additions a row. Beyond the last row they may wrap, and are not looked at. */
static void narrow_side(const rasterizer *r, const raster_edge *e, bool left, int32_t *x)
{
    int64_t n = e->n + (r->filled_y0 - r->bound.y0) * e->step;
    int64_t quotient = floor_div(n, e->divisor), remainder = n - quotient * e->divisor;
    int64_t quotient_step = floor_div(e->step, e->divisor), remainder_step = e->step - quotient_step * e->divisor;
    for (int32_t i = 0; i < r->filled_y1 - r->filled_y0; i++) {
        int64_t at = quotient < r->bound.x0 ? r->bound.x0 : quotient < r->bound.x1 ? quotient + 1 : r->bound.x1;
        if (left ? at > x[i] : at < x[i])
            x[i] = (int32_t)at;
        remainder += remainder_step;
        int64_t carry = remainder >= e->divisor;
        remainder -= e->divisor & -carry;
        quotient = (int64_t)((uint64_t)quotient + (uint64_t)quotient_step + (uint64_t)carry);
    }
}

static void fill_exactly(rasterizer *r)
{
    for (int32_t i = 0; i < RASTER_ROWS; i++) {
        r->x0[i] = r->bound.x0;
        r->x1[i] = r->bound.x1;
    }
    for (int j = 0; j < r->axes; j++) {
        narrow_side(r, &r->left[j], true, r->x0);
        narrow_side(r, &r->right[j], false, r->x1);
    }
}

/* Finds the runs of the next rows. */
static void fill(rasterizer *r)
{
    int32_t left = r->end_y - r->y;
    r->filled_y0 = r->y;
    r->filled_y1 = r->y + (left < RASTER_ROWS ? left : RASTER_ROWS);
    if (r->rounds)
        fill_rounding(r);
    else
        fill_exactly(r);
}

bool rasterizer_next(rasterizer *r, span *s)
{
    while (r->y < r->end_y) {
        if (r->y == r->filled_y1)
            fill(r);
        int32_t y = r->y++, x0 = r->x0[y - r->filled_y0], x1 = r->x1[y - r->filled_y0];
        if (x0 < x1) {
            r->any = true;
            *s = (span){.y = y, .x0 = x0, .x1 = x1};
            return true;
        }
        /* Bounds that cross leave nothing between them, not even between pixels; and a slice of a brick is convex. */
        if (x0 > x1 && r->any)
            return false;
    }
    return false;
}
