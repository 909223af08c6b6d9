/* progress.h - a line on the terminal that says how far long work has come. */
#ifndef HOST_PROGRESS_H
#define HOST_PROGRESS_H

#include <stdbool.h>

typedef struct progress {
    const char *label;
    double begin_s;
    int percent; /* as shown; -1: nothing yet */
    bool shown;  /* standard error is a terminal */
} progress;

/* Nothing is shown before a second has passed, nor when standard error is no terminal. */
progress progress_begin(const char *label);

/* `context` is a progress; done is 0 to 1. */
void progress_show(void *context, double done);

/* Takes the line away. */
void progress_end(const progress *p);

/* Seconds since some moment; they never go back. */
double progress_now_s(void);

#endif
