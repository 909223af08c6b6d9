/* lanes_cpu_cubic.h - the cubic filters of kernel_cubic.h for sixteen floats: one ray after the other, the 16 voxels of
 * a layer in one vector, so that rays that have no sample to take cost nothing. */
#ifndef REFERENCE_LANES_CPU_CUBIC_H
#define REFERENCE_LANES_CPU_CUBIC_H

typedef float half_real __attribute__((vector_size(32)));
typedef float quarter_real __attribute__((vector_size(16)));
typedef uint8_t layer_bytes __attribute__((vector_size(16)));
typedef uint64_t layer_shorts __attribute__((vector_size(32)));

/* What the four weights have of the share's powers 3 to 0. In a layer's vector x runs fastest. */
#define CUBIC_ALONG_X(a, b, c, d)                                                                                      \
    {                                                                                                                  \
        a, b, c, d, a, b, c, d, a, b, c, d, a, b, c, d                                                                 \
    }
#define CUBIC_ALONG_Y(a, b, c, d)                                                                                      \
    {                                                                                                                  \
        a, a, a, a, b, b, b, b, c, c, c, c, d, d, d, d                                                                 \
    }
#define CUBIC_ALONG_Z(a, b, c, d)                                                                                      \
    {                                                                                                                  \
        a, b, c, d                                                                                                     \
    }
#define CUBIC_CARDINAL(along)                                                                                          \
    {                                                                                                                  \
        along(-0.5F, 1.5F, -1.5F, 0.5F), along(1, -2.5F, 2, -0.5F), along(-0.5F, 0, 0.5F, 0), along(0, 1, 0, 0)        \
    }
#define CUBIC_BSPLINE(along)                                                                                           \
    {                                                                                                                  \
        along(-1 / 6.0F, 0.5F, -0.5F, 1 / 6.0F), along(0.5F, -1, 0.5F, 0), along(-0.5F, 0, 0.5F, 0),                   \
            along(1 / 6.0F, 2 / 3.0F, 1 / 6.0F, 0)                                                                     \
    }

static const real cubic_along_x[2][4] = {CUBIC_CARDINAL(CUBIC_ALONG_X), CUBIC_BSPLINE(CUBIC_ALONG_X)};
static const real cubic_along_y[2][4] = {CUBIC_CARDINAL(CUBIC_ALONG_Y), CUBIC_BSPLINE(CUBIC_ALONG_Y)};
static const quarter_real cubic_along_z[2][4] = {CUBIC_CARDINAL(CUBIC_ALONG_Z), CUBIC_BSPLINE(CUBIC_ALONG_Z)};

KERNEL whole cubic_widen(layer_shorts line)
{
    shorts layer;
#if defined(__AVX512F__)
    return (whole)_mm512_cvtepu16_epi32((__m256i)line);
#endif
    memcpy(&layer, &line, sizeof layer);
    return __builtin_convertvector(layer, whole);
}

/* The layer of four rows of four voxels from number `first` on, `row` apart. */
KERNEL real cubic_layer(const void *voxels, reference_voxel type, ptrdiff_t first, ptrdiff_t row)
{
    if (type == REFERENCE_UINT8) {
        uint32_t line[4];
        layer_bytes layer;
        for (ptrdiff_t y = 0; y < 4; y++)
            memcpy(&line[y], (const uint8_t *)voxels + first + y * row, sizeof line[y]);
        const four all = {(int32_t)line[0], (int32_t)line[1], (int32_t)line[2], (int32_t)line[3]};
        memcpy(&layer, &all, sizeof layer);
        return to_real(cubic_widen((layer_shorts) __builtin_convertvector(layer, shorts)));
    }
    if (type == REFERENCE_UINT16) {
        uint64_t line[4];
        for (ptrdiff_t y = 0; y < 4; y++)
            memcpy(&line[y], (const uint16_t *)voxels + first + y * row, sizeof line[y]);
        return to_real(cubic_widen((layer_shorts){line[0], line[1], line[2], line[3]}));
    }
    four line[4];
    for (ptrdiff_t y = 0; y < 4; y++)
        memcpy(&line[y], (const float *)voxels + first + y * row, sizeof line[y]);
    return (real)join(line[0], line[1], line[2], line[3]);
}

/* Of KERNEL_QUADS: what a layer takes of the 32 voxels of two quads, x slowest in each, where its rows begin with row
 * y of the first. */
#define CUBIC_ROW(y)                                                                                                   \
    (y) / 4 * 16 + (y) % 4, (y) / 4 * 16 + (y) % 4 + 4, (y) / 4 * 16 + (y) % 4 + 8, (y) / 4 * 16 + (y) % 4 + 12
#define CUBIC_ROWS(y)                                                                                                  \
    {                                                                                                                  \
        CUBIC_ROW(y), CUBIC_ROW(y + 1), CUBIC_ROW(y + 2), CUBIC_ROW(y + 3)                                             \
    }
static const whole cubic_turned[LAYOUT_QUAD] = {CUBIC_ROWS(0), CUBIC_ROWS(1), CUBIC_ROWS(2), CUBIC_ROWS(3)};

/* The four layers of a cell, of voxels in quads. */
KERNEL void cubic_quads(const kernel_volume *v, const int32_t cell[3], real layer[4])
{
    const ptrdiff_t quad = v->stride[1], next = v->stride[2];
    const int32_t y = cell[1] - 2;
    const float *at = (const float *)v->voxels + (cell[2] - 2) * next + (y >> 2) * quad + (cell[0] - 2) * LAYOUT_QUAD;
    const whole turned = cubic_turned[y & 3];
    for (int z = 0; z < 4; z++, at += next) {
#if defined(__AVX512F__)
        layer[z] = (real)_mm512_permutex2var_ps(_mm512_loadu_ps(at), (__m512i)turned, _mm512_loadu_ps(at + quad));
#else
        for (int n = 0; n < LANES; n++)
            layer[z][n] = turned[n] < LANES ? at[turned[n]] : at[quad + turned[n] - LANES];
#endif
    }
}

/* The four layers of a cell at the volume's border. */
APART void cubic_border(const kernel_volume *v, const int32_t cell[3], real layer[4])
{
    int32_t at[3][4];
    whole index;
    for (int a = 0; a < 3; a++)
        for (int n = 0; n < 4; n++) {
            const int32_t i = cell[a] + n - 2, last = v->dims_vox[a] - 1;
            at[a][n] = i < 0 ? 0 : i > last ? last : i;
        }
    for (int z = 0; z < 4; z++) {
        for (int n = 0; n < LANES; n++)
            index[n] = (at[2][z] * v->dims_vox[1] + at[1][n / 4]) * v->dims_vox[0] + at[0][n % 4];
        layer[z] = fetch(v, v->type, index);
    }
}

KERNEL real cubic_polynomial(const real power[4], float t)
{
    return ((power[0] * t + power[1]) * t + power[2]) * t + power[3];
}

KERNEL float cubic_total(real x)
{
    const half_real eight = __builtin_shufflevector(x, x, 0, 1, 2, 3, 4, 5, 6, 7) +
                            __builtin_shufflevector(x, x, 8, 9, 10, 11, 12, 13, 14, 15);
    const quarter_real four_sums =
        __builtin_shufflevector(eight, eight, 0, 1, 2, 3) + __builtin_shufflevector(eight, eight, 4, 5, 6, 7);
    const quarter_real two = four_sums + __builtin_shufflevector(four_sums, four_sums, 2, 3, 0, 1);
    return two[0] + two[1];
}

/* The weighted sum of four layers. */
KERNEL float cubic_value(bool spline, const real layer[4], const float t[3])
{
    const quarter_real *p = cubic_along_z[spline];
    const quarter_real z = ((p[0] * t[2] + p[1]) * t[2] + p[2]) * t[2] + p[3];
    const real across = cubic_polynomial(cubic_along_x[spline], t[0]) * cubic_polynomial(cubic_along_y[spline], t[1]);
    const real through = (layer[0] * z[0] + layer[1] * z[1]) + (layer[2] * z[2] + layer[3] * z[3]);
    return cubic_total(through * across);
}

/* Bit l: lane l. */
KERNEL uint32_t lane_bits(mask m)
{
#if defined(__AVX512F__)
    return _mm512_test_epi32_mask((__m512i)m, (__m512i)m);
#else
    int32_t lane[LANES];
    uint32_t bits = 0;
    memcpy(lane, &m, sizeof lane);
    for (int l = 0; l < LANES; l++)
        bits |= (lane[l] != 0 ? 1U : 0U) << l;
    return bits;
#endif
}

/* Where lanes sample: their cells, shares of them, and as bits which cells do not touch the border. */
typedef struct cubic_places {
    int32_t cell[3][LANES];
    float share[3][LANES];
    uint32_t inside;
} cubic_places;

/* The values of the lanes that are bits of `on`; type and spline are constants. */
KERNEL void cubic_lanes(const kernel_volume *v, reference_voxel type, bool spline, bool quads, const cubic_places *p,
                        uint32_t on, float value[LANES])
{
    const ptrdiff_t row = v->stride[1], next = v->stride[2];
    for (; on != 0; on &= on - 1) {
        const int l = __builtin_ctz(on);
        const int32_t at[3] = {p->cell[0][l], p->cell[1][l], p->cell[2][l]};
        const float t[3] = {p->share[0][l], p->share[1][l], p->share[2][l]};
        real layer[4];
        if (quads) {
            cubic_quads(v, at, layer);
        } else if (p->inside >> l & 1) {
            const ptrdiff_t first = (at[2] - 2) * next + (at[1] - 2) * row + (at[0] - 2);
            for (ptrdiff_t z = 0; z < 4; z++)
                layer[z] = cubic_layer(v->voxels, type, first + z * next, row);
        } else {
            cubic_border(v, at, layer);
        }
        value[l] = cubic_value(spline, layer, t);
    }
}

/* The same. Coefficients of B-splines are floats. */
APART void cubic_values(const kernel_volume *v, reference_voxel type, const cubic_places *p, uint32_t on,
                        float value[LANES])
{
    if (v->layout == KERNEL_QUADS)
        cubic_lanes(v, REFERENCE_FLOAT32, true, true, p, on, value);
    else if (v->spline)
        cubic_lanes(v, REFERENCE_FLOAT32, true, false, p, on, value);
    else if (type == REFERENCE_UINT8)
        cubic_lanes(v, REFERENCE_UINT8, false, false, p, on, value);
    else if (type == REFERENCE_UINT16)
        cubic_lanes(v, REFERENCE_UINT16, false, false, p, on, value);
    else
        cubic_lanes(v, REFERENCE_FLOAT32, false, false, p, on, value);
}

KERNEL real sample_cubic(const kernel_volume *v, reference_voxel type, const real place[3], mask on)
{
    const uint32_t bits = lane_bits(on);
    cubic_places p;
    real value = spread(0);
    mask inside = on;
    if (bits == 0)
        return value;
    for (int a = 0; a < 3; a++) {
        const whole i = truncate(place[a]);
        const real t = place[a] - to_real(i);
        memcpy(p.cell[a], &i, sizeof p.cell[a]);
        memcpy(p.share[a], &t, sizeof p.share[a]);
        if (v->layout == KERNEL_PLAIN)
            inside = inside & (i >= 2) & (i <= v->dims_vox[a] - 2);
    }
    p.inside = lane_bits(inside);
    float lane[LANES] = {0};
    cubic_values(v, type, &p, bits, lane);
    memcpy(&value, lane, sizeof value);
    return value;
}

KERNEL void cubic_ask(const kernel_frame *f, const real place[3])
{
    const whole cell = cubic_cell(&f->volume, place);
    for (int l = 0; l < LANES; l++)
        __builtin_prefetch(f->cells.codes + cell[l]);
}

#endif
