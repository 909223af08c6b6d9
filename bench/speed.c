/* speed.c - fragments a second on one thread and on all, over the volume of Table 1.
 *
 *   speed [REPEAT]    a table; each figure is the median of REPEAT frames (5) */
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "cube.h"
#include "stopwatch.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

enum { MAX_REPEAT = 99 };

typedef struct row {
    const char *label, *machine;
    double azimuth_deg, elevation_deg;
} row;

static const row rows[] = {
    {"paper-16, view 0,0", "paper-16", 0, 0},
    {"paper-16, view 30,30", "paper-16", 30, 30},
    {"paper-32, view 0,0", "paper-32", 0, 0},
    {"paper-general, view 0,0", "paper-general", 0, 0},
};

/* Fragments a second; 0 after a sentence on standard error. */
static double measure(const cube *c, const row *r, int32_t threads, int repeat)
{
    const vodr_options options = {.threads = threads};
    double times_s[MAX_REPEAT];
    host_error error;
    vodr_error reason;
    vodr_view view;
    vodr_machine machine;
    vodr_counters counters = {0};
    if (cube_view(r->azimuth_deg, r->elevation_deg, &view, &error) != HOST_OK) {
        fprintf(stderr, "speed: %s\n", error.text);
        return 0;
    }
    vodr_status status = vodr_machine_named(r->machine, &machine, &reason);
    for (int i = 0; i < repeat && status == VODR_OK; i++) {
        vodr_frame frame;
        double start_s = stopwatch_now_s();
        status = vodr_render(&machine, &c->volume, &c->table, &view, &options, &frame, &counters, &reason);
        times_s[i] = stopwatch_now_s() - start_s;
        vodr_frame_free(&frame);
    }
    if (status != VODR_OK) {
        fprintf(stderr, "speed: %s: %s\n", r->label, reason.text);
        return 0;
    }
    return (double)counters.fragments / stopwatch_median(times_s, (size_t)repeat);
}

int main(int argc, char **argv)
{
    int repeat = argc == 2 ? atoi(argv[1]) : 5;
    if (argc > 2 || repeat < 1 || repeat > MAX_REPEAT) {
        fprintf(stderr, "usage: speed [REPEAT], REPEAT from 1 to %d\n", MAX_REPEAT);
        return 2;
    }
    cube c;
    host_error error;
    if (cube_make(&c, &error) != HOST_OK) {
        fprintf(stderr, "speed: %s\n", error.text);
        return 3;
    }
    bool good = true;
    printf("| million fragments a second | 1 thread | %ld threads |\n| --- | --- | --- |\n",
           sysconf(_SC_NPROCESSORS_ONLN));
    for (size_t i = 0; i < COUNT(rows); i++) {
        double one = measure(&c, &rows[i], 1, repeat), all = measure(&c, &rows[i], 0, repeat);
        printf("| %s | %.0f | %.0f |\n", rows[i].label, one / 1e6, all / 1e6);
        good &= one > 0 && all > 0;
    }
    cube_free(&c);
    return good ? 0 : 1;
}
