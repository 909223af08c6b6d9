/* node.c - joins the other processes of mpirun, or is alone; statuses that all nodes agree on. */
#include "node.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fail.h"

static const char library_name[] = "vodr-mpi.so";

/* ---- alone ---- */

static bool alone_reduce(double *value, size_t count, bool most)
{
    (void)value, (void)count, (void)most;
    return true;
}

static bool alone_gather(const void *own, size_t bytes, void *all)
{
    memcpy(all, own, bytes);
    return true;
}

static bool alone_broadcast(void *data, size_t bytes, int32_t root)
{
    (void)data, (void)bytes, (void)root;
    return true;
}

static bool alone_exchange(int32_t peers, const int32_t *peer, const node_message *out, node_message *in)
{
    (void)peer, (void)out, (void)in;
    return peers == 0;
}

static void alone_close(bool well)
{
    (void)well;
}

static const node_ops alone = {alone_reduce, alone_gather, alone_broadcast, alone_exchange, alone_close};

/* ---- joining ---- */

/* The processes that mpirun says it started; 1 without. */
static long started(void)
{
    const char *text = getenv("OMPI_COMM_WORLD_SIZE");
    return text ? strtol(text, NULL, 10) : 1;
}

/* The library beside this program. */
static void *open_library(char *path, size_t size)
{
    ssize_t length = readlink("/proc/self/exe", path, size - sizeof library_name - 1);
    if (length < 0)
        length = 0;
    path[length] = '\0';
    char *slash = strrchr(path, '/');
    strcpy(slash ? slash + 1 : path, library_name);
    return dlopen(path, RTLD_NOW | RTLD_GLOBAL);
}

static cluster_status join_others(cluster_node *n, vodr_error *error)
{
    char path[4096];
    void *library = open_library(path, sizeof path);
    node_link_function *link = NULL;
    if (library)
        *(void **)&link = dlsym(library, NODE_LINK);
    if (!link)
        return cluster_fail(error, CLUSTER_ENVIRONMENT,
                            "mpirun started %ld processes, but this build has no MPI: make found no mpicc (%.300s)",
                            started(), access(path, F_OK) == 0 ? dlerror() : "vodr-mpi.so is not beside vodr");
    const node_link made = link();
    if (!made.started)
        return cluster_fail(error, CLUSTER_ENVIRONMENT, "MPI cannot start");
    *n = (cluster_node){made.rank, made.ranks, made.local_ranks, made.ops, false};
    return CLUSTER_OK;
}

cluster_status cluster_join(cluster_node **node, vodr_error *error)
{
    cluster_node *n = malloc(sizeof *n);
    *node = NULL;
    if (!n)
        return cluster_no_memory(error);
    *n = (cluster_node){0, 1, 1, &alone, false};
    cluster_status status = started() > 1 ? join_others(n, error) : CLUSTER_OK;
    if (status == CLUSTER_OK)
        *node = n;
    else
        free(n);
    return status;
}

void cluster_leave(cluster_node *node)
{
    if (!node)
        return;
    node->ops->close(!node->broken);
    free(node);
}

bool cluster_broken(const cluster_node *node)
{
    return node->broken;
}

int32_t cluster_rank(const cluster_node *node)
{
    return node->rank;
}

int32_t cluster_ranks(const cluster_node *node)
{
    return node->ranks;
}

int32_t cluster_local_ranks(const cluster_node *node)
{
    return node->local_ranks;
}

/* ---- talking ---- */

void node_message_free(node_message *m)
{
    free(m->bytes);
    *m = (node_message){0};
}

/* What went wrong is known to this node alone: the others are ended with it. */
static cluster_status lost(cluster_node *n, vodr_error *error)
{
    n->broken = true;
    return cluster_fail(error, CLUSTER_ENVIRONMENT, "a message to or from the others failed, or memory for it is out");
}

cluster_status cluster_reduce(cluster_node *node, double *value, size_t count, bool most, vodr_error *error)
{
    return node->ops->reduce(value, count, most) ? CLUSTER_OK : lost(node, error);
}

cluster_status node_gather(cluster_node *n, const void *own, size_t bytes, void *all, vodr_error *error)
{
    return n->ops->gather(own, bytes, all) ? CLUSTER_OK : lost(n, error);
}

cluster_status node_exchange(cluster_node *n, int32_t peers, const int32_t *peer, const node_message *out,
                             node_message *in, vodr_error *error)
{
    return n->ops->exchange(peers, peer, out, in) ? CLUSTER_OK : lost(n, error);
}

cluster_status cluster_agree(cluster_node *node, cluster_status status, vodr_error *error)
{
    double first = status == CLUSTER_OK ? node->ranks : node->rank, fine = status == CLUSTER_OK;
    if (node->broken || node->ranks == 1)
        return status;
    if (cluster_reduce(node, &first, 1, false, error) != CLUSTER_OK)
        return CLUSTER_ENVIRONMENT;
    const int32_t root = (int32_t)first;
    if (root == node->ranks)
        return CLUSTER_OK;
    if (cluster_reduce(node, &fine, 1, true, error) != CLUSTER_OK)
        return CLUSTER_ENVIRONMENT;
    struct {
        cluster_status status;
        vodr_error error;
    } told = {status, *error};
    if (!node->ops->broadcast(&told, sizeof told, root))
        return lost(node, error);
    *error = told.error;
    if (fine > 0) /* not all have failed */
        snprintf(error->text, sizeof error->text, "node %d of %d: %.*s", root, node->ranks,
                 (int)sizeof error->text - 40, told.error.text);
    return told.status;
}
