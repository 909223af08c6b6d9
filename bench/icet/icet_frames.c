/* icet_frames.c - compositing beside IceT's: the same pictures, on the same processes, in the same run.
 *   mpirun -n 8 build/icet_frames [SIZE [ROUNDS]]    a line a way on standard output: name, median milliseconds,
 * greatest difference from the first; squares of SIZE pixels (1024), 21 rounds
 *
 * Each process has what a box of eight shows of a cube seen at an angle: a hexagon of pixels that let some light
 * through, with holes. Pictures are floats, in order of the processes' numbers; times are from one barrier to the next,
 * with the whole picture on process 0. IceT is told the rectangle that a process's pixels lie in. */
#include <IceT.h>
#include <IceTMPI.h>
#include <math.h>
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "composite.h"
#include "stopwatch.h"

enum { WAYS = 6, OURS = 3, CHANNELS = 4, MOST_ROUNDS = 1000 };

static const char *const name[WAYS] = {"direct",    "binary-swap",      "radix-k",
                                       "IceT tree", "IceT binary-swap", "IceT radix-k"};
static const IceTEnum strategy[WAYS] = {[3] = ICET_SINGLE_IMAGE_STRATEGY_TREE,
                                        [4] = ICET_SINGLE_IMAGE_STRATEGY_BSWAP,
                                        [5] = ICET_SINGLE_IMAGE_STRATEGY_RADIXK};

typedef struct run_state {
    cluster_node *node;
    int32_t rank, ranks, size_px;
    rectangle area; /* of this process's pixels */
    float *pixels;  /* of the whole picture, owned */
    float *picture; /* what came out, on process 0; owned */
    float *first;   /* what came out the first way; owned */
} run_state;

static bool shows(const run_state *s, int32_t x, int32_t y)
{
    const double turn = 6.283185307 * (s->rank % 6) / 6, far = s->rank < 6 ? 0.2 : 0;
    const double u = (x + 0.5) / s->size_px - 0.5 - far * cos(turn), v = (y + 0.5) / s->size_px - 0.5 - far * sin(turn);
    const bool inside = fabs(v) < 0.25 && fabs(0.866 * u + 0.5 * v) < 0.25 && fabs(0.866 * u - 0.5 * v) < 0.25;
    return inside && (x / 16 * 7 + y / 16 * 5 + s->rank) % 4 > 0;
}

static void make_pixels(run_state *s)
{
    for (int32_t y = 0; y < s->size_px; y++)
        for (int32_t x = 0; x < s->size_px; x++) {
            float *pixel = s->pixels + CHANNELS * ((size_t)y * (size_t)s->size_px + (size_t)x);
            const float alpha = shows(s, x, y) ? 0.2f + 0.1f * (float)(x % 5) : 0;
            for (int c = 0; c < 3; c++)
                pixel[c] = alpha * (float)((x + y * (c + 2) + 40 * s->rank) % 256) / 255;
            pixel[3] = alpha;
            if (alpha > 0)
                s->area = rectangle_union(s->area, (rectangle){x, y, x + 1, y + 1});
        }
}

static void fail_on(const vodr_error *error)
{
    fprintf(stderr, "icet_frames: %s\n", error->text);
    MPI_Abort(MPI_COMM_WORLD, 3);
}

/* The bands that compositing ends with as one picture, of floats as IceT's. */
static void put_together(const run_state *s, const layers *l)
{
    memset(s->picture, 0, (size_t)s->size_px * (size_t)s->size_px * CHANNELS * sizeof *s->picture);
    for (int32_t i = 0; i < l->count; i++) {
        const layer *from = &l->layer[i];
        const size_t row = (size_t)(from->area.x1 - from->area.x0) * CHANNELS;
        for (int32_t y = from->area.y0; y < from->area.y1; y++)
            memcpy(s->picture + CHANNELS * ((size_t)y * (size_t)s->size_px + (size_t)from->area.x0),
                   from->pixel + (size_t)(y - from->area.y0) * row, row * sizeof *s->picture);
    }
}

/* One of cluster's ways. What a process drew is copied before the clock starts, as compositing takes it apart. */
static double ours(run_state *s, int way)
{
    composite_piece piece = {{.bits = 32}, 0, s->size_px, 0};
    const composite_model model = {0, 1};
    const size_t row = (size_t)(s->area.x1 - s->area.x0) * CHANNELS;
    vodr_error error;
    double took;
    cluster_status status = layers_add(&piece.layers, s->rank, s->rank + 1, s->area, &error);
    for (int32_t y = s->area.y0; status == CLUSTER_OK && y < s->area.y1; y++)
        memcpy(piece.layers.layer[0].pixel + (size_t)(y - s->area.y0) * row,
               s->pixels + CHANNELS * ((size_t)y * (size_t)s->size_px + (size_t)s->area.x0), row * sizeof(float));
    MPI_Barrier(MPI_COMM_WORLD);
    const double begin_s = MPI_Wtime();
    if (status == CLUSTER_OK)
        status = composite_run(s->node, (cluster_composite)way, &piece, &model, &took, &error);
    if (status == CLUSTER_OK && s->rank == 0)
        put_together(s, &piece.layers);
    MPI_Barrier(MPI_COMM_WORLD);
    const double end_s = MPI_Wtime();
    if (status != CLUSTER_OK)
        fail_on(&error);
    layers_free(&piece.layers);
    return end_s - begin_s;
}

static void start_icet(const run_state *s)
{
    IceTInt *order = malloc((size_t)s->ranks * sizeof *order);
    for (int32_t i = 0; i < s->ranks; i++)
        order[i] = i;
    icetResetTiles();
    icetAddTile(0, 0, s->size_px, s->size_px, 0);
    icetStrategy(ICET_STRATEGY_SEQUENTIAL);
    icetCompositeMode(ICET_COMPOSITE_MODE_BLEND);
    icetSetColorFormat(ICET_IMAGE_COLOR_RGBA_FLOAT);
    icetSetDepthFormat(ICET_IMAGE_DEPTH_NONE);
    icetEnable(ICET_ORDERED_COMPOSITE);
    icetCompositeOrder(order);
    free(order);
}

static double icet(run_state *s, int way)
{
    const IceTInt valid[4] = {s->area.x0, s->area.y0, s->area.x1 - s->area.x0, s->area.y1 - s->area.y0};
    const IceTFloat nothing[4] = {0, 0, 0, 0};
    icetSingleImageStrategy(strategy[way]);
    MPI_Barrier(MPI_COMM_WORLD);
    const double begin_s = MPI_Wtime();
    const IceTImage image = icetCompositeImage(s->pixels, NULL, valid, NULL, NULL, nothing);
    MPI_Barrier(MPI_COMM_WORLD);
    const double end_s = MPI_Wtime();
    const IceTFloat *from = s->rank == 0 ? icetImageGetColorcf(image) : NULL;
    for (size_t i = 0; from && i < (size_t)s->size_px * (size_t)s->size_px * CHANNELS; i++)
        s->picture[i] = from[i];
    return end_s - begin_s;
}

/* The greatest difference of a channel from the first picture. */
static double difference(run_state *s, bool first)
{
    double most = 0;
    for (size_t i = 0; i < (size_t)s->size_px * (size_t)s->size_px * CHANNELS; i++) {
        if (first)
            s->first[i] = s->picture[i];
        most = fmax(most, fabs((double)(s->picture[i] - s->first[i])));
    }
    return most;
}

static void measure(run_state *s, int rounds)
{
    static double times[WAYS][MOST_ROUNDS], off[WAYS];
    for (int i = -1; i < rounds; i++) /* the first of all warms up */
        for (int way = 0; way < WAYS; way++) {
            const double seconds = way < OURS ? ours(s, way) : icet(s, way);
            if (i >= 0)
                times[way][i] = seconds;
            if (s->rank == 0)
                off[way] = difference(s, way == 0 && i < 0);
        }
    for (int way = 0; s->rank == 0 && way < WAYS; way++)
        printf("%s,%.2f,%.1e\n", name[way], 1e3 * stopwatch_median(times[way], rounds), off[way]);
}

int main(int argc, char **argv)
{
    vodr_error error;
    run_state s = {.size_px = argc > 1 ? atoi(argv[1]) : 1024};
    const int rounds = argc > 2 ? atoi(argv[2]) : 21;
    if (s.size_px < 16 || s.size_px > VODR_MAX_SIZE_PX || rounds < 1 || rounds > MOST_ROUNDS) {
        fprintf(stderr, "usage: mpirun -n N icet_frames [SIZE [ROUNDS]]: 16 to %d pixels, 1 to %d rounds\n",
                VODR_MAX_SIZE_PX, MOST_ROUNDS);
        return 2;
    }
    if (cluster_join(&s.node, &error) != CLUSTER_OK) {
        fprintf(stderr, "icet_frames: %s\n", error.text);
        return 3;
    }
    s.rank = cluster_rank(s.node);
    s.ranks = cluster_ranks(s.node);
    const size_t channels = (size_t)s.size_px * (size_t)s.size_px * CHANNELS;
    s.pixels = malloc(channels * sizeof *s.pixels);
    s.picture = calloc(channels, sizeof *s.picture);
    s.first = malloc(channels * sizeof *s.first);
    if (s.ranks < 2 || !s.pixels || !s.picture || !s.first) {
        fprintf(stderr, "icet_frames: needs mpirun with at least 2 processes, and memory for pictures\n");
        return 3;
    }
    make_pixels(&s);
    IceTCommunicator all = icetCreateMPICommunicator(MPI_COMM_WORLD);
    IceTContext context = icetCreateContext(all);
    start_icet(&s);
    measure(&s, rounds);
    icetDestroyContext(context);
    icetDestroyMPICommunicator(all);
    free(s.pixels);
    free(s.picture);
    free(s.first);
    cluster_leave(s.node);
    return 0;
}
