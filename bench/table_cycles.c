/* table_cycles.c - cycles a frame: what dividing the volume, a non-blocking cache and the memory's latency do to time,
 * over the volume of Table 1; and what counting them costs.
 *
 *   table_cycles [frames|speed]    both, or one; exit 1 when a frame's cycles do not add up */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "jobs.h"
#include "stopwatch.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

static const char program[] = "table_cycles";

enum { VIEWS = 2, LATENCIES = 4, REPEAT = 15, CLOCKED_SLICES = 16 };

static const double view_angles_deg[VIEWS][2] = {{0, 0}, {30, 30}};
static const char *const latencies[LATENCIES] = {"20", "50", "100", "200"};

static const job_machine orders[] = {
    {"undivided (paper-general)", "paper-general", {{0}}},
    {"layer (paper-16)", "paper-16", {{0}}},
    {"column", "paper-16", {{"traversal", "column"}}},
    {"tile", "paper-16", {{"traversal", "tile"}}},
    {"undivided, non-blocking", "paper-general", {{"nonblocking", "1"}}},
    {"layer, non-blocking", "paper-16", {{"nonblocking", "1"}}},
    {"column, non-blocking", "paper-16", {{"traversal", "column"}, {"nonblocking", "1"}}},
    {"tile, non-blocking", "paper-16", {{"traversal", "tile"}, {"nonblocking", "1"}}},
};

static const job_machine timed[] = {
    {"paper-16", "paper-16", {{0}}},
    {"paper-32", "paper-32", {{0}}},
    {"paper-general", "paper-general", {{0}}},
    {"tile", "paper-16", {{"traversal", "tile"}}},
    {"paper-16, non-blocking", "paper-16", {{"nonblocking", "1"}}},
    {"paper-16, DRAM", "paper-16", {{"memory", "dram"}}},
    {"paper-16, written through", "paper-16", {{"write_policy", "through"}}},
};

/* ---- cycles a frame ---- */

static bool adds_up(const job *j)
{
    const vodr_cycles *c = &j->counters.cycles;
    bool good = c->total >= j->counters.fragments;
    for (int i = 0; i < VODR_BLOCK_COUNT; i++)
        good &= c->blocks[i].busy + c->blocks[i].stalled + c->blocks[i].idle == c->total;
    if (!good)
        fprintf(stderr, "%s: %s: the cycles of a block do not add up to the total\n", program, j->row->label);
    return good;
}

static bool print_view(const job *jobs, int view)
{
    bool good = true;
    printf("| view %2.0f,%-2.0f: cycles (a fragment) |", view_angles_deg[view][0], view_angles_deg[view][1]);
    for (int l = 0; l < LATENCIES; l++)
        printf(" latency %-11s |", latencies[l]);
    printf("\n| ------------------------------- |");
    for (int l = 0; l < LATENCIES; l++)
        printf(" ------------------: |");
    puts("");
    for (size_t i = 0; i < COUNT(orders); i++) {
        printf("| %-31s |", orders[i].label);
        for (int l = 0; l < LATENCIES; l++) {
            const job *j = &jobs[i * LATENCIES + (size_t)l];
            const uint64_t total = j->counters.cycles.total;
            char text[32];
            printf(" %11s (%5.2f) |", job_commas(total, text), (double)total / (double)j->counters.fragments);
            good &= adds_up(j);
        }
        puts("");
    }
    return good;
}

static bool print_frames(const cube *c, const vodr_view views[VIEWS])
{
    enum { EACH = COUNT(orders) * LATENCIES };
    job_machine machines[EACH];
    job jobs[VIEWS * EACH];
    for (size_t i = 0; i < EACH; i++) {
        int n = 0;
        machines[i] = orders[i / LATENCIES];
        while (machines[i].settings[n][0])
            n++;
        machines[i].settings[n][0] = "mem_latency_cycles";
        machines[i].settings[n][1] = latencies[i % LATENCIES];
    }
    for (size_t i = 0; i < COUNT(jobs); i++)
        jobs[i] = (job){.row = &machines[i % EACH], .view = &views[i / EACH]};
    if (!jobs_draw(program, c, jobs, COUNT(jobs), true))
        return false;
    bool good = true;
    for (int v = 0; v < VIEWS; v++) {
        if (v)
            puts("");
        good &= print_view(jobs + v * EACH, v);
    }
    return good;
}

/* ---- what counting costs ---- */

/* Seconds that a frame takes; 0 after a sentence on standard error. */
static double draw_once(const cube *c, const vodr_machine *m, const vodr_view *view, const vodr_options *options,
                        uint64_t *cycles)
{
    vodr_frame frame;
    vodr_counters counters;
    vodr_error error;
    double start_s = stopwatch_now_s();
    vodr_status status = vodr_render(m, &c->volume, &c->table, view, options, &frame, &counters, &error);
    double time_s = stopwatch_now_s() - start_s;
    if (status != VODR_OK)
        fprintf(stderr, "%s: %s\n", program, error.text);
    *cycles = counters.cycles.total;
    vodr_frame_free(&frame);
    return status == VODR_OK ? time_s : 0;
}

/* Without and with cycles in turn, so that both meet the same computer. */
static bool print_cost_row(const cube *c, const job_machine *row, const double angles_deg[2], const vodr_view *view)
{
    static const vodr_options plain = {.threads = 2}, counting = {.threads = 2, .cycles = true};
    double without_s[REPEAT], with_s[REPEAT];
    uint64_t cycles;
    vodr_machine m;
    bool good = job_machine_make(program, row, &m);
    for (int i = 0; i < REPEAT && good; i++) {
        without_s[i] = draw_once(c, &m, view, &plain, &cycles);
        with_s[i] = draw_once(c, &m, view, &counting, &cycles);
        good = without_s[i] > 0 && with_s[i] > 0;
    }
    if (!good)
        return false;
    double before_s = stopwatch_median(without_s, REPEAT), after_s = stopwatch_median(with_s, REPEAT);
    printf("| %s | %.0f,%.0f | %.0f | %.0f | %+.0f %% | %.0f |\n", row->label, angles_deg[0], angles_deg[1],
           1e3 * before_s, 1e3 * after_s, 100 * (after_s / before_s - 1), 1e-6 * (double)cycles / after_s);
    return true;
}

/* The clocked machine over the first slices of a frame, which is enough of them to tell its speed. */
static bool print_clocked(const cube *c, const vodr_view *whole_view)
{
    const vodr_options clocked = {.path = VODR_PATH_CLOCKED, .cycles = true};
    vodr_view view = *whole_view;
    vodr_machine m;
    uint64_t cycles;
    view.slices = CLOCKED_SLICES;
    if (!job_machine_make(program, &timed[0], &m))
        return false;
    double time_s = draw_once(c, &m, &view, &clocked, &cycles);
    if (time_s > 0)
        printf("\nThe clocked machine, one thread, %s, %d slices: %.1f million cycles/s.\n", timed[0].label,
               CLOCKED_SLICES, 1e-6 * (double)cycles / time_s);
    return time_s > 0;
}

static bool print_speed(const cube *c, const vodr_view views[VIEWS])
{
    bool good = true;
    puts("| 2 threads | view | without, ms | with cycles, ms | on top | million cycles/s |\n"
         "| --- | --- | ---: | ---: | ---: | ---: |");
    for (size_t i = 0; i < COUNT(timed) * VIEWS && good; i++)
        good = print_cost_row(c, &timed[i / VIEWS], view_angles_deg[i % VIEWS], &views[i % VIEWS]);
    return good && print_clocked(c, &views[0]);
}

int main(int argc, char **argv)
{
    const char *which = argc == 2 ? argv[1] : "";
    bool frames = argc == 1 || strcmp(which, "frames") == 0, speed = argc == 1 || strcmp(which, "speed") == 0;
    if (!frames && !speed) {
        fputs("usage: table_cycles [frames|speed]\n", stderr);
        return 2;
    }
    cube c;
    vodr_view views[VIEWS];
    host_error error;
    host_status status = cube_make(&c, &error);
    for (int v = 0; v < VIEWS && status == HOST_OK; v++)
        status = cube_view(view_angles_deg[v][0], view_angles_deg[v][1], &views[v], &error);
    if (status != HOST_OK) {
        fprintf(stderr, "%s: %s\n", program, error.text);
        return 3;
    }
    bool good = true;
    if (frames)
        good &= print_frames(&c, views);
    if (argc == 1)
        puts("");
    if (speed)
        good &= print_speed(&c, views);
    cube_free(&c);
    return good ? 0 : 1;
}
