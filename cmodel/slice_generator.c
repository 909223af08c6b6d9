/* slice_generator.c - slices are global planes parallel to the image: slice k is the same plane in every brick, so a
 * brick needs no more than the range of k and its own borders. */
#include "slice_generator.h"

slice_generator slice_generator_start(const vodr_view *view, const vox_box *box, int32_t k0, int32_t k1,
                                      bool front_to_back)
{
    slice_generator g = {.view = view,
                         .k = front_to_back ? k1 - 1 : k0,
                         .end = front_to_back ? k0 - 1 : k1,
                         .step = front_to_back ? -1 : 1};
    for (int c = 0; c < 3; c++) {
        g.lo[c] = border_of(view, c, box->lo[c]);
        g.hi[c] = border_of(view, c, box->hi[c]);
    }
    return g;
}

bool slice_generator_next(slice_generator *g, brick_slice *slice)
{
    if (g->k == g->end)
        return false;
    slice->k = g->k;
    slice->plane = slice_plane_of(g->view, g->k);
    for (int c = 0; c < 3; c++) {
        slice->lo[c] = g->lo[c];
        slice->hi[c] = g->hi[c];
    }
    g->k += g->step;
    return true;
}
