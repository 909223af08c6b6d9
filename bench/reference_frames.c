/* reference_frames.c - milliseconds a frame of the reference renderer on the CPU, as vtk_fixedpoint.py of the peers
 * measures them: parallel rays, a sample a voxel, the first frame left out.
 *
 *   reference_frames VOLUME.raw SIDE_VOX TABLE.raw SIDE_PX AZ,EL composite|shaded|mip THREADS FRAMES [none|block|best]
 * VOLUME: SIDE_VOX^3 bytes. TABLE: 256 entries of r, g, b, opacity of a voxel's depth, a byte each; mip draws grey. A
 * frame is all of reference_march(). Prints a line of JSON: medians, and the sum of the picture's bytes. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "camera.h"
#include "reference.h"
#include "stopwatch.h"

enum { COLUMNS = 256, MAX_FRAMES = 999, MAX_SIDE = 1024, BLOCK_VOX = 8 };

typedef struct request {
    int side_vox, side_px, threads, frames;
    double azimuth_deg, elevation_deg;
    const char *mode, *accel;
} request;

/* `count` bytes of a file, to be freed; NULL after a sentence. */
static uint8_t *read_bytes(const char *path, size_t count)
{
    uint8_t *bytes = malloc(count + 1);
    FILE *file = fopen(path, "rb");
    size_t got = bytes && file ? fread(bytes, 1, count + 1, file) : 0;
    if (file)
        fclose(file);
    if (got == count)
        return bytes;
    fprintf(stderr, "reference_frames: %s: must be a file of %zu bytes\n", path, count);
    free(bytes);
    return NULL;
}

static void fill_table(const uint8_t *entries, bool grey, double *rgba)
{
    for (int i = 0; i < COLUMNS; i++) {
        double opacity = grey ? 1 : entries[4 * i + 3] / 255.0;
        for (int c = 0; c < 3; c++)
            rgba[4 * i + c] = opacity * (grey ? i : entries[4 * i + c]) / 255.0;
        rgba[4 * i + 3] = opacity;
    }
}

static bool make_rays(const request *q, reference_camera *rays)
{
    static const double spacing[3] = {1, 1, 1};
    const volume geometry = {.dims_vox = {q->side_vox, q->side_vox, q->side_vox},
                             .spacing = {1, 1, 1},
                             .axis = {0, 1, 2},
                             .sign = {1, 1, 1}};
    camera c = camera_default();
    host_error reason;
    vodr_view view;
    double depth;
    c.azimuth_deg = q->azimuth_deg;
    c.elevation_deg = q->elevation_deg;
    c.width_px = c.height_px = q->side_px;
    c.slices = q->side_vox;
    c.zoom = (double)q->side_px / q->side_vox;
    if (camera_view(&c, &geometry, &view, &depth, &reason) != HOST_OK) {
        fprintf(stderr, "reference_frames: %s\n", reason.text);
        return false;
    }
    *rays = reference_camera_rays(&view, spacing, 1);
    return true;
}

static bool make_job(const request *q, const double *table, reference_march_job *job)
{
    static const struct {
        const char *name;
        reference_accel accel;
    } accels[] = {{"none", REFERENCE_ACCEL_NONE}, {"block", REFERENCE_ACCEL_BLOCK}, {"best", REFERENCE_ACCEL_BEST}};
    int i = 0;
    while (i < 2 && strcmp(q->accel, accels[i].name) != 0)
        i++;
    *job = (reference_march_job){.blend = strcmp(q->mode, "mip") == 0 ? REFERENCE_MIP : REFERENCE_OVER,
                                 .filter = REFERENCE_LINEAR,
                                 .shading = strcmp(q->mode, "shaded") == 0 ? REFERENCE_PHONG : REFERENCE_UNLIT,
                                 .accel = accels[i].accel,
                                 .block_vox = BLOCK_VOX,
                                 .termination = 0.998,
                                 .table = {.columns = COLUMNS, .rows = 1, .rgba = table},
                                 .window_scale = 1 / 255.0};
    return make_rays(q, &job->camera);
}

static double cpu_now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static uint64_t hash_of(const double *rgba, size_t channels)
{
    uint64_t hash = 0xCBF29CE484222325;
    for (size_t i = 0; i < channels * sizeof *rgba; i++)
        hash = (hash ^ ((const uint8_t *)rgba)[i]) * 0x100000001B3;
    return hash;
}

/* Draws the frames and says how long they took. */
static bool draw(const request *q, reference *r, const reference_march_job *job, double *rgba)
{
    double wall_s[MAX_FRAMES], cpu_s[MAX_FRAMES];
    size_t count = (size_t)q->frames;
    reference_stats stats, first = {0};
    vodr_error error;
    for (int i = -1; i < q->frames; i++) {
        double begin_s = stopwatch_now_s(), cpu_begin_s = cpu_now_s();
        if (reference_march(r, job, rgba, &stats, &error) != REFERENCE_OK) {
            fprintf(stderr, "reference_frames: %s\n", error.text);
            return false;
        }
        if (i < 0) {
            first = stats;
            continue;
        }
        wall_s[i] = stopwatch_now_s() - begin_s;
        cpu_s[i] = cpu_now_s() - cpu_begin_s;
    }
    double ms = 1e3 * stopwatch_median(wall_s, count), cpu_ms = 1e3 * stopwatch_median(cpu_s, count);
    printf(
        "{\"tool\": \"vodr\", \"device\": \"%s\", \"mode\": \"%s\", \"accel\": \"%s\", \"ms\": %.2f, \"ms_min\": %.2f, "
        "\"ms_max\": %.2f, \"cpu_ms\": %.2f, \"cpu_ms_min\": %.2f, \"first_ms\": %.2f, \"samples\": %llu, "
        "\"hash\": \"%016llx\"}\n",
        reference_device_name(r), q->mode, q->accel, ms, 1e3 * wall_s[0], 1e3 * wall_s[count - 1], cpu_ms,
        1e3 * cpu_s[0], first.preprocess_ms + first.prepare_ms + first.draw_ms, (unsigned long long)stats.samples,
        (unsigned long long)hash_of(rgba, 4 * (size_t)q->side_px * (size_t)q->side_px));
    return true;
}

static bool run(const request *q, const char *volume_path, const char *table_path)
{
    static double table[4 * COLUMNS];
    size_t side = (size_t)q->side_vox, pixels = (size_t)q->side_px * (size_t)q->side_px;
    uint8_t *voxels = read_bytes(volume_path, side * side * side);
    uint8_t *entries = read_bytes(table_path, 4 * COLUMNS);
    double *rgba = malloc(4 * pixels * sizeof *rgba);
    reference_march_job job;
    reference *r = NULL;
    vodr_error error;
    bool good = voxels && entries && rgba;
    if (good) {
        const reference_options options = {.device = REFERENCE_CPU, .threads = q->threads};
        const reference_volume v = {
            .dims_vox = {q->side_vox, q->side_vox, q->side_vox}, .type = REFERENCE_UINT8, .voxels = voxels};
        fill_table(entries, strcmp(q->mode, "mip") == 0, table);
        good = make_job(q, table, &job) && reference_open(&options, &v, &r, &error) == REFERENCE_OK &&
               draw(q, r, &job, rgba);
    }
    reference_close(r);
    free(voxels);
    free(entries);
    free(rgba);
    return good;
}

int main(int argc, char **argv)
{
    request q = {.accel = "best"};
    if (argc == 9 || argc == 10) {
        q = (request){.side_vox = atoi(argv[2]),
                      .side_px = atoi(argv[4]),
                      .threads = atoi(argv[7]),
                      .frames = atoi(argv[8]),
                      .mode = argv[6],
                      .accel = argc == 10 ? argv[9] : "best"};
        if (sscanf(argv[5], "%lf,%lf", &q.azimuth_deg, &q.elevation_deg) == 2 && q.side_vox > 0 &&
            q.side_vox <= MAX_SIDE && q.side_px > 0 && q.side_px <= MAX_SIDE && q.threads > 0 && q.frames > 0 &&
            q.frames <= MAX_FRAMES)
            return run(&q, argv[1], argv[3]) ? 0 : 1;
    }
    fputs("usage: reference_frames VOLUME.raw SIDE_VOX TABLE.raw SIDE_PX AZ,EL composite|shaded|mip THREADS FRAMES "
          "[none|block|best]\n",
          stderr);
    return 2;
}
