/* node_mpi.c - nodes that talk by MPI: the library vodr-mpi.so, which node.c loads in processes of mpirun. An error of
 * MPI itself ends all processes, which is MPI's default. */
#include <mpi.h>
#include <stdlib.h>

#include "node.h"

enum { TAG = 1, MOST_BYTES = 1 << 30 };

static bool mpi_reduce(double *value, size_t count, bool most)
{
    for (size_t done = 0; done < count; done += MOST_BYTES / sizeof *value) {
        const size_t left = count - done, now = left < MOST_BYTES / sizeof *value ? left : MOST_BYTES / sizeof *value;
        MPI_Allreduce(MPI_IN_PLACE, value + done, (int)now, MPI_DOUBLE, most ? MPI_MAX : MPI_MIN, MPI_COMM_WORLD);
    }
    return true;
}

static bool mpi_gather(const void *own, size_t bytes, void *all)
{
    return bytes <= MOST_BYTES &&
           MPI_Allgather(own, (int)bytes, MPI_BYTE, all, (int)bytes, MPI_BYTE, MPI_COMM_WORLD) == MPI_SUCCESS;
}

static bool mpi_broadcast(void *data, size_t bytes, int32_t root)
{
    return bytes <= MOST_BYTES && MPI_Bcast(data, (int)bytes, MPI_BYTE, root, MPI_COMM_WORLD) == MPI_SUCCESS;
}

/* Receives what a peer sends, whatever its length. */
static bool receive(int32_t peer, node_message *in)
{
    MPI_Status status;
    int count;
    MPI_Probe(peer, TAG, MPI_COMM_WORLD, &status);
    MPI_Get_count(&status, MPI_BYTE, &count);
    *in = (node_message){malloc(count > 0 ? (size_t)count : 1), (size_t)count};
    if (!in->bytes)
        return false;
    return MPI_Recv(in->bytes, count, MPI_BYTE, peer, TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE) == MPI_SUCCESS;
}

static bool mpi_exchange(int32_t peers, const int32_t *peer, const node_message *out, node_message *in)
{
    MPI_Request *sent = malloc(((size_t)peers + 1) * sizeof *sent);
    bool well = sent != NULL;
    int32_t started = 0;
    for (; well && started < peers; started++) {
        well = out[started].count <= MOST_BYTES;
        if (well)
            MPI_Isend(out[started].bytes, (int)out[started].count, MPI_BYTE, peer[started], TAG, MPI_COMM_WORLD,
                      &sent[started]);
    }
    for (int32_t i = 0; well && i < peers; i++)
        well = receive(peer[i], &in[i]);
    if (well)
        MPI_Waitall(started, sent, MPI_STATUSES_IGNORE);
    free(sent);
    return well;
}

/* A node that failed alone leaves without a word, and mpirun ends the others. */
static void mpi_close(bool well)
{
    if (well)
        MPI_Finalize();
}

static const node_ops ops = {mpi_reduce, mpi_gather, mpi_broadcast, mpi_exchange, mpi_close};

node_link vodr_node_link(void);

node_link vodr_node_link(void)
{
    node_link link = {.ops = &ops};
    MPI_Comm local;
    int rank, ranks, local_ranks;
    if (MPI_Init(NULL, NULL) != MPI_SUCCESS)
        return link;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, rank, MPI_INFO_NULL, &local);
    MPI_Comm_size(local, &local_ranks);
    MPI_Comm_free(&local);
    link.started = true;
    link.rank = rank;
    link.ranks = ranks;
    link.local_ranks = local_ranks;
    return link;
}
