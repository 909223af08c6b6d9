/* cluster_scene.h - a scene whose voxels lie apart: each node reads of the file what it draws. */
#ifndef HOST_CLUSTER_SCENE_H
#define HOST_CLUSTER_SCENE_H

#include "cluster.h"
#include "reference_scene.h"

/* Not to be copied while a cluster reads from it. */
typedef struct cluster_scene {
    scene scene; /* its volume has no voxels */
    volume_options options;
    size_t memory_bytes; /* voxels that may be read at a time; 0: no limit */
    double least, most;  /* finite values seen by this node; least above most: none */
    volume near;         /* voxels of a box from which others are cut; voxels NULL: none */
    int32_t near_lo[3];
    reference_march_job job;
    double *table;           /* of the job, owned */
    bool draws_machine;      /* set before the source is made: it loads densities, and */
    cluster_machine machine; /* is settled too */
} cluster_scene;

/* Reads the header. To be closed on success. */
host_status cluster_scene_open(const char *path, const view_options *options, size_t memory_bytes, cluster_scene *s,
                               host_error *error);
void cluster_scene_close(cluster_scene *s);

/* The file as a cluster's source. Scanning it finds least and most. */
cluster_source cluster_scene_source(cluster_scene *s);

/* Once least and most are those of all nodes: window, camera and job. */
host_status cluster_scene_settle(cluster_scene *s, const view_options *options, const reference_choice *choice,
                                 host_error *error);

/* The same for another transfer function, of a settled scene. */
host_status cluster_scene_change(cluster_scene *s, const view_options *options, const char *function,
                                 const reference_choice *choice, host_error *error);

/* What a failure of cluster/ is as an exit code. */
host_status cluster_scene_status(cluster_status status);

#endif
