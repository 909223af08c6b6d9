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

static int64_t max64(int64_t a, int64_t b)
{
    return a > b ? a : b;
}

static int64_t min64(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

/* Narrows [*x0, *x1) to the pixels with lo <= a + x*step < hi. */
static void narrow(int64_t a, int64_t step, int64_t lo, int64_t hi, int64_t *x0, int64_t *x1)
{
    if (step > 0) {
        *x0 = max64(*x0, floor_div(lo - a - 1, step) + 1);
        *x1 = min64(*x1, floor_div(hi - a - 1, step) + 1);
    } else if (step < 0) {
        *x0 = max64(*x0, floor_div(a - hi, -step) + 1);
        *x1 = min64(*x1, floor_div(a - lo, -step) + 1);
    } else if (a < lo || a >= hi) {
        *x1 = *x0;
    }
}

rasterizer rasterizer_start(const brick_slice *slice, const px_rect *bound)
{
    return (rasterizer){.slice = slice, .bound = *bound, .y = bound->y0};
}

bool rasterizer_next(rasterizer *r, span *s)
{
    const slice_plane *p = &r->slice->plane;
    while (r->y < r->bound.y1) {
        int32_t y = r->y++;
        int64_t x0 = r->bound.x0, x1 = r->bound.x1;
        for (int c = 0; c < 3 && x0 < x1; c++)
            narrow(p->origin[c] + y * p->step_v[c], p->step_u[c], r->slice->lo[c], r->slice->hi[c], &x0, &x1);
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
