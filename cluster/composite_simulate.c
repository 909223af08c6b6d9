/* composite_simulate.c - the rounds of compositing among nodes that one process draws, with a model of the network. */
#include <math.h>
#include <stdlib.h>

#include "composite_round.h"
#include "fail.h"

/* A round: mail[from*nodes + to]. */
typedef struct round_state {
    int32_t nodes;
    node_message *mail;
    composite_step step;
} round_state;

static cluster_status give_all(round_state *r, cluster_composite method, int32_t round, composite_piece *piece,
                               vodr_error *error)
{
    node_message out[CLUSTER_MAX_NODES];
    cluster_status status = CLUSTER_OK;
    for (int32_t i = 0; status == CLUSTER_OK && i < r->nodes; i++) {
        composite_step_of(method, r->nodes, round, i, &r->step);
        for (int32_t j = 0; j < r->step.members; j++)
            out[j] = (node_message){0};
        status = composite_give(&r->step, &piece[i], out, error);
        for (int32_t j = 0; j < r->step.members; j++)
            r->mail[(size_t)i * (size_t)r->nodes + (size_t)r->step.member[j]] = out[j];
    }
    return status;
}

static cluster_status take_all(round_state *r, cluster_composite method, int32_t round, composite_piece *piece,
                               vodr_error *error)
{
    node_message in[CLUSTER_MAX_NODES];
    cluster_status status = CLUSTER_OK;
    for (int32_t i = 0; status == CLUSTER_OK && i < r->nodes; i++) {
        composite_step_of(method, r->nodes, round, i, &r->step);
        for (int32_t j = 0; j < r->step.members; j++)
            in[j] = r->mail[(size_t)r->step.member[j] * (size_t)r->nodes + (size_t)i];
        status = composite_take(&r->step, &piece[i], in, error);
    }
    return status;
}

/* What the messages of a round take: each node sends and receives at once. */
static double round_seconds(const round_state *r, const composite_model *model)
{
    double most = 0;
    for (int32_t i = 0; i < r->nodes; i++) {
        double bytes[2] = {0, 0}, messages = 0;
        for (int32_t j = 0; j < r->nodes; j++) {
            const node_message *out = &r->mail[(size_t)i * (size_t)r->nodes + (size_t)j];
            const node_message *in = &r->mail[(size_t)j * (size_t)r->nodes + (size_t)i];
            messages += out->bytes != NULL;
            bytes[0] += (double)out->count;
            bytes[1] += (double)in->count;
        }
        most = fmax(most, messages * model->latency_s + fmax(bytes[0], bytes[1]) / model->bytes_per_s);
    }
    return most;
}

static void free_mail(round_state *r)
{
    for (size_t i = 0; i < (size_t)r->nodes * (size_t)r->nodes; i++)
        node_message_free(&r->mail[i]);
}

static cluster_status collect(int32_t nodes, composite_piece *piece, const composite_model *model, double *seconds,
                              vodr_error *error)
{
    for (int32_t i = 1; i < nodes; i++) {
        node_message m = {0};
        cluster_status status = CLUSTER_OK;
        if (piece[i].y0 < piece[i].y1)
            status = layers_pack(&piece[i].layers, piece[i].y0, piece[i].y1, &m, error);
        if (status == CLUSTER_OK)
            status = layers_unpack(&piece[0].layers, &m, error);
        piece[i].sent_bytes += m.count;
        *seconds += (m.count > 0 ? model->latency_s : 0) + (double)m.count / model->bytes_per_s;
        node_message_free(&m);
        if (status != CLUSTER_OK)
            return status;
    }
    return CLUSTER_OK;
}

cluster_status composite_simulate(cluster_composite method, int32_t nodes, composite_piece *piece,
                                  const composite_model *model, double *seconds, vodr_error *error)
{
    round_state *r = calloc(1, sizeof *r);
    cluster_status status = CLUSTER_OK;
    *seconds = 0;
    if (r)
        *r = (round_state){.nodes = nodes, .mail = calloc((size_t)nodes * (size_t)nodes, sizeof *r->mail)};
    if (!r || !r->mail) {
        free(r);
        return cluster_no_memory(error);
    }
    for (int32_t i = 0; status == CLUSTER_OK && i < nodes; i++)
        status = layers_merge(&piece[i].layers, error);
    const int32_t rounds = composite_rounds(method, nodes);
    for (int32_t round = 0; status == CLUSTER_OK && round < rounds; round++) {
        status = give_all(r, method, round, piece, error);
        if (status == CLUSTER_OK)
            status = take_all(r, method, round, piece, error);
        *seconds += round_seconds(r, model);
        free_mail(r);
    }
    if (status == CLUSTER_OK)
        status = collect(nodes, piece, model, seconds, error);
    free(r->mail);
    free(r);
    return status;
}
