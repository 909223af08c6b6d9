/* teem_frames.c - the maximum through the cubic filters on the CPU at the places where teem's mrender samples, held
 * against its picture: teem computes in double precision and gives values, not levels.
 *
 *   teem_frames coefficients VOLUME.raw SIDE_VOX OUT.raw
 *   teem_frames cardinal|bspline VOLUME.raw SIDE_VOX PICTURE.raw SIDE_PX RX,RY STEPS THREADS ROUNDS
 * VOLUME: SIDE_VOX^3 bytes. The first writes the coefficients of its B-spline as floats, which teem's own B-spline
 * kernel is given. PICTURE: SIDE_PX^2 doubles of mrender (teem_mip.py of the peers says how its view is made):
 * parallel, the volume turned by RX, then RY degrees, STEPS samples along an edge. Prints a line of JSON: decibels over
 * the range of voxels, milliseconds of `none` and `best`, of a
 * B-spline of `aligned` too. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "prefilter.h"
#include "reference.h"
#include "stopwatch.h"

enum { MAX_ROUNDS = 99 };

/* `count` things of a file, to be freed; NULL after a sentence. */
static void *read_all(const char *path, size_t count, size_t bytes)
{
    unsigned char *all = malloc((count + 1) * bytes);
    FILE *file = fopen(path, "rb");
    const bool good = all && file && fread(all, bytes, count + 1, file) == count;
    if (file)
        fclose(file);
    if (good)
        return all;
    fprintf(stderr, "teem_frames: %s: must hold %zu times %zu bytes\n", path, count, bytes);
    free(all);
    return NULL;
}

static int write_coefficients(const char *path, int side, const char *out)
{
    const size_t count = (size_t)side * (size_t)side * (size_t)side;
    uint8_t *voxels = read_all(path, count, 1);
    float *coefficients = malloc(count * sizeof *coefficients);
    const reference_volume v = {.dims_vox = {side, side, side}, .type = REFERENCE_UINT8, .voxels = voxels};
    FILE *file = fopen(out, "wb");
    bool good = voxels && coefficients && file && prefilter_layers(&v, 0, side, coefficients);
    if (good) {
        prefilter_rows(v.dims_vox, 0, side, coefficients);
        good = fwrite(coefficients, sizeof *coefficients, count, file) == count;
    }
    if (file)
        good = fclose(file) == 0 && good;
    free(voxels);
    free(coefficients);
    return good ? 0 : 1;
}

/* mrender's rays: the eye is in direction r[2] of the middle, r[1] is up and r[0] right; from an edge's length before
 * the middle on. */
static reference_camera rays_of(int side, int side_px, double rx_deg, double ry_deg, int steps)
{
    const double a = rx_deg * acos(-1) / 180, b = ry_deg * acos(-1) / 180, pixel = (double)side / side_px;
    const double r[3][3] = {
        {cos(b), 0, sin(b)}, {sin(a) * sin(b), cos(a), -sin(a) * cos(b)}, {-cos(a) * sin(b), sin(a), cos(a) * cos(b)}};
    reference_camera c = {.width_px = side_px,
                          .height_px = side_px,
                          .spacing = (double)side / steps,
                          .most = 2 * steps + 1,
                          .spacing_vox = {1, 1, 1}};
    for (int i = 0; i < 3; i++) {
        c.origin[1][i] = pixel * r[0][i];
        c.origin[2][i] = -pixel * r[1][i];
        c.origin[0][i] = side / 2.0 + side * r[2][i] - (side_px / 2.0 - 0.5) * (c.origin[1][i] + c.origin[2][i]);
        c.direction[0][i] = -r[2][i];
    }
    return c;
}

typedef struct timing {
    double ms[MAX_ROUNDS], cpu_ms[MAX_ROUNDS];
    uint64_t samples;
} timing;

/* Window of the table: twice the range of bytes on both sides, as samples overshoot. */
static bool draw(reference *r, reference_march_job job, reference_accel accel, double *rgba, int round, timing *t)
{
    reference_stats stats;
    vodr_error error;
    job.accel = accel;
    const double begin_s = stopwatch_cpu_now_s();
    if (reference_march(r, &job, rgba, &stats, &error) != REFERENCE_OK) {
        fprintf(stderr, "teem_frames: %s\n", error.text);
        return false;
    }
    if (round >= 0) {
        t->ms[round] = stats.draw_ms;
        t->cpu_ms[round] = 1e3 * (stopwatch_cpu_now_s() - begin_s);
    }
    t->samples = stats.samples;
    return true;
}

static double decibels(const double *rgba, const double *teem, size_t pixels, double *farthest)
{
    double squares = 0;
    for (size_t i = 0; i < pixels; i++) {
        const double off = (rgba[4 * i + 3] > 0 ? (rgba[4 * i] * 5 - 2) * 255 : 0) - teem[i];
        squares += off * off;
        *farthest = fmax(*farthest, fabs(off));
    }
    return 10 * log10(255 * 255.0 * (double)pixels / squares);
}

static int measure(const char *filter, const uint8_t *voxels, int side, const double *teem, reference_camera camera,
                   int threads, int rounds)
{
    static const double table[8] = {0, 0, 0, 1, 1, 1, 1, 1};
    const bool spline = filter[0] == 'b';
    static timing none, best, aligned;
    const reference_options options = {REFERENCE_CPU, threads, VODR_SIMD_BEST};
    const reference_volume v = {.dims_vox = {side, side, side}, .type = REFERENCE_UINT8, .voxels = voxels};
    const size_t pixels = (size_t)camera.width_px * (size_t)camera.height_px, count = (size_t)rounds;
    const reference_march_job job = {.camera = camera,
                                     .blend = REFERENCE_MIP,
                                     .filter = spline ? REFERENCE_BSPLINE : REFERENCE_CARDINAL,
                                     .block_vox = 8,
                                     .termination = 2,
                                     .table = {2, 1, table, 0},
                                     .window_scale = 1 / (5 * 255.0),
                                     .window_offset = 0.4};
    double *rgba = malloc(4 * pixels * sizeof *rgba), farthest = 0;
    reference *r = NULL;
    vodr_error error;
    bool good = rgba && reference_open(&options, &v, &r, &error) == REFERENCE_OK;
    for (int round = -1; good && round < rounds; round++)
        good = draw(r, job, REFERENCE_ACCEL_NONE, rgba, round, &none) &&
               (!spline || draw(r, job, REFERENCE_ACCEL_ALIGNED, rgba, round, &aligned)) &&
               draw(r, job, REFERENCE_ACCEL_BEST, rgba, round, &best);
    if (good) {
        const double psnr = decibels(rgba, teem, pixels, &farthest);
        const double ms = stopwatch_median(none.ms, count), best_ms = stopwatch_median(best.ms, count);
        const double cpu_ms = stopwatch_median(none.cpu_ms, count), best_cpu_ms = stopwatch_median(best.cpu_ms, count);
        printf("{\"result\": \"teem\", \"device\": \"%s\", \"filter\": \"%s\", \"psnr\": %.2f, \"farthest\": %.6f, "
               "\"none_ms\": %.2f, \"none_cpu_ms\": %.2f, \"best_ms\": %.2f, \"best_cpu_ms\": %.2f, \"none_samples\": "
               "%llu, "
               "\"best_samples\": %llu",
               reference_device_name(r), filter, psnr, farthest, ms, cpu_ms, best_ms, best_cpu_ms,
               (unsigned long long)none.samples, (unsigned long long)best.samples);
        if (spline)
            printf(", \"aligned_ms\": %.2f, \"aligned_cpu_ms\": %.2f", stopwatch_median(aligned.ms, count),
                   stopwatch_median(aligned.cpu_ms, count));
        puts("}");
    }
    reference_close(r);
    free(rgba);
    return good ? 0 : 1;
}

int main(int argc, char **argv)
{
    double rx_deg, ry_deg;
    const int side = argc > 3 ? atoi(argv[3]) : 0;
    if (argc == 5 && strcmp(argv[1], "coefficients") == 0 && side > 0 && side <= 1024)
        return write_coefficients(argv[2], side, argv[4]);
    if (argc == 10 && side > 0 && side <= 1024 && sscanf(argv[6], "%lf,%lf", &rx_deg, &ry_deg) == 2) {
        const int side_px = atoi(argv[5]), steps = atoi(argv[7]), threads = atoi(argv[8]), rounds = atoi(argv[9]);
        if (side_px > 0 && side_px <= 4096 && steps > 0 && steps <= 8192 && rounds > 0 && rounds <= MAX_ROUNDS) {
            uint8_t *voxels = read_all(argv[2], (size_t)side * (size_t)side * (size_t)side, 1);
            double *teem = read_all(argv[4], (size_t)side_px * (size_t)side_px, sizeof *teem);
            const int status = voxels && teem ? measure(argv[1], voxels, side, teem,
                                                        rays_of(side, side_px, rx_deg, ry_deg, steps), threads, rounds)
                                              : 1;
            free(voxels);
            free(teem);
            return status;
        }
    }
    fputs("usage: teem_frames coefficients VOLUME.raw SIDE_VOX OUT.raw | cardinal|bspline VOLUME.raw SIDE_VOX "
          "PICTURE.raw "
          "SIDE_PX RX,RY STEPS THREADS ROUNDS\n",
          stderr);
    return 2;
}
