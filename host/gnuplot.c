/* gnuplot.c - runs gnuplot. */
#include "gnuplot.h"

#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <string.h>
#include <sys/wait.h>

extern char **environ;

/* Its standard input and output; -1: /dev/null. Standard error goes to /dev/null: its complaints are no sentences. */
static host_status start(char *const argv[], int in, int out, pid_t *child, host_error *error)
{
    posix_spawn_file_actions_t actions;
    int code = posix_spawn_file_actions_init(&actions);
    if (code == 0) {
        in < 0 ? posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0)
               : posix_spawn_file_actions_adddup2(&actions, in, 0);
        out < 0 ? posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0)
                : posix_spawn_file_actions_adddup2(&actions, out, 1);
        posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
        code = posix_spawnp(child, argv[0], &actions, NULL, argv, environ);
        posix_spawn_file_actions_destroy(&actions);
    }
    if (code == ENOENT)
        return host_fail(error, HOST_ENVIRONMENT,
                         "--plot needs gnuplot, which is not there (Debian package gnuplot-nox)");
    if (code != 0)
        return host_fail(error, HOST_ENVIRONMENT, "cannot run gnuplot: %s", strerror(code));
    return HOST_OK;
}

static host_status finish(pid_t child, host_error *error)
{
    int status;
    pid_t ended;
    do
        ended = waitpid(child, &status, 0);
    while (ended < 0 && errno == EINTR);
    if (ended == child && WIFEXITED(status) && WEXITSTATUS(status) == 0)
        return HOST_OK;
    return host_fail(error, HOST_ENVIRONMENT, "gnuplot failed");
}

host_status gnuplot_check(host_error *error)
{
    char name[] = "gnuplot", version[] = "--version";
    pid_t child;
    host_status status = start((char *[]){name, version, NULL}, -1, -1, &child, error);
    return status == HOST_OK ? finish(child, error) : status;
}

host_status gnuplot_run(FILE *script, FILE *out, host_error *error)
{
    char name[] = "gnuplot", input[] = "-";
    pid_t child;
    rewind(script);
    fflush(out);
    host_status status = start((char *[]){name, input, NULL}, fileno(script), fileno(out), &child, error);
    return status == HOST_OK ? finish(child, error) : status;
}

void gnuplot_quote(FILE *script, const char *text)
{
    putc('\'', script);
    for (; *text; text++) {
        if (*text == '\'')
            putc('\'', script);
        putc((unsigned char)*text < ' ' ? '?' : *text, script);
    }
    putc('\'', script);
}
