/* composite_simulate.c - the rounds of compositing among nodes that one process draws, with a model of the network. */
#include <math.h>
#include <stdlib.h>

#include "composite_round.h"
#include "fail.h"

/* A round: mail[from*nodes + to]. */
typedef struct round_state {
    cluster_composite method;
    int32_t nodes, round;
    node_message *mail;
    composite_step step; /* of the node looked at, with its messages: */
    node_message out[CLUSTER_MAX_NODES], in[CLUSTER_MAX_NODES];
} round_state;

/* The message from one node to another. */
static node_message *message(const round_state *r, int32_t from, int32_t to)
{
    return &r->mail[(size_t)from * (size_t)r->nodes + (size_t)to];
}

/* Finds who is in a node's group in this round, and what they have for it and it for them. */
static void find_group(round_state *r, int32_t node)
{
    composite_step_of(r->method, r->nodes, r->round, node, &r->step);
    for (int32_t i = 0; i < r->step.members; i++) {
        r->out[i] = *message(r, node, r->step.member[i]);
        r->in[i] = *message(r, r->step.member[i], node);
    }
}

/* A round: all give, then all take. */
static cluster_status run_round(round_state *r, composite_piece *piece, const composite_model *model, double *took,
                                vodr_error *error)
{
    double most = 0;
    cluster_status status = CLUSTER_OK;
    for (int32_t i = 0; status == CLUSTER_OK && i < r->nodes; i++) {
        find_group(r, i);
        status = composite_give(&r->step, &piece[i], r->out, error);
        for (int32_t j = 0; j < r->step.members; j++)
            *message(r, i, r->step.member[j]) = r->out[j];
    }
    for (int32_t i = 0; status == CLUSTER_OK && i < r->nodes; i++) {
        find_group(r, i);
        most = fmax(most, composite_took(model, r->step.members, r->out, r->in));
        status = composite_take(&r->step, &piece[i], r->in, error);
    }
    *took += most;
    return status;
}

static void free_mail(round_state *r)
{
    for (size_t i = 0; i < (size_t)r->nodes * (size_t)r->nodes; i++)
        node_message_free(&r->mail[i]);
}

static cluster_status collect(int32_t nodes, composite_piece *piece, const composite_model *model, double *took,
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
        *took += composite_took(model, 1, &m, &(node_message){0});
        node_message_free(&m);
        if (status != CLUSTER_OK)
            return status;
    }
    return CLUSTER_OK;
}

cluster_status composite_simulate(cluster_composite method, int32_t nodes, composite_piece *piece,
                                  const composite_model *model, double *took, vodr_error *error)
{
    round_state *r = calloc(1, sizeof *r);
    cluster_status status = CLUSTER_OK;
    *took = 0;
    if (r)
        *r = (round_state){
            .method = method, .nodes = nodes, .mail = calloc((size_t)nodes * (size_t)nodes, sizeof *r->mail)};
    if (!r || !r->mail) {
        free(r);
        return cluster_no_memory(error);
    }
    for (int32_t i = 0; status == CLUSTER_OK && i < nodes; i++)
        status = layers_merge(&piece[i].layers, error);
    const int32_t rounds = composite_rounds(method, nodes);
    for (; status == CLUSTER_OK && r->round < rounds; r->round++) {
        status = run_round(r, piece, model, took, error);
        free_mail(r);
    }
    if (status == CLUSTER_OK)
        status = collect(nodes, piece, model, took, error);
    free(r->mail);
    free(r);
    return status;
}
