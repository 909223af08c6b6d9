/* rasterizer.c - coverage in exact integers: on a row each numerator is affine in x, so the pixels with lo <= A < hi
 * are one run, and its ends are two divisions. Half-open boxes make neighbouring bricks' runs a partition: no seam, no
 * overlap. */
#include "rasterizer.h"

/* Rounds towards minus infinity; b > 0. */
static int64_t floor_div(int64_t a, int64_t b)
{
    int64_t q = a / b;
    return q - (a % b < 0);
}

/* Edge i: floor(n/divisor) on the first row, n growing by `step` a row. */
static void set_edge(raster_edges *e, int i, int64_t n, int64_t step, int64_t divisor)
{
    e->quotient[i] = floor_div(n, divisor);
    e->remainder[i] = n - e->quotient[i] * divisor;
    e->quotient_step[i] = floor_div(step, divisor);
    e->remainder_step[i] = step - e->quotient_step[i] * divisor;
    e->divisor[i] = divisor;
}

/* One row down. Beyond the last row quotients may wrap, and are not looked at. */
static inline void step_edge(raster_edges *e, int i)
{
    int64_t remainder = e->remainder[i] + e->remainder_step[i], carry = remainder >= e->divisor[i];
    e->quotient[i] = (int64_t)((uint64_t)e->quotient[i] + (uint64_t)e->quotient_step[i] + (uint64_t)carry);
    e->remainder[i] = remainder - (e->divisor[i] & -carry);
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

void rasterizer_start(rasterizer *r, const brick_slice *slice, const px_rect *bound)
{
    const slice_plane *p = &slice->plane;
    raster_edges *e = &r->edges;
    r->slice = slice;
    r->bound = *bound;
    r->any = false;
    e->count = 0;
    for (int c = 0; c < 3; c++) {
        if (p->step_u[c] == 0)
            narrow_rows(p->origin[c], p->step_v[c], slice->lo[c], slice->hi[c], &r->bound);
        else
            e->count++;
    }
    r->y = r->bound.y0;
    if (r->y >= r->bound.y1)
        return;
    for (int c = 0, left = 0, right = e->count; c < 3; c++) {
        int64_t a = p->origin[c] + r->y * p->step_v[c], u = p->step_u[c], v = p->step_v[c];
        r->row[c] = a;
        if (u > 0) {
            set_edge(e, left++, slice->lo[c] - a - 1, -v, u);
            set_edge(e, right++, slice->hi[c] - a - 1, -v, u);
        } else if (u < 0) {
            set_edge(e, left++, a - slice->hi[c], v, -u);
            set_edge(e, right++, a - slice->lo[c], v, -u);
        }
    }
}

bool rasterizer_next(rasterizer *r, span *s)
{
    const slice_plane *p = &r->slice->plane;
    raster_edges *e = &r->edges;
    while (r->y < r->bound.y1) {
        int64_t x0 = r->bound.x0, x1 = r->bound.x1, row[3];
        for (int i = 0; i < e->count; i++) {
            int64_t left = e->quotient[i] + 1, right = e->quotient[i + e->count] + 1;
            x0 = left > x0 ? left : x0;
            x1 = right < x1 ? right : x1;
            step_edge(e, i);
            step_edge(e, i + e->count);
        }
        for (int c = 0; c < 3; c++) {
            row[c] = r->row[c];
            r->row[c] = (int64_t)((uint64_t)row[c] + (uint64_t)p->step_v[c]);
        }
        s->y = r->y++;
        if (x0 >= x1) {
            /* Bounds that cross leave nothing between them, not even between pixels; and a slice of a brick is convex.
             */
            if (x0 > x1 && r->any)
                return false;
            continue;
        }
        r->any = true;
        s->x0 = (int32_t)x0;
        s->x1 = (int32_t)x1;
        for (int c = 0; c < 3; c++)
            s->a[c] = row[c] + x0 * p->step_u[c];
        return true;
    }
    return false;
}
