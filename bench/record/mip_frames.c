/* mip_frames.c - the maximum by every --accel on a device: random frames held against `none`, and the figures of the
 * paper (Kye and Kim: Table 2, Figure 8) on a volume enlarged to the size of one of the paper's. Lines of JSON.
 *
 *   mip_frames DEVICE matrix CASES
 *   mip_frames DEVICE table|figure NAME VOLUME.raw TYPE FROM TO SIDE_PX ROUNDS [THREADS]
 * DEVICE: cuda, cpu, or plain: the CPU without vector instructions of its own and without packed cells. TYPE: uint8 or
 * int16; FROM, TO: WxHxD voxels, in the file and enlarged. A table is of every --accel in blocks of 2 voxels, a figure
 * of `seed` in all sizes to the volume's. Every picture is held against none's: exit 1 when one differs. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mip_case.h"
#include "stand_in.h"
#include "stopwatch.h"

enum { MAX_ROUNDS = 99 };

static bool say(reference_status status, const char *what, const vodr_error *error)
{
    if (status != REFERENCE_OK)
        fprintf(stderr, "mip_frames: %s: %s\n", what, error->text);
    return status == REFERENCE_OK;
}

/* ---- matrix ---- */

/* The sums of the cases' maxima follow the totals: on another device they are the same but for what sums round. */
static int matrix(const reference_options *options, int cases)
{
    mip_tally t = {0};
    bool good = true;
    double *sums = malloc(((size_t)cases + 1) * sizeof *sums);
    for (int i = 0; sums && good && i < cases; i++) {
        mip_case c;
        good = mip_case_make((uint64_t)i + 1, &c) && mip_case_hold(&c, options, stderr, &t);
        sums[i] = t.sum;
        mip_case_free(&c);
    }
    printf("{\"result\": \"mip_matrix\", \"cases\": %llu, \"frames\": %llu, \"differ\": %llu",
           (unsigned long long)t.cases, (unsigned long long)t.frames, (unsigned long long)t.differ);
    for (int accel = 0; accel <= REFERENCE_ACCEL_BEST; accel++)
        printf(", \"%s_samples\": %llu", mip_accel_name((reference_accel)accel), (unsigned long long)t.samples[accel]);
    printf(", \"sums\": [");
    for (int i = 0; sums && i < (int)t.cases; i++)
        printf("%s%.9g", i ? ", " : "", sums[i]);
    puts("]}");
    free(sums);
    return sums && good && t.differ == 0 ? 0 : 1;
}

/* ---- the paper's figures ---- */

typedef struct request {
    stand_in volume;
    int rounds;
    bool figure;
} request;

static bool draw(reference *r, reference_march_job job, reference_accel accel, int32_t block_vox, double *rgba,
                 reference_stats *stats)
{
    vodr_error error;
    job.accel = accel;
    job.block_vox = block_vox;
    return say(reference_march(r, &job, rgba, stats, &error), mip_accel_name(accel), &error);
}

static bool make_job(const request *q, int view, const double *table, reference_march_job *job)
{
    *job = (reference_march_job){.blend = REFERENCE_MIP,
                                 .filter = REFERENCE_LINEAR,
                                 .termination = 2,
                                 .table = {.columns = MIP_COLUMNS, .rows = 1, .rgba = table},
                                 .window_scale = 1 / 65535.0};
    return stand_in_rays(&q->volume, view, &job->camera);
}

/* One way of drawing a view, and how long it took. */
typedef struct entry {
    reference_accel accel;
    int32_t block_vox;
    uint64_t samples;
    double ms[MAX_ROUNDS], cpu_ms[MAX_ROUNDS], preprocess_ms;
    double first_cpu_ms; /* of the frame that warms up: with what is made once of the volume */
} entry;

static void print_entry(const request *q, const char *device, int view, entry *e)
{
    const size_t rounds = (size_t)q->rounds;
    const double ms = stopwatch_median(e->ms, rounds), cpu_ms = stopwatch_median(e->cpu_ms, rounds);
    printf("{\"result\": \"mip\", \"device\": \"%s\", \"volume\": \"%s\", \"size_vox\": \"%dx%dx%d\", \"size_px\": %d, "
           "\"view\": \"%s\", \"accel\": \"%s\", \"block_vox\": %d, \"ms\": %.4f, \"least_ms\": %.4f, \"most_ms\": "
           "%.4f, \"cpu_ms\": %.4f, \"least_cpu_ms\": %.4f, \"first_cpu_ms\": %.4f, \"samples\": %llu, "
           "\"preprocess_ms\": %.3f}\n",
           device, q->volume.name, q->volume.to[0], q->volume.to[1], q->volume.to[2], q->volume.side_px,
           stand_in_view(view), mip_accel_name(e->accel), e->block_vox, ms, e->ms[0], e->ms[rounds - 1], cpu_ms,
           e->cpu_ms[0], e->first_cpu_ms, (unsigned long long)e->samples, e->preprocess_ms);
}

/* Draws the entries in turn; the picture of `none`, of these or an earlier call, is what all others are held against.
 */
static bool time_entries(const request *q, reference *r, const reference_march_job *job, int view, entry *entries,
                         int count, double *pictures[2])
{
    const size_t bytes = 4 * (size_t)q->volume.side_px * (size_t)q->volume.side_px * sizeof **pictures;
    bool good = true;
    for (int round = -1; good && round < q->rounds; round++) /* the first round warms up */
        for (int i = 0; good && i < count; i++) {
            entry *e = &entries[i];
            reference_stats stats;
            double begin_s = stopwatch_cpu_now_s();
            good = draw(r, *job, e->accel, e->block_vox, pictures[e->accel != REFERENCE_ACCEL_NONE], &stats);
            e->samples = stats.samples;
            e->preprocess_ms += stats.preprocess_ms;
            const double cpu_ms = 1e3 * (stopwatch_cpu_now_s() - begin_s);
            if (round < 0) {
                e->first_cpu_ms = cpu_ms;
            } else {
                e->ms[round] = stats.draw_ms;
                e->cpu_ms[round] = cpu_ms;
            }
            if (good && e->accel != REFERENCE_ACCEL_NONE && memcmp(pictures[0], pictures[1], bytes) != 0) {
                fprintf(stderr, "mip_frames: %s, view %s, %s: not the picture of none\n", q->volume.name,
                        stand_in_view(view), mip_accel_name(e->accel));
                good = false;
            }
        }
    for (int i = 0; good && i < count; i++)
        print_entry(q, reference_device_name(r), view, &entries[i]);
    fflush(stdout);
    return good;
}

static bool draw_view(const request *q, reference *r, int view, double *pictures[2])
{
    static double table[4 * MIP_COLUMNS];
    reference_march_job job;
    mip_fill_ramp(table);
    if (!make_job(q, view, table, &job))
        return false;
    entry entries[REFERENCE_ACCEL_BEST + 1] = {{.accel = REFERENCE_ACCEL_NONE, .block_vox = 2}};
    int32_t longest = q->volume.to[0] > q->volume.to[1] ? q->volume.to[0] : q->volume.to[1];
    longest = longest > q->volume.to[2] ? longest : q->volume.to[2];
    for (int accel = REFERENCE_ACCEL_BLOCK; accel <= REFERENCE_ACCEL_BEST; accel++)
        entries[accel] = (entry){.accel = (reference_accel)accel, .block_vox = 2};
    bool good = time_entries(q, r, &job, view, entries, q->figure ? 1 : REFERENCE_ACCEL_BEST + 1, pictures);
    for (int32_t edge = 2; good && q->figure && edge <= longest; edge *= 2) {
        entry seed = {.accel = REFERENCE_ACCEL_SEED, .block_vox = edge};
        good = time_entries(q, r, &job, view, &seed, 1, pictures);
    }
    return good;
}

static int figures(const reference_options *options, const request *q)
{
    uint16_t *voxels = stand_in_read(&q->volume);
    const size_t channels = 4 * (size_t)q->volume.side_px * (size_t)q->volume.side_px;
    double *pictures[2] = {malloc(channels * sizeof(double)), malloc(channels * sizeof(double))};
    reference_volume v = {.type = REFERENCE_UINT16, .voxels = voxels};
    reference *r = NULL;
    vodr_error error;
    memcpy(v.dims_vox, q->volume.to, sizeof v.dims_vox);
    bool good = voxels && pictures[0] && pictures[1] && say(reference_open(options, &v, &r, &error), "open", &error);
    for (int view = 0; good && view < STAND_IN_VIEWS; view++)
        good = draw_view(q, r, view, pictures);
    reference_close(r);
    free(voxels);
    free(pictures[0]);
    free(pictures[1]);
    return good ? 0 : 1;
}

int main(int argc, char **argv)
{
    reference_options options = {.device = argc > 1 && strcmp(argv[1], "cuda") == 0 ? REFERENCE_CUDA : REFERENCE_CPU,
                                 .simd =
                                     argc > 1 && strcmp(argv[1], "plain") == 0 ? VODR_SIMD_PORTABLE : VODR_SIMD_BEST};
    if (argc == 4 && strcmp(argv[2], "matrix") == 0)
        return matrix(&options, atoi(argv[3]));
    if (argc == 10 || argc == 11) {
        request q = {.volume = {.name = argv[3], .path = argv[4], .type = argv[5], .side_px = atoi(argv[8])},
                     .rounds = atoi(argv[9]),
                     .figure = strcmp(argv[2], "figure") == 0};
        options.threads = argc == 11 ? atoi(argv[10]) : 0;
        if (stand_in_size(argv[6], q.volume.from) && stand_in_size(argv[7], q.volume.to) && q.volume.side_px > 0 &&
            q.volume.side_px <= 4096 && q.rounds > 0 && q.rounds <= MAX_ROUNDS)
            return figures(&options, &q);
    }
    fputs("usage: mip_frames cuda|cpu|plain matrix CASES | table|figure NAME VOLUME.raw uint8|int16 FROM TO SIDE_PX "
          "ROUNDS "
          "[THREADS]\n",
          stderr);
    return 2;
}
