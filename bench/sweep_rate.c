/* sweep_rate.c - what `vodr sweep` adds to the drawing itself: a sweep of 10,000 points of a 64^3 volume at 64x64
 * pixels and 64 slices, beside vodr_render() in a loop over the same points on as many threads.
 *
 *   sweep_rate VODR [ROUNDS]    frames a second and processor time of both, and the ratios; ROUNDS of each in turn (3)
 */
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <spawn.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "scene.h"
#include "stopwatch.h"

enum { VOX = 64, VIEWS = 100, CACHES = 4, WAYS = 5, LINES = 5, MAX_THREADS = 64, MAX_ROUNDS = 99 };
enum { MACHINES = CACHES * WAYS * LINES, POINTS = VIEWS * MACHINES };

static const char *const caches[CACHES] = {"2048", "4096", "8192", "16384"};
static const char *const ways[WAYS] = {"1", "2", "4", "8", "16"};
static const char *const lines[LINES] = {"16x1", "8x1", "4x2", "4x4", "2x2"};

extern char **environ;

typedef struct raw {
    scene scene;
    vodr_machine machines[MACHINES];
    vodr_view views[VIEWS];
    atomic_int next, failed;
} raw;

/* Shells of density about the middle. */
static bool write_volume(const char *path)
{
    static uint8_t voxels[VOX][VOX][VOX];
    for (int z = 0; z < VOX; z++)
        for (int y = 0; y < VOX; y++)
            for (int x = 0; x < VOX; x++) {
                int dx = x - VOX / 2, dy = y - VOX / 2, dz = z - VOX / 2;
                voxels[z][y][x] = (uint8_t)((dx * dx + dy * dy + dz * dz) / 4);
            }
    FILE *file = fopen(path, "wb");
    bool good = file && fwrite(voxels, sizeof voxels, 1, file) == 1;
    return file && fclose(file) == 0 && good;
}

static bool make_points(raw *r, const char *path, host_error *error)
{
    view_options options = view_options_default();
    double depth_vox;
    options.volume.dims_vox[0] = options.volume.dims_vox[1] = options.volume.dims_vox[2] = VOX;
    if (scene_open(path, &options, &r->scene, error) != HOST_OK)
        return false;
    for (int i = 0; i < VIEWS; i++) {
        camera c = camera_default();
        c.azimuth_deg = 360.0 * i / VIEWS;
        if (camera_view(&c, &r->scene.volume, &r->views[i], &depth_vox, error) != HOST_OK)
            return false;
    }
    for (int i = 0; i < MACHINES; i++) {
        vodr_machine *m = &r->machines[i];
        *m = r->scene.machine;
        if (vodr_machine_set(m, "cache_bytes", caches[i % CACHES], NULL) != VODR_OK ||
            vodr_machine_set(m, "ways", ways[i / CACHES % WAYS], NULL) != VODR_OK ||
            vodr_machine_set(m, "line_px", lines[i / CACHES / WAYS], NULL) != VODR_OK)
            return false;
    }
    return true;
}

static void *draw(void *context)
{
    raw *r = context;
    const vodr_options how = {.threads = 1};
    for (int i = atomic_fetch_add(&r->next, 1); i < POINTS; i = atomic_fetch_add(&r->next, 1)) {
        vodr_frame frame;
        vodr_counters counters;
        vodr_error reason;
        if (vodr_render(&r->machines[i / VIEWS], &r->scene.densities, &r->scene.table, &r->views[i % VIEWS], &how,
                        &frame, &counters, &reason) != VODR_OK)
            atomic_store(&r->failed, 1);
        vodr_frame_free(&frame);
    }
    return NULL;
}

static double time_raw(raw *r)
{
    pthread_t threads[MAX_THREADS];
    long cores = sysconf(_SC_NPROCESSORS_ONLN), started = 0;
    double begin_s = stopwatch_now_s();
    atomic_store(&r->next, 0);
    while (started + 1 < cores && started < MAX_THREADS && pthread_create(&threads[started], NULL, draw, r) == 0)
        started++;
    draw(r);
    while (started > 0)
        pthread_join(threads[--started], NULL);
    return stopwatch_now_s() - begin_s;
}

/* "NAME=A,B,C" */
static void join(const char *name, const char *const *values, int count, char *text, size_t size)
{
    size_t used = (size_t)snprintf(text, size, "%s=", name);
    for (int i = 0; i < count; i++)
        used += (size_t)snprintf(text + used, size - used, "%s%s", i ? "," : "", values[i]);
}

/* The whole command, from its start to its end; negative when it failed. */
static double time_sweep(char *vodr, char *shells, char *out)
{
    char c[64], w[64], l[64], orbit[32];
    join("cache_bytes", caches, CACHES, c, sizeof c);
    join("ways", ways, WAYS, w, sizeof w);
    join("line_px", lines, LINES, l, sizeof l);
    snprintf(orbit, sizeof orbit, "view=orbit:%d", VIEWS);
    char sweep[] = "sweep", dims[] = "--dims", size[] = "64x64x64", over[] = "--over", to[] = "-o";
    char *const argv[] = {vodr, sweep, shells, dims, size, over, c, over, w, over, l, over, orbit, to, out, NULL};
    posix_spawn_file_actions_t actions;
    pid_t child;
    int status = -1;
    unlink(out);
    double begin_s = stopwatch_now_s();
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    if (posix_spawn(&child, vodr, &actions, NULL, argv, environ) == 0)
        waitpid(child, &status, 0);
    posix_spawn_file_actions_destroy(&actions);
    return status == 0 ? stopwatch_now_s() - begin_s : -1;
}

/* Of this process, or of those it waited for. */
static double processor_s(int who)
{
    struct rusage u;
    getrusage(who, &u);
    return (double)(u.ru_utime.tv_sec + u.ru_stime.tv_sec) + 1e-6 * (double)(u.ru_utime.tv_usec + u.ru_stime.tv_usec);
}

static void print_row(const char *name, double wall_s, double cpu_s)
{
    printf("| %s | %.2f | %.0f | %.2f |\n", name, wall_s, POINTS / wall_s, cpu_s);
}

static bool measure(raw *r, char *vodr, char *shells, char *out, int rounds)
{
    double raw_s[MAX_ROUNDS], sweep_s[MAX_ROUNDS], raw_cpu_s[MAX_ROUNDS], sweep_cpu_s[MAX_ROUNDS];
    for (int i = 0; i < rounds; i++) {
        raw_cpu_s[i] = -processor_s(RUSAGE_SELF);
        raw_s[i] = time_raw(r);
        raw_cpu_s[i] += processor_s(RUSAGE_SELF);
        sweep_cpu_s[i] = -processor_s(RUSAGE_CHILDREN);
        sweep_s[i] = time_sweep(vodr, shells, out);
        sweep_cpu_s[i] += processor_s(RUSAGE_CHILDREN);
        if (sweep_s[i] < 0 || atomic_load(&r->failed)) {
            fprintf(stderr, "sweep_rate: %s failed\n", sweep_s[i] < 0 ? vodr : "vodr_render()");
            return false;
        }
    }
    const size_t n = (size_t)rounds;
    double drawing = stopwatch_median(raw_s, n), sweeping = stopwatch_median(sweep_s, n);
    double drawing_cpu = stopwatch_median(raw_cpu_s, n), sweeping_cpu = stopwatch_median(sweep_cpu_s, n);
    printf("| %d points of %d^3, %ld threads | seconds | frames a second | processor seconds |\n"
           "| --- | --- | --- | --- |\n",
           POINTS, VOX, sysconf(_SC_NPROCESSORS_ONLN));
    print_row("`vodr_render()` in a loop", drawing, drawing_cpu);
    print_row("`vodr sweep`", sweeping, sweeping_cpu);
    printf("\nThe sweep runs at %.1f %% of the loop's rate, by processor time %.1f %% (medians of %d).\n",
           100 * drawing / sweeping, 100 * drawing_cpu / sweeping_cpu, rounds);
    return true;
}

int main(int argc, char **argv)
{
    static raw r;
    host_error error = {""};
    char directory[] = "/tmp/vodr-sweep-XXXXXX", shells[64], out[64];
    int rounds = argc > 2 ? atoi(argv[2]) : 3;
    if (argc < 2 || argc > 3 || rounds < 1 || rounds > MAX_ROUNDS) {
        fprintf(stderr, "usage: sweep_rate VODR [ROUNDS], ROUNDS from 1 to %d\n", MAX_ROUNDS);
        return 2;
    }
    if (!mkdtemp(directory)) {
        fprintf(stderr, "sweep_rate: cannot write to /tmp: %s\n", strerror(errno));
        return 3;
    }
    snprintf(shells, sizeof shells, "%s/shells.raw", directory);
    snprintf(out, sizeof out, "%s/sweep.csv", directory);
    bool good = write_volume(shells) && make_points(&r, shells, &error);
    if (!good)
        fprintf(stderr, "sweep_rate: cannot make the points: %s\n", error.text);
    good = good && measure(&r, argv[1], shells, out, rounds);
    scene_close(&r.scene);
    unlink(out);
    unlink(shells);
    rmdir(directory);
    return good ? 0 : 1;
}
