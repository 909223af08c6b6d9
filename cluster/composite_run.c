/* composite_run.c - the rounds of compositing among the processes of a cluster. */
#include <stdlib.h>

#include "composite_round.h"
#include "fail.h"

/* Room for the messages of a round. */
typedef struct mail {
    const composite_model *model;
    double took; /* by the model, this node's messages of the round */
    composite_step step;
    int32_t peer[CLUSTER_MAX_NODES];
    node_message out[CLUSTER_MAX_NODES], in[CLUSTER_MAX_NODES];
} mail;

static void free_mail(mail *m)
{
    for (int32_t i = 0; i < m->step.members; i++) {
        node_message_free(&m->out[i]);
        node_message_free(&m->in[i]);
    }
}

/* Takes the node itself out of a list of members, or puts an empty message in its place. */
static void close_gap(node_message *list, int32_t own, int32_t members)
{
    for (int32_t i = own; i + 1 < members; i++)
        list[i] = list[i + 1];
    list[members - 1] = (node_message){0};
}

static void open_gap(node_message *list, int32_t own, int32_t members)
{
    for (int32_t i = members - 1; i > own; i--)
        list[i] = list[i - 1];
    list[own] = (node_message){0};
}

static cluster_status run_round(cluster_node *node, mail *m, composite_piece *piece, vodr_error *error)
{
    const composite_step *s = &m->step;
    m->took = 0;
    if (s->members == 0)
        return CLUSTER_OK;
    for (int32_t i = 0; i < s->members; i++) {
        m->out[i] = m->in[i] = (node_message){0};
        m->peer[i - (i > s->own)] = s->member[i];
    }
    cluster_status status = composite_give(s, piece, m->out, error);
    close_gap(m->out, s->own, s->members);
    if (status == CLUSTER_OK)
        status = node_exchange(node, s->members - 1, m->peer, m->out, m->in, error);
    open_gap(m->in, s->own, s->members);
    if (status == CLUSTER_OK)
        status = composite_take(s, piece, m->in, error);
    m->took = composite_took(m->model, s->members, m->out, m->in);
    free_mail(m);
    return status;
}

/* All pieces to node 0. */
static cluster_status collect(cluster_node *node, mail *m, composite_piece *piece, vodr_error *error)
{
    const int32_t peers = node->rank == 0 ? node->ranks - 1 : 1;
    cluster_status status = CLUSTER_OK;
    m->step.members = peers;
    for (int32_t i = 0; i < peers; i++) {
        m->peer[i] = node->rank == 0 ? i + 1 : 0;
        m->out[i] = m->in[i] = (node_message){0};
    }
    if (node->rank > 0 && piece->y0 < piece->y1) {
        status = layers_pack(&piece->layers, piece->y0, piece->y1, &m->out[0], error);
        piece->sent_bytes += m->out[0].count;
    }
    if (status == CLUSTER_OK && peers > 0 && node->ranks > 1)
        status = node_exchange(node, peers, m->peer, m->out, m->in, error);
    for (int32_t i = 0; status == CLUSTER_OK && node->rank == 0 && i < peers; i++)
        status = layers_unpack(&piece->layers, &m->in[i], error);
    m->took = 0;
    for (int32_t i = 0; node->rank == 0 && i < peers; i++)
        m->took += composite_took(m->model, 1, &m->in[i], &m->out[i]);
    free_mail(m);
    return status;
}

/* Adds what the slowest node's messages of each round take. */
static cluster_status add_up(cluster_node *node, double *round_took, int32_t rounds, double *took, vodr_error *error)
{
    cluster_status status = cluster_reduce(node, round_took, (size_t)rounds, true, error);
    for (int32_t i = 0; status == CLUSTER_OK && i < rounds; i++)
        *took += round_took[i];
    return status;
}

cluster_status composite_run(cluster_node *node, cluster_composite method, composite_piece *piece,
                             const composite_model *model, double *took, vodr_error *error)
{
    double round_took[COMPOSITE_ROUNDS + 1] = {0};
    mail *m = calloc(1, sizeof *m);
    *took = 0;
    if (!m) {
        node->broken = true;
        return cluster_no_memory(error);
    }
    m->model = model;
    cluster_status status = layers_merge(&piece->layers, error);
    const int32_t rounds = composite_rounds(method, node->ranks);
    for (int32_t round = 0; status == CLUSTER_OK && round < rounds; round++) {
        composite_step_of(method, node->ranks, round, node->rank, &m->step);
        status = run_round(node, m, piece, error);
        round_took[round] = m->took;
    }
    if (status == CLUSTER_OK && node->ranks > 1) {
        status = collect(node, m, piece, error);
        round_took[rounds] = m->took;
    }
    if (status == CLUSTER_OK)
        status = add_up(node, round_took, rounds + 1, took, error);
    if (status != CLUSTER_OK)
        node->broken = true; /* the others wait for a message that does not come */
    free(m);
    return status;
}
