/* output_set.c - options for output files, and the files of a drawing command. */
#include "output_set.h"

#include <string.h>

#include "text.h"

host_status output_set_path(void *target, const option *o, const char *value, host_error *error)
{
    output_set *s = target;
    (void)error;
    for (int i = 0; i < s->count; i++)
        if (strcmp(o->name, s->option[i]) == 0)
            s->path[i] = value;
    return HOST_OK;
}

host_status output_set_repeat(void *target, const option *o, const char *value, host_error *error)
{
    int64_t repeat;
    if (!text_integer(value, 1, 1000, &repeat))
        return option_refuse(o, value, "an integer from 1 to 1000", error);
    ((output_set *)target)->repeat = (int)repeat;
    return HOST_OK;
}

host_status output_set_check(const output_set *s, const view_options *v, const char *input, host_error *error)
{
    for (int i = 0; i < s->count; i++) {
        for (int j = 0; s->path[i] && j < i; j++)
            if (s->path[j] && strcmp(s->path[i], s->path[j]) == 0 && strncmp(s->path[i], "/dev/", 5) != 0)
                return host_fail(error, HOST_BAD_INPUT, "--%s and --%s both name '%s'", s->option[j], s->option[i],
                                 s->path[i]);
        host_status status = HOST_OK;
        if (s->path[i])
            status = view_options_output(v, input, s->path[i], error);
        if (status != HOST_OK)
            return status;
    }
    return HOST_OK;
}

host_status output_set_write(const output_set *s, host_status (*write)(void *context, int i, output *o, host_error *),
                             void *context, host_error *error)
{
    output outputs[OUTPUT_SET_MOST] = {{0}};
    host_status status = HOST_OK;
    for (int i = 0; status == HOST_OK && i < s->count; i++) {
        if (!s->path[i])
            continue;
        status = output_open(&outputs[i], s->path[i], error);
        if (status == HOST_OK)
            status = write(context, i, &outputs[i], error);
        if (status == HOST_OK)
            status = output_close(&outputs[i], error);
    }
    for (int i = 0; status == HOST_OK && i < s->count; i++)
        status = output_commit(&outputs[i], error);
    for (int i = 0; i < s->count; i++)
        output_discard(&outputs[i]);
    return status;
}

bool output_set_takes_stdout(const output_set *s)
{
    for (int i = 0; i < s->count; i++)
        if (s->path[i] && output_is_stdout(s->path[i]))
            return true;
    return false;
}

void output_set_print(const output_set *s)
{
    for (int i = 0; i < s->count; i++)
        if (s->path[i])
            printf("written            %s\n", s->path[i]);
}
