/* host.h - what all of host/ shares: exit codes and the error sentence. */
#ifndef HOST_H
#define HOST_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Also the exit codes of the vodr command. */
typedef enum host_status {
    HOST_OK = 0,
    HOST_DIFFERENT = 1,   /* a comparison or check failed */
    HOST_BAD_INPUT = 2,   /* bad usage or bad input */
    HOST_ENVIRONMENT = 3, /* unwritable output, disk full, no memory, no device */
} host_status;

/* One sentence without a final newline, naming the file or option, the field, the value and the range. */
typedef struct host_error {
    char text[1024];
} host_error;

/* Formats the sentence and returns `status`, so that a failing function ends `return host_fail(error, HOST_BAD_INPUT,
 * ...)`. error may be NULL. */
host_status host_fail(host_error *error, host_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Says the sentence on standard error, in one line whatever a file's name or content put into it, and empties it. */
void host_say(host_error *error);

#endif
