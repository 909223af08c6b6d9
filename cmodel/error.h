/* error.h - how a failing function of the library says why. */
#ifndef VODR_ERROR_H
#define VODR_ERROR_H

#include "vodr.h"

/* Formats the sentence and returns `status`, so that a failing function ends `return vodr_fail(error, ...)`. error may
 * be NULL. */
vodr_status vodr_fail(vodr_error *error, vodr_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
