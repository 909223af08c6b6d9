/* jobs.c - frames of the cube drawn side by side. */
#include "jobs.h"

#include <inttypes.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <unistd.h>

enum { MAX_THREADS = 64 };

typedef struct work {
    const char *program;
    const cube *cube;
    job *jobs;
    size_t count;
    vodr_options options;
    atomic_size_t next;
} work;

bool job_machine_make(const char *program, const job_machine *row, vodr_machine *machine)
{
    vodr_error error;
    vodr_status status = vodr_machine_named(row->machine, machine, &error);
    for (int i = 0; i < JOB_SETTINGS && row->settings[i][0] && status == VODR_OK; i++)
        status = vodr_machine_set(machine, row->settings[i][0], row->settings[i][1], &error);
    if (status != VODR_OK)
        fprintf(stderr, "%s: %s: %s\n", program, row->label, error.text);
    return status == VODR_OK;
}

static void draw(const work *w, job *j)
{
    vodr_frame frame;
    vodr_error error;
    j->drawn = job_machine_make(w->program, j->row, &j->machine);
    if (!j->drawn)
        return;
    vodr_status status =
        vodr_render(&j->machine, &w->cube->volume, &w->cube->table, j->view, &w->options, &frame, &j->counters, &error);
    j->drawn = status == VODR_OK;
    if (!j->drawn)
        fprintf(stderr, "%s: %s: %s\n", w->program, j->row->label, error.text);
    vodr_frame_free(&frame);
}

static void *draw_some(void *argument)
{
    work *w = argument;
    for (size_t i = atomic_fetch_add(&w->next, 1); i < w->count; i = atomic_fetch_add(&w->next, 1))
        draw(w, &w->jobs[i]);
    return NULL;
}

bool jobs_draw(const char *program, const cube *c, job *jobs, size_t count, bool cycles)
{
    work w = {.program = program, .cube = c, .jobs = jobs, .count = count, .options = {.threads = 1, .cycles = cycles}};
    pthread_t threads[MAX_THREADS];
    long cores = sysconf(_SC_NPROCESSORS_ONLN), started = 0;
    atomic_init(&w.next, 0);
    while (started + 1 < cores && started < MAX_THREADS && pthread_create(&threads[started], NULL, draw_some, &w) == 0)
        started++;
    draw_some(&w);
    for (long i = 0; i < started; i++)
        pthread_join(threads[i], NULL);
    bool drawn = true;
    for (size_t i = 0; i < count; i++)
        drawn &= jobs[i].drawn;
    return drawn;
}

const char *job_commas(uint64_t number, char text[32])
{
    char digits[24];
    int n = snprintf(digits, sizeof digits, "%" PRIu64, number), length = 0;
    for (int i = 0; i < n; i++) {
        if (i && (n - i) % 3 == 0)
            text[length++] = ',';
        text[length++] = digits[i];
    }
    text[length] = '\0';
    return text;
}
