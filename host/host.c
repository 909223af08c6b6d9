#include "host.h"

#include <stdio.h>

host_status host_fail(host_error *error, host_status status, const char *format, ...)
{
    if (error) {
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(error->text, sizeof error->text, format, arguments);
        va_end(arguments);
    }
    return status;
}

void host_say(host_error *error)
{
    for (char *c = error->text; *c; c++)
        if ((unsigned char)*c < ' ' || *c == 0x7f)
            *c = '?';
    fprintf(stderr, "vodr: %s\n", error->text);
    error->text[0] = '\0';
}
