/* fail.h - private to cluster/: a failure as a status and one sentence. */
#ifndef CLUSTER_FAIL_H
#define CLUSTER_FAIL_H

#include "cluster.h"

/* Writes the sentence and returns the status. `error` may be NULL. */
cluster_status cluster_fail(vodr_error *error, cluster_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* The same for a want of memory. */
cluster_status cluster_no_memory(vodr_error *error);

#endif
