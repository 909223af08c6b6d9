/* cpu_job.c - work in rows, dealt out to threads in bands. */
#include "cpu_job.h"

#include "device.h"

static void *thread_main(void *context)
{
    cpu_job *job = context;
    const int32_t band = job->band > 0 ? job->band : BAND;
    uint64_t samples = 0;
    for (;;) {
        pthread_mutex_lock(&job->lock);
        int32_t begin = job->next, end = job->rows - begin > band ? begin + band : job->rows;
        job->next = end;
        if (begin == end)
            job->samples += samples;
        pthread_mutex_unlock(&job->lock);
        if (begin == end)
            return NULL;
        job->work(job, begin, end, &samples);
    }
}

double cpu_job_run(int32_t threads, cpu_job *job)
{
    pthread_t thread[MAX_THREADS];
    int32_t started = 0;
    double begin_ms = reference_now_ms();
    pthread_mutex_init(&job->lock, NULL);
    while (started < threads - 1 && pthread_create(&thread[started], NULL, thread_main, job) == 0)
        started++;
    thread_main(job);
    while (started > 0)
        pthread_join(thread[--started], NULL);
    pthread_mutex_destroy(&job->lock);
    return reference_now_ms() - begin_ms;
}
