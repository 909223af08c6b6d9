/* composite.c - who shares rows with whom, and what a node does with its piece in a round: direct send, binary swap
 * (Ma, Painter, Hansen, Krogh, 1994) and radix-k (Peterka et al., 2009). */
#include "composite.h"

#include <math.h>
#include <string.h>

#include "composite_round.h"
#include "fail.h"

enum { RADIX = 4, MOST_ROUNDS = 16 };

/* ---- schedules ---- */

static int32_t power_below(int32_t nodes)
{
    int32_t power = 1;
    while (2 * power <= nodes)
        power *= 2;
    return power;
}

/* The sizes of the groups of each round; their product is `nodes`. */
static int32_t factors(cluster_composite method, int32_t nodes, int32_t factor[MOST_ROUNDS])
{
    int32_t count = 0;
    if (method == CLUSTER_DIRECT) {
        factor[0] = nodes;
        return nodes > 1;
    }
    if (method == CLUSTER_BINARY_SWAP)
        nodes = power_below(nodes);
    for (; method == CLUSTER_RADIX_K && nodes % RADIX == 0; nodes /= RADIX)
        factor[count++] = RADIX;
    for (int32_t prime = 2; nodes > 1; prime++)
        for (; nodes % prime == 0; nodes /= prime)
            factor[count++] = prime;
    return count;
}

static bool has_fold(cluster_composite method, int32_t nodes)
{
    return method == CLUSTER_BINARY_SWAP && power_below(nodes) < nodes;
}

int32_t composite_rounds(cluster_composite method, int32_t nodes)
{
    int32_t factor[MOST_ROUNDS];
    return factors(method, nodes, factor) + has_fold(method, nodes);
}

static void fold_of(int32_t nodes, int32_t node, composite_step *step)
{
    const int32_t power = power_below(nodes), low = node < power ? node : node - power;
    *step = (composite_step){.folds = true};
    if (low + power >= nodes)
        return;
    step->members = 2;
    step->own = node >= power;
    step->member[0] = low;
    step->member[1] = low + power;
}

void composite_step_of(cluster_composite method, int32_t nodes, int32_t round, int32_t node, composite_step *step)
{
    int32_t factor[MOST_ROUNDS], stride = 1;
    factors(method, nodes, factor);
    if (has_fold(method, nodes)) {
        if (round == 0) {
            fold_of(nodes, node, step);
            return;
        }
        round--;
    }
    step->members = 0;
    step->folds = false;
    if (method == CLUSTER_BINARY_SWAP && node >= power_below(nodes))
        return;
    for (int32_t i = 0; i < round; i++)
        stride *= factor[i];
    const int32_t group = stride * factor[round], base = node / group * group + node % stride;
    step->members = factor[round];
    step->own = node % group / stride;
    for (int32_t i = 0; i < step->members; i++)
        step->member[i] = base + i * stride;
}

void composite_rows(const composite_step *step, int32_t i, int32_t y0, int32_t y1, int32_t rows[2])
{
    for (int end = 0; end < 2; end++) {
        const int64_t share = step->folds ? (i + end > 0) : i + end, all = step->folds ? 1 : step->members;
        rows[end] = y0 + (int32_t)((y1 - y0) * share / all);
    }
}

/* ---- a round ---- */

cluster_status composite_give(const composite_step *step, composite_piece *p, node_message *out, vodr_error *error)
{
    int32_t rows[2];
    for (int32_t i = 0; i < step->members; i++) {
        if (i == step->own)
            continue;
        composite_rows(step, i, p->y0, p->y1, rows);
        cluster_status status = layers_pack(&p->layers, rows[0], rows[1], &out[i], error);
        if (status != CLUSTER_OK)
            return status;
        p->sent_bytes += out[i].count;
    }
    return CLUSTER_OK;
}

double composite_took(const composite_model *model, int32_t members, const node_message *out, const node_message *in)
{
    double sent = 0, received = 0, messages = 0;
    for (int32_t i = 0; i < members; i++) {
        messages += out[i].count > 0;
        sent += (double)out[i].count;
        received += (double)in[i].count;
    }
    return messages * model->latency + fmax(sent, received) / model->bytes_per_time;
}

cluster_status composite_take(const composite_step *step, composite_piece *p, const node_message *in, vodr_error *error)
{
    int32_t rows[2];
    if (step->members == 0)
        return CLUSTER_OK;
    composite_rows(step, step->own, p->y0, p->y1, rows);
    p->y0 = rows[0];
    p->y1 = rows[1];
    cluster_status status = layers_cut(&p->layers, p->y0, p->y1, error);
    for (int32_t i = 0; status == CLUSTER_OK && i < step->members; i++)
        if (i != step->own)
            status = layers_unpack(&p->layers, &in[i], error);
    return status == CLUSTER_OK ? layers_merge(&p->layers, error) : status;
}

/* ---- the picture ---- */

static void write_pixel(bool mip, const float *from, double *to)
{
    for (int c = 0; c < 4; c++)
        to[c] = (double)from[mip ? 0 : c];
    if (mip)
        to[3] = 1;
}

/* A piece has all its rows from one layer, or from one for each node it came of. */
cluster_status composite_write(const composite_piece *piece, int32_t places, int32_t width_px, double *rgba,
                               vodr_error *error)
{
    const layers *l = &piece->layers;
    for (int32_t i = 0; i < l->count; i++) {
        const layer *from = &l->layer[i];
        const float *pixel = from->pixel;
        if (from->first != 0 || from->end != places)
            return cluster_fail(error, CLUSTER_ENVIRONMENT,
                                "compositing has lost a part of the picture: places %d to %d of %d are there",
                                from->first, from->end, places);
        for (int32_t y = from->area.y0; pixel && y < from->area.y1; y++)
            for (int32_t x = from->area.x0; x < from->area.x1; x++, pixel += l->mip ? 1 : 4)
                if (!l->mip || *pixel > -INFINITY)
                    write_pixel(l->mip, pixel, rgba + 4 * ((size_t)y * (size_t)width_px + (size_t)x));
    }
    return CLUSTER_OK;
}
