/* node.h - private to cluster/: how nodes talk. node.c picks: alone, or by MPI, which lies in a library of its own
 * (mpi/), loaded by processes of mpirun only, so that no other needs it. */
#ifndef CLUSTER_NODE_H
#define CLUSTER_NODE_H

#include "cluster.h"

typedef struct node_message {
    void *bytes; /* owned */
    size_t count;
} node_message;

/* Each returns false when it cannot go on; all but close() are called by all nodes. */
typedef struct node_ops {
    bool (*reduce)(double *value, size_t count, bool most);
    bool (*gather)(const void *own, size_t bytes, void *all); /* all[]: of each node, `bytes` long */
    bool (*broadcast)(void *data, size_t bytes, int32_t root);
    /* Sends out[i] to peer[i], and receives in[i] of it, new. A peer names this node in turn. */
    bool (*exchange)(int32_t peers, const int32_t *peer, const node_message *out, node_message *in);
    void (*close)(bool well);
} node_ops;

struct cluster_node {
    int32_t rank, ranks, local_ranks;
    const node_ops *ops;
    bool broken; /* the nodes no longer agree */
};

/* What the library's function of this name returns. */
typedef struct node_link {
    const node_ops *ops;
    bool started; /* false: MPI cannot start */
    int32_t rank, ranks, local_ranks;
} node_link;
typedef node_link node_link_function(void);
#define NODE_LINK "vodr_node_link"

void node_message_free(node_message *m);

/* The operations, with a sentence where they fail. */
cluster_status node_gather(cluster_node *n, const void *own, size_t bytes, void *all, vodr_error *error);
cluster_status node_exchange(cluster_node *n, int32_t peers, const int32_t *peer, const node_message *out,
                             node_message *in, vodr_error *error);

#endif
