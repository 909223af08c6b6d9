/* histogram.h - how a volume's values are spread. */
#ifndef HOST_HISTOGRAM_H
#define HOST_HISTOGRAM_H

#include "volume.h"

enum { HISTOGRAM_BINS = 1024 };

typedef struct histogram {
    double lo, width; /* of a bin: equal parts of the range */
    uint64_t count[HISTOGRAM_BINS];
    uint64_t soft; /* values from -200 to 200: in a CT, soft tissue */
    uint64_t all;
} histogram;

/* Counts every voxel. Not after volume_quantise(). */
void histogram_of(const volume *v, histogram *h);

/* How many voxels, and which share of them, 0 to 1, lie from one sixteenth of the range up to another. */
uint64_t histogram_count(const histogram *h, int first, int end);
double histogram_share(const histogram *h, int first, int end);

#endif
