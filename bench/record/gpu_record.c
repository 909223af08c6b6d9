/* gpu_record.c - the reference renderer on a device, held against the machine and timed: lines of JSON, one a result.
 *
 *   gpu_record DEVICE matrix CASES      random frames: fixed against the C model; float, every --accel, against the CPU
 *   gpu_record cuda refuse              a volume that no card has room for
 *   gpu_record DEVICE times SIDE_VOX [VOLUME.raw NAME]
 *                                       milliseconds a frame, made-up volume or SIDE_VOX^3 bytes of a file
 * DEVICE is cuda or cpu. Exit 1 when something differs. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "baseline.h"
#include "camera.h"
#include "cases.h"
#include "outcome.h"
#include "reference.h"
#include "stopwatch.h"

enum { COLUMNS = 256, ROUNDS = 9 };

/* ---- what both parts share ---- */

static bool say(reference_status status, const char *what, const vodr_error *error)
{
    if (status != REFERENCE_OK)
        fprintf(stderr, "gpu_record: %s: %s\n", what, error->text);
    return status == REFERENCE_OK;
}

/* Opacity rises from `first` to the last column; grey. */
static void fill_table(double *rgba, double first, double opacity)
{
    for (int i = 0; i < COLUMNS; i++) {
        double v = (double)i / (COLUMNS - 1), a = v <= first ? 0 : (v - first) / (1 - first) * opacity;
        rgba[4 * i] = a * v;
        rgba[4 * i + 1] = a * (1 - v);
        rgba[4 * i + 2] = a * 0.5;
        rgba[4 * i + 3] = a;
    }
}

typedef struct distance {
    double largest, squares;
    uint64_t channels;
} distance;

static void add_distance(distance *d, const double *a, const double *b, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        double error = fabs(a[i] - b[i]);
        d->largest = error > d->largest || !(error <= 1e30) ? error : d->largest;
        d->squares += error * error;
    }
    d->channels += count;
}

static double decibels(const distance *d)
{
    return d->squares > 0 ? -10 * log10(d->squares / (double)d->channels) : 999;
}

/* ---- matrix ---- */

typedef struct tally {
    uint64_t frames, differ, samples;
    double device_ms, model_ms;
    uint64_t hash;
    uint64_t float_frames, accel_differ, counts_differ;
    distance float_cpu; /* float of the device and of the CPU */
    distance texture_cpu;
    distance float_double[2]; /* by filter: positions that round across a border between voxels show with nearest */
} tally;

static bool draw_fixed(const test_case *c, const reference_volume *v, const reference_options *options, tally *t)
{
    reference *r = NULL;
    outcome model, ours = {0};
    reference_stats stats;
    const vodr_options how = {.threads = 1};
    double begin_s = stopwatch_now_s();
    outcome_draw(c, &c->machine, &how, &model);
    t->model_ms += 1e3 * (stopwatch_now_s() - begin_s);
    bool good =
        say(reference_open(options, v, &r, &ours.error), "open", &ours.error) &&
        say(reference_fixed(r, &c->machine, c->input.map, &c->table, &c->view, &ours.frame, &stats, &ours.error),
            "fixed", &ours.error);
    if (good) {
        t->frames++;
        t->samples += stats.samples;
        t->device_ms += stats.draw_ms;
        t->hash = outcome_hash(t->hash, &ours);
        if (!outcome_same_frame(stderr, &model, &ours)) {
            t->differ++;
            case_print(stderr, c, &c->machine);
        }
    }
    reference_close(r);
    outcome_free(&model);
    outcome_free(&ours);
    return good;
}

/* A job of random choices over a case's view. */
static reference_march_job random_job(test_case *c, double *table)
{
    rng *r = &c->random;
    double most = c->input.voxel_bytes == 1 ? 255 : 65535;
    double spacing[3], finest = fmin(c->geometry.spacing[0], fmin(c->geometry.spacing[1], c->geometry.spacing[2]));
    for (int a = 0; a < 3; a++)
        spacing[a] = c->geometry.spacing[a] / finest;
    bool rays = rng_one_in(r, 2);
    fill_table(table, rng_real(r, 0, 0.9), rng_real(r, 0.01, 1));
    return (reference_march_job){.camera = rays ? reference_camera_rays(&c->view, spacing, rng_real(r, 0.3, 2))
                                                : reference_camera_slices(&c->view),
                                 .blend = rng_one_in(r, 3) ? REFERENCE_MIP : REFERENCE_OVER,
                                 .filter = rng_one_in(r, 4) ? REFERENCE_NEAREST : REFERENCE_LINEAR,
                                 .shading = rng_one_in(r, 2) ? REFERENCE_PHONG : REFERENCE_UNLIT,
                                 .block_vox = (int32_t)rng_int(r, 2, 12),
                                 .termination = rays ? 0.998 : 2,
                                 .table = {.columns = COLUMNS, .rows = 1, .rgba = table},
                                 .window_scale = 1 / most};
}

static bool march(reference *r, reference_march_job job, reference_numbers numbers, reference_accel accel, double *rgba,
                  reference_stats *stats)
{
    vodr_error error;
    job.numbers = numbers;
    job.accel = accel;
    return say(reference_march(r, &job, rgba, stats, &error), "march", &error);
}

/* Every --accel against none. */
static bool accelerate(reference *device, const reference_march_job *job, reference_numbers numbers, double *a,
                       double *b, size_t channels, uint64_t seed, tally *t)
{
    reference_stats stats;
    bool good = march(device, *job, numbers, REFERENCE_ACCEL_NONE, a, &stats);
    for (int accel = REFERENCE_ACCEL_BLOCK; good && accel <= REFERENCE_ACCEL_BEST; accel++) {
        if (!reference_accel_suits((reference_accel)accel, job->blend, job->filter))
            continue;
        good = march(device, *job, numbers, (reference_accel)accel, b, &stats);
        if (good && memcmp(a, b, channels * sizeof *a) != 0) {
            t->accel_differ++;
            fprintf(stderr, "case %llu, numbers %d, accel %d: not the picture of none\n", (unsigned long long)seed,
                    numbers, accel);
        }
    }
    return good;
}

static bool draw_float(test_case *c, const reference_volume *v, const reference_options *options, tally *t)
{
    static const reference_options cpu = {.device = REFERENCE_CPU, .threads = 1};
    static double table[4 * COLUMNS];
    vodr_error error;
    reference *device = NULL, *host = NULL;
    size_t channels = 4 * (size_t)c->view.width_px * (size_t)c->view.height_px;
    double *a = malloc(channels * sizeof *a), *b = malloc(channels * sizeof *b);
    reference_march_job job = random_job(c, table);
    reference_stats none, other;
    bool good = a && b && say(reference_open(options, v, &device, &error), "open", &error) &&
                say(reference_open(&cpu, v, &host, &error), "open", &error) &&
                accelerate(device, &job, REFERENCE_TEXTURE, a, b, channels, c->seed, t) &&
                accelerate(device, &job, REFERENCE_FLOAT, a, b, channels, c->seed, t) &&
                march(device, job, REFERENCE_FLOAT, REFERENCE_ACCEL_NONE, a, &none);
    good = good && march(host, job, REFERENCE_FLOAT, REFERENCE_ACCEL_NONE, b, &other);
    if (good) {
        t->counts_differ += other.samples != none.samples;
        add_distance(&t->float_cpu, a, b, channels);
        t->float_frames++;
    }
    good = good && march(host, job, REFERENCE_DOUBLE, REFERENCE_ACCEL_NONE, b, &other);
    if (good)
        add_distance(&t->float_double[job.filter], a, b, channels);
    good = good && march(device, job, REFERENCE_TEXTURE, REFERENCE_ACCEL_NONE, a, &none) &&
           march(host, job, REFERENCE_TEXTURE, REFERENCE_ACCEL_NONE, b, &other);
    if (good)
        add_distance(&t->texture_cpu, a, b, channels);
    reference_close(device);
    reference_close(host);
    free(a);
    free(b);
    return good;
}

static int matrix(const reference_options *options, int cases)
{
    tally t = {.hash = OUTCOME_HASH_START};
    bool good = true;
    for (int i = 0; i < cases && good; i++) {
        test_case c;
        good = case_make((uint64_t)i + 1, &c);
        reference_volume v = {.type = c.input.voxel_bytes == 1 ? REFERENCE_UINT8 : REFERENCE_UINT16,
                              .voxels = c.input.voxels};
        memcpy(v.dims_vox, c.input.dims_vox, sizeof v.dims_vox);
        good = good && draw_fixed(&c, &v, options, &t) && draw_float(&c, &v, options, &t);
        case_free(&c);
    }
    printf("{\"result\": \"matrix\", \"fixed_frames\": %llu, \"fixed_differ\": %llu, \"fixed_hash\": \"%016llx\", "
           "\"fixed_samples\": %llu, \"fixed_device_ms\": %.3f, \"model_1_thread_ms\": %.3f, \"float_frames\": %llu, "
           "\"accel_differ\": %llu, \"samples_differ\": %llu, \"float_cpu_db\": %.2f, \"float_cpu_max\": %.3g, "
           "\"linear_double_db\": %.2f, \"linear_double_max\": %.3g, \"nearest_double_db\": %.2f, \"texture_cpu_db\": "
           "%.2f, \"texture_cpu_max\": %.3g}\n",
           (unsigned long long)t.frames, (unsigned long long)t.differ, (unsigned long long)t.hash,
           (unsigned long long)t.samples, t.device_ms, t.model_ms, (unsigned long long)t.float_frames,
           (unsigned long long)t.accel_differ, (unsigned long long)t.counts_differ, decibels(&t.float_cpu),
           t.float_cpu.largest, decibels(&t.float_double[REFERENCE_LINEAR]), t.float_double[REFERENCE_LINEAR].largest,
           decibels(&t.float_double[REFERENCE_NEAREST]), decibels(&t.texture_cpu), t.texture_cpu.largest);
    return good && t.differ == 0 && t.accel_differ == 0 ? 0 : 1;
}

/* ---- times ---- */

static uint32_t hash3(uint32_t x, uint32_t y, uint32_t z)
{
    uint32_t h = x * 0x8da6b343u ^ y * 0xd8163841u ^ z * 0xcb1ab31fu;
    h ^= h >> 15;
    h *= 0x2c1b3c6du;
    return h ^ (h >> 12);
}

/* Shells and a little noise in an empty box. */
static void make_volume(uint8_t *voxels, int side)
{
    for (int z = 0; z < side; z++)
        for (int y = 0; y < side; y++)
            for (int x = 0; x < side; x++) {
                double px = (x + 0.5) / side - 0.5, py = (y + 0.5) / side - 0.5, pz = (z + 0.5) / side - 0.5;
                double r = sqrt(px * px + py * py + pz * pz), shell = fabs(sin(24 * r + 2 * sin(9 * px)));
                double d = r < 0.46 ? 40 + 160 * shell * shell * shell : 0;
                *voxels++ = (uint8_t)(d > 0 ? d + hash3((uint32_t)x, (uint32_t)y, (uint32_t)z) % 8 : 0);
            }
}

typedef struct timed {
    const char *method, *numbers_name, *blend_name, *accel_name;
    bool rays;
    reference_numbers numbers;
    reference_blend blend;
    reference_accel accel;
    reference_shading shading;
    double first, opacity; /* of the table */
    double termination;
    int32_t block_vox;
    bool beside_baseline; /* its picture is held against the rival's, and the rival timed */
} timed;

/* Of the rival's picture from ours. A ray that one ends a sample before the other, as they round differently, differs
 * by at most (1 - termination) * opacity. */
static const double farthest = 4 / 255.0;

/* The rival on the same frame, and how far its picture is from ours; 1 where that is too far. */
static int time_baseline(const reference_volume *v, const char *volume_name, const char *view_name,
                         const reference_march_job *job, const double *ours)
{
    vodr_error error;
    double times_ms[ROUNDS], *rgba = malloc(4 * 1024 * 1024 * sizeof *rgba);
    distance d = {0};
    bool good = rgba && say(baseline_draw(v, job, rgba, times_ms, ROUNDS, &error), "baseline", &error);
    if (good) {
        add_distance(&d, rgba, ours, 4 * 1024 * 1024);
        double median = stopwatch_median(times_ms, ROUNDS);
        printf("{\"result\": \"baseline\", \"volume\": \"%s\", \"view\": \"%s\", \"ms\": %.4f, \"least_ms\": %.4f, "
               "\"most_ms\": %.4f, \"max_difference\": %.5f, \"termination\": %g}\n",
               volume_name, view_name, median, times_ms[0], times_ms[ROUNDS - 1], d.largest, job->termination);
    }
    free(rgba);
    if (good && d.largest > farthest)
        fprintf(stderr, "gpu_record: the rival's picture of %s at %s is not ours\n", volume_name, view_name);
    return good && d.largest <= farthest ? 0 : 1;
}

static int time_one(reference *r, const reference_volume *v, const char *volume_name, const vodr_view *view,
                    const char *view_name, const timed *t, double *rgba)
{
    static double table[4 * COLUMNS];
    static const double spacing[3] = {1, 1, 1};
    double times_ms[ROUNDS];
    reference_stats stats = {0};
    fill_table(table, t->first, t->opacity);
    reference_march_job job = {.camera =
                                   t->rays ? reference_camera_rays(view, spacing, 1) : reference_camera_slices(view),
                               .blend = t->blend,
                               .filter = REFERENCE_LINEAR,
                               .shading = t->shading,
                               .block_vox = t->block_vox,
                               .termination = t->termination,
                               .table = {.columns = COLUMNS, .rows = 1, .rgba = table},
                               .window_scale = 1 / 255.0};
    double prepare_ms = 0, preprocess_ms = 0;
    for (int i = -1; i < ROUNDS; i++) {
        if (!march(r, job, t->numbers, t->accel, rgba, &stats))
            return 1;
        prepare_ms = fmax(prepare_ms, stats.prepare_ms);
        preprocess_ms = fmax(preprocess_ms, stats.preprocess_ms);
        if (i >= 0)
            times_ms[i] = stats.draw_ms;
    }
    double median = stopwatch_median(times_ms, ROUNDS);
    printf("{\"result\": \"time\", \"volume\": \"%s\", \"view\": \"%s\", \"size_px\": %d, \"method\": \"%s\", "
           "\"numbers\": "
           "\"%s\", \"blend\": \"%s\", \"accel\": \"%s\", \"shading\": \"%s\", \"ms\": %.4f, \"least_ms\": %.4f, "
           "\"most_ms\": %.4f, \"samples\": %llu, \"gsamples_s\": %.1f, \"prepare_ms\": %.3f, \"preprocess_ms\": %.3f, "
           "\"block_vox\": %d, "
           "\"termination\": %g}\n",
           volume_name, view_name, view->width_px, t->method, t->numbers_name, t->blend_name, t->accel_name,
           t->shading == REFERENCE_PHONG ? "phong" : "none", median, times_ms[0], times_ms[ROUNDS - 1],
           (unsigned long long)stats.samples, (double)stats.samples / median * 1e-6, prepare_ms, preprocess_ms,
           t->block_vox, t->termination);
    fflush(stdout);
    return t->beside_baseline ? time_baseline(v, volume_name, view_name, &job, rgba) : 0;
}

/* Rows: opaque enough to end rays, or so faint that none ends. */
#define FAINT(method, rays, numbers, number)                                                                           \
    {                                                                                                                  \
        method, numbers, "over", "none", rays, number, REFERENCE_OVER, REFERENCE_ACCEL_NONE, 0, 0, 1e-4, 2, 8, false   \
    }
#define MAXIMUM(numbers, number, name, accel)                                                                          \
    {                                                                                                                  \
        "raycast", numbers, "mip", name, true, number, REFERENCE_MIP, accel, 0, 0, 1, 2, 8, false                      \
    }
#define SOLID(numbers, number, name, accel, shading, termination, block_vox, beside)                                   \
    {                                                                                                                  \
        "raycast", numbers, "over", name, true, number, REFERENCE_OVER, accel, shading, 0.3, 0.3, termination,         \
            block_vox, beside                                                                                          \
    }
static const timed rows[] = {
    MAXIMUM("texture", REFERENCE_TEXTURE, "none", REFERENCE_ACCEL_NONE),
    MAXIMUM("float", REFERENCE_FLOAT, "none", REFERENCE_ACCEL_NONE),
    MAXIMUM("texture", REFERENCE_TEXTURE, "best", REFERENCE_ACCEL_BEST),
    MAXIMUM("float", REFERENCE_FLOAT, "best", REFERENCE_ACCEL_BEST),
    FAINT("raycast", true, "texture", REFERENCE_TEXTURE),
    FAINT("slices", false, "texture", REFERENCE_TEXTURE),
    FAINT("raycast", true, "float", REFERENCE_FLOAT),
    FAINT("slices", false, "float", REFERENCE_FLOAT),
    SOLID("texture", REFERENCE_TEXTURE, "none", REFERENCE_ACCEL_NONE, REFERENCE_UNLIT, 0.998, 8, true),
    SOLID("texture", REFERENCE_TEXTURE, "block", REFERENCE_ACCEL_BLOCK, REFERENCE_UNLIT, 0.998, 8, false),
    SOLID("texture", REFERENCE_TEXTURE, "best", REFERENCE_ACCEL_BEST, REFERENCE_UNLIT, 0.998, 8, false),
    SOLID("float", REFERENCE_FLOAT, "best", REFERENCE_ACCEL_BEST, REFERENCE_UNLIT, 0.998, 8, true),
    SOLID("texture", REFERENCE_TEXTURE, "best", REFERENCE_ACCEL_BEST, REFERENCE_UNLIT, 0.99, 8, true),
    SOLID("texture", REFERENCE_TEXTURE, "best", REFERENCE_ACCEL_BEST, REFERENCE_PHONG, 0.998, 8, false),
    SOLID("float", REFERENCE_FLOAT, "best", REFERENCE_ACCEL_BEST, REFERENCE_PHONG, 0.998, 8, false),
    SOLID("texture", REFERENCE_TEXTURE, "best", REFERENCE_ACCEL_BEST, REFERENCE_UNLIT, 0.998, 16, false),
    SOLID("texture", REFERENCE_TEXTURE, "best", REFERENCE_ACCEL_BEST, REFERENCE_UNLIT, 0.998, 4, false),
};

static int times(const reference_options *options, int side, const char *path, const char *name)
{
    static const struct {
        const char *name;
        double azimuth_deg, elevation_deg;
    } views[] = {{"0,0", 0, 0}, {"90,0", 90, 0}, {"0,90", 0, 90}, {"30,30", 30, 30}};
    size_t count = (size_t)side * (size_t)side * (size_t)side;
    uint8_t *voxels = malloc(count);
    double *rgba = malloc(4 * 1024 * 1024 * sizeof *rgba);
    if (!voxels || !rgba)
        return 3;
    if (path) {
        FILE *file = fopen(path, "rb");
        size_t got = file ? fread(voxels, 1, count, file) : 0;
        if (file)
            fclose(file);
        if (got != count) {
            fprintf(stderr, "gpu_record: %s: %zu bytes, must be %zu\n", path, got, count);
            return 2;
        }
    } else {
        make_volume(voxels, side);
    }
    vodr_error error;
    reference_volume v = {.dims_vox = {side, side, side}, .type = REFERENCE_UINT8, .voxels = voxels};
    reference *r = NULL;
    int failed = !say(reference_open(options, &v, &r, &error), "open", &error);
    printf("{\"result\": \"device\", \"name\": \"%s\"}\n", r ? reference_device_name(r) : "none");
    volume geometry = {.spacing = {1, 1, 1}, .axis = {0, 1, 2}, .sign = {1, 1, 1}};
    for (int a = 0; a < 3; a++)
        geometry.dims_vox[a] = side;
    for (size_t at = 0; !failed && at < sizeof views / sizeof *views; at++) {
        camera c = camera_default();
        host_error reason;
        vodr_view view;
        double depth;
        c.azimuth_deg = views[at].azimuth_deg;
        c.elevation_deg = views[at].elevation_deg;
        c.width_px = c.height_px = 1024;
        c.slices = side;
        c.zoom = 1024.0 / side;
        if (camera_view(&c, &geometry, &view, &depth, &reason) != HOST_OK)
            return 2;
        for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
            failed |= time_one(r, &v, name, &view, views[at].name, &rows[i], rgba);
    }
    reference_close(r);
    free(voxels);
    free(rgba);
    return failed;
}

/* A volume that no card has room for is refused by figure, before a voxel of it is read. */
static int refuse(const reference_options *options)
{
    const reference_volume v = {.dims_vox = {VODR_MAX_DIM_VOX, VODR_MAX_DIM_VOX, VODR_MAX_DIM_VOX},
                                .type = REFERENCE_UINT8};
    reference *r = NULL;
    vodr_error error = {{0}};
    reference_status status = reference_open(options, &v, &r, &error);
    printf("{\"result\": \"refused\", \"status\": %d, \"sentence\": \"%s\"}\n", status, error.text);
    reference_close(r);
    return status == REFERENCE_NO_MEMORY ? 0 : 1;
}

int main(int argc, char **argv)
{
    reference_options options = {.device = argc > 1 && strcmp(argv[1], "cuda") == 0 ? REFERENCE_CUDA : REFERENCE_CPU};
    if (argc == 4 && strcmp(argv[2], "matrix") == 0)
        return matrix(&options, atoi(argv[3]));
    if (argc == 3 && strcmp(argv[2], "refuse") == 0)
        return refuse(&options);
    if ((argc == 4 || argc == 6) && strcmp(argv[2], "times") == 0)
        return times(&options, atoi(argv[3]), argc == 6 ? argv[4] : NULL, argc == 6 ? argv[5] : "shells");
    fputs("usage: gpu_record cuda|cpu matrix CASES | refuse | times SIDE_VOX [VOLUME.raw NAME]\n", stderr);
    return 2;
}
