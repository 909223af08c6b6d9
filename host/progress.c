/* progress.c - a line on the terminal that says how far long work has come. */
#include "progress.h"

#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

double progress_now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + (double)t.tv_nsec * 1e-9;
}

progress progress_begin(const char *label)
{
    return (progress){.label = label, .begin_s = progress_now_s(), .percent = -1, .shown = isatty(STDERR_FILENO)};
}

void progress_show(void *context, double done)
{
    progress *p = context;
    int percent = (int)(100 * done);
    if (!p->shown || percent == p->percent || progress_now_s() - p->begin_s < 1)
        return;
    fprintf(stderr, "\r%s: %3d %%", p->label, percent);
    p->percent = percent;
}

void progress_end(const progress *p)
{
    if (p->percent >= 0)
        fprintf(stderr, "\r%*s\r", (int)strlen(p->label) + 7, "");
}
