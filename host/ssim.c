/* ssim.c - mean structural similarity of two pictures: Wang, Bovik, Sheikh, Simoncelli, "Image Quality Assessment: From
 * Error Visibility to Structural Similarity", IEEE Transactions on Image Processing 13(4), 2004. */
#include <math.h>
#include <stdlib.h>

#include "difference.h"

enum { WINDOW = 11, MOMENTS = 5 }; /* the moments: a, b, a*a, b*b, a*b */

typedef struct window {
    int size;
    double weight[WINDOW];
} window;

static window make_window(int32_t extent_px)
{
    window w = {.size = extent_px < WINDOW ? extent_px : WINDOW};
    double sum = 0;
    for (int i = 0; i < w.size; i++) {
        double x = i - (w.size - 1) / 2.0;
        w.weight[i] = exp(-x * x / (2 * 1.5 * 1.5));
        sum += w.weight[i];
    }
    for (int i = 0; i < w.size; i++)
        w.weight[i] /= sum;
    return w;
}

/* ITU-R BT.601 luma in 8-bit levels, over black. */
static double luma(const image *p, size_t pixel)
{
    const uint16_t *c = &p->rgba[4 * pixel];
    return (0.299 * c[0] + 0.587 * c[1] + 0.114 * c[2]) / 257 * (c[3] / 65535.0);
}

/* The moments of row y, filtered along it: moments[m*width_px + x] is the window that begins at x. luma_a and luma_b
 * are scratch of a row. */
static void filter_row(const image *a, const image *b, int32_t y, const window *w, double *luma_a, double *luma_b,
                       double *moments)
{
    const size_t width = (size_t)a->width_px;
    for (size_t x = 0; x < width; x++) {
        luma_a[x] = luma(a, (size_t)y * width + x);
        luma_b[x] = luma(b, (size_t)y * width + x);
    }
    for (size_t x = 0; x + (size_t)w->size <= width; x++) {
        double sum[MOMENTS] = {0};
        for (int i = 0; i < w->size; i++) {
            double la = luma_a[x + (size_t)i], lb = luma_b[x + (size_t)i];
            sum[0] += w->weight[i] * la;
            sum[1] += w->weight[i] * lb;
            sum[2] += w->weight[i] * (la * la);
            sum[3] += w->weight[i] * (lb * lb);
            sum[4] += w->weight[i] * (la * lb);
        }
        for (size_t m = 0; m < MOMENTS; m++)
            moments[m * width + x] = sum[m];
    }
}

/* Equation 13 of the paper. */
static double similarity(const double m[MOMENTS])
{
    const double c1 = (0.01 * 255) * (0.01 * 255), c2 = (0.03 * 255) * (0.03 * 255);
    double variance_a = m[2] - m[0] * m[0], variance_b = m[3] - m[1] * m[1], covariance = m[4] - m[0] * m[1];
    return (2 * m[0] * m[1] + c1) * (2 * covariance + c2) /
           ((m[0] * m[0] + m[1] * m[1] + c1) * (variance_a + variance_b + c2));
}

/* Sum of the similarity over the windows whose rows are all in `ring`, the topmost being row y. */
static double sum_row(const double *ring, size_t width, int32_t y, const window *across, const window *down)
{
    double total = 0;
    for (size_t x = 0; x + (size_t)across->size <= width; x++) {
        double moment[MOMENTS] = {0};
        for (int i = 0; i < down->size; i++) {
            const double *row = ring + (size_t)((y + i) % WINDOW) * MOMENTS * width;
            for (size_t m = 0; m < MOMENTS; m++)
                moment[m] += down->weight[i] * row[m * width + x];
        }
        total += similarity(moment);
    }
    return total;
}

host_status ssim_mean(const image *a, const image *b, double *ssim, host_error *error)
{
    const size_t width = (size_t)a->width_px;
    const window across = make_window(a->width_px), down = make_window(a->height_px);
    double *ring = malloc((WINDOW * MOMENTS + 2) * width * sizeof *ring);
    if (!ring)
        return host_fail(error, HOST_ENVIRONMENT, "no memory to compare the pictures");
    double *scratch = ring + WINDOW * MOMENTS * width, total = 0;
    for (int32_t y = 0; y < a->height_px; y++) {
        filter_row(a, b, y, &across, scratch, scratch + width, ring + (size_t)(y % WINDOW) * MOMENTS * width);
        if (y + 1 >= down.size)
            total += sum_row(ring, width, y + 1 - down.size, &across, &down);
    }
    free(ring);
    *ssim = total / ((double)(a->width_px - across.size + 1) * (a->height_px - down.size + 1));
    return HOST_OK;
}
