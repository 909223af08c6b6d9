/* cluster_options.h - the options of `vodr cluster` about nodes, and which go together with others. */
#ifndef HOST_CLUSTER_OPTIONS_H
#define HOST_CLUSTER_OPTIONS_H

#include "cluster.h"
#include "options.h"
#include "output_set.h"
#include "reference_options.h"

enum { CLUSTER_CHANGES = 16 };

/* What is asked of a cluster. */
typedef struct cluster_wish {
    cluster_options options;
    const char *then[CLUSTER_CHANGES]; /* transfer functions after the first */
    int changes;
    bool machine; /* draws, in place of the reference renderer */
} cluster_wish;

/* Takes a cluster_wish as its target. */
extern const option_table option_cluster;

/* best, count, radix-k, sub-volumes of 8 voxels, floats; no changes. */
cluster_wish cluster_wish_default(void);

/* Refuses what does not go together. */
host_status cluster_options_check(const cluster_wish *nodes, const reference_wish *wish, const view_options *v,
                                  host_error *error);

/* The words that the options take. */
const char *cluster_balance_name(cluster_balance balance);
const char *cluster_weight_name(cluster_weight weight);
const char *cluster_composite_name(cluster_composite composite);

#endif
