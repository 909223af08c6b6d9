/* stopwatch.h - seconds, and their median. */
#ifndef BENCH_STOPWATCH_H
#define BENCH_STOPWATCH_H

#include <stddef.h>

/* Seconds since some moment; they never go back. */
double stopwatch_now_s(void);

/* The same of the CPU, all threads of the process together. */
double stopwatch_cpu_now_s(void);

/* Sorts `count` times, at least one, and returns the middle one. */
double stopwatch_median(double *times_s, size_t count);

#endif
