#include "error.h"

#include <stdarg.h>
#include <stdio.h>

vodr_status vodr_fail(vodr_error *error, vodr_status status, const char *format, ...)
{
    if (error) {
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(error->text, sizeof error->text, format, arguments);
        va_end(arguments);
        /* Quoted input may hold anything; the sentence stays one line. */
        for (char *c = error->text; *c; c++)
            *c = (unsigned char)*c < ' ' || *c == 127 ? '?' : *c;
    }
    return status;
}
