/* output.c - output files that appear whole or not at all. */
#define _XOPEN_SOURCE 700 /* realpath() */
#include "output.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static host_status fail(const char *path, int code, host_error *error)
{
    return host_fail(error, HOST_ENVIRONMENT, "cannot write '%s': %s", path, strerror(code));
}

bool output_is_stdout(const char *path)
{
    struct stat file, out;
    return stat(path, &file) == 0 && fstat(STDOUT_FILENO, &out) == 0 && file.st_dev == out.st_dev &&
           file.st_ino == out.st_ino;
}

/* Whether path is written by rename: it is a regular file, or there is nothing yet. */
static bool is_replaced(const char *path)
{
    struct stat info;
    if (stat(path, &info) != 0)
        return true;
    return S_ISREG(info.st_mode) && !output_is_stdout(path);
}

/* A new file in the directory of `target`, its name in *temporary (to be freed); -1 with errno on failure. */
static int create_beside(const char *target, char **temporary)
{
    const char *slash = strrchr(target, '/');
    int directory_chars = slash ? (int)(slash - target) + 1 : 0;
    size_t size = (size_t)directory_chars + 48;
    char *name = malloc(size);
    if (!name)
        return -1;
    int descriptor = -1;
    for (unsigned attempt = 0; descriptor < 0 && attempt < 100; attempt++) {
        snprintf(name, size, "%.*s.vodr-%ld-%u.tmp", directory_chars, target, (long)getpid(), attempt);
        descriptor = open(name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor < 0 && errno != EEXIST)
            break;
    }
    if (descriptor < 0) {
        int code = errno;
        free(name);
        errno = code;
        return -1;
    }
    *temporary = name;
    return descriptor;
}

static int open_replacing(output *o, const char *path)
{
    if (path[0] == '\0') {
        errno = ENOENT;
        return -1;
    }
    if (path[strlen(path) - 1] == '/') {
        errno = EISDIR;
        return -1;
    }
    if (access(path, F_OK) == 0 && access(path, W_OK) != 0)
        return -1;
    o->target = realpath(path, NULL);
    if (!o->target)
        o->target = strdup(path);
    return o->target ? create_beside(o->target, &o->temporary) : -1;
}

host_status output_open(output *o, const char *path, host_error *error)
{
    *o = (output){.path = strdup(path)};
    int descriptor;
    if (!o->path)
        return fail(path, ENOMEM, error);
    if (is_replaced(path))
        descriptor = open_replacing(o, path);
    else
        descriptor = open(path, O_WRONLY | O_TRUNC | O_CLOEXEC);
    o->file = descriptor < 0 ? NULL : fdopen(descriptor, "wb");
    if (o->file)
        return HOST_OK;
    int code = errno;
    if (descriptor >= 0)
        close(descriptor);
    output_discard(o);
    return fail(path, code, error);
}

host_status output_check(const char *path, host_error *error)
{
    struct stat info;
    if (is_replaced(path)) {
        output o;
        host_status status = output_open(&o, path, error);
        output_discard(&o);
        return status;
    }
    if (stat(path, &info) == 0 && S_ISDIR(info.st_mode))
        return fail(path, EISDIR, error);
    return access(path, W_OK) == 0 ? HOST_OK : fail(path, errno, error);
}

host_status output_spare(const char *path, const char *input, host_error *error)
{
    struct stat out, in;
    if (!input || stat(path, &out) != 0 || stat(input, &in) != 0 || !S_ISREG(in.st_mode))
        return HOST_OK;
    if (out.st_dev != in.st_dev || out.st_ino != in.st_ino)
        return HOST_OK;
    return host_fail(error, HOST_BAD_INPUT, "'%s' is read by this command and cannot be its output too", path);
}

host_status output_close(output *o, host_error *error)
{
    bool failed = ferror(o->file) != 0;
    int code = failed ? EIO : 0;
    if (fflush(o->file) != 0) {
        failed = true;
        code = errno;
    }
    if (fclose(o->file) != 0 && !failed) {
        failed = true;
        code = errno;
    }
    o->file = NULL;
    return failed ? fail(o->path, code, error) : HOST_OK;
}

host_status output_commit(output *o, host_error *error)
{
    if (!o->temporary)
        return HOST_OK;
    if (rename(o->temporary, o->target) != 0)
        return fail(o->path, errno, error);
    free(o->temporary);
    o->temporary = NULL;
    return HOST_OK;
}

void output_discard(output *o)
{
    if (o->file)
        fclose(o->file);
    if (o->temporary)
        unlink(o->temporary);
    free(o->temporary);
    free(o->target);
    free(o->path);
    *o = (output){0};
}

host_status output_write(const char *path, host_status (*write)(void *context, output *o, host_error *error),
                         void *context, host_error *error)
{
    output o;
    host_status status = output_open(&o, path, error);
    if (status != HOST_OK)
        return status;
    status = write(context, &o, error);
    if (status == HOST_OK)
        status = output_close(&o, error);
    if (status == HOST_OK)
        status = output_commit(&o, error);
    output_discard(&o);
    return status;
}
