#include "library.h"

#include <ctype.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <inttypes.h>
#include <spawn.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum { MAX_ARGUMENTS = 40, NOT_RUN = 127 };

extern char **environ;

rtl_status rtl_fail(vodr_error *error, rtl_status status, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(error->text, sizeof error->text, format, arguments);
    va_end(arguments);
    return status;
}

/* ---- the parameters that a module has ---- */

/* The next `parameter ... NAME =` of a Verilog text; NULL when there is none. The text loses the end of the name. */
static char *next_parameter(char **text)
{
    char *at = *text;
    while ((at = strstr(at, "parameter")) != NULL) {
        bool word = at == *text || (!isalnum((unsigned char)at[-1]) && at[-1] != '_');
        at += strlen("parameter");
        char *end = at + strcspn(at, "=;,)");
        if (!word || *end != '=' || !isspace((unsigned char)*at))
            continue;
        *text = end + 1;
        while (isspace((unsigned char)end[-1]))
            end--;
        *end = '\0';
        while (isalnum((unsigned char)end[-1]) || end[-1] == '_')
            end--;
        return end;
    }
    return NULL;
}

static char *read_text(const char *path)
{
    FILE *file = fopen(path, "r");
    char *text = NULL;
    size_t size = 0, room = 0;
    while (file && !ferror(file) && !feof(file)) {
        if (room - size < 4096) {
            room = 2 * room + 8192;
            char *more = realloc(text, room);
            if (!more)
                break;
            text = more;
        }
        size += fread(text + size, 1, room - size - 1, file);
        text[size] = '\0';
    }
    bool whole = file && feof(file);
    if (file)
        fclose(file);
    if (!whole) {
        free(text);
        return NULL;
    }
    return text;
}

/* Adds NAME=VALUE for every parameter whose value the machine says. */
static int add_parameters(char *text, const rtl_registers *registers, char **arguments, int count)
{
    int64_t value;
    for (char *name; count + 1 < MAX_ARGUMENTS && (name = next_parameter(&text)) != NULL;) {
        char argument[128];
        if (!registers || !rtl_parameter(registers, name, &value))
            continue;
        snprintf(argument, sizeof argument, "%s=%" PRId64, name, value);
        arguments[count] = strdup(argument);
        count += arguments[count] != NULL;
    }
    return count;
}

/* ---- building ---- */

/* Starts a program whose output and errors go to `out`. */
static bool start(char *const *arguments, int out, pid_t *child)
{
    posix_spawn_file_actions_t actions;
    if (posix_spawn_file_actions_init(&actions) != 0)
        return false;
    bool good = posix_spawn_file_actions_adddup2(&actions, out, STDOUT_FILENO) == 0 &&
                posix_spawn_file_actions_adddup2(&actions, out, STDERR_FILENO) == 0 &&
                posix_spawn(child, arguments[0], &actions, NULL, arguments, environ) == 0;
    posix_spawn_file_actions_destroy(&actions);
    return good;
}

/* Runs the script; what it says lands in `said`, which is cut at the front when it is long. Returns its exit status,
 * NOT_RUN when it cannot be run. */
static int run(char *const *arguments, char *said, size_t size)
{
    int ends[2], status = 0;
    size_t length = 0;
    pid_t child;
    if (pipe(ends) != 0)
        return NOT_RUN;
    fcntl(ends[0], F_SETFD, FD_CLOEXEC);
    bool started = start(arguments, ends[1], &child);
    close(ends[1]);
    for (ssize_t n; started && (n = read(ends[0], said + length, size - 1 - length)) > 0;) {
        length += (size_t)n;
        if (length == size - 1) {
            memmove(said, said + size / 2, length - size / 2);
            length -= size / 2;
        }
    }
    close(ends[0]);
    said[length] = '\0';
    return started && waitpid(child, &status, 0) == child && WIFEXITED(status) ? WEXITSTATUS(status) : NOT_RUN;
}

static char *last_line(char *said)
{
    size_t length = strlen(said);
    while (length && said[length - 1] == '\n')
        said[--length] = '\0';
    char *newline = strrchr(said, '\n');
    return newline ? newline + 1 : said;
}

/* Asks the script for the library's path; it makes what is not there. */
static rtl_status ask(char *const *arguments, const char *module, char path[RTL_PATH_BYTES], vodr_error *error)
{
    char said[2 * RTL_PATH_BYTES];
    int status = run(arguments, said, sizeof said);
    const char *last = last_line(said);
    size_t length = strlen(last);
    if (status == NOT_RUN)
        return rtl_fail(error, RTL_ENVIRONMENT, "%s cannot be run", arguments[0]);
    if (status != 0)
        return rtl_fail(error, status == 2 ? RTL_INVALID : RTL_ENVIRONMENT, "%s: %s", module, last);
    if (length >= RTL_PATH_BYTES)
        return rtl_fail(error, RTL_ENVIRONMENT, "%s: the path of its library is too long", module);
    memcpy(path, last, length + 1);
    return RTL_OK;
}

/* Whether the same was asked for before; else that is what will have been. */
static bool asked_before(rtl_found *found, char *const *arguments)
{
    char asked[sizeof found->asked] = "";
    size_t length = 0;
    for (int i = 0; arguments[i] && length < sizeof asked; i++)
        length += (size_t)snprintf(asked + length, sizeof asked - length, "%s\n", arguments[i]);
    bool same = length < sizeof asked && strcmp(found->asked, asked) == 0;
    memcpy(found->asked, length < sizeof asked ? asked : "", length < sizeof asked ? length + 1 : 1);
    return same;
}

/* Finds the library's path, which is made when need be. */
static rtl_status build(const rtl_source *source, const char *module, const char *file, const rtl_registers *registers,
                        char path[RTL_PATH_BYTES], vodr_error *error)
{
    char script[RTL_PATH_BYTES], cache[RTL_PATH_BYTES], headers[RTL_PATH_BYTES];
    rtl_found own = {.asked = ""}, *found = source->found ? source->found : &own;
    snprintf(script, sizeof script, "%s/scripts/rtl-library", source->root);
    snprintf(cache, sizeof cache, "%s/rtl", source->build);
    snprintf(headers, sizeof headers, "%s/gen", source->build);
    char *text = read_text(file);
    if (!text)
        return rtl_fail(error, RTL_INVALID, "%s: cannot be read", file);
    char *arguments[MAX_ARGUMENTS] = {script, cache, headers, (char *)module, (char *)file, "--trace"};
    int fixed = source->trace ? 6 : 5, count = add_parameters(text, registers, arguments, fixed);
    arguments[count] = NULL;
    free(text);
    rtl_status status = RTL_OK;
    if (!asked_before(found, arguments))
        status = ask(arguments, module, found->path, error);
    for (int i = fixed; i < count; i++)
        free(arguments[i]);
    if (status == RTL_OK)
        memcpy(path, found->path, sizeof found->path);
    else
        found->asked[0] = '\0';
    return status;
}

/* ---- checking ---- */

const vodr_rtl_port *rtl_library_port(const rtl_library *l, const char *name)
{
    for (int32_t i = 0; i < l->model.port_count; i++)
        if (strcmp(l->model.ports[i].name, name) == 0)
            return &l->model.ports[i];
    return NULL;
}

static rtl_status check_port(const rtl_library *l, const char *block, const char *name, bool output, int32_t width,
                             vodr_error *error)
{
    const vodr_rtl_port *p = rtl_library_port(l, name);
    const char *way = output ? "output" : "input", *s = width == 1 ? "" : "s";
    if (!p)
        return rtl_fail(error, RTL_INVALID, "%s: module %s has no port %s; it must have this %s, of %" PRId32 " bit%s",
                        l->file, block, name, way, width, s);
    if (p->output != output)
        return rtl_fail(error, RTL_INVALID, "%s: port %s of module %s is an %s; it must be an %s, of %" PRId32 " bit%s",
                        l->file, name, block, p->output ? "output" : "input", way, width, s);
    if (p->width_bits != width)
        return rtl_fail(error, RTL_INVALID,
                        "%s: port %s of module %s has %" PRId32 " bit%s; this %s must have %" PRId32, l->file, name,
                        block, p->width_bits, p->width_bits == 1 ? "" : "s", way, width);
    return RTL_OK;
}

static rtl_status check_ports(const rtl_library *l, vodr_block block, const rtl_registers *registers, vodr_error *error)
{
    const block_signals *s = signals_of(block);
    rtl_status status = check_port(l, s->name, "clk", false, 1, error);
    if (status == RTL_OK)
        status = check_port(l, s->name, "rst", false, 1, error);
    for (int32_t i = 0; i < s->count; i++)
        for (int32_t j = 0; status == RTL_OK && j < s->ports[i].count; j++) {
            const signal_field *f = &s->ports[i].fields[j];
            status =
                check_port(l, s->name, f->name, s->ports[i].output, signal_width(f, rtl_machine(registers)), error);
        }
    return status;
}

static rtl_status load(const char *path, uint32_t seed, rtl_library *l, vodr_error *error)
{
    vodr_rtl_open_function *open = NULL;
    l->handle = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    void *symbol = l->handle ? dlsym(l->handle, VODR_RTL_OPEN) : NULL;
    memcpy(&open, &symbol, sizeof open); /* a pointer to data is no pointer to a function, but here it is */
    if (!open)
        return rtl_fail(error, RTL_ENVIRONMENT, "%s cannot be loaded: %s", path, dlerror());
    if (!open(&l->model, seed))
        return rtl_fail(error, RTL_NO_MEMORY, "no memory for the model of %s", l->file);
    return RTL_OK;
}

static rtl_status open_module(const rtl_source *source, const char *module, const char *file,
                              const rtl_registers *registers, rtl_library *l, vodr_error *error)
{
    char path[RTL_PATH_BYTES];
    *l = (rtl_library){0};
    snprintf(l->file, sizeof l->file, "%s", source->file ? source->file : strrchr(file, '/') + 1);
    rtl_status status = build(source, module, file, registers, path, error);
    return status == RTL_OK ? load(path, source->seed, l, error) : status;
}

rtl_status rtl_library_open(const rtl_source *source, vodr_block block, const rtl_registers *registers, rtl_library *l,
                            vodr_error *error)
{
    const char *module = signals_of(block)->name;
    char file[RTL_PATH_BYTES];
    snprintf(file, sizeof file, "%s/rtl/%s.v", source->root, module);
    rtl_status status = open_module(source, module, source->file ? source->file : file, registers, l, error);
    if (status == RTL_OK)
        status = check_ports(l, block, registers, error);
    if (status != RTL_OK)
        rtl_library_close(l);
    return status;
}

rtl_status rtl_module_open(const rtl_source *source, const char *module, rtl_library *l, vodr_error *error)
{
    rtl_status status = open_module(source, module, source->file, NULL, l, error);
    if (status != RTL_OK)
        rtl_library_close(l);
    return status;
}

void rtl_library_close(rtl_library *l)
{
    if (l->model.finish)
        l->model.finish(l->model.state);
    if (l->handle)
        dlclose(l->handle);
    *l = (rtl_library){0};
}
