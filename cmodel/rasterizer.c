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

/* floor(n/divisor) on the first row, n growing by `step` a row. */
static raster_edge edge_of(int64_t n, int64_t step, int64_t divisor)
{
    raster_edge e = {.quotient = floor_div(n, divisor), .quotient_step = floor_div(step, divisor), .divisor = divisor};
    e.remainder = n - e.quotient * divisor;
    e.remainder_step = step - e.quotient_step * divisor;
    return e;
}

static void edge_step(raster_edge *e)
{
    e->quotient += e->quotient_step;
    e->remainder += e->remainder_step;
    int64_t carry = e->remainder >= e->divisor;
    e->quotient += carry;
    e->remainder -= carry ? e->divisor : 0;
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
    r->slice = slice;
    r->bound = *bound;
    r->edges = 0;
    for (int c = 0; c < 3; c++)
        if (p->step_u[c] == 0)
            narrow_rows(p->origin[c], p->step_v[c], slice->lo[c], slice->hi[c], &r->bound);
    r->y = r->bound.y0;
    if (r->y >= r->bound.y1)
        return;
    for (int c = 0; c < 3; c++) {
        int64_t a = p->origin[c] + r->y * p->step_v[c], u = p->step_u[c], v = p->step_v[c];
        raster_edge *left = &r->left[r->edges], *right = &r->right[r->edges];
        if (u > 0) {
            *left = edge_of(slice->lo[c] - a - 1, -v, u);
            *right = edge_of(slice->hi[c] - a - 1, -v, u);
        } else if (u < 0) {
            *left = edge_of(a - slice->hi[c], v, -u);
            *right = edge_of(a - slice->lo[c], v, -u);
        }
        r->edges += u != 0;
    }
}

bool rasterizer_next(rasterizer *r, span *s)
{
    const slice_plane *p = &r->slice->plane;
    while (r->y < r->bound.y1) {
        int32_t y = r->y++;
        int64_t x0 = r->bound.x0, x1 = r->bound.x1;
        for (int e = 0; e < r->edges; e++) {
            int64_t left = r->left[e].quotient + 1, right = r->right[e].quotient + 1;
            x0 = left > x0 ? left : x0;
            x1 = right < x1 ? right : x1;
        }
        for (int e = 0; e < r->edges && r->y < r->bound.y1; e++) {
            edge_step(&r->left[e]);
            edge_step(&r->right[e]);
        }
        if (x0 >= x1)
            continue;
        s->y = y;
        s->x0 = (int32_t)x0;
        s->x1 = (int32_t)x1;
        for (int c = 0; c < 3; c++)
            s->a[c] = p->origin[c] + y * p->step_v[c] + x0 * p->step_u[c];
        return true;
    }
    return false;
}
