/* aligned_frames.c - the thread-aligned projection on a device (Kim N.-Y., Table 2): an orbit about a volume enlarged
 * to the size of one of the paper's, by the usual frame and every way of alignment; what the copies of the coefficients
 * take; and how far the pictures are from those in double precision. Lines of JSON.
 *
 *   aligned_frames DEVICE orbit NAME VOLUME.raw TYPE FROM TO SIDE_PX FRAMES TIMES LOW:HIGH [THREADS]
 *   aligned_frames DEVICE prefilter NAME VOLUME.raw TYPE FROM TO SIDE_PX 1 TIMES LOW:HIGH [THREADS]
 *   aligned_frames DEVICE quality|launches NAME VOLUME.raw TYPE FROM TO SIDE_PX 1 1 LOW:HIGH [THREADS]
 * DEVICE: cuda or cpu; TYPE: uint8 or int16; FROM, TO: WxHxD voxels, in the file and enlarged; LOW, HIGH: where in the
 * volume's range opacity begins and where it is full. The usual frame and `aligned` are drawn TIMES times, the others
 * once. `launches` draws each view once by each way, for a profiler, and says in which order. Exit 1 when a picture is
 * not the usual one's to the byte that should be, or below 60 dB of double's. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cubic_cases.h"
#include "stand_in.h"
#include "stopwatch.h"

enum { COLUMNS = 1024, MAX_TIMES = 99, MAX_FRAMES = 3600 };

/* What `quality` asks for. */
static const double least_db = 60;

typedef struct request {
    stand_in volume;
    int frames, times, threads;
    double low, high;
    reference_device device;
} request;

/* A way of drawing. The first is the usual one; the first ALWAYS are drawn TIMES times. */
typedef struct way {
    reference_accel accel;
    reference_theta theta;
    int32_t copies;
    const char *name;
} way;

static const way ways[] = {
    {REFERENCE_ACCEL_NONE, REFERENCE_THETA_BOX, 0, "none"},
    {REFERENCE_ACCEL_ALIGNED, REFERENCE_THETA_BOX, 0, "aligned"},
    {REFERENCE_ACCEL_ALIGNED, REFERENCE_THETA_BOX, 1, "aligned, one copy"},
    {REFERENCE_ACCEL_ALIGNED_PAPER, REFERENCE_THETA_BOX, 0, "aligned-paper, box"},
    {REFERENCE_ACCEL_ALIGNED_PAPER, REFERENCE_THETA_PLANE, 0, "aligned-paper, plane"},
    {REFERENCE_ACCEL_BEST, REFERENCE_THETA_BOX, 0, "best"},
    {REFERENCE_ACCEL_ALIGNED_BEST, REFERENCE_THETA_BOX, 0, "aligned-best"},
};

enum { WAYS = sizeof ways / sizeof *ways, ALWAYS = 2 };

/* What a way came to over an orbit. */
typedef struct tally {
    double best_ms, worst_ms, sum_ms, best_cpu_ms, worst_cpu_ms, sum_cpu_ms, turn_ms, round_ms[MAX_TIMES], least_db,
        preprocess_ms;
    uint64_t samples, differing_px;
    int32_t drawn, copies;
} tally;

/* A device with a volume, and pictures of it. */
typedef struct stage {
    const request *q;
    reference *r;
    uint16_t *voxels;
    double *usual, *other, table[4 * COLUMNS];
    reference_march_job job;
} stage;

static bool stage_open(const request *q, stage *s)
{
    const reference_options options = {.device = q->device, .threads = q->threads};
    const size_t bytes = 4 * (size_t)q->volume.side_px * (size_t)q->volume.side_px * sizeof(double);
    vodr_error error;
    *s = (stage){.q = q, .voxels = stand_in_read(&q->volume), .usual = malloc(bytes), .other = malloc(bytes)};
    reference_volume v = {.type = REFERENCE_UINT16, .voxels = s->voxels};
    memcpy(v.dims_vox, q->volume.to, sizeof v.dims_vox);
    for (int i = 0; i < COLUMNS; i++) {
        const double place = (i / (COLUMNS - 1.0) - q->low) / (q->high - q->low),
                     opacity = fmin(fmax(place, 0), 1) * 0.9;
        const double colour[4] = {1, 0.9 - 0.5 * (1 - opacity), 0.8 - 0.7 * (1 - opacity), 1};
        for (int c = 0; c < 4; c++)
            s->table[4 * i + c] = colour[c] * opacity;
    }
    s->job = (reference_march_job){.filter = REFERENCE_BSPLINE,
                                   .termination = 0.998,
                                   .block_vox = 8,
                                   .table = {COLUMNS, 1, s->table, 0},
                                   .window_scale = 1 / 65535.0};
    if (!s->voxels || !s->usual || !s->other)
        return false;
    if (reference_open(&options, &v, &s->r, &error) == REFERENCE_OK)
        return true;
    fprintf(stderr, "aligned_frames: %s\n", error.text);
    return false;
}

static void stage_close(stage *s)
{
    reference_close(s->r);
    free(s->voxels);
    free(s->usual);
    free(s->other);
}

static bool draw(stage *s, const way *w, double *rgba, reference_stats *stats)
{
    vodr_error error;
    s->job.accel = w->accel;
    s->job.theta = w->theta;
    s->job.copies = w->copies;
    if (reference_march(s->r, &s->job, rgba, stats, &error) == REFERENCE_OK)
        return true;
    fprintf(stderr, "aligned_frames: %s: %s\n", w->name, error.text);
    return false;
}

static size_t pixels_of(const stage *s)
{
    return (size_t)s->job.camera.width_px * (size_t)s->job.camera.height_px;
}

static double decibels(const double *a, const double *b, size_t pixels)
{
    double squares = 0;
    for (size_t i = 0; i < 4 * pixels; i++)
        squares += (a[i] - b[i]) * (a[i] - b[i]);
    return squares > 0 ? 10 * log10(4 * (double)pixels / squares) : 999;
}

static void add_frame(const stage *s, int round, const reference_stats *stats, double cpu_ms, const double *rgba,
                      tally *t)
{
    t->best_ms = t->drawn ? fmin(t->best_ms, stats->draw_ms) : stats->draw_ms;
    t->worst_ms = fmax(t->worst_ms, stats->draw_ms);
    t->sum_ms += stats->draw_ms;
    t->best_cpu_ms = t->drawn ? fmin(t->best_cpu_ms, cpu_ms) : cpu_ms;
    t->worst_cpu_ms = fmax(t->worst_cpu_ms, cpu_ms);
    t->sum_cpu_ms += cpu_ms;
    t->turn_ms += stats->turn_ms;
    t->round_ms[round] += stats->draw_ms / s->q->frames;
    t->samples += stats->samples;
    t->copies = stats->copies;
    t->drawn++;
    if (round > 0 || rgba == s->usual)
        return;
    const double db = decibels(s->usual, rgba, pixels_of(s));
    t->least_db = t->drawn == 1 ? db : fmin(t->least_db, db);
    for (size_t i = 0; i < pixels_of(s); i++)
        t->differing_px += memcmp(&s->usual[4 * i], &rgba[4 * i], 4 * sizeof *rgba) != 0;
}

static void print_tally(const stage *s, const way *w, tally *t)
{
    const request *q = s->q;
    const size_t rounds = (size_t)(t->drawn / q->frames);
    const double mean_ms = t->sum_ms / t->drawn, samples = (double)t->samples / t->drawn;
    stopwatch_median(t->round_ms, rounds); /* sorts them */
    printf(
        "{\"result\": \"aligned_orbit\", \"device\": \"%s\", \"volume\": \"%s\", \"size_vox\": \"%dx%dx%d\", "
        "\"size_px\": %d, \"frames\": %d, \"times\": %zu, \"way\": \"%s\", \"copies\": %d, \"mean_ms\": %.4f, "
        "\"worst_ms\": %.4f, \"best_ms\": %.4f, \"mean_cpu_ms\": %.4f, \"worst_cpu_ms\": %.4f, \"best_cpu_ms\": %.4f, "
        "\"least_round_ms\": %.4f, \"most_round_ms\": %.4f, \"samples\": %.0f, \"gsamples_s\": %.4f, \"turn_ms\": "
        "%.4f, \"preprocess_ms\": %.1f, \"differing_px\": %llu, \"least_db\": %.2f}\n",
        reference_device_name(s->r), q->volume.name, q->volume.to[0], q->volume.to[1], q->volume.to[2],
        q->volume.side_px, q->frames, rounds, w->name, t->copies, mean_ms, t->worst_ms, t->best_ms,
        t->sum_cpu_ms / t->drawn, t->worst_cpu_ms, t->best_cpu_ms, t->round_ms[0], t->round_ms[rounds - 1], samples,
        samples / mean_ms * 1e-6, t->turn_ms / t->drawn, t->preprocess_ms, (unsigned long long)t->differing_px,
        t->least_db);
}

/* All ways in turn at each view; what copies take falls to a frame that is not counted. */
static bool orbit(stage *s)
{
    static tally tallies[WAYS];
    const request *q = s->q;
    bool good = true, same = true;
    reference_stats stats;
    for (int round = 0; good && round < q->times; round++)
        for (int frame = 0; good && frame < q->frames; frame++) {
            good = stand_in_orbit(&q->volume, frame, q->frames, &s->job.camera);
            for (int i = 0; good && i < (round ? ALWAYS : WAYS); i++) {
                double *rgba = i ? s->other : s->usual;
                double begin_s = stopwatch_cpu_now_s();
                good = draw(s, &ways[i], rgba, &stats);
                if (good && stats.preprocess_ms > 0) {
                    tallies[i].preprocess_ms += stats.preprocess_ms;
                    begin_s = stopwatch_cpu_now_s();
                    good = draw(s, &ways[i], rgba, &stats);
                }
                if (good)
                    add_frame(s, round, &stats, 1e3 * (stopwatch_cpu_now_s() - begin_s), rgba, &tallies[i]);
            }
        }
    for (int i = 0; good && i < WAYS; i++) {
        print_tally(s, &ways[i], &tallies[i]);
        same = same && (ways[i].accel == REFERENCE_ACCEL_ALIGNED_PAPER || tallies[i].differing_px == 0);
    }
    return good && same;
}

/* The recursive filter, and one copy, in a renderer that is new each time; the picture is small. */
static bool prefilter(const request *q)
{
    double ms[MAX_TIMES], cpu_ms[MAX_TIMES], copy_ms[MAX_TIMES];
    bool good = true;
    char device[160] = "";
    for (int i = 0; good && i < q->times; i++) {
        stage s;
        reference_stats usual = {0}, aligned = {0};
        good = stage_open(q, &s) && stand_in_rays(&q->volume, 0, &s.job.camera);
        s.job.camera.width_px = s.job.camera.height_px = 8;
        const double begin_s = stopwatch_cpu_now_s();
        good = good && draw(&s, &ways[0], s.usual, &usual);
        cpu_ms[i] = 1e3 * (stopwatch_cpu_now_s() - begin_s);
        good = good && draw(&s, &ways[1], s.other, &aligned);
        if (good)
            snprintf(device, sizeof device, "%s", reference_device_name(s.r));
        ms[i] = usual.preprocess_ms;
        copy_ms[i] = aligned.preprocess_ms;
        stage_close(&s);
    }
    if (!good)
        return false;
    const double median_ms = stopwatch_median(ms, (size_t)q->times);
    const double median_copy_ms = stopwatch_median(copy_ms, (size_t)q->times);
    stopwatch_median(cpu_ms, (size_t)q->times); /* sorts them */
    printf("{\"result\": \"aligned_prefilter\", \"device\": \"%s\", \"size_vox\": \"%dx%dx%d\", \"ms\": %.3f, "
           "\"least_ms\": %.3f, \"least_cpu_ms\": %.3f, \"copy_ms\": %.3f, \"least_copy_ms\": %.3f}\n",
           device, q->volume.to[0], q->volume.to[1], q->volume.to[2], median_ms, ms[0], cpu_ms[0], median_copy_ms,
           copy_ms[0]);
    return true;
}

/* Each way's picture against that in double precision, which the CPU draws. */
static bool quality(const request *q)
{
    stage s = {0}, exact = {0};
    request on_cpu = *q;
    reference_stats stats;
    bool good = true, near = true;
    on_cpu.device = REFERENCE_CPU;
    good = stage_open(q, &s) && stage_open(&on_cpu, &exact);
    for (int view = 0; good && view < STAND_IN_VIEWS; view++) {
        good = stand_in_rays(&q->volume, view, &s.job.camera);
        exact.job.camera = s.job.camera;
        exact.job.numbers = REFERENCE_DOUBLE;
        good = good && draw(&exact, &ways[0], exact.usual, &stats);
        for (int i = 0; good && i < WAYS; i++) {
            if (ways[i].accel == REFERENCE_ACCEL_ALIGNED_PAPER)
                continue;
            good = draw(&s, &ways[i], s.other, &stats);
            const double db = decibels(exact.usual, s.other, pixels_of(&s));
            near = near && db >= least_db;
            printf(
                "{\"result\": \"aligned_quality\", \"device\": \"%s\", \"volume\": \"%s\", \"view\": \"%s\", \"way\": "
                "\"%s\", \"double_db\": %.2f}\n",
                reference_device_name(s.r), q->volume.name, stand_in_view(view), ways[i].name, db);
        }
    }
    stage_close(&s);
    stage_close(&exact);
    return good && near;
}

static bool launches(stage *s)
{
    reference_stats stats;
    int number = 0;
    bool good = true;
    for (int view = 0; good && view < STAND_IN_VIEWS; view++) {
        good = stand_in_rays(&s->q->volume, view, &s->job.camera);
        for (int i = 0; good && i < WAYS; i++) {
            good = draw(s, &ways[i], s->other, &stats);
            printf("{\"result\": \"aligned_launch\", \"number\": %d, \"volume\": \"%s\", \"view\": \"%s\", \"way\": "
                   "\"%s\"}\n",
                   number++, s->q->volume.name, stand_in_view(view), ways[i].name);
        }
    }
    return good;
}

int main(int argc, char **argv)
{
    request q = {.device = argc > 1 && strcmp(argv[1], "cuda") == 0 ? REFERENCE_CUDA : REFERENCE_CPU};
    const char *what = argc > 2 ? argv[2] : "";
    if (argc == 12 || argc == 13) {
        q.volume = (stand_in){argv[3], argv[4], argv[5], .side_px = atoi(argv[8])};
        q.frames = atoi(argv[9]);
        q.times = atoi(argv[10]);
        q.threads = argc == 13 ? atoi(argv[12]) : 0;
        if (stand_in_size(argv[6], q.volume.from) && stand_in_size(argv[7], q.volume.to) && q.volume.side_px >= 8 &&
            q.volume.side_px <= 4096 && q.frames > 0 && q.frames <= MAX_FRAMES && q.times > 0 && q.times <= MAX_TIMES &&
            sscanf(argv[11], "%lf:%lf", &q.low, &q.high) == 2 && q.low < q.high) {
            stage s;
            if (strcmp(what, "prefilter") == 0)
                return prefilter(&q) ? 0 : 1;
            if (strcmp(what, "quality") == 0)
                return quality(&q) ? 0 : 1;
            const bool good = stage_open(&q, &s) && (strcmp(what, "launches") == 0 ? launches(&s) : orbit(&s));
            stage_close(&s);
            return good ? 0 : 1;
        }
    }
    fputs("usage: aligned_frames cuda|cpu orbit|prefilter|quality|launches NAME VOLUME.raw uint8|int16 FROM TO SIDE_PX "
          "FRAMES TIMES LOW:HIGH [THREADS]\n",
          stderr);
    return 2;
}
