/* kernel_order.h - the pixel that a lane takes (kernel_types.h): lines of pixels on which neighbours read memory side
 * by side, as the thread-aligned projection of Kim N.-Y. turns its picture for, but of the pixels of the usual frame,
 * so that nothing has to be turned back. */
#ifndef REFERENCE_KERNEL_ORDER_H
#define REFERENCE_KERNEL_ORDER_H

#include "kernel_types.h"
#include "lanes.h"

enum { ORDER_ONE = 1 << 16 };

HOST_AND_KERNEL int32_t order_shift(const kernel_order *o, int32_t i)
{
    return (int32_t)(((int64_t)i * o->slope + ORDER_ONE / 2) >> 16);
}

/* Column i of row j; which may lie outside the picture. */
HOST_AND_KERNEL void order_pixel(const kernel_order *o, int32_t i, int32_t j, int32_t *x, int32_t *y)
{
    const int32_t across = j + o->first + order_shift(o, i);
    *x = o->steep ? across : i;
    *y = o->steep ? i : across;
}

/* Whether column i of row j is a pixel of the picture. */
HOST_AND_KERNEL bool order_has(const kernel_frame *f, int32_t i, int32_t j, int32_t *x, int32_t *y)
{
    order_pixel(&f->order, i, j, x, y);
    return i < f->order.columns && *x >= 0 && *y >= 0 && *x < f->camera.width_px && *y < f->camera.height_px;
}

#endif
