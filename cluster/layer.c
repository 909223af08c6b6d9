/* layer.c - pieces of picture: laid over one another in the order of sight, or the greater kept. */
#include "layer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fail.h"

rectangle rectangle_union(rectangle a, rectangle b)
{
    if (rectangle_is_empty(a))
        return b;
    if (rectangle_is_empty(b))
        return a;
    return (rectangle){a.x0 < b.x0 ? a.x0 : b.x0, a.y0 < b.y0 ? a.y0 : b.y0, a.x1 > b.x1 ? a.x1 : b.x1,
                       a.y1 > b.y1 ? a.y1 : b.y1};
}

static size_t width_of(rectangle r)
{
    return (size_t)(r.x1 - r.x0);
}

void layers_free(layers *l)
{
    for (int32_t i = 0; i < l->count; i++)
        free(l->layer[i].pixel);
    free(l->layer);
    l->layer = NULL;
    l->count = l->room = 0;
}

static float *new_pixels(const layers *l, rectangle area)
{
    const size_t count = width_of(area) * (size_t)(area.y1 - area.y0);
    if (!l->mip)
        return calloc(count, 4 * sizeof(float));
    float *pixel = malloc(count * sizeof *pixel);
    for (size_t i = 0; pixel && i < count; i++)
        pixel[i] = -INFINITY;
    return pixel;
}

cluster_status layers_add(layers *l, int32_t first, int32_t end, rectangle area, vodr_error *error)
{
    if (l->count == l->room) {
        layer *grown = realloc(l->layer, (size_t)(2 * l->room + 4) * sizeof *grown);
        if (!grown)
            return cluster_no_memory(error);
        l->layer = grown;
        l->room = 2 * l->room + 4;
    }
    layer made = {first, end, area, NULL};
    if (!rectangle_is_empty(area)) {
        made.pixel = new_pixels(l, area);
        if (!made.pixel)
            return cluster_fail(error, CLUSTER_ENVIRONMENT, "no memory for a layer of %dx%d pixels", area.x1 - area.x0,
                                area.y1 - area.y0);
    }
    l->layer[l->count++] = made;
    return CLUSTER_OK;
}

static float *pixel_at(const layers *l, layer *to, int32_t x, int32_t y)
{
    return to->pixel + ((size_t)(y - to->area.y0) * width_of(to->area) + (size_t)(x - to->area.x0)) * (l->mip ? 1 : 4);
}

void layers_march(layers *l, int32_t i, rectangle area, const double *rgba)
{
    for (int32_t y = area.y0; y < area.y1; y++) {
        float *to = pixel_at(l, &l->layer[i], area.x0, y);
        for (int32_t x = area.x0; x < area.x1; x++, rgba += 4, to += l->mip ? 1 : 4) {
            if (l->mip) {
                if (rgba[3] > 0 && (float)rgba[0] > *to)
                    *to = (float)rgba[0];
                continue;
            }
            const float through = 1 - to[3];
            for (int c = 0; c < 4; c++)
                to[c] += through * (float)rgba[c];
        }
    }
}

/* Puts colours behind others. */
static void lay_colours(float *restrict to, const float *restrict from, size_t count)
{
    for (size_t i = 0; i < count; i++, to += 4, from += 4) {
        const float through = 1 - to[3];
        for (int c = 0; c < 4; c++)
            to[c] += through * from[c];
    }
}

/* Puts a layer behind another, whose area holds its own. */
static void lay(const layers *l, layer *front, const layer *back)
{
    const size_t wide = width_of(back->area);
    const float *from = back->pixel;
    for (int32_t y = back->area.y0; from && y < back->area.y1; y++, from += wide * (l->mip ? 1 : 4)) {
        float *to = pixel_at(l, front, back->area.x0, y);
        if (!l->mip)
            lay_colours(to, from, wide);
        for (size_t x = 0; l->mip && x < wide; x++)
            to[x] = from[x] > to[x] ? from[x] : to[x];
    }
}

/* The same where nothing lies in front. */
static void put_down(const layers *l, layer *empty, const layer *back)
{
    const size_t row = width_of(back->area) * (l->mip ? 1 : 4);
    for (int32_t y = back->area.y0; back->pixel && y < back->area.y1; y++)
        memcpy(pixel_at(l, empty, back->area.x0, y), back->pixel + (size_t)(y - back->area.y0) * row,
               row * sizeof(float));
}

static int by_place(const void *a, const void *b)
{
    const layer *p = a, *q = b;
    return (p->first > q->first) - (p->first < q->first);
}

/* Makes one layer of [begin, end), which follow on one another. */
static cluster_status join(layers *l, layers *out, int32_t begin, int32_t end, vodr_error *error)
{
    rectangle area = {0, 0, 0, 0};
    for (int32_t i = begin; i < end; i++)
        area = rectangle_union(area, l->layer[i].area);
    const layer *first = &l->layer[begin];
    if (end - begin == 1) {
        cluster_status status = layers_add(out, first->first, first->end, (rectangle){0, 0, 0, 0}, error);
        if (status == CLUSTER_OK) {
            out->layer[out->count - 1] = *first;
            l->layer[begin].pixel = NULL;
        }
        return status;
    }
    cluster_status status = layers_add(out, first->first, l->layer[end - 1].end, area, error);
    if (status == CLUSTER_OK)
        put_down(l, &out->layer[out->count - 1], first);
    for (int32_t i = begin + 1; status == CLUSTER_OK && i < end; i++)
        lay(l, &out->layer[out->count - 1], &l->layer[i]);
    return status;
}

cluster_status layers_merge(layers *l, vodr_error *error)
{
    layers out = {.mip = l->mip, .bits = l->bits};
    cluster_status status = CLUSTER_OK;
    if (l->count > 1)
        qsort(l->layer, (size_t)l->count, sizeof *l->layer, by_place);
    for (int32_t begin = 0, end; status == CLUSTER_OK && begin < l->count; begin = end) {
        for (end = begin + 1; end < l->count && l->layer[end].first == l->layer[end - 1].end; end++)
            continue;
        status = join(l, &out, begin, end, error);
    }
    if (status == CLUSTER_OK) {
        layers_free(l);
        *l = out;
    } else {
        layers_free(&out);
    }
    return status;
}

cluster_status layers_cut(layers *l, int32_t y0, int32_t y1, vodr_error *error)
{
    for (int32_t i = 0; i < l->count; i++) {
        layer *own = &l->layer[i];
        rectangle area = own->area;
        area.y0 = area.y0 > y0 ? area.y0 : y0;
        area.y1 = area.y1 < y1 ? area.y1 : y1;
        if (rectangle_is_empty(area)) {
            free(own->pixel);
            own->pixel = NULL;
            own->area = (rectangle){0, 0, 0, 0};
            continue;
        }
        const size_t row = width_of(area) * (l->mip ? 1 : 4) * sizeof(float);
        float *kept = malloc(row * (size_t)(area.y1 - area.y0));
        if (!kept)
            return cluster_no_memory(error);
        memcpy(kept, pixel_at(l, own, area.x0, area.y0), row * (size_t)(area.y1 - area.y0));
        free(own->pixel);
        own->pixel = kept;
        own->area = area;
    }
    return CLUSTER_OK;
}
