/* timing.c - a volume divided by time: drawn, measured, and its planes moved by what each box took, until nodes are
 * even; the best of these divisions stays. */
#include <math.h>
#include <stdlib.h>

#include "fail.h"
#include "state.h"

/* The volume is not divided anew while the nodes are as even as this. */
static const double even = 0.94;

/* Looks at the division that was just measured, and keeps it if it is the best so far. */
static cluster_status judge(cluster *c, vodr_error *error)
{
    double slowest_s = 0;
    for (int32_t i = 0; i < c->nodes; i++)
        slowest_s = fmax(slowest_s, c->share[i].cpu_s);
    const bool best = c->tries == 0 || slowest_s < c->best_s;
    c->tries++;
    if (!best)
        return CLUSTER_OK;
    c->best_s = slowest_s;
    kd_tree_free(&c->best);
    return kd_tree_copy(&c->planes, &c->best, error);
}

/* Goes back to the best division. */
static cluster_status restore(cluster *c, const reference_march_job *job, vodr_error *error)
{
    const double begin_s = cluster_now_s();
    kd_tree_free(&c->planes);
    c->planes = c->best;
    c->best = (kd_tree){0};
    return division_load(c, job, begin_s, error);
}

cluster_status timing_look(cluster *c, const reference_march_job *job, bool *stays, vodr_error *error)
{
    *stays = c->frames < CLUSTER_TIMED_FRAMES || c->tries > CLUSTER_TIMED_DIVISIONS || c->report.lbr_time >= even;
    if (*stays)
        return CLUSTER_OK;
    cluster_status status = cluster_agree(c->node, judge(c, error), error);
    if (status == CLUSTER_OK && c->tries == CLUSTER_TIMED_DIVISIONS) {
        *stays = true;
        c->tries++;
        status = restore(c, job, error);
    }
    return status;
}

void timing_forget(cluster *c)
{
    free(c->measured);
    c->measured = NULL;
    kd_tree_free(&c->best);
    c->tries = 0;
    c->report.lbr_time = 0;
}
