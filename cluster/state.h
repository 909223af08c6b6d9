/* state.h - private to cluster/: a cluster between calls. */
#ifndef CLUSTER_STATE_H
#define CLUSTER_STATE_H

#include "composite.h"
#include "kd_tree.h"
#include "subvolumes.h"

/* A box that a node of this process draws, with voxels of its own. */
typedef struct brick {
    int32_t owner;
    int32_t lo_vox[3], hi_vox[3];
    int32_t border_vox;
    size_t held_bytes;
    void *voxels;            /* of the source, to be released; NULL: */
    void *made;              /* put together of others, owned */
    reference_volume volume; /* either */
    reference *renderer;     /* NULL: not loaded */
    double cpu_s;            /* least of the frames since it was placed; 0: none was drawn */
} brick;

/* Bricks by the number of their leaf, so that the order of sight finds them. */
typedef struct bricks {
    int32_t count; /* leaves of the tree and more */
    brick *brick;  /* owned; not loaded where others draw */
} bricks;

struct cluster {
    cluster_options options;
    cluster_source source;
    cluster_node *node;
    int32_t nodes;
    subvolumes grid;
    octree octree;
    uint8_t *occupied; /* of each sub-volume */
    double *weight;    /* of each sub-volume, 0 where it is empty */
    double *measured;  /* seconds of each sub-volume in the division before; NULL: none was drawn */
    int64_t occupied_count;
    sums counts, weights;
    kd_tree planes; /* the nodes' parts */
    kd_tree tree;   /* the same, the parts made clusters */
    bricks bricks;
    cluster_share *share; /* of each node */
    cluster_report report;
    double scan_s;
    int32_t frames; /* drawn since the volume was divided */
    int32_t tries;  /* by time: divisions measured; at CLUSTER_TIMED_DIVISIONS the best of them stays */
    kd_tree best;   /* of these, its planes */
    double best_s;  /* its slowest node */
};

/* Seconds since some moment, and of all threads of this process. */
double cluster_now_s(void);
double cluster_cpu_s(void);

/* Frees the trees of planes and what they were made from. */
void division_free(cluster *c);

/* Makes clusters of c->planes and loads this process's. All nodes call it; the division began at begin_s. */
cluster_status division_load(cluster *c, const reference_march_job *job, double begin_s, vodr_error *error);

/* By time, whether the division stays for the next frame; all nodes know the same times. */
cluster_status timing_look(cluster *c, const reference_march_job *job, bool *stays, vodr_error *error);

/* Forgets all times: something else is drawn. */
void timing_forget(cluster *c);

/* Whether a node of the cluster is drawn by this process. */
static inline bool cluster_holds(const cluster *c, int32_t owner)
{
    return c->options.nodes > 0 || owner == c->node->rank;
}

/* The weights of the sub-volumes, by c->options.weight. */
void weights_fill(const cluster *c, const reference_camera *camera, double *weight);

/* Makes c->measured of the seconds that each box took in the frames since the volume was divided. All nodes call it. */
cluster_status weights_measure(cluster *c, const reference_camera *camera, vodr_error *error);

/* The voxels of a leaf's box, half-open. */
void bricks_box(const cluster *c, int32_t leaf, int32_t lo_vox[3], int32_t hi_vox[3]);

/* The same with its border. */
void bricks_border(const cluster *c, const brick *b, int32_t lo_vox[3], int32_t hi_vox[3]);

/* Whether there is an old brick of the same box, border and node. */
bool bricks_stay(const bricks *old, const brick *b);

/* Gives the bricks of this process that do not stay, which have no voxels yet, theirs: of `old` bricks, whose nodes
 * send what others need, and of the file. Tells c->report.change. All nodes call it. */
cluster_status exchange_bricks(cluster *c, const bricks *old, vodr_error *error);

/* Loads the bricks of this process for the tree, of the file the first time, and frees `old` ones. All nodes call it.
 */
cluster_status bricks_load(cluster *c, bricks *old, int32_t border_vox, vodr_error *error);
void bricks_free(const cluster_source *source, bricks *b);

/* Draws a box by the hardware model, as it is of the whole volume: the area's pixels into rgba, as reference_march()
 * does. Adds fragments and cycles. */
cluster_status draw_by_machine(const cluster_options *o, const brick *b, rectangle area, double *rgba,
                               cluster_share *share, vodr_error *error);

#endif
