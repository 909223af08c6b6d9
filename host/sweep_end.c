/* sweep_end.c - the end of a sweep: its file in order, the front marked. */
#include "sweep_end.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "csv.h"
#include "output.h"
#include "text.h"

/* A second stream on the file would give back this process's locks when closed: the end reads with pread() alone. */
typedef struct reader {
    const sweep_file *file;
    char *line; /* without its line break */
    size_t room;
} reader;

static host_status fail(const reader *r, host_error *error)
{
    return host_fail(error, HOST_ENVIRONMENT, "cannot read '%s': %s", r->file->path, strerror(errno));
}

/* The line at `at`; *next: the one after it. Lines are whole, and the last ends with a line break. */
static host_status read_line(reader *r, off_t at, off_t *next, host_error *error)
{
    for (;;) {
        ssize_t n = r->room ? pread(r->file->descriptor, r->line, r->room, at) : 0;
        char *end = n > 0 ? memchr(r->line, '\n', (size_t)n) : NULL;
        if (n < 0)
            return fail(r, error);
        if (end) {
            *end = '\0';
            *next = at + (end - r->line) + 1;
            return HOST_OK;
        }
        if (r->room && n < (ssize_t)r->room)
            return host_fail(error, HOST_ENVIRONMENT, "cannot read '%s': it became shorter", r->file->path);
        size_t room = r->room ? 2 * r->room : 2048;
        char *grown = realloc(r->line, room);
        if (!grown)
            return host_fail(error, HOST_ENVIRONMENT, "no memory to read '%s'", r->file->path);
        r->line = grown;
        r->room = room;
    }
}

/* ---- reading ---- */

/* Its column `refused` is the last but one. */
static void take_row(sweep_rows *r, char *line, size_t fields, off_t at, const size_t *columns, size_t count)
{
    char *values[SWEEP_MAX_COLUMNS];
    csv_split(line, values, SWEEP_MAX_COLUMNS);
    const size_t point = (size_t)strtoull(values[0], NULL, 10);
    r->at[point] = at;
    r->refused += values[fields - 2][0] != '\0';
    for (size_t i = 0; i < count; i++) {
        double number = NAN;
        text_number(values[columns[i]], -HUGE_VAL, HUGE_VAL, &number);
        r->values[point * count + i] = values[fields - 2][0] ? NAN : number;
    }
}

static host_status read_all(sweep_rows *r, const sweep_file *f, const size_t *columns, size_t count, host_error *error)
{
    reader in = {.file = f};
    host_status status = HOST_OK;
    off_t next;
    uint64_t expected = 0;
    r->in_order = true;
    for (off_t at = f->rows_at; status == HOST_OK && at < f->read_bytes; at = next) {
        status = read_line(&in, at, &next, error);
        if (status != HOST_OK)
            break;
        r->in_order = r->in_order && strtoull(in.line, NULL, 10) == expected++;
        take_row(r, in.line, f->fields, at, columns, count);
    }
    free(in.line);
    return status;
}

/* The front of the objectives among the values. */
static host_status mark(sweep_rows *r, size_t count, const sweep_objectives *o, host_error *error)
{
    double *values = malloc((size_t)r->count * o->count * sizeof *values);
    if (!values)
        return host_fail(error, HOST_ENVIRONMENT, "no memory for the sweep's rows");
    for (uint64_t i = 0; i < r->count; i++)
        memcpy(values + i * o->count, r->values + i * count, o->count * sizeof *values);
    host_status status = sweep_front(values, (size_t)r->count, o, r->marks, error);
    for (uint64_t i = 0; i < r->count; i++)
        r->front += r->marks[i];
    free(values);
    return status;
}

host_status sweep_rows_read(sweep_rows *r, const sweep_file *f, const size_t *columns, size_t count,
                            const sweep_objectives *o, host_error *error)
{
    const size_t points = (size_t)f->plan->points;
    *r = (sweep_rows){.count = points,
                      .at = calloc(points, sizeof *r->at),
                      .values = calloc(points, (count ? count : 1) * sizeof *r->values),
                      .marks = calloc(points, sizeof *r->marks)};
    if (!r->at || !r->values || !r->marks)
        return host_fail(error, HOST_ENVIRONMENT, "no memory for the sweep's rows");
    host_status status = read_all(r, f, columns, count, error);
    return status == HOST_OK && o->count ? mark(r, count, o, error) : status;
}

void sweep_rows_free(sweep_rows *r)
{
    free(r->at);
    free(r->values);
    free(r->marks);
    *r = (sweep_rows){0};
}

/* ---- writing ---- */

/* The mark is what follows the last comma. */
static void put_row(FILE *file, char *line, const bool *mark)
{
    if (mark)
        strrchr(line, ',')[1] = '\0';
    fputs(line, file);
    if (mark)
        putc(*mark ? '1' : '0', file);
    putc('\n', file);
}

typedef struct replacement {
    const sweep_file *file;
    const sweep_rows *rows;
    const char *objective; /* the line's text as it is to be */
    bool marked;
} replacement;

static host_status write_all(void *context, output *o, host_error *error)
{
    const replacement *r = context;
    reader in = {.file = r->file};
    off_t next;
    host_status status = HOST_OK;
    fprintf(o->file, "%s%s\n%s", r->file->head, r->objective, r->file->columns);
    for (uint64_t i = 0; status == HOST_OK && i < r->rows->count; i++) {
        status = read_line(&in, r->rows->at[i], &next, error);
        if (status == HOST_OK)
            put_row(o->file, in.line, r->marked ? &r->rows->marks[i] : NULL);
    }
    free(in.line);
    return status;
}

host_status sweep_end(const sweep_file *f, const sweep_rows *r, const char *objective, host_error *error)
{
    reader in = {.file = f};
    off_t next;
    char line[4096];
    host_status status = read_line(&in, (off_t)f->head_bytes, &next, error);
    if (status == HOST_OK) {
        int n = snprintf(line, sizeof line, "%s%s", SWEEP_OBJECTIVE_LINE, objective ? objective : "");
        const bool changed = objective && strcmp(line, in.line) != 0;
        if (n >= (int)sizeof line)
            status = host_fail(error, HOST_BAD_INPUT, "--objective is longer than %zu characters", sizeof line);
        else if (changed || !r->in_order)
            status = output_write(f->path, write_all,
                                  &(replacement){f, r, objective ? line : in.line, objective != NULL}, error);
    }
    free(in.line);
    return status;
}
