/* composite_round.h - private to compositing: what a node gives and takes in a round, however messages travel. */
#ifndef CLUSTER_COMPOSITE_ROUND_H
#define CLUSTER_COMPOSITE_ROUND_H

#include "composite.h"

/* Makes the messages for the other members of a step, out[i] of member i. On failure some may be there. */
cluster_status composite_give(const composite_step *step, composite_piece *p, node_message *out, vodr_error *error);

/* What a node's messages of a round take by a model; empty ones are none. It sends and receives at
 * once. */
double composite_took(const composite_model *model, int32_t members, const node_message *out, const node_message *in);

/* Leaves the node its own rows, with what in[i] of the other members adds. */
cluster_status composite_take(const composite_step *step, composite_piece *p, const node_message *in,
                              vodr_error *error);

#endif
