/* sweep_file.c - the CSV file of a sweep while it grows. */
#include "sweep_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "csv.h"
#include "text.h"

enum { FREE, CLAIMED, DONE };

enum { CHUNK_BYTES = 1 << 16, WAIT_MS = 20, MAX_OBJECTIVE_BYTES = 4096 };

/* Bytes that locks stand for; no file grows so long. */
static const off_t append_byte = (off_t)1 << 60, first_claim_byte = ((off_t)1 << 60) + 1;

static host_status fail(const sweep_file *f, host_error *error)
{
    return host_fail(error, HOST_ENVIRONMENT, "cannot write '%s': %s", f->path, strerror(errno));
}

/* ---- locks between processes ---- */

static int set_lock(const sweep_file *f, int how, short type, off_t byte)
{
    struct flock lock = {.l_type = type, .l_whence = SEEK_SET, .l_start = byte, .l_len = 1};
    int result;
    do
        result = fcntl(f->descriptor, how, &lock);
    while (result != 0 && errno == EINTR);
    return result;
}

static host_status lock_appending(const sweep_file *f, host_error *error)
{
    return set_lock(f, F_SETLKW, F_WRLCK, append_byte) == 0
               ? HOST_OK
               : host_fail(error, HOST_ENVIRONMENT, "cannot lock '%s': %s", f->path, strerror(errno));
}

static void unlock(const sweep_file *f, off_t byte)
{
    set_lock(f, F_SETLK, F_UNLCK, byte);
}

/* ---- reading what is there ---- */

static host_status damaged(const sweep_file *f, off_t at, host_error *error)
{
    return host_fail(error, HOST_BAD_INPUT, "'%s' is no file of this sweep: at byte %lld there is no row of it",
                     f->path, (long long)at);
}

/* A row without its line break, which is changed. */
static host_status take_row(sweep_file *f, char *line, off_t at, host_error *error)
{
    char *fields[SWEEP_MAX_COLUMNS];
    int64_t point;
    size_t count = csv_split(line, fields, SWEEP_MAX_COLUMNS);
    if (count != f->fields || !text_integer(fields[0], 0, (int64_t)f->plan->points - 1, &point))
        return damaged(f, at, error);
    f->done += f->state[point] != DONE;
    f->state[point] = DONE;
    return HOST_OK;
}

/* The whole rows of a chunk; *taken: their bytes. */
static host_status take_rows(sweep_file *f, char *chunk, size_t bytes, size_t *taken, host_error *error)
{
    host_status status = HOST_OK;
    *taken = 0;
    for (char *end; status == HOST_OK && (end = memchr(chunk + *taken, '\n', bytes - *taken)) != NULL;) {
        char *line = chunk + *taken;
        *end = '\0';
        status = take_row(f, line, f->read_bytes + (off_t)*taken, error);
        *taken = (size_t)(end + 1 - chunk);
    }
    return status;
}

/* Reads the rows that came since the last time. */
static host_status read_rows(sweep_file *f, host_error *error)
{
    char chunk[CHUNK_BYTES];
    for (;;) {
        ssize_t n = pread(f->descriptor, chunk, sizeof chunk, f->read_bytes);
        size_t taken;
        if (n < 0)
            return host_fail(error, HOST_ENVIRONMENT, "cannot read '%s': %s", f->path, strerror(errno));
        host_status status = take_rows(f, chunk, (size_t)n, &taken, error);
        if (status != HOST_OK)
            return status;
        if (taken == 0)
            return n == CHUNK_BYTES ? damaged(f, f->read_bytes, error) : HOST_OK;
        f->read_bytes += (off_t)taken;
    }
}

/* ---- writing; the lock is held ---- */

/* Cuts off what a killed process left of a row. *end receives the file's length. */
static host_status mend(const sweep_file *f, off_t *end, host_error *error)
{
    struct stat info;
    char last[CHUNK_BYTES];
    if (fstat(f->descriptor, &info) != 0)
        return fail(f, error);
    *end = info.st_size;
    off_t from = *end > CHUNK_BYTES ? *end - CHUNK_BYTES : 0;
    if (pread(f->descriptor, last, 1, *end - 1) == 1 && last[0] == '\n')
        return HOST_OK;
    ssize_t n = pread(f->descriptor, last, sizeof last, from);
    while (n > 0 && last[n - 1] != '\n')
        n--;
    *end = n > 0 ? from + n : from;
    return n >= 0 && ftruncate(f->descriptor, *end) == 0 ? HOST_OK : fail(f, error);
}

/* All of it or nothing. */
static host_status write_whole(const sweep_file *f, const char *text, off_t end, host_error *error)
{
    size_t bytes = strlen(text);
    ssize_t written = write(f->descriptor, text, bytes);
    if (written == (ssize_t)bytes)
        return HOST_OK;
    if (written >= 0)
        errno = ENOSPC;
    int code = errno;
    if (written > 0 && ftruncate(f->descriptor, end) != 0)
        code = errno;
    errno = code;
    return fail(f, error);
}

host_status sweep_file_append(sweep_file *f, uint64_t point, const char *line, host_error *error)
{
    off_t end;
    pthread_mutex_lock(&f->lock);
    host_status status = lock_appending(f, error);
    if (status == HOST_OK) {
        status = mend(f, &end, error);
        if (status == HOST_OK)
            status = write_whole(f, line, end, error);
        unlock(f, append_byte);
    }
    if (status == HOST_OK)
        status = read_rows(f, error);
    unlock(f, first_claim_byte + (off_t)point);
    pthread_mutex_unlock(&f->lock);
    return status;
}

/* ---- claims ---- */

/* Tries the points that are free, from the last one on; *contended: another process has one of them. */
static host_status try_claims(sweep_file *f, uint64_t *point, bool *claimed, bool *contended, host_error *error)
{
    host_status status = HOST_OK;
    *claimed = *contended = false;
    for (uint64_t i = 0; status == HOST_OK && !*claimed && i < f->plan->points; i++) {
        uint64_t turn = (f->turn + i) % f->plan->points, at = sweep_plan_turn(f->plan, turn);
        if (f->state[at] != FREE)
            continue;
        if (set_lock(f, F_SETLK, F_WRLCK, first_claim_byte + (off_t)at) != 0) {
            *contended = true;
            if (errno != EACCES && errno != EAGAIN)
                status = host_fail(error, HOST_ENVIRONMENT, "cannot lock '%s': %s", f->path, strerror(errno));
            continue;
        }
        status = read_rows(f, error);
        *claimed = status == HOST_OK && f->state[at] == FREE;
        if (*claimed) {
            f->state[at] = CLAIMED;
            f->turn = turn + 1;
            *point = at;
        } else {
            unlock(f, first_claim_byte + (off_t)at);
        }
    }
    return status;
}

host_status sweep_file_claim(sweep_file *f, uint64_t *point, bool *more, host_error *error)
{
    for (;;) {
        bool contended;
        pthread_mutex_lock(&f->lock);
        host_status status = try_claims(f, point, more, &contended, error);
        if (status == HOST_OK && contended && !*more)
            status = read_rows(f, error);
        pthread_mutex_unlock(&f->lock);
        if (status != HOST_OK || *more || !contended)
            return status;
        nanosleep(&(struct timespec){.tv_nsec = WAIT_MS * 1000000L}, NULL);
    }
}

/* ---- opening ---- */

static bool begins_with(const char *text, const char *beginning)
{
    return strncmp(text, beginning, strlen(beginning)) == 0;
}

/* Where rows begin in a file that begins like this; 0: a killed process did not get further than its head; -1: it is of
 * something else. */
static off_t find_rows(const sweep_file *f, const char *there)
{
    const char *const parts[] = {f->head, SWEEP_OBJECTIVE_LINE};
    const char *at = there;
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        if (begins_with(parts[i], at))
            return 0;
        if (!begins_with(at, parts[i]))
            return -1;
        at += strlen(parts[i]);
    }
    at = strchr(at, '\n');
    if (!at)
        return 0;
    if (begins_with(++at, f->columns))
        return at - there + (off_t)strlen(f->columns);
    return begins_with(f->columns, at) ? 0 : -1;
}

/* *fresh: the file is empty or as good as that. */
static host_status compare_head(sweep_file *f, bool *fresh, host_error *error)
{
    const size_t most = f->head_bytes + MAX_OBJECTIVE_BYTES + strlen(f->columns);
    char *there = malloc(most + 1);
    if (!there)
        return host_fail(error, HOST_ENVIRONMENT, "no memory to read '%s'", f->path);
    ssize_t n = pread(f->descriptor, there, most, 0);
    there[n > 0 ? n : 0] = '\0';
    const bool text = n > 0 ? strlen(there) == (size_t)n : n == 0;
    f->rows_at = f->read_bytes = text ? find_rows(f, there) : -1;
    *fresh = f->rows_at == 0;
    free(there);
    if (n < 0)
        return host_fail(error, HOST_ENVIRONMENT, "cannot read '%s': %s", f->path, strerror(errno));
    if (f->rows_at >= 0)
        return HOST_OK;
    return host_fail(error, HOST_BAD_INPUT,
                     "'%s' is there and is not of this sweep: name another output, or remove it to begin anew",
                     f->path);
}

static host_status write_head(sweep_file *f, host_error *error)
{
    static const char none[] = SWEEP_OBJECTIVE_LINE "none\n";
    const size_t bytes = f->head_bytes + strlen(none) + strlen(f->columns);
    char *whole = malloc(bytes + 1);
    if (!whole)
        return host_fail(error, HOST_ENVIRONMENT, "no memory for the head of '%s'", f->path);
    snprintf(whole, bytes + 1, "%s%s%s", f->head, none, f->columns);
    host_status status = ftruncate(f->descriptor, 0) == 0 ? write_whole(f, whole, 0, error) : fail(f, error);
    free(whole);
    f->rows_at = f->read_bytes = (off_t)bytes;
    if (status != HOST_OK && f->created)
        unlink(f->path);
    return status;
}

static host_status open_descriptor(sweep_file *f, host_error *error)
{
    struct stat info;
    f->created = true;
    f->descriptor = open(f->path, O_RDWR | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0666);
    if (f->descriptor < 0 && errno == EEXIST) {
        f->created = false;
        f->descriptor = open(f->path, O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC | O_NONBLOCK, 0666);
    }
    if (f->descriptor < 0)
        return fail(f, error);
    if (fstat(f->descriptor, &info) != 0 || !S_ISREG(info.st_mode))
        return host_fail(error, HOST_ENVIRONMENT,
                         "cannot write '%s': a sweep goes on from its output, which must be a regular file", f->path);
    return HOST_OK;
}

host_status sweep_file_open(sweep_file *f, const char *path, char *head, char *columns, size_t fields,
                            const sweep_plan *plan, uint64_t first_turn, host_error *error)
{
    bool fresh = false;
    *f = (sweep_file){.path = path,
                      .descriptor = -1,
                      .plan = plan,
                      .head = head,
                      .head_bytes = strlen(head),
                      .columns = columns,
                      .fields = fields,
                      .turn = first_turn,
                      .state = calloc(plan->points, 1)};
    if (!f->state || fields > SWEEP_MAX_COLUMNS || pthread_mutex_init(&f->lock, NULL) != 0)
        return host_fail(error, HOST_ENVIRONMENT, "no memory for the sweep's points");
    host_status status = open_descriptor(f, error);
    if (status == HOST_OK)
        status = lock_appending(f, error);
    if (status != HOST_OK)
        return status;
    status = compare_head(f, &fresh, error);
    if (status == HOST_OK && fresh)
        status = write_head(f, error);
    unlock(f, append_byte);
    if (status == HOST_OK)
        status = read_rows(f, error);
    f->found = f->done;
    return status;
}

double sweep_file_done(sweep_file *f)
{
    pthread_mutex_lock(&f->lock);
    double share = (double)f->done / (double)f->plan->points;
    pthread_mutex_unlock(&f->lock);
    return share;
}

void sweep_file_close(sweep_file *f)
{
    if (f->descriptor >= 0)
        close(f->descriptor);
    free(f->head);
    free(f->columns);
    free(f->state);
    *f = (sweep_file){.descriptor = -1};
}
