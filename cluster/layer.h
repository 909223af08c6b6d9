/* layer.h - private to cluster/: a piece of picture with its place in the order of sight, between nodes as runs of
 * active pixels within their bounding box. */
#ifndef CLUSTER_LAYER_H
#define CLUSTER_LAYER_H

#include "node.h"

/* Half-open, in pixels of the picture. */
typedef struct rectangle {
    int32_t x0, y0, x1, y1;
} rectangle;

static inline bool rectangle_is_empty(rectangle r)
{
    return r.x1 <= r.x0 || r.y1 <= r.y0;
}

/* The least that holds both. */
rectangle rectangle_union(rectangle a, rectangle b);

/* What the places [first, end) of the order show. A pixel is four floats r, g, b, a, premultiplied; of maxima one, the
 * stored value, -INFINITY where there is none. Pixels outside the rectangle are empty. */
typedef struct layer {
    int32_t first, end;
    rectangle area;
    float *pixel; /* owned; NULL where the area is empty */
} layer;

/* The layers that a node has, by their places. */
typedef struct layers {
    bool mip;
    int32_t bits; /* of a channel between nodes: 16 or 32 */
    int32_t count, room;
    layer *layer; /* owned */
} layers;

void layers_free(layers *l);

/* Adds an empty layer of this area. */
cluster_status layers_add(layers *l, int32_t first, int32_t end, rectangle area, vodr_error *error);

/* Puts the pixels of a march, `stored` where maxima are drawn, behind those of layer i, which has room for the area. */
void layers_march(layers *l, int32_t i, rectangle area, const double *rgba);

/* Makes one layer of those that follow on one another, after sorting them. */
cluster_status layers_merge(layers *l, vodr_error *error);

/* The rows [y0, y1) of all layers as a message. */
cluster_status layers_pack(const layers *l, int32_t y0, int32_t y1, node_message *m, vodr_error *error);

/* Adds the layers of a message. */
cluster_status layers_unpack(layers *l, const node_message *m, vodr_error *error);

/* Leaves only the rows [y0, y1). */
cluster_status layers_cut(layers *l, int32_t y0, int32_t y1, vodr_error *error);

#endif
