/* lanes_cpu_float.h - the look-ups of lanes_cpu.h for sixteen floats: one load a lane, of all that the lane needs, and
 * the loads turned so that each number lies in a vector of its own. */
#ifndef REFERENCE_LANES_CPU_FLOAT_H
#define REFERENCE_LANES_CPU_FLOAT_H

typedef int32_t four __attribute__((vector_size(16)));
typedef uint64_t two_wide __attribute__((vector_size(16)));
typedef uint16_t shorts __attribute__((vector_size(32)));

#define JOIN_8(a, b) __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7)
#define JOIN_16(a, b) __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15)
/* In each quarter of the vectors: elements i and j of a, then k and l of b; those of b count from 4. */
#define QUARTERS(a, b, i, j, k, l)                                                                                     \
    __builtin_shufflevector(a, b, i, j, k + 12, l + 12, i + 4, j + 4, k + 16, l + 16, i + 8, j + 8, k + 20, l + 20,    \
                            i + 12, j + 12, k + 24, l + 24)

KERNEL whole join(four a, four b, four c, four d)
{
    return JOIN_16(JOIN_8(a, b), JOIN_8(c, d));
}

/* Loads 16 bytes a lane, `stride` bytes times index[] on; column[c] becomes word c of all lanes. */
KERNEL void load_columns(const void *base, size_t stride, const int32_t index[LANES], whole column[4])
{
    four row[LANES];
    whole turned[4];
    for (int l = 0; l < LANES; l++)
        memcpy(&row[l], (const char *)base + stride * (size_t)index[l], sizeof row[l]);
    for (int i = 0; i < 4; i++)
        turned[i] = join(row[i], row[4 + i], row[8 + i], row[12 + i]);
    whole even = QUARTERS(turned[0], turned[1], 0, 1, 4, 5), odd = QUARTERS(turned[2], turned[3], 0, 1, 4, 5);
    column[0] = QUARTERS(even, odd, 0, 2, 4, 6);
    column[1] = QUARTERS(even, odd, 1, 3, 5, 7);
    even = QUARTERS(turned[0], turned[1], 2, 3, 6, 7), odd = QUARTERS(turned[2], turned[3], 2, 3, 6, 7);
    column[2] = QUARTERS(even, odd, 0, 2, 4, 6);
    column[3] = QUARTERS(even, odd, 1, 3, 5, 7);
}

/* The same of 8 bytes. */
KERNEL void load_pairs(const void *base, size_t stride, const int32_t index[LANES], whole column[2])
{
    four row[LANES / 2];
    for (int l = 0; l < LANES; l += 2) {
        uint64_t first, second;
        memcpy(&first, (const char *)base + stride * (size_t)index[l], sizeof first);
        memcpy(&second, (const char *)base + stride * (size_t)index[l + 1], sizeof second);
        row[l / 2] = (four)(two_wide){first, second};
    }
    whole even = join(row[0], row[2], row[4], row[6]), odd = join(row[1], row[3], row[5], row[7]);
    column[0] = QUARTERS(even, odd, 0, 2, 4, 6);
    column[1] = QUARTERS(even, odd, 1, 3, 5, 7);
}

/* Loads 2 bytes a lane, `stride` bytes times index[] on. */
KERNEL whole load_shorts(const void *base, size_t stride, whole index)
{
    int32_t at[LANES];
    uint16_t lane[LANES];
    shorts row;
    memcpy(at, &index, sizeof at);
    for (int l = 0; l < LANES; l++)
        memcpy(&lane[l], (const char *)base + stride * (size_t)at[l], sizeof lane[l]);
    for (int l = 0; l < LANES; l++)
        row[l] = lane[l];
    return __builtin_convertvector(row, whole);
}

/* Loads 4 bytes a lane, 2 bytes times index[] on. */
KERNEL whole load_words(const void *base, whole index)
{
    int32_t at[LANES], lane[LANES];
    memcpy(at, &index, sizeof at);
    for (int l = 0; l < LANES; l++)
        memcpy(&lane[l], (const char *)base + 2 * (size_t)at[l], sizeof lane[l]);
    const four a = {lane[0], lane[1], lane[2], lane[3]}, b = {lane[4], lane[5], lane[6], lane[7]};
    const four c = {lane[8], lane[9], lane[10], lane[11]}, d = {lane[12], lane[13], lane[14], lane[15]};
    return join(a, b, c, d);
}

KERNEL whole fetch_word(const uint16_t *words, whole index)
{
    return load_shorts(words, sizeof *words, index);
}

/* Mixes voxel `shift` bits up in the words. */
KERNEL real mix_words(whole low, whole high, int shift, int32_t mask_of_voxel, real share)
{
    real a = to_real(low >> shift & mask_of_voxel), b = to_real(high >> shift & mask_of_voxel);
    return a + (b - a) * share;
}

/* The number of a place's cell, and the place's shares of it. */
KERNEL whole cell_of(const kernel_volume *v, const real place[3], real share[3])
{
    whole cell[3];
    for (int a = 0; a < 3; a++) {
        cell[a] = truncate(place[a]);
        share[a] = place[a] - to_real(cell[a]);
    }
    return (cell[2] * (v->dims_vox[1] + 1) + cell[1]) * (v->dims_vox[0] + 2) + cell[0];
}

/* Asks for the cells of places that will be sampled soon. */
KERNEL void fetch_ahead(const kernel_volume *v, reference_voxel type, const real place[3])
{
    real share[3];
    int32_t index[LANES];
    whole cell = cell_of(v, place, share);
    memcpy(index, &cell, sizeof index);
    for (int l = 0; l < LANES; l++)
        __builtin_prefetch((const char *)v->cells + (type == REFERENCE_UINT8 ? 4 : 8) * (size_t)index[l]);
}

/* What lies on the four edges of a place's cell that run along x, y fastest, and the place's shares of the cell. An
 * entry of v->cells is the four voxels around a cell at one end of it in x, y fastest; the entry behind it is at the
 * other. */
KERNEL void fetch_edges(const kernel_volume *v, reference_voxel type, const real place[3], real share[3], real edge[4])
{
    whole cell = cell_of(v, place, share), word[4];
    int32_t index[LANES];
    memcpy(index, &cell, sizeof index);
    if (type == REFERENCE_UINT8) {
        load_pairs(v->cells, 4, index, word);
        for (int i = 0; i < 4; i++)
            edge[i] = mix_words(word[0], word[1], 8 * i, 0xFF, share[0]);
    } else {
        load_columns(v->cells, 8, index, word);
        for (int i = 0; i < 4; i++)
            edge[i] = mix_words(word[i / 2], word[2 + i / 2], 16 * (i % 2), 0xFFFF, share[0]);
    }
}

/* What fetch_edges() does, from the voxels as they are, two of a row at a time; false where a lane's cell lies on the
 * volume's border, or voxels are floats. */
KERNEL bool fetch_pairs(const kernel_volume *v, reference_voxel type, const real place[3], real share[3], real edge[4])
{
    const int32_t *size = v->dims_vox;
    const size_t bytes = type == REFERENCE_UINT8 ? 1 : 2;
    whole low[3];
    mask border = spread_whole(0);
    if (type == REFERENCE_FLOAT32)
        return false;
    for (int a = 0; a < 3; a++) {
        whole cell = truncate(place[a]);
        share[a] = place[a] - to_real(cell);
        low[a] = cell - 1;
        border = border | (low[a] < 0) | (low[a] > size[a] - 2);
    }
    if (any_lane(border))
        return false;
    whole first = (low[2] * size[1] + low[1]) * size[0] + low[0];
    for (int i = 0; i < 4; i++) {
        const size_t row = (size_t)(i % 2) * (size_t)size[0] + (size_t)(i / 2) * (size_t)size[0] * (size_t)size[1];
        const char *voxels = (const char *)v->voxels + bytes * row;
        const whole pair = bytes == 1 ? load_shorts(voxels, bytes, first) : load_words(voxels, first);
        const int shift = bytes == 1 ? 8 : 16;
        edge[i] = mix_words(pair, pair >> shift, 0, (1 << shift) - 1, share[0]);
    }
    return true;
}

/* The colour between entry `at` and the one behind it. */
KERNEL void fetch_colour(const lookup *table, whole at, real share, real colour[4])
{
    int32_t index[LANES];
    whole column[2][4];
    memcpy(index, &at, sizeof index);
    load_columns(table->rgba, 16, index, column[0]);
    load_columns(table->rgba + 4, 16, index, column[1]);
    for (int c = 0; c < 4; c++) {
        real entry = (real)column[0][c];
        colour[c] = entry + ((real)column[1][c] - entry) * share;
    }
}

#endif
