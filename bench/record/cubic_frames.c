/* cubic_frames.c - the cubic filters by every --accel on a device: random frames held against `none`, and the figures
 * of the paper (Kye, Tables 2 and 3) on a volume enlarged to the size of one of the paper's. Lines of JSON.
 *
 *   cubic_frames DEVICE matrix CASES
 *   cubic_frames DEVICE table NAME VOLUME.raw TYPE FROM TO SIDE_PX ROUNDS LOW:HIGH [THREADS]
 *   cubic_frames DEVICE preprocess NAME VOLUME.raw TYPE FROM TO SIDE_PX ROUNDS LOW:HIGH [THREADS]
 * DEVICE: cuda or cpu; TYPE: uint8 or int16; FROM, TO: WxHxD voxels, in the file and enlarged; LOW, HIGH: where in the
 * volume's range opacity begins and where it is full. Every picture is held against none's: exit 1 when one differs
 * that should not. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cubic_cases.h"
#include "stand_in.h"
#include "stopwatch.h"

enum { COLUMNS = 1024, MAX_ROUNDS = 99 };

typedef struct request {
    stand_in volume;
    int rounds, threads;
    double low, high;
    reference_device device;
} request;

/* One way of drawing, and how long it took: preprocess_ms when it was first needed, prepare_ms under a transfer
 * function that is new. */
typedef struct entry {
    const char *filter_name;
    reference_filter filter;
    reference_accel accel;
    uint64_t samples, differing_px;
    double ms[MAX_ROUNDS], cpu_ms[MAX_ROUNDS], prepare_ms[MAX_ROUNDS], preprocess_ms, farthest;
} entry;

#define ENTRY(word, of_filter, of_accel)                                                                               \
    {                                                                                                                  \
        .filter_name = word, .filter = of_filter, .accel = of_accel                                                    \
    }
static const entry entries[] = {
    ENTRY("linear", REFERENCE_LINEAR, REFERENCE_ACCEL_NONE),
    ENTRY("linear", REFERENCE_LINEAR, REFERENCE_ACCEL_BEST),
    ENTRY("cardinal", REFERENCE_CARDINAL, REFERENCE_ACCEL_NONE),
    ENTRY("cardinal", REFERENCE_CARDINAL, REFERENCE_ACCEL_RIVAL),
    ENTRY("cardinal", REFERENCE_CARDINAL, REFERENCE_ACCEL_HULL),
    ENTRY("cardinal", REFERENCE_CARDINAL, REFERENCE_ACCEL_BEST),
    ENTRY("cardinal", REFERENCE_CARDINAL, REFERENCE_ACCEL_UNSAFE),
    ENTRY("bspline", REFERENCE_BSPLINE, REFERENCE_ACCEL_NONE),
    ENTRY("bspline", REFERENCE_BSPLINE, REFERENCE_ACCEL_RIVAL),
    ENTRY("bspline", REFERENCE_BSPLINE, REFERENCE_ACCEL_HULL),
    ENTRY("bspline", REFERENCE_BSPLINE, REFERENCE_ACCEL_BEST),
};

enum { ENTRIES = sizeof entries / sizeof *entries };

/* Each round has a function of its own, by a little. */
static void fill_table(const request *q, int round, double *rgba)
{
    for (int i = 0; i < COLUMNS; i++) {
        const double place = (i / (COLUMNS - 1.0) - q->low) / (q->high - q->low);
        const double opacity = fmin(fmax(place, 0), 1) * (0.9 + 0.0001 * round);
        const double colour[3] = {1, 0.9 - 0.5 * (1 - opacity), 0.8 - 0.7 * (1 - opacity)};
        for (int c = 0; c < 3; c++)
            rgba[4 * i + c] = colour[c] * opacity;
        rgba[4 * i + 3] = opacity;
    }
}

static bool draw(reference *r, reference_march_job job, const entry *e, double *rgba, reference_stats *stats)
{
    vodr_error error;
    job.filter = e->filter;
    job.accel = e->accel;
    if (reference_march(r, &job, rgba, stats, &error) == REFERENCE_OK)
        return true;
    fprintf(stderr, "cubic_frames: %s, %s: %s\n", e->filter_name, cubic_accel_name(e->accel), error.text);
    return false;
}

static void compare(const double *none, const double *other, size_t pixels, entry *e)
{
    e->differing_px = 0;
    for (size_t i = 0; i < pixels; i++) {
        e->differing_px += memcmp(&none[4 * i], &other[4 * i], 4 * sizeof *none) != 0;
        for (size_t c = 0; c < 4; c++)
            e->farthest = fmax(e->farthest, fabs(none[4 * i + c] - other[4 * i + c]));
    }
}

static void print_entry(const request *q, const char *device, int view, entry *e)
{
    const size_t rounds = (size_t)q->rounds;
    const int32_t *to = q->volume.to;
    const double ms = stopwatch_median(e->ms, rounds), cpu_ms = stopwatch_median(e->cpu_ms, rounds);
    const double prepare_ms = stopwatch_median(e->prepare_ms, rounds);
    printf(
        "{\"result\": \"cubic\", \"device\": \"%s\", \"volume\": \"%s\", \"size_vox\": \"%dx%dx%d\", \"size_px\": %d, "
        "\"view\": \"%s\", \"filter\": \"%s\", \"accel\": \"%s\", \"ms\": %.4f, \"least_ms\": %.4f, \"most_ms\": %.4f, "
        "\"cpu_ms\": %.4f, \"least_cpu_ms\": %.4f, \"samples\": %llu, \"prepare_ms\": %.3f, \"least_prepare_ms\": "
        "%.3f, \"preprocess_ms\": %.3f, \"differing_px\": %llu, \"farthest\": %.4f}\n",
        device, q->volume.name, to[0], to[1], to[2], q->volume.side_px, stand_in_view(view), e->filter_name,
        cubic_accel_name(e->accel), ms, e->ms[0], e->ms[rounds - 1], cpu_ms, e->cpu_ms[0],
        (unsigned long long)e->samples, prepare_ms, e->prepare_ms[0], e->preprocess_ms,
        (unsigned long long)e->differing_px, e->farthest);
}

/* Draws the entries in turn and holds the pictures of a filter against that of its none, which comes first. */
static bool draw_view(const request *q, reference *r, int view, double *table, double *pictures[2], bool *differs)
{
    entry all[ENTRIES];
    memcpy(all, entries, sizeof all);
    reference_march_job job = {.termination = 0.998,
                               .block_vox = 8,
                               .table = {.columns = COLUMNS, .rows = 1, .rgba = table},
                               .window_scale = 1 / 65535.0};
    bool good = stand_in_rays(&q->volume, view, &job.camera);
    const size_t pixels = (size_t)q->volume.side_px * (size_t)q->volume.side_px;
    for (int round = -1; good && round < q->rounds; round++) { /* the first round warms up */
        for (int i = 0; good && i < ENTRIES; i++) {
            entry *e = &all[i];
            reference_stats stats;
            const bool none = e->accel == REFERENCE_ACCEL_NONE;
            if (round >= 0 && !none) { /* the renderer keeps the blocks of the last accel alone */
                fill_table(q, round, table);
                good = draw(r, job, e, pictures[1], &stats);
            }
            fill_table(q, round + 1, table);
            const double begin_s = stopwatch_cpu_now_s();
            good = good && draw(r, job, e, pictures[!none], &stats);
            if (round < 0) {
                e->preprocess_ms = stats.preprocess_ms;
                if (good && !none && e->filter != REFERENCE_LINEAR)
                    compare(pictures[0], pictures[1], pixels, e);
                *differs = *differs || (e->differing_px > 0 && e->accel != REFERENCE_ACCEL_UNSAFE);
                continue;
            }
            e->ms[round] = stats.draw_ms;
            e->cpu_ms[round] = 1e3 * (stopwatch_cpu_now_s() - begin_s);
            e->prepare_ms[round] = stats.prepare_ms;
            e->samples = stats.samples;
        }
    }
    for (int i = 0; good && i < ENTRIES; i++)
        print_entry(q, reference_device_name(r), view, &all[i]);
    fflush(stdout);
    return good;
}

static bool open_volume(const request *q, const uint16_t *voxels, reference **r)
{
    const reference_options options = {.device = q->device, .threads = q->threads};
    reference_volume v = {.type = REFERENCE_UINT16, .voxels = voxels};
    vodr_error error;
    memcpy(v.dims_vox, q->volume.to, sizeof v.dims_vox);
    if (reference_open(&options, &v, r, &error) == REFERENCE_OK)
        return true;
    fprintf(stderr, "cubic_frames: %s\n", error.text);
    return false;
}

static int figures(const request *q)
{
    const size_t channels = 4 * (size_t)q->volume.side_px * (size_t)q->volume.side_px;
    static double table[4 * COLUMNS];
    uint16_t *voxels = stand_in_read(&q->volume);
    double *pictures[2] = {malloc(channels * sizeof(double)), malloc(channels * sizeof(double))};
    reference *r = NULL;
    bool differs = false, good = voxels && pictures[0] && pictures[1] && open_volume(q, voxels, &r);
    for (int view = 0; good && view < STAND_IN_VIEWS; view++)
        good = draw_view(q, r, view, table, pictures, &differs);
    reference_close(r);
    free(voxels);
    free(pictures[0]);
    free(pictures[1]);
    return good && !differs ? 0 : 1;
}

/* What each filter's best derives of the volume, each time in a renderer that is new. */
static int preprocess(const request *q)
{
    const size_t channels = 4 * (size_t)q->volume.side_px * (size_t)q->volume.side_px;
    static double table[4 * COLUMNS];
    uint16_t *voxels = stand_in_read(&q->volume);
    double *picture = malloc(channels * sizeof *picture);
    bool good = voxels && picture;
    for (int i = 0; good && i < ENTRIES; i++) {
        double ms[MAX_ROUNDS], cpu_ms[MAX_ROUNDS];
        char device[160] = "";
        if (entries[i].accel == REFERENCE_ACCEL_NONE)
            continue;
        for (int round = 0; good && round < q->rounds; round++) {
            reference_march_job job = {
                .termination = 0.998, .block_vox = 8, .table = {.columns = COLUMNS, .rows = 1, .rgba = table}};
            reference *r = NULL;
            reference_stats stats = {0};
            fill_table(q, 0, table);
            const double begin_s = stopwatch_cpu_now_s();
            good = open_volume(q, voxels, &r) && stand_in_rays(&q->volume, 0, &job.camera) &&
                   draw(r, job, &entries[i], picture, &stats);
            if (good)
                snprintf(device, sizeof device, "%s", reference_device_name(r));
            ms[round] = stats.preprocess_ms;
            cpu_ms[round] = 1e3 * (stopwatch_cpu_now_s() - begin_s);
            reference_close(r);
        }
        const double median_ms = stopwatch_median(ms, (size_t)q->rounds);
        stopwatch_median(cpu_ms, (size_t)q->rounds); /* sorts them */
        printf("{\"result\": \"cubic_preprocess\", \"device\": \"%s\", \"volume\": \"%s\", \"size_vox\": \"%dx%dx%d\", "
               "\"filter\": \"%s\", \"accel\": \"%s\", \"ms\": %.3f, \"least_ms\": %.3f, \"least_cpu_ms\": %.3f}\n",
               device, q->volume.name, q->volume.to[0], q->volume.to[1], q->volume.to[2], entries[i].filter_name,
               cubic_accel_name(entries[i].accel), median_ms, ms[0], cpu_ms[0]);
    }
    free(voxels);
    free(picture);
    return good ? 0 : 1;
}

static int matrix(reference_device device, int cases)
{
    const reference_options way = {.device = device};
    cubic_tally t = {0};
    bool good = true;
    for (int i = 0; i < cases; i++) {
        test_case c;
        good = case_make((uint64_t)i + 1, &c) && cubic_case_hold(&c, &way, 1, stderr, &t) && good;
        case_free(&c);
    }
    printf(
        "{\"result\": \"cubic_matrix\", \"cases\": %llu, \"frames\": %llu, \"differ\": %llu, \"unsafe_frames\": %llu, "
        "\"unsafe_differ\": %llu",
        (unsigned long long)t.cases, (unsigned long long)t.frames, (unsigned long long)t.differ,
        (unsigned long long)t.unsafe_frames, (unsigned long long)t.unsafe);
    for (int accel = 0; accel < REFERENCE_ACCELS; accel++)
        if (t.samples[accel] > 0)
            printf(", \"%s_samples\": %llu", cubic_accel_name((reference_accel)accel),
                   (unsigned long long)t.samples[accel]);
    puts("}");
    return good && t.differ == 0 && t.cases == (uint64_t)cases ? 0 : 1;
}

int main(int argc, char **argv)
{
    const reference_device device = argc > 1 && strcmp(argv[1], "cuda") == 0 ? REFERENCE_CUDA : REFERENCE_CPU;
    if (argc == 4 && strcmp(argv[2], "matrix") == 0)
        return matrix(device, atoi(argv[3]));
    if (argc == 11 || argc == 12) {
        request q = {.volume = {argv[3], argv[4], argv[5], .side_px = atoi(argv[8])},
                     .rounds = atoi(argv[9]),
                     .threads = argc == 12 ? atoi(argv[11]) : 0,
                     .device = device};
        if (stand_in_size(argv[6], q.volume.from) && stand_in_size(argv[7], q.volume.to) && q.volume.side_px > 0 &&
            q.volume.side_px <= 4096 && q.rounds > 0 && q.rounds <= MAX_ROUNDS &&
            sscanf(argv[10], "%lf:%lf", &q.low, &q.high) == 2 && q.low < q.high)
            return strcmp(argv[2], "preprocess") == 0 ? preprocess(&q) : figures(&q);
    }
    fputs("usage: cubic_frames cuda|cpu matrix CASES | table|preprocess NAME VOLUME.raw uint8|int16 FROM TO SIDE_PX "
          "ROUNDS "
          "LOW:HIGH [THREADS]\n",
          stderr);
    return 2;
}
