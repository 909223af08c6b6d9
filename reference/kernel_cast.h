/* kernel_cast.h - the rays of a packet, by whatever way the mode says. */
#ifndef REFERENCE_KERNEL_CAST_H
#define REFERENCE_KERNEL_CAST_H

#include "kernel_leap.h"
#include "kernel_search.h"

/* mode, filter, skip and type are constants where this is inlined; `entries` is the table, wherever the device keeps
 * it. */
KERNEL packet_result cast(const kernel_frame *f, const lookup *entries, const packet *rays, kernel_mode mode,
                          kernel_filter filter, kernel_skip skip, reference_voxel type)
{
    if (mode == KERNEL_LEAP)
        return leap(f, entries, rays, filter, type);
    if (mode == KERNEL_SEARCH)
        return search(f, entries, rays, filter, type);
    return march(f, entries, rays, mode, filter, skip, type);
}

#endif
