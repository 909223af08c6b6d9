#include "ideal.h"

#include <math.h>

/* The position's components in voxels. */
static void position_of(const vodr_view *v, int32_t x, int32_t y, int32_t k, double position[3])
{
    double depth = 1;
    if (v->perspective)
        depth = floor((double)(v->depth_first + k * v->depth_step) * 0x1p-16);
    for (int c = 0; c < 3; c++) {
        double along = (double)v->step_s[c],
               across = (double)x * (double)v->step_u[c] + (double)y * (double)v->step_v[c];
        double numerator = v->perspective ? depth * (along + across) : k * along + across;
        position[c] = ldexp((double)v->base[c] + ldexp(numerator, -v->shift), -VODR_POSITION_BITS);
    }
}

static double mix(double a, double b, double share)
{
    return a + (b - a) * share;
}

static double value_at(const ideal_scene *s, const double position[3])
{
    size_t i[3][2];
    double share[3], value[8];
    for (int c = 0; c < 3; c++) {
        double from_centre = position[c] - 0.5, last = s->dims_vox[c] - 1, first = floor(from_centre);
        share[c] = from_centre - first;
        i[c][0] = (size_t)fmin(fmax(first, 0), last);
        i[c][1] = (size_t)fmin(fmax(first + 1, 0), last);
    }
    for (int n = 0; n < 8; n++)
        value[n] =
            (double)s->values[(i[2][n >> 2] * (size_t)s->dims_vox[1] + i[1][n >> 1 & 1]) * (size_t)s->dims_vox[0] +
                              i[0][n & 1]];
    for (int c = 0, n = 4; c < 3; c++, n /= 2)
        for (int m = 0; m < n; m++)
            value[m] = mix(value[2 * m], value[2 * m + 1], share[c]);
    return value[0];
}

void ideal_render(const ideal_scene *s, double *rgba)
{
    const vodr_view *v = s->view;
    for (int32_t y = 0; y < v->height_px; y++)
        for (int32_t x = 0; x < v->width_px; x++, rgba += 4) {
            for (int c = 0; c < 4; c++)
                rgba[c] = 0;
            for (int32_t k = 0; k < v->slices; k++) {
                double p[3];
                position_of(v, x, y, k, p);
                if (p[0] < 0 || p[1] < 0 || p[2] < 0 || p[0] >= s->dims_vox[0] || p[1] >= s->dims_vox[1] ||
                    p[2] >= s->dims_vox[2])
                    continue;
                transfer_point t = transfer_at(s->transfer, value_at(s, p), s->window_lo, s->window_hi);
                double a = t.a > 0 ? 1 - pow(1 - t.a, s->depth_vox) : 0, colour[4] = {t.r, t.g, t.b, 1};
                for (int c = 0; c < 4 && a > 0; c++)
                    rgba[c] = colour[c] * a + rgba[c] * (1 - a);
            }
        }
}

ideal_error ideal_compare(const vodr_frame *frame, const double *rgba)
{
    ideal_error e = {0};
    double full = frame->bits == 16 ? 65535 : 255, squares = 0;
    size_t pixels = (size_t)frame->width_px * (size_t)frame->height_px;
    for (size_t i = 0; i < pixels; i++, rgba += 4) {
        double got[4];
        for (size_t c = 0; c < 4; c++)
            got[c] = (frame->bits == 16 ? ((const uint16_t *)frame->pixels)[4 * i + c]
                                        : ((const uint8_t *)frame->pixels)[4 * i + c]) /
                     full;
        if (!(rgba[3] > 0) && !(got[3] > 0))
            continue;
        e.covered_px++;
        for (int c = 0; c < 4; c++) {
            double difference = fabs(got[c] - rgba[c]);
            squares += difference * difference;
            e.largest = fmax(e.largest, difference);
        }
    }
    e.psnr = e.covered_px ? -10 * log10(squares / (4 * (double)e.covered_px)) : INFINITY;
    return e;
}
