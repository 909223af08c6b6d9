/* fail.c - a failure as a status and one sentence. */
#include "fail.h"

#include <stdarg.h>
#include <stdio.h>

cluster_status cluster_fail(vodr_error *error, cluster_status status, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    if (error)
        vsnprintf(error->text, sizeof error->text, format, arguments);
    va_end(arguments);
    return status;
}

cluster_status cluster_no_memory(vodr_error *error)
{
    return cluster_fail(error, CLUSTER_ENVIRONMENT, "no memory");
}
