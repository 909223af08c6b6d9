/* composite.h - private to cluster/: pictures of nodes become one, in rounds in which groups of nodes share out rows.
 *
 * Layers carry their places in the order of sight, and only those that follow on one another become one; so any
 * grouping gives the right picture, and one that follows the tree of planes sends least. */
#ifndef CLUSTER_COMPOSITE_H
#define CLUSTER_COMPOSITE_H

#include "layer.h"

enum { COMPOSITE_ROUNDS = 17 }; /* at most: 16 of binary-swap or radix-k, and the fold */

/* The nodes that share out rows in a round; own: which of them the node is. members 0: the node rests. */
typedef struct composite_step {
    int32_t members, own;
    int32_t member[CLUSTER_MAX_NODES];
    bool folds; /* the first takes all */
} composite_step;

/* What a node has of the picture: layers of the rows [y0, y1). */
typedef struct composite_piece {
    layers layers;
    int32_t y0, y1;
    uint64_t sent_bytes;
} composite_piece;

/* direct: all in one round. binary-swap: pairs; nodes beyond a power of two first give all to one below. radix-k:
 * groups of four, and of what primes are left. */
int32_t composite_rounds(cluster_composite method, int32_t nodes);
void composite_step_of(cluster_composite method, int32_t nodes, int32_t round, int32_t node, composite_step *step);

/* The rows of [y0, y1) that member i of a step gets. */
void composite_rows(const composite_step *step, int32_t i, int32_t y0, int32_t y1, int32_t rows[2]);

/* A network: a latency for each message, a rate of each node; in seconds, or in cycles. */
typedef struct composite_model {
    double latency, bytes_per_time;
} composite_model;

/* A node's part of all rounds, and the way of all pieces to node 0, which has them in *piece then. *took is what
 * messages take by the model: in each round the most of any node, latency for each message it sends and the time of the
 * bytes it sends or receives; of the last way, each piece after the other. */
cluster_status composite_run(cluster_node *node, cluster_composite method, composite_piece *piece,
                             const composite_model *model, double *took, vodr_error *error);

/* The same for simulated nodes, piece by piece. */
cluster_status composite_simulate(cluster_composite method, int32_t nodes, composite_piece *piece,
                                  const composite_model *model, double *took, vodr_error *error);

/* Writes the pixels of a finished piece into the picture, r, g, b, a; maxima as reference_march() stores them. Fails
 * where a place of `places` is missing. */
cluster_status composite_write(const composite_piece *piece, int32_t places, int32_t width_px, double *rgba,
                               vodr_error *error);

#endif
