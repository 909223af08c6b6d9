/* weights.c - what drawing a sub-volume costs: one, as the paper counts; the samples that rays take in it; or the time
 * that it took in the last frame. */
#include <math.h>
#include <string.h>
#include <time.h>

#include "footprint.h"
#include "state.h"

/* What a sub-volume outside the picture costs, of one in its middle: it is held, and may come into sight. */
static const double least_share = 0.01;

static double seconds(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + (double)t.tv_nsec * 1e-9;
}

double cluster_now_s(void)
{
    return seconds(CLOCK_MONOTONIC);
}

double cluster_cpu_s(void)
{
    return seconds(CLOCK_PROCESS_CPUTIME_ID);
}

/* Voxels of a sub-volume, whose far sides may be cut off, and its middle. */
static double extent(const subvolumes *s, const int32_t at[3], double middle[3])
{
    double voxels = 1;
    for (int a = 0; a < 3; a++) {
        const int32_t lo = at[a] * s->edge_vox, end = lo + s->edge_vox;
        const int32_t hi = end < s->dims_vox[a] ? end : s->dims_vox[a];
        voxels *= hi - lo;
        middle[a] = (lo + hi) / 2.0;
    }
    return voxels;
}

void weights_fill(const cluster *c, const reference_camera *camera, double *weight)
{
    const subvolumes *s = &c->grid;
    int32_t at[3];
    size_t i = 0;
    for (at[2] = 0; at[2] < s->count[2]; at[2]++)
        for (at[1] = 0; at[1] < s->count[1]; at[1]++)
            for (at[0] = 0; at[0] < s->count[0]; at[0]++, i++) {
                double middle[3], voxels = extent(s, at, middle);
                weight[i] = 0;
                if (!c->occupied[i])
                    continue;
                if (c->options.weight == CLUSTER_COUNT) {
                    weight[i] = 1;
                    continue;
                }
                double samples = voxels * fmax(footprint_samples(camera, middle), least_share);
                weight[i] =
                    c->options.weight == CLUSTER_TIME && c->measured && c->measured[i] > 0 ? c->measured[i] : samples;
            }
}
