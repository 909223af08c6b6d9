/* suggest.h - a transfer function and a window to look at a volume with, from its values. */
#ifndef HOST_SUGGEST_H
#define HOST_SUGGEST_H

#include "histogram.h"
#include "volume.h"

typedef struct suggestion {
    const char *transfer; /* a built-in function's name */
    double lo, hi;        /* the window, lo <= hi */
} suggestion;

/* The histogram is the volume's. */
host_status suggest(const volume *v, const histogram *h, suggestion *s, host_error *error);

#endif
