/* histogram.c - how a volume's values are spread. */
#include "histogram.h"

#include <math.h>

void histogram_of(const volume *v, histogram *h)
{
    *h = (histogram){.lo = v->min, .width = (v->max - v->min) / HISTOGRAM_BINS, .all = volume_count(v)};
    double scale = HISTOGRAM_BINS / (v->max - v->min);
    if (!isfinite(scale))
        scale = 0;
    for (size_t i = 0; i < h->all; i++) {
        double value = volume_value(v, i), bin = (value - h->lo) * scale;
        h->count[bin < HISTOGRAM_BINS ? (int)bin : HISTOGRAM_BINS - 1]++;
        h->soft += value >= -200 && value <= 200;
    }
}

uint64_t histogram_count(const histogram *h, int first, int end)
{
    uint64_t sum = 0;
    for (int i = first * HISTOGRAM_BINS / 16; i < end * HISTOGRAM_BINS / 16; i++)
        sum += h->count[i];
    return sum;
}

double histogram_share(const histogram *h, int first, int end)
{
    return (double)histogram_count(h, first, end) / (double)h->all;
}
