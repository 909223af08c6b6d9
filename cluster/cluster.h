/* cluster.h - the public interface of the cluster: one volume drawn by several nodes, each its own part, composited in
 * the order of sight (Lee, Park, Han, "Adaptive load balancing ... for parallel volume rendering on GPU clusters").
 *
 * Every node of a cluster makes the same calls in the same order. A call that fails on one node fails on all: with the
 * same status and the sentence of the first that failed.
 *
 * Errors: a function that can fail returns a status and writes one sentence to its vodr_error. No global mutable state.
 */
#ifndef CLUSTER_H
#define CLUSTER_H

#include "reference.h"

typedef enum cluster_status {
    CLUSTER_OK = 0,
    CLUSTER_INVALID,     /* an input is outside what can be drawn */
    CLUSTER_ENVIRONMENT, /* no memory, no MPI, a node that fails */
} cluster_status;

/* ---- nodes ---- */

typedef struct cluster_node cluster_node;

/* Joins the processes that mpirun started; a process that it did not start is a node alone. *node is to be left. */
cluster_status cluster_join(cluster_node **node, vodr_error *error);

/* A broken node leaves without a word, and mpirun ends the others. */
void cluster_leave(cluster_node *node);

/* Whether this node failed in a way that the others do not know of. */
bool cluster_broken(const cluster_node *node);

int32_t cluster_rank(const cluster_node *node);
int32_t cluster_ranks(const cluster_node *node);       /* processes */
int32_t cluster_local_ranks(const cluster_node *node); /* of this computer */

/* What the nodes make of each node's status: the first that is not CLUSTER_OK, with its sentence; where there are
 * several nodes, it says which. All nodes call it. */
cluster_status cluster_agree(cluster_node *node, cluster_status status, vodr_error *error);

/* Makes each value the least, or the greatest, of all nodes'. All nodes call it. */
cluster_status cluster_reduce(cluster_node *node, double *value, size_t count, bool most, vodr_error *error);

/* ---- a volume ---- */

/* Where voxels come from. Coordinates are of the whole volume. */
typedef struct cluster_source {
    int32_t dims_vox[3];
    void *context;
    /* The least and greatest values that samples can have in the sub-volumes of the layers [first, end), each with a
     * border of one voxel; a value that is not finite makes the least -INFINITY. least[], most[]: of the first of these
     * sub-volumes, x fastest. */
    cluster_status (*scan)(void *context, int32_t edge_vox, int32_t first, int32_t end, float *least, float *most,
                           vodr_error *error);
    /* The voxels of a box; *owner is to be released. */
    cluster_status (*load)(void *context, const int32_t lo_vox[3], const int32_t hi_vox[3], reference_volume *volume,
                           void **owner, vodr_error *error);
    void (*release)(void *context, void *owner);
    /* Says that boxes within this one will be loaded next, and the node may hold all of it; forget() that they have
     * been. */
    cluster_status (*expect)(void *context, const int32_t lo_vox[3], const int32_t hi_vox[3], vodr_error *error);
    void (*forget)(void *context);
    int32_t voxel_bytes;
} cluster_source;

typedef enum cluster_balance { CLUSTER_STATIC, CLUSTER_OCTREE, CLUSTER_PAPER, CLUSTER_BEST } cluster_balance;
typedef enum cluster_weight { CLUSTER_COUNT, CLUSTER_SAMPLES, CLUSTER_TIME } cluster_weight;
typedef enum cluster_composite { CLUSTER_DIRECT, CLUSTER_BINARY_SWAP, CLUSTER_RADIX_K } cluster_composite;

/* By time, so many frames are drawn before the volume is divided anew, the least of their times counts; and so many
 * divisions are tried at most, the one whose slowest node is fastest stays. */
enum { CLUSTER_TIMED_FRAMES = 8, CLUSTER_TIMED_DIVISIONS = 20 };

enum { CLUSTER_MAX_NODES = 1024, CLUSTER_LEAST_SUBVOLUME_VOX = 4, CLUSTER_MOST_SUBVOLUME_VOX = 64 };

/* What nodes are that draw with the hardware model; filled in before the volume is divided. */
typedef struct cluster_machine {
    vodr_machine machine;
    vodr_view view; /* of the whole volume */
    vodr_table table;
    const uint16_t *map; /* of the voxels that the source loads, which are densities then: see vodr_volume */
} cluster_machine;

typedef struct cluster_options {
    cluster_balance balance;
    cluster_weight weight;
    cluster_composite composite;
    int32_t subvolume_vox;
    int32_t nodes;       /* simulated, drawn one after another by a process alone; 0: the processes are the nodes */
    int32_t pixel_bits;  /* of a channel between nodes: 16, or 32 for floats; maxima are always floats */
    size_t memory_bytes; /* voxels that a node may hold; 0: no limit */
    double latency_s, bytes_per_s;  /* simulated: of a message, and of each node's network */
    const cluster_machine *machine; /* draws in place of the reference renderer; NULL: that does. Over and under only */
    double latency_cycles, bytes_per_cycle; /* of a network of machines */
    reference_options renderer;
} cluster_options;

/* What may be seen, of values: transparent where visible[] does not rise. */
typedef struct cluster_function {
    int32_t columns;
    const int32_t *visible; /* columns + 1: how many of the first i columns show something */
    double lo, hi;          /* values of the first and last column */
    bool mip;
} cluster_function;

typedef struct cluster cluster;

/* Finds the values of all sub-volumes, each node those of its share of the layers. To be closed on success, before the
 * node is left. The source lives as long. */
cluster_status cluster_open(const cluster_options *options, const cluster_source *source, cluster_node *node,
                            cluster **c, vodr_error *error);
void cluster_close(cluster *c);

/* Divides the volume for what `job` shows, whose window is the values lo to hi, and loads this node's part. Callable
 * again: boxes that stay are not loaded anew. By time it is to be called before each frame, all of one job, and divides
 * when enough is known. */
cluster_status cluster_place(cluster *c, const reference_march_job *job, double lo, double hi, vodr_error *error);

/* The same for another transfer function: a division whose nodes are still nearly even stays, else by best as few
 * sub-volumes as need be change owner, and nodes exchange only what is new to them. */
cluster_status cluster_change_function(cluster *c, const reference_march_job *job, double lo, double hi,
                                       vodr_error *error);

/* Draws into rgba[4*width*height] of node 0, as reference_march() does; NULL elsewhere. After cluster_place(). */
cluster_status cluster_draw(cluster *c, const reference_march_job *job, double *rgba, vodr_error *error);

/* ---- what it took ---- */

/* Of each node. */
typedef struct cluster_share {
    double subvolumes; /* not empty */
    double weight;
    int32_t parts;       /* leaves of the tree of nodes */
    int32_t clusters;    /* boxes drawn */
    uint64_t held_bytes; /* voxels, borders too */
    uint64_t samples;    /* of machines: fragments */
    uint64_t cycles;     /* of machines */
    double render_s;     /* of the last frame, by the clock */
    double cpu_s;        /* of all threads; least of the frames since the volume was divided */
    double composite_s;  /* after rendering, waiting included; simulated: by the model */
    uint64_t sent_bytes;
    double scan_s, divide_s, load_s; /* preprocessing */
} cluster_share;

/* Of the voxels of a division that is not the first, borders too; of all nodes. */
typedef struct cluster_change {
    uint64_t moved_bytes;   /* from node to node */
    uint64_t read_bytes;    /* from the file: no node had them */
    uint64_t scatter_bytes; /* that nodes hold now: a scatter of all */
} cluster_change;

typedef struct cluster_report {
    int32_t nodes;
    bool simulated;
    int64_t subvolumes, occupied;
    const cluster_share *share; /* of each node; on node 0 */
    double lbr, lbr_weight, lbr_time;
    double slowest_s;     /* rendering of the slowest node */
    double barrier_share; /* of that: how long the fastest waits for it */
    double frame_s;       /* rendering and compositing; simulated: by the model */
    cluster_change change;
    uint64_t slowest_cycles; /* of machines */
    double network_cycles;   /* that compositing takes after these, by the model */
} cluster_report;

/* Of the last cluster_draw(); lives until the next call. On node 0. */
cluster_report cluster_reported(const cluster *c);

#endif
