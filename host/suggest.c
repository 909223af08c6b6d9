/* suggest.c - a transfer function and a window to look at a volume with, from its values. */
#include "suggest.h"

#include <string.h>

#include "transfer.h"

/* Voxels in the bins around one: noise is no valley. */
static uint64_t smoothed(const histogram *h, int bin)
{
    const int around = HISTOGRAM_BINS / 128;
    uint64_t sum = 0;
    for (int i = bin - around; i <= bin + around; i++)
        sum += i >= 0 && i < HISTOGRAM_BINS ? h->count[i] : 0;
    return sum;
}

/* The bin where what is around the object ends: behind the histogram's highest peak, where that has fallen to a
 * twentieth. A peak in the upper half is the object's own. */
static int background_end(const histogram *h)
{
    int peak = 0, end;
    for (int i = 1; i < HISTOGRAM_BINS; i++)
        if (smoothed(h, i) > smoothed(h, peak))
            peak = i;
    if (peak >= HISTOGRAM_BINS / 2)
        return 0;
    for (end = peak; end < HISTOGRAM_BINS && smoothed(h, end) > smoothed(h, peak) / 20; end++)
        ;
    return end < HISTOGRAM_BINS ? end : 0;
}

/* The bin that ends what all but the brightest two thousandths of the object lie in: of what is behind `begin`. */
static int object_end(const histogram *h, int begin)
{
    uint64_t object = 0, sum = 0;
    for (int i = begin; i < HISTOGRAM_BINS; i++)
        object += h->count[i];
    int end = begin;
    while (end < HISTOGRAM_BINS && sum < object - object / 500)
        sum += h->count[end++];
    return end;
}

/* A CT with soft tissue has a skin. Contrast-filled vessels are the one per cent that is not dark. NIfTI is the format
 * of brain imaging; else, in MRI, tissue spreads over the lower half of the range and little lies above. */
static const char *transfer_for(const volume *v, const histogram *h)
{
    if (volume_is_ct(v))
        return h->soft >= h->all / 20 ? "skin-bone" : "bone";
    if (!(v->max > v->min))
        return "ramp";
    if (histogram_share(h, 0, 1) >= 0.985)
        return "vessels";
    bool tissue = histogram_share(h, 0, 1) < 0.7 && histogram_share(h, 1, 9) >= 0.4 && histogram_share(h, 9, 16) < 0.1;
    if (strcmp(v->format, "nifti") == 0 || tissue)
        return "mri";
    return "bone";
}

host_status suggest(const volume *v, const histogram *h, suggestion *s, host_error *error)
{
    transfer t;
    s->transfer = transfer_for(v, h);
    host_status status = transfer_open(s->transfer, volume_is_ct(v), &t, error);
    if (status != HOST_OK)
        return status;
    if (volume_is_ct(v) && t.has_ct_window) {
        s->lo = t.ct_lo;
        s->hi = t.ct_hi;
    } else {
        int begin = background_end(h), end = object_end(h, begin);
        s->lo = h->lo + begin * h->width;
        s->hi = end < HISTOGRAM_BINS ? h->lo + end * h->width : v->max;
    }
    transfer_close(&t);
    return HOST_OK;
}
