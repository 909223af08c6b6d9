/* cosim_rate.c - cycles a second of the machine in Verilog beside those of the model in C, on one thread, in one run:
 * vodr_top with the memory behind it and nothing else, the same with its events counted, all seven blocks in lock-step
 * with C, the clocked blocks in C, and the recurrences. `whole` needs voxels and is not run alone.
 * Medians of rounds, one way after the other in each. Prints a table in Markdown.
 *   cosim_rate [ROUNDS]    default 5 */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "cosim.h"
#include "cube.h"
#include "jobs.h"
#include "stopwatch.h"
#include "top.h"

static const char program[] = "cosim_rate";

enum { MAX_ROUNDS = 99, SLICES = 16 };

/* How a frame's cycles are come by. */
typedef enum way { RECURRENCES, VERILOG_ALONE, VERILOG_TOP, VERILOG_BLOCKS, CLOCKED, WAY_COUNT } way;

static const job_machine machines[] = {
    {"paper-16", "paper-16", {{0}}},
    {"paper-32", "paper-32", {{0}}},
    {"paper-general", "paper-general", {{0}}},
    {"paper-16, non-blocking", "paper-16", {{"nonblocking", "1"}}},
};

enum { MACHINES = sizeof machines / sizeof *machines };

typedef struct frame {
    const vodr_machine *machine;
    const cube *cube;
    const vodr_view *view;
} frame;

/* vodr_top, what blocks register counted in C; or `alone` for so many cycles, not looked at. */
static bool draw_top(const frame *f, bool alone, uint64_t *cycles, double *time_s)
{
    const voxels_port no_voxels = {.valid = false};
    const texture_unit_in in = {.voxels = &no_voxels};
    const rtl_source source = {.root = VODR_ROOT, .build = VODR_BUILD};
    clocked *machine;
    vodr_error error;
    vodr_frame drawn;
    vodr_counters counters;
    top t;
    if (clocked_start(&machine, f->machine, &f->cube->volume, &f->cube->table, f->view, NULL, &error) != VODR_OK) {
        fprintf(stderr, "%s: %s\n", program, error.text);
        return false;
    }
    bool good = top_open(&t, &source, machine, &error) == RTL_OK;
    if (good) {
        double begin_s = stopwatch_now_s();
        for (uint64_t cycle = 0; alone && cycle < *cycles; cycle++)
            rtl_block_tick(&t.rtl, &in);
        while (!alone && top_step(&t))
            ;
        *time_s = stopwatch_now_s() - begin_s;
        good = clocked_readout(machine, &drawn, &counters, &error) == VODR_OK;
        top_close(&t);
    }
    if (good) {
        *cycles = alone ? *cycles : counters.cycles.total;
        vodr_frame_free(&drawn);
    } else {
        fprintf(stderr, "%s: %s\n", program, error.text);
    }
    clocked_free(machine);
    return good;
}

static void begin(void *begin_s)
{
    *(double *)begin_s = stopwatch_now_s();
}

static bool draw_blocks(const frame *f, uint64_t *cycles, double *time_s)
{
    double begin_s = 0;
    cosim_options options = {.root = VODR_ROOT, .build = VODR_BUILD, .begin = begin, .begin_context = &begin_s};
    vodr_error error;
    vodr_frame drawn;
    vodr_counters counters;
    for (int b = 0; b < VODR_BLOCK_COUNT; b++)
        options.replaced[b] = true;
    if (cosim_render(f->machine, &f->cube->volume, &f->cube->table, f->view, &options, &drawn, &counters, &error) !=
        RTL_OK) {
        fprintf(stderr, "%s: %s\n", program, error.text);
        return false;
    }
    *time_s = stopwatch_now_s() - begin_s;
    *cycles = counters.cycles.total;
    vodr_frame_free(&drawn);
    return true;
}

static bool draw_c(const frame *f, vodr_path path, uint64_t *cycles, double *time_s)
{
    const vodr_options options = {.threads = 1, .path = path, .cycles = true};
    vodr_error error;
    vodr_frame drawn;
    vodr_counters counters;
    double begin_s = stopwatch_now_s();
    if (vodr_render(f->machine, &f->cube->volume, &f->cube->table, f->view, &options, &drawn, &counters, &error) !=
        VODR_OK) {
        fprintf(stderr, "%s: %s\n", program, error.text);
        return false;
    }
    *time_s = stopwatch_now_s() - begin_s;
    *cycles = counters.cycles.total;
    vodr_frame_free(&drawn);
    return true;
}

static bool draw(const frame *f, way w, uint64_t *cycles, double *time_s)
{
    switch (w) {
    case VERILOG_ALONE: return draw_top(f, true, cycles, time_s);
    case VERILOG_TOP: return draw_top(f, false, cycles, time_s);
    case VERILOG_BLOCKS: return draw_blocks(f, cycles, time_s);
    case CLOCKED: return draw_c(f, VODR_PATH_CLOCKED, cycles, time_s);
    default: return draw_c(f, VODR_PATH_FAST, cycles, time_s);
    }
}

/* A row of the table: millions of cycles a second each way. */
static bool print_row(const job_machine *row, frame *f, int rounds)
{
    double times_s[WAY_COUNT][MAX_ROUNDS];
    uint64_t cycles[WAY_COUNT] = {0};
    vodr_machine machine;
    if (!job_machine_make(program, row, &machine))
        return false;
    f->machine = &machine;
    for (int r = -1; r < rounds; r++) /* the first builds what is missing, and is not counted */
        for (int w = 0; w < WAY_COUNT; w++) {
            cycles[w] = cycles[0];
            if (!draw(f, (way)w, &cycles[w], &times_s[w][r < 0 ? 0 : r]))
                return false;
        }
    printf("| %-22s |", row->label);
    for (int w = 0; w < WAY_COUNT; w++) {
        if (cycles[w] != cycles[0]) {
            fprintf(stderr, "%s: %s: %" PRIu64 " cycles one way, %" PRIu64 " another\n", program, row->label, cycles[0],
                    cycles[w]);
            return false;
        }
        if (w == VERILOG_ALONE && machine.traversal == VODR_TRAVERSAL_WHOLE)
            printf(" %14s |", "-");
        else
            printf(" %14.2f |", (double)cycles[w] / stopwatch_median(times_s[w], (size_t)rounds) / 1e6);
    }
    puts("");
    return true;
}

int main(int argc, char **argv)
{
    long rounds = argc > 1 ? strtol(argv[1], NULL, 10) : 5;
    if (argc > 2 || rounds < 1 || rounds > MAX_ROUNDS) {
        fprintf(stderr, "usage: cosim_rate [ROUNDS], 1 to %d\n", MAX_ROUNDS);
        return 2;
    }
    cube c;
    vodr_view view;
    host_error error;
    if (cube_make(&c, &error) != HOST_OK || cube_view(30, 30, &view, &error) != HOST_OK) {
        fprintf(stderr, "%s: %s\n", program, error.text);
        return 3;
    }
    frame f = {.cube = &c, .view = &view};
    bool good = true;
    view.slices = SLICES;
    puts("| M cycles/s             | recurrences, C | vodr_top alone | and counted    | seven blocks   | clocked, C    "
         " |");
    puts("| ---------------------- | -------------: | -------------: | -------------: | -------------: | "
         "-------------: |");
    for (int m = 0; good && m < MACHINES; m++)
        good = print_row(&machines[m], &f, (int)rounds);
    cube_free(&c);
    return good ? 0 : 1;
}
