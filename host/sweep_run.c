/* sweep_run.c - the points of a sweep drawn by threads. Ranks need no message between them: the file says what is done,
 * and claims in it who is at what. */
#include "sweep_run.h"

#include <pthread.h>
#include <stdlib.h>
#include <unistd.h>

#include "progress.h"
#include "text.h"

enum { MAX_THREADS = 1024 };

typedef struct run {
    sweep_stage *stage;
    const sweep_columns *columns;
    sweep_file *file;
    progress line;
    pthread_mutex_t lock; /* over what follows */
    host_status status;
    host_error error;
} run;

static int variable(const char *name, int least, int fallback)
{
    const char *text = getenv(name);
    int64_t value;
    return text && text_integer(text, least, INT32_MAX, &value) ? (int)value : fallback;
}

sweep_rank sweep_rank_here(void)
{
    sweep_rank r = {.rank = variable("OMPI_COMM_WORLD_RANK", 0, 0),
                    .ranks = variable("OMPI_COMM_WORLD_SIZE", 1, 1),
                    .local_ranks = variable("OMPI_COMM_WORLD_LOCAL_SIZE", 1, 1)};
    if (r.rank >= r.ranks)
        r = (sweep_rank){0, 1, 1};
    return r;
}

static void note_failure(run *r, host_status status, const host_error *error)
{
    pthread_mutex_lock(&r->lock);
    if (r->status == HOST_OK) {
        r->status = status;
        r->error = *error;
    }
    pthread_mutex_unlock(&r->lock);
}

static bool failed(run *r)
{
    pthread_mutex_lock(&r->lock);
    bool is = r->status != HOST_OK;
    pthread_mutex_unlock(&r->lock);
    return is;
}

static host_status draw_point(run *r, uint64_t point, host_error *error)
{
    sweep_sample sample;
    char *line;
    host_status status = sweep_stage_draw(r->stage, point, &sample, error);
    if (status == HOST_OK)
        status = sweep_row_make(r->columns, r->stage, point, &sample, &line, error);
    if (status != HOST_OK)
        return status;
    status = sweep_file_append(r->file, point, line, error);
    free(line);
    return status;
}

static void draw_points(run *r, bool shows)
{
    host_error error;
    for (bool more = true; more && !failed(r);) {
        uint64_t point;
        host_status status = sweep_file_claim(r->file, &point, &more, &error);
        if (status == HOST_OK && more)
            status = draw_point(r, point, &error);
        if (status != HOST_OK)
            note_failure(r, status, &error);
        if (shows)
            progress_show(&r->line, sweep_file_done(r->file));
    }
}

static void *thread_main(void *context)
{
    draw_points(context, false);
    return NULL;
}

static int thread_count(int threads, const sweep_rank *rank, uint64_t points)
{
    long count = threads ? threads : sysconf(_SC_NPROCESSORS_ONLN) / rank->local_ranks;
    if (count > (long)points)
        count = (long)points;
    return count < 1 ? 1 : count > MAX_THREADS ? MAX_THREADS : (int)count;
}

host_status sweep_run(sweep_stage *s, const sweep_columns *c, sweep_file *f, int threads, const sweep_rank *rank,
                      host_error *error)
{
    pthread_t started[MAX_THREADS];
    int count = thread_count(threads, rank, f->plan->points), others = 0;
    run r = {.stage = s, .columns = c, .file = f, .line = progress_begin("sweep")};
    if (rank->rank > 0)
        r.line.shown = false;
    if (pthread_mutex_init(&r.lock, NULL) != 0)
        return host_fail(error, HOST_ENVIRONMENT, "no memory for a lock");
    while (others < count - 1 && pthread_create(&started[others], NULL, thread_main, &r) == 0)
        others++;
    draw_points(&r, true);
    while (others > 0)
        pthread_join(started[--others], NULL);
    progress_end(&r.line);
    pthread_mutex_destroy(&r.lock);
    if (r.status != HOST_OK)
        *error = r.error;
    return r.status;
}
