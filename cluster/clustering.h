/* clustering.h - tight boxes around what is not empty (Berger and Rigoutsos, "An algorithm for point clustering and
 * grid generation"; Lee, Park, Han, section 4.3). */
#ifndef CLUSTER_CLUSTERING_H
#define CLUSTER_CLUSTERING_H

#include "kd_tree.h"

/* Divides each owned leaf of the tree, shrunk to what it holds, until every one is full to `efficiency`, or has fewer
 * than `least` sub-volumes; what is empty loses its owner. */
cluster_status clustering_refine(kd_tree *t, const sums *occupied, double efficiency, int32_t least, vodr_error *error);

#endif
