/* sweep_file.h - the CSV file of a sweep while it grows, shared by threads and processes.
 *
 * The file is its own record of what is done: a point is done when its row is there. A process claims a point by a
 * POSIX lock on one byte far behind the file's end, which the system gives back whatever ends the process; appending a
 * row, and mending what a killed process left of one, is done under a lock too. So any number of processes on one file
 * system may work on one file, each point is computed once, and whoever comes back from sweep_file_claim() with nothing
 * left knows that all points are done. */
#ifndef HOST_SWEEP_FILE_H
#define HOST_SWEEP_FILE_H

#include <pthread.h>
#include <sys/types.h>

#include "host.h"
#include "sweep_plan.h"

enum { SWEEP_MAX_COLUMNS = 256 };

typedef struct sweep_file {
    const char *path;
    int descriptor;
    const sweep_plan *plan;
    char *head; /* what the file begins with: the JSON lines */
    size_t head_bytes;
    char *columns; /* the line of columns, with its line break */
    size_t fields;
    pthread_mutex_t lock; /* over what follows */
    uint8_t *state;       /* of each point */
    uint64_t done, found; /* found: done before this process began */
    uint64_t turn;        /* where to look for the next point */
    off_t read_bytes;     /* how far rows were read */
    off_t rows_at;        /* where the first row begins */
    bool created;
} sweep_file;

/* The line between JSON and columns that says what `pareto` is of. */
#define SWEEP_OBJECTIVE_LINE "# objective: "

/* Opens or creates `path`. HOST_BAD_INPUT when it is there and is not this sweep's: its head or its columns are others.
 * The file owns head and columns in either case, and is to be closed in either case. first_turn: see sweep_plan_turn().
 */
host_status sweep_file_open(sweep_file *f, const char *path, char *head, char *columns, size_t fields,
                            const sweep_plan *plan, uint64_t first_turn, host_error *error);

/* A point that nobody has done or is at; *more is false when there is none left for this thread. Waits for other
 * processes to finish or die. */
host_status sweep_file_claim(sweep_file *f, uint64_t *point, bool *more, host_error *error);

/* Appends the row of a claimed point, whole or not at all, and gives the claim back. */
host_status sweep_file_append(sweep_file *f, uint64_t point, const char *line, host_error *error);

/* The share of the points that are done. */
double sweep_file_done(sweep_file *f);

void sweep_file_close(sweep_file *f);

#endif
