/* weights.c - what drawing a sub-volume costs: one, as the paper counts; the samples that rays take in it; or the time
 * that it took in the last frame. */
#include <math.h>
#include <stdlib.h>
#include <time.h>

#include "fail.h"
#include "footprint.h"
#include "state.h"

/* What a sub-volume outside the picture costs, of one in its middle: it is held, and may come into sight. */
static const double least_share = 0.01;

/* How far a measurement moves what is believed, as a power of the ratio: other work on a computer disturbs times. */
static const double trust = 0.6;

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

static size_t number_of(const subvolumes *s, const int32_t at[3])
{
    return ((size_t)at[2] * (size_t)s->count[1] + (size_t)at[1]) * (size_t)s->count[0] + (size_t)at[0];
}

/* Samples that rays take in a sub-volume. */
static double expected(const subvolumes *s, const reference_camera *camera, const int32_t at[3])
{
    double middle[3], voxels = extent(s, at, middle);
    return voxels * fmax(footprint_samples(camera, middle), least_share);
}

void weights_fill(const cluster *c, const reference_camera *camera, double *weight)
{
    const subvolumes *s = &c->grid;
    int32_t at[3];
    size_t i = 0;
    for (at[2] = 0; at[2] < s->count[2]; at[2]++)
        for (at[1] = 0; at[1] < s->count[1]; at[1]++)
            for (at[0] = 0; at[0] < s->count[0]; at[0]++, i++) {
                const bool measured = c->measured && c->measured[i] > 0;
                if (!c->occupied[i])
                    weight[i] = 0;
                else if (c->options.weight == CLUSTER_COUNT)
                    weight[i] = 1;
                else if (c->options.weight == CLUSTER_TIME && measured)
                    weight[i] = c->measured[i];
                else
                    weight[i] = expected(s, camera, at);
            }
}

/* ---- measured ---- */

/* What a sub-volume of a box is thought to take of the box's time: what it took in the division before, else its
 * samples.
 */
static double believed(const cluster *c, const reference_camera *camera, const int32_t at[3])
{
    const size_t i = number_of(&c->grid, at);
    if (!c->occupied[i])
        return 0;
    return c->measured && c->measured[i] > 0 ? c->measured[i] : expected(&c->grid, camera, at);
}

/* Adds up what is believed of a leaf's sub-volumes; with `scale`, sets their seconds to so many times that. */
static double share_out(const cluster *c, const box *b, const reference_camera *camera, double scale, double *seconds)
{
    double sum = 0;
    int32_t at[3];
    for (at[2] = b->lo[2]; at[2] < b->hi[2]; at[2]++)
        for (at[1] = b->lo[1]; at[1] < b->hi[1]; at[1]++)
            for (at[0] = b->lo[0]; at[0] < b->hi[0]; at[0]++) {
                const double share = believed(c, camera, at);
                sum += share;
                if (scale > 0)
                    seconds[number_of(&c->grid, at)] = share * scale;
            }
    return sum;
}

/* Of the boxes of this process, and what its nodes took beside them, which goes with their boxes. */
static void share_all(const cluster *c, const reference_camera *camera, double *boxes_s, double *seconds)
{
    for (int32_t i = 0; i < c->bricks.count; i++)
        if (c->bricks.brick[i].renderer)
            boxes_s[c->bricks.brick[i].owner] += c->bricks.brick[i].cpu_s;
    for (int32_t i = 0; i < c->bricks.count; i++) {
        const brick *b = &c->bricks.brick[i];
        if (!b->renderer || b->cpu_s <= 0)
            continue;
        const double sum = share_out(c, &c->tree.node[i].box, camera, 0, seconds);
        const double box_s = b->cpu_s * c->share[b->owner].cpu_s / boxes_s[b->owner];
        if (sum > 0)
            share_out(c, &c->tree.node[i].box, camera, c->measured ? pow(box_s / sum, trust) : box_s / sum, seconds);
    }
}

cluster_status weights_measure(cluster *c, const reference_camera *camera, vodr_error *error)
{
    const size_t total = subvolumes_total(c->grid.count);
    double *seconds = calloc(total, sizeof *seconds), *boxes_s = calloc((size_t)c->nodes, sizeof *boxes_s);
    const bool room = seconds && boxes_s;
    cluster_status status = cluster_agree(c->node, room ? CLUSTER_OK : cluster_no_memory(error), error);
    if (status == CLUSTER_OK) {
        share_all(c, camera, boxes_s, seconds);
        status = cluster_reduce(c->node, seconds, total, true, error);
    }
    free(boxes_s);
    free(c->measured);
    c->measured = seconds;
    return status;
}
