/* layer_pack.c - layers as messages: of each its places, the bounding box of its active pixels, and runs of those. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fail.h"
#include "layer.h"

/* What a layer's part of a message begins with; `runs` pairs of numbers follow, pixels that are left out and pixels
 * that are there, row after row of the area, then the pixels. */
typedef struct head {
    int32_t first, end;
    rectangle area;
    uint32_t runs, pixels;
} head;

typedef struct writer {
    const layers *layers;
    node_message *message;
    size_t room;
} writer;

static size_t channels_of(const layers *l)
{
    return l->mip ? 1 : 4;
}

static bool is_16_bits(const layers *l)
{
    return l->bits == 16 && !l->mip;
}

static size_t pixel_bytes(const layers *l)
{
    return channels_of(l) * (is_16_bits(l) ? sizeof(uint16_t) : sizeof(float));
}

static bool is_active(const layers *l, const float *pixel)
{
    return l->mip ? *pixel > -INFINITY : pixel[3] > 0;
}

static const float *pixel_of(const layers *l, const layer *from, int32_t x, int32_t y)
{
    const size_t wide = (size_t)(from->area.x1 - from->area.x0);
    return from->pixel + ((size_t)(y - from->area.y0) * wide + (size_t)(x - from->area.x0)) * channels_of(l);
}

/* The least area of the rows [y0, y1) that holds all active pixels. */
static rectangle active_area(const layers *l, const layer *from, int32_t y0, int32_t y1)
{
    rectangle area = {INT32_MAX, INT32_MAX, 0, 0}, own = from->area;
    own.y0 = own.y0 > y0 ? own.y0 : y0;
    own.y1 = own.y1 < y1 ? own.y1 : y1;
    for (int32_t y = own.y0; y < own.y1; y++) {
        int32_t left = own.x0, right = own.x1;
        while (left < right && !is_active(l, pixel_of(l, from, left, y)))
            left++;
        while (left < right && !is_active(l, pixel_of(l, from, right - 1, y)))
            right--;
        if (left < right)
            area = rectangle_union(area, (rectangle){left, y, right, y + 1});
    }
    return rectangle_is_empty(area) ? (rectangle){0, 0, 0, 0} : area;
}

static bool reserve(writer *w, size_t more)
{
    node_message *m = w->message;
    if (m->count + more <= w->room)
        return true;
    const size_t room = 2 * w->room + more + 4096;
    void *grown = realloc(m->bytes, room);
    if (!grown)
        return false;
    m->bytes = grown;
    w->room = room;
    return true;
}

static void put(writer *w, const void *data, size_t bytes)
{
    memcpy((char *)w->message->bytes + w->message->count, data, bytes);
    w->message->count += bytes;
}

/* Puts the runs of a layer's area: how many pixels lie before each since the last, and how many it has. */
static void put_runs(writer *w, const layer *from, head *h)
{
    const layers *l = w->layers;
    uint32_t run[2] = {0, 0};
    for (int32_t y = h->area.y0; y < h->area.y1; y++) {
        const float *pixel = pixel_of(l, from, h->area.x0, y);
        for (int32_t x = h->area.x0; x < h->area.x1; x++, pixel += channels_of(l)) {
            const bool active = is_active(l, pixel);
            if (active || run[1] == 0) {
                run[active]++;
                h->pixels += active;
                continue;
            }
            put(w, run, sizeof run);
            h->runs++;
            run[0] = 1;
            run[1] = 0;
        }
    }
    if (run[1] > 0) {
        put(w, run, sizeof run);
        h->runs++;
    }
}

/* Puts pixels that follow on one another. */
static void put_pixels(writer *w, const float *pixel, size_t count)
{
    const layers *l = w->layers;
    if (!is_16_bits(l)) {
        put(w, pixel, count * pixel_bytes(l));
        return;
    }
    for (size_t i = 0; i < 4 * count; i++) {
        const uint16_t rounded = (uint16_t)(fminf(fmaxf(pixel[i], 0), 1) * 65535 + 0.5f);
        put(w, &rounded, sizeof rounded);
    }
}

/* Puts the pixels of the runs that were put at `place`. */
static void put_active(writer *w, const layer *from, const head *h, size_t place)
{
    const size_t wide = (size_t)(h->area.x1 - h->area.x0);
    size_t at = 0;
    for (uint32_t i = 0; i < h->runs; i++, place += 2 * sizeof(uint32_t)) {
        uint32_t run[2];
        memcpy(run, (const char *)w->message->bytes + place, sizeof run);
        at += run[0];
        for (size_t left = run[1], now; left > 0; left -= now, at += now) { /* row by row */
            const size_t x = at % wide;
            now = wide - x < left ? wide - x : left;
            put_pixels(w, pixel_of(w->layers, from, h->area.x0 + (int32_t)x, h->area.y0 + (int32_t)(at / wide)), now);
        }
    }
}

static bool put_layer(writer *w, const layer *from, int32_t y0, int32_t y1)
{
    head h = {.first = from->first, .end = from->end, .area = active_area(w->layers, from, y0, y1)};
    const size_t area = (size_t)(h.area.x1 - h.area.x0) * (size_t)(h.area.y1 - h.area.y0);
    if (!reserve(w, sizeof h + area * pixel_bytes(w->layers) + (area + 2) * 2 * sizeof(uint32_t)))
        return false;
    const size_t begin = w->message->count;
    put(w, &h, sizeof h);
    if (area > 0) {
        put_runs(w, from, &h);
        put_active(w, from, &h, begin + sizeof h);
    }
    memcpy((char *)w->message->bytes + begin, &h, sizeof h);
    return true;
}

cluster_status layers_pack(const layers *l, int32_t y0, int32_t y1, node_message *m, vodr_error *error)
{
    writer w = {l, m, 0};
    *m = (node_message){0};
    bool well = reserve(&w, 1);
    for (int32_t i = 0; well && i < l->count; i++)
        well = put_layer(&w, &l->layer[i], y0, y1);
    if (well)
        return CLUSTER_OK;
    node_message_free(m);
    return cluster_no_memory(error);
}

/* ---- the other way ---- */

static void get_pixels(const layers *l, const char *from, float *to, size_t count)
{
    if (!is_16_bits(l)) {
        memcpy(to, from, count * pixel_bytes(l));
        return;
    }
    for (size_t i = 0; i < 4 * count; i++) {
        uint16_t rounded;
        memcpy(&rounded, from + i * sizeof rounded, sizeof rounded);
        to[i] = (float)rounded * (1 / 65535.0f);
    }
}

static void get_runs(const layers *l, const head *h, const char *runs, layer *to)
{
    const char *pixel = runs + (size_t)h->runs * 2 * sizeof(uint32_t);
    float *place = to->pixel;
    for (uint32_t i = 0; i < h->runs; i++, runs += 2 * sizeof(uint32_t)) {
        uint32_t run[2];
        memcpy(run, runs, sizeof run);
        place += run[0] * channels_of(l);
        get_pixels(l, pixel, place, run[1]);
        place += run[1] * channels_of(l);
        pixel += run[1] * pixel_bytes(l);
    }
}

cluster_status layers_unpack(layers *l, const node_message *m, vodr_error *error)
{
    for (const char *at = m->bytes, *end = at + m->count; at < end;) {
        head h;
        memcpy(&h, at, sizeof h);
        cluster_status status = layers_add(l, h.first, h.end, h.area, error);
        if (status != CLUSTER_OK)
            return status;
        get_runs(l, &h, at + sizeof h, &l->layer[l->count - 1]);
        at += sizeof h + h.runs * 2 * sizeof(uint32_t) + h.pixels * pixel_bytes(l);
    }
    return CLUSTER_OK;
}
