/* fused_kernels.c - each body is written once, as loops that gcc and clang vectorise, and inlined into one function an
 * instruction set. Look-ups stay scalar loads: they go faster than gather instructions where those are slow, and no
 * slower elsewhere. Loops that compute run over whole groups of lanes, so that no vector is left half done. */
#include "fused_kernels.h"

#include <string.h>

#define INLINE static inline __attribute__((always_inline))

/* `count` rounded up to whole groups of lanes. */
INLINE int32_t whole_groups(int32_t count)
{
    return (count + FUSED_LANES - 1) & -FUSED_LANES;
}

typedef uint8_t bytes __attribute__((vector_size(16)));
typedef uint16_t pairs __attribute__((vector_size(16)));

/* Each of a row's 16 densities beside its right neighbour. */
INLINE void pair_up(const uint8_t *row, pairs *low, pairs *high)
{
    bytes left, right;
    memcpy(&left, row, sizeof left);
    memcpy(&right, row + 1, sizeof right);
    *low = (pairs)__builtin_shufflevector(left, right, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23);
    *high = (pairs)__builtin_shufflevector(left, right, 8, 24, 9, 25, 10, 26, 11, 27, 12, 28, 13, 29, 14, 30, 15, 31);
}

/* Eight words from eight pairs of the upper row and the eight below them. */
INLINE void store_words(pairs upper, pairs lower, uint32_t *words)
{
    pairs first = __builtin_shufflevector(upper, lower, 0, 8, 1, 9, 2, 10, 3, 11);
    pairs second = __builtin_shufflevector(upper, lower, 4, 12, 5, 13, 6, 14, 7, 15);
    memcpy(words, &first, sizeof first);
    memcpy(words + 4, &second, sizeof second);
}

INLINE void pack8_body(const uint8_t *const *rows, int32_t count, int32_t width, uint32_t *words, fused_range *range)
{
    for (int32_t x = 0; x < width; x += FUSED_LANES) {
        pairs upper[2], lower[2];
        pair_up(rows[0] + x, &upper[0], &upper[1]);
        for (int32_t y = 0; y < count; y++) {
            pair_up(rows[y + 1] + x, &lower[0], &lower[1]);
            store_words(upper[0], lower[0], words + y * width + x);
            store_words(upper[1], lower[1], words + y * width + x + 8);
            upper[0] = lower[0];
            upper[1] = lower[1];
        }
    }
    uint8_t *restrict min = range->min8, *restrict max = range->max8;
    for (int32_t y = 0; y <= count; y++) {
        const uint8_t *restrict row = rows[y];
        for (int32_t x = 0; x <= width; x++) {
            min[x] = row[x] < min[x] ? row[x] : min[x];
            max[x] = row[x] > max[x] ? row[x] : max[x];
        }
    }
}

INLINE void pack12_body(const uint16_t *const *rows, int32_t count, int32_t width, uint64_t *words, fused_range *range)
{
    for (int32_t y = 0; y < count; y++, words += width) {
        const uint16_t *upper = rows[y], *lower = rows[y + 1];
        for (int32_t x = 0; x < width; x++)
            words[x] = (uint64_t)upper[x] | (uint64_t)upper[x + 1] << 16 | (uint64_t)lower[x] << 32 |
                       (uint64_t)lower[x + 1] << 48;
    }
    uint16_t *restrict min = range->min12, *restrict max = range->max12;
    for (int32_t y = 0; y <= count; y++) {
        const uint16_t *restrict row = rows[y];
        for (int32_t x = 0; x <= width; x++) {
            min[x] = row[x] < min[x] ? row[x] : min[x];
            max[x] = row[x] > max[x] ? row[x] : max[x];
        }
    }
}

/* Position i of a row along axis c, in units of 2^-24 voxel from the brick's first word. */
INLINE uint32_t position(const fused_row *row, int c, uint32_t i, bool shifted)
{
    if (shifted)
        return row->start[c] + (uint32_t)((row->a[c] + i * row->step[c]) >> row->shift);
    return row->start[c] + (uint32_t)row->a[c] + i * (uint32_t)row->step[c];
}

INLINE void address_loop(const fused_texture *t, const fused_row *row, uint32_t count, fused_batch *b, int32_t at,
                         bool shifted)
{
    const fused_row r = *row;
    uint32_t mask = (1u << t->weight_bits) - 1;
    int32_t down = 24 - t->weight_bits, up = 15 - t->weight_bits, row_bits = t->row_bits, plane_bits = t->plane_bits;
    uint32_t *restrict index = b->index + at, *restrict wx = b->wx.word + at, *restrict wy = b->wy.word + at;
    uint32_t *restrict wz = b->wz + at;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t x = position(&r, 0, i, shifted), y = position(&r, 1, i, shifted), z = position(&r, 2, i, shifted);
        index[i] = (x >> 24) + ((y >> 24) << row_bits) + ((z >> 24) << plane_bits);
        wx[i] = (((x >> down) & mask) << up) * 0x10001u;
        wy[i] = (((y >> down) & mask) << up) * 0x10001u;
        wz[i] = (z >> down) & mask;
    }
}

INLINE void address_body(const fused_texture *t, const fused_row *row, int32_t count, fused_batch *b, int32_t at)
{
    if (row->shift)
        address_loop(t, row, (uint32_t)whole_groups(count), b, at, true);
    else
        address_loop(t, row, (uint32_t)whole_groups(count), b, at, false);
}

/* a + (d*w >> weight_bits), with w raised to bits 14 down and d doubled: floor either way. */
INLINE int16_t step_half(int16_t d, int16_t w)
{
    return (int16_t)(((int32_t)d * w) >> 16);
}

INLINE void linear8_body(const fused_texture *t, int32_t count, fused_batch *b)
{
    const uint32_t *words = t->words;
    int32_t guard = t->guard_bits, half = (1 << guard) >> 1, whole = whole_groups(count);
    uint32_t plane = 1u << t->plane_bits;
    for (int32_t i = 0; i < count; i++) {
        b->near.word[i] = words[b->index[i]];
        b->far.word[i] = words[b->index[i] + plane];
    }
    for (int32_t i = 0; i < 2 * whole; i++) {
        int16_t w = b->wx.half[i];
        int16_t n = (int16_t)(b->near.half[i] & 255), f = (int16_t)(b->far.half[i] & 255);
        int16_t dn = (int16_t)((uint16_t)b->near.half[i] >> 8), df = (int16_t)((uint16_t)b->far.half[i] >> 8);
        dn = (int16_t)((dn - n) * (2 << guard));
        df = (int16_t)((df - f) * (2 << guard));
        b->near.half[i] = (int16_t)((n << guard) + step_half(dn, w));
        b->far.half[i] = (int16_t)((f << guard) + step_half(df, w));
    }
    for (int32_t i = 0; i < whole; i++) { /* from pairs in y, near and far, to pairs in z, upper and lower */
        uint32_t near = b->near.word[i], far = b->far.word[i];
        b->near.word[i] = (near & 0xffff) | (far << 16);
        b->other.word[i] = (near >> 16) | (far & 0xffff0000u);
    }
    for (int32_t i = 0; i < 2 * whole; i++) {
        int16_t n = b->near.half[i], d = (int16_t)((b->other.half[i] - n) * 2);
        b->near.half[i] = (int16_t)(n + step_half(d, b->wy.half[i]));
    }
    for (int32_t i = 0; i < whole; i++) {
        int32_t near = (int32_t)(b->near.word[i] & 0xffff), far = (int32_t)(b->near.word[i] >> 16);
        b->density[i] = (uint16_t)((near + (((far - near) * (int32_t)b->wz[i]) >> t->weight_bits) + half) >> guard);
    }
}

INLINE int32_t lerp(int32_t a, int32_t b, int32_t w, int32_t bits)
{
    return a + (((b - a) * w) >> bits);
}

/* The four voxels of a 64-bit word, interpolated along x and y. */
INLINE int32_t plane12(uint64_t word, int32_t wx, int32_t wy, int32_t bits, int32_t guard)
{
    int32_t v00 = (int32_t)(word & 0xffff) << guard, v10 = (int32_t)((word >> 16) & 0xffff) << guard;
    int32_t v01 = (int32_t)((word >> 32) & 0xffff) << guard, v11 = (int32_t)(word >> 48) << guard;
    return lerp(lerp(v00, v10, wx, bits), lerp(v01, v11, wx, bits), wy, bits);
}

INLINE void linear12_body(const fused_texture *t, int32_t count, fused_batch *b)
{
    const uint64_t *words = t->words;
    int32_t guard = t->guard_bits, half = (1 << guard) >> 1, bits = t->weight_bits, down = 15 - bits;
    int32_t whole = whole_groups(count);
    uint32_t plane = 1u << t->plane_bits;
    for (int32_t i = 0; i < count; i++) {
        b->near12[i] = words[b->index[i]];
        b->far12[i] = words[b->index[i] + plane];
    }
    for (int32_t i = 0; i < whole; i++) {
        int32_t x = (int32_t)((b->wx.word[i] & 0xffff) >> down), y = (int32_t)((b->wy.word[i] & 0xffff) >> down);
        int32_t near = plane12(b->near12[i], x, y, bits, guard), far = plane12(b->far12[i], x, y, bits, guard);
        b->density[i] = (uint16_t)((lerp(near, far, (int32_t)b->wz[i], bits) + half) >> guard);
    }
}

INLINE void nearest8_body(const fused_texture *t, int32_t count, fused_batch *b)
{
    const uint32_t *words = t->words;
    for (int32_t i = 0; i < count; i++)
        b->density[i] = (uint16_t)(words[b->index[i]] & 0xff);
}

INLINE void nearest12_body(const fused_texture *t, int32_t count, fused_batch *b)
{
    const uint64_t *words = t->words;
    for (int32_t i = 0; i < count; i++)
        b->density[i] = (uint16_t)words[b->index[i]];
}

/* Two channels of a pixel at once, 16 bits apart: x*m/255 to nearest, each x and m below 256. */
INLINE uint32_t scale_pair(uint32_t pair, uint32_t m)
{
    uint32_t t = pair * m + 0x00800080u;
    return ((t + ((t >> 8) & 0x00ff00ffu)) >> 8) & 0x00ff00ffu;
}

/* All ones where i < count, else zero; a comparison would tempt the compiler to split the loop. */
INLINE uint32_t lane_mask(int32_t i, int32_t count)
{
    return (uint32_t)((i - count) >> 31);
}

INLINE uint64_t wide_mask(int32_t i, int32_t count)
{
    return (uint64_t)((int64_t)(i - count) >> 63);
}

/* near in front of far. */
INLINE uint32_t composite8(uint32_t near, uint32_t far)
{
    uint32_t through = 255 - (near >> 24);
    uint32_t even = scale_pair(far & 0x00ff00ffu, through), odd = scale_pair((far >> 8) & 0x00ff00ffu, through);
    return near + (even | (odd << 8));
}

INLINE void over8_body(const uint32_t *restrict colour, int32_t count, uint32_t *restrict pixels)
{
    int32_t whole = whole_groups(count);
    for (int32_t i = 0; i < whole; i++)
        pixels[i] = composite8(colour[i] & lane_mask(i, count), pixels[i]);
}

INLINE void under8_body(const uint32_t *restrict colour, int32_t count, uint32_t *restrict pixels,
                        uint8_t *restrict written)
{
    int32_t whole = whole_groups(count);
    for (int32_t i = 0; i < whole; i++)
        written[i] = pixels[i] >> 24 != 255;
    for (int32_t i = 0; i < whole; i++)
        pixels[i] = composite8(pixels[i], colour[i] & lane_mask(i, count));
}

INLINE void mip_body(const uint32_t *restrict token, int32_t count, uint32_t *restrict pixels,
                     uint8_t *restrict written)
{
    int32_t whole = whole_groups(count);
    for (int32_t i = 0; i < whole; i++)
        written[i] = token[i] > pixels[i];
    for (int32_t i = 0; i < whole; i++) {
        uint32_t t = token[i] & lane_mask(i, count);
        pixels[i] = t > pixels[i] ? t : pixels[i];
    }
}

INLINE uint64_t scale16(uint64_t channel, uint32_t m)
{
    uint32_t t = (uint32_t)channel * m + 0x8000u;
    return (t + (t >> 16)) >> 16;
}

INLINE uint64_t composite16(uint64_t near, uint64_t far)
{
    uint32_t through = 65535 - (uint32_t)(near >> 48);
    return near + (scale16(far & 0xffff, through) | scale16((far >> 16) & 0xffff, through) << 16 |
                   scale16((far >> 32) & 0xffff, through) << 32 | scale16(far >> 48, through) << 48);
}

INLINE void over16_body(const uint64_t *restrict colour, int32_t count, uint64_t *restrict pixels)
{
    int32_t whole = whole_groups(count);
    for (int32_t i = 0; i < whole; i++)
        pixels[i] = composite16(colour[i] & wide_mask(i, count), pixels[i]);
}

INLINE void under16_body(const uint64_t *restrict colour, int32_t count, uint64_t *restrict pixels,
                         uint8_t *restrict written)
{
    int32_t whole = whole_groups(count);
    for (int32_t i = 0; i < whole; i++)
        written[i] = pixels[i] >> 48 != 65535;
    for (int32_t i = 0; i < whole; i++)
        pixels[i] = composite16(pixels[i], colour[i] & wide_mask(i, count));
}

#define DEFINE_KERNELS(set, target)                                                                                    \
    target static void pack8_##set(const uint8_t *const *rows, int32_t count, int32_t width, uint32_t *words,          \
                                   fused_range *range)                                                                 \
    {                                                                                                                  \
        pack8_body(rows, count, width, words, range);                                                                  \
    }                                                                                                                  \
    target static void pack12_##set(const uint16_t *const *rows, int32_t count, int32_t width, uint64_t *words,        \
                                    fused_range *range)                                                                \
    {                                                                                                                  \
        pack12_body(rows, count, width, words, range);                                                                 \
    }                                                                                                                  \
    target static void address_##set(const fused_texture *t, const fused_row *row, int32_t count, fused_batch *b,      \
                                     int32_t at)                                                                       \
    {                                                                                                                  \
        address_body(t, row, count, b, at);                                                                            \
    }                                                                                                                  \
    target static void linear8_##set(const fused_texture *t, int32_t count, fused_batch *b)                            \
    {                                                                                                                  \
        linear8_body(t, count, b);                                                                                     \
    }                                                                                                                  \
    target static void linear12_##set(const fused_texture *t, int32_t count, fused_batch *b)                           \
    {                                                                                                                  \
        linear12_body(t, count, b);                                                                                    \
    }                                                                                                                  \
    target static void nearest8_##set(const fused_texture *t, int32_t count, fused_batch *b)                           \
    {                                                                                                                  \
        nearest8_body(t, count, b);                                                                                    \
    }                                                                                                                  \
    target static void nearest12_##set(const fused_texture *t, int32_t count, fused_batch *b)                          \
    {                                                                                                                  \
        nearest12_body(t, count, b);                                                                                   \
    }                                                                                                                  \
    target static void over8_##set(const uint32_t *colour, int32_t count, uint32_t *pixels)                            \
    {                                                                                                                  \
        over8_body(colour, count, pixels);                                                                             \
    }                                                                                                                  \
    target static void over16_##set(const uint64_t *colour, int32_t count, uint64_t *pixels)                           \
    {                                                                                                                  \
        over16_body(colour, count, pixels);                                                                            \
    }                                                                                                                  \
    target static void under8_##set(const uint32_t *colour, int32_t count, uint32_t *pixels, uint8_t *written)         \
    {                                                                                                                  \
        under8_body(colour, count, pixels, written);                                                                   \
    }                                                                                                                  \
    target static void under16_##set(const uint64_t *colour, int32_t count, uint64_t *pixels, uint8_t *written)        \
    {                                                                                                                  \
        under16_body(colour, count, pixels, written);                                                                  \
    }                                                                                                                  \
    target static void mip_##set(const uint32_t *token, int32_t count, uint32_t *pixels, uint8_t *written)             \
    {                                                                                                                  \
        mip_body(token, count, pixels, written);                                                                       \
    }                                                                                                                  \
    static const fused_kernels kernels_##set = {.pack8 = pack8_##set,                                                  \
                                                .pack12 = pack12_##set,                                                \
                                                .address = address_##set,                                              \
                                                .linear8 = linear8_##set,                                              \
                                                .linear12 = linear12_##set,                                            \
                                                .nearest8 = nearest8_##set,                                            \
                                                .nearest12 = nearest12_##set,                                          \
                                                .over8 = over8_##set,                                                  \
                                                .over16 = over16_##set,                                                \
                                                .under8 = under8_##set,                                                \
                                                .under16 = under16_##set,                                              \
                                                .mip = mip_##set}

DEFINE_KERNELS(portable, );

#if defined(__x86_64__)
DEFINE_KERNELS(avx2, __attribute__((target("avx2"))));
DEFINE_KERNELS(avx512, __attribute__((target("avx512f,avx512bw,avx512dq,avx512vl"))));

const fused_kernels *fused_kernels_for(vodr_simd simd)
{
    bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                  __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
    if ((simd == VODR_SIMD_BEST || simd == VODR_SIMD_AVX512) && avx512)
        return &kernels_avx512;
    if (simd != VODR_SIMD_PORTABLE && __builtin_cpu_supports("avx2"))
        return &kernels_avx2;
    return &kernels_portable;
}
#else
const fused_kernels *fused_kernels_for(vodr_simd simd)
{
    (void)simd;
    return &kernels_portable;
}
#endif
