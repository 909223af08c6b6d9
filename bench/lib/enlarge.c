/* enlarge.c - Catmull-Rom resampling, one axis after the other. */
#include "enlarge.h"

#include <math.h>
#include <stdlib.h>

/* One axis: for each target voxel four source voxels and their weights. */
typedef struct taps {
    int32_t at[4];
    float weight[4];
} taps;

static double catmull_rom(double x)
{
    x = fabs(x);
    return x < 1 ? (1.5 * x - 2.5) * x * x + 1 : x < 2 ? ((-0.5 * x + 2.5) * x - 4) * x + 2 : 0;
}

static taps *make_taps(int32_t from, int32_t to)
{
    taps *t = malloc((size_t)to * sizeof *t);
    for (int32_t i = 0; t && i < to; i++) {
        double place = (i + 0.5) * from / to - 0.5;
        int32_t first = (int32_t)floor(place) - 1;
        for (int n = 0; n < 4; n++) {
            int32_t at = first + n;
            t[i].weight[n] = (float)catmull_rom(place - at);
            t[i].at[n] = at < 0 ? 0 : at < from ? at : from - 1;
        }
    }
    return t;
}

/* Resamples the middle axis of in[outer][from][inner]. NULL when the host is out of memory. */
static float *resample(const float *in, int32_t from, int32_t to, size_t inner, size_t outer)
{
    taps *t = make_taps(from, to);
    float *out = malloc(outer * (size_t)to * inner * sizeof *out);
    for (size_t o = 0; t && out && o < outer; o++)
        for (int32_t i = 0; i < to; i++) {
            const float *plane = in + o * (size_t)from * inner, *w = t[i].weight;
            const float *row[4];
            float *target = out + (o * (size_t)to + (size_t)i) * inner;
            for (int n = 0; n < 4; n++)
                row[n] = plane + (size_t)t[i].at[n] * inner;
            for (size_t x = 0; x < inner; x++)
                target[x] = row[0][x] * w[0] + row[1][x] * w[1] + row[2][x] * w[2] + row[3][x] * w[3];
        }
    if (!t) {
        free(out);
        out = NULL;
    }
    free(t);
    return out;
}

bool enlarge(const float *voxels, const int32_t from[3], const int32_t to[3], float lo, float hi, uint16_t *out)
{
    float *done = NULL;
    size_t size[3] = {(size_t)from[0], (size_t)from[1], (size_t)from[2]};
    for (int a = 0; a < 3; a++) {
        size_t inner = a == 0 ? 1 : a == 1 ? size[0] : size[0] * size[1];
        size_t outer = a == 0 ? size[1] * size[2] : a == 1 ? size[2] : 1;
        float *next = resample(done ? done : voxels, from[a], to[a], inner, outer);
        free(done);
        done = next;
        if (!done)
            return false;
        size[a] = (size_t)to[a];
    }
    for (size_t i = 0, n = size[0] * size[1] * size[2]; i < n; i++)
        out[i] = (uint16_t)(fminf(fmaxf((done[i] - lo) / (hi - lo), 0), 1) * 65535 + 0.5f);
    free(done);
    return true;
}
