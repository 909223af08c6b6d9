#include "cubic.h"

#include <stdlib.h>

#include "layout.h"
#include "voxels.h"

/* ---- weights ---- */

/* Catmull and Rom's. The outer two are rounded towards zero, so that their magnitudes never add up to more than an
 * eighth. */
static cubic_weights cardinal_weights(int64_t u, int32_t bits)
{
    const int64_t one = (int64_t)1 << bits, v = one - u;
    const int64_t w0 = -((2 * u * v * v) >> 2 * bits), w3 = -((2 * u * u * v) >> 2 * bits);
    const int64_t w2 = (2 * u * (one * one + 4 * u * one - 3 * u * u) + one * one / 2) >> 2 * bits;
    return (cubic_weights){{(int16_t)w0, (int16_t)(4 * one - w0 - w2 - w3), (int16_t)w2, (int16_t)w3}};
}

static cubic_weights bspline_weights(int64_t u, int32_t bits)
{
    const int64_t one = (int64_t)1 << bits, v = one - u, unit = 3 * one * one;
    const int64_t w0 = 2 * v * v * v / unit, w3 = 2 * u * u * u / unit;
    const int64_t w2 =
        (4 * (one * one * one + 3 * u * one * one + 3 * u * u * one - 3 * u * u * u) + unit) / (2 * unit);
    return (cubic_weights){{(int16_t)w0, (int16_t)(4 * one - w0 - w2 - w3), (int16_t)w2, (int16_t)w3}};
}

/* Of a coefficient. */
static int32_t fraction_bits(const vodr_machine *m)
{
    return m->filter == VODR_FILTER_BSPLINE && m->density_bits == 8 ? 3 : 0;
}

bool cubic_start(cubic *c, const vodr_machine *m)
{
    const int32_t count = 1 << m->weight_bits;
    *c = (cubic){.weight_bits = m->weight_bits + CUBIC_MORE_BITS,
                 .guard_bits = m->guard_bits,
                 .drop_bits = m->guard_bits + fraction_bits(m),
                 .most = (1 << m->density_bits) - 1};
    if (!filter_is_cubic(m))
        return true;
    c->weights = malloc((size_t)count * sizeof *c->weights);
    for (int32_t u = 0; c->weights && u < count; u++)
        c->weights[u] = m->filter == VODR_FILTER_CARDINAL ? cardinal_weights(u, m->weight_bits)
                                                          : bspline_weights(u, m->weight_bits);
    return c->weights != NULL;
}

void cubic_finish(cubic *c)
{
    free(c->weights);
    *c = (cubic){0};
}

/* ---- values ---- */

static int32_t round_density(int32_t value, int32_t drop_bits, int32_t most)
{
    int32_t density = (value + ((1 << drop_bits) >> 1)) >> drop_bits;
    return density < 0 ? 0 : density > most ? most : density;
}

/* Four voxels: they get their guard bits with the sum, which comes to the same and fits 32 bits before. */
static inline int32_t weigh_voxels(const cubic *c, const cubic_weights *w, const int32_t voxels[CUBIC_TAPS])
{
    const int32_t drop_bits = c->weight_bits - c->guard_bits;
    int32_t sum = 0;
    for (int i = 0; i < CUBIC_TAPS; i++)
        sum += w->tap[i] * voxels[i];
    return drop_bits >= 0 ? sum >> drop_bits : sum * (1 << -drop_bits);
}

/* Numbers have 22 bits with their sign, a sum 36. */
static inline int32_t weigh(const cubic *c, const cubic_weights *w, const int32_t values[CUBIC_TAPS])
{
    int64_t sum = 0;
    for (int i = 0; i < CUBIC_TAPS; i++)
        sum += (int64_t)w->tap[i] * values[i];
    return (int32_t)(sum >> c->weight_bits);
}

int32_t cubic_value(const cubic *c, const int32_t share[3], const int32_t voxels[CUBIC_VOXELS])
{
    int32_t along_x[16], along_y[4];
    for (int i = 0; i < 16; i++)
        along_x[i] = weigh_voxels(c, &c->weights[share[0]], voxels + 4 * i);
    for (int i = 0; i < 4; i++)
        along_y[i] = weigh(c, &c->weights[share[1]], along_x + 4 * i);
    return round_density(weigh(c, &c->weights[share[2]], along_y), c->drop_bits, c->most);
}

/* The weights of a B-spline are not negative: what they make lies between the least and the greatest coefficient. Those
 * of a cardinal spline make up to an eighth of the range more on both sides, along each axis. */
void filter_range(const vodr_machine *m, int32_t *min, int32_t *max)
{
    const int32_t drop_bits = m->guard_bits + fraction_bits(m), most = (1 << m->density_bits) - 1;
    int32_t lo = *min * (1 << m->guard_bits), hi = *max * (1 << m->guard_bits);
    if (!filter_is_cubic(m))
        return;
    for (int axis = 0; axis < 3 && m->filter == VODR_FILTER_CARDINAL; axis++) {
        const int32_t range = hi - lo;
        lo -= (range + 7) >> 3;
        hi += range >> 3;
    }
    *min = round_density(lo, drop_bits, most);
    *max = round_density(hi, drop_bits, most);
}

void filter_bounds(const vodr_machine *m, const vodr_volume *volume, const vox_box *box, int32_t *min, int32_t *max)
{
    const vox_box reach = voxels_reach(volume->dims_vox, box, filter_border_vox(m));
    voxels_range(volume, stored_bits(m), &reach, min, max);
    filter_range(m, min, max);
}
