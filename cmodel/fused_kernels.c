/* fused_kernels.c - each body is written once as loops that gcc and clang vectorise, and inlined into one function an
 * instruction set. Table and word look-ups stay scalar loads: they go faster than gather instructions where those are
 * slow and no slower elsewhere. */
#include "fused_kernels.h"

#define INLINE static inline __attribute__((always_inline))

/* `count` rounded up to whole groups. */
INLINE int32_t groups_of(int32_t count)
{
    return (count + FUSED_LANES - 1) / FUSED_LANES;
}

INLINE void address_body(const fused_texture *t, const fused_row *row, int32_t count, fused_batch *b, int32_t at)
{
    uint32_t position[3][FUSED_LANES], mask = (1u << t->weight_bits) - 1;
    int32_t down = 24 - t->weight_bits, up = 15 - t->weight_bits;
    for (int32_t first = 0; first < count; first += FUSED_LANES) {
        for (int c = 0; c < 3; c++) {
            uint64_t a = row->a[c] + (uint64_t)first * row->step[c], step = row->step[c];
            if (row->shift)
                for (uint32_t i = 0; i < FUSED_LANES; i++)
                    position[c][i] = row->start[c] + (uint32_t)((a + i * step) >> row->shift);
            else
                for (uint32_t i = 0; i < FUSED_LANES; i++)
                    position[c][i] = row->start[c] + (uint32_t)a + i * (uint32_t)step;
        }
        uint32_t *index = b->index + at + first, *wx = b->wx.word + at + first, *wy = b->wy.word + at + first;
        int32_t *wz = b->wz + at + first;
        for (int i = 0; i < FUSED_LANES; i++) {
            uint32_t x = position[0][i], y = position[1][i], z = position[2][i];
            index[i] = (x >> 24) + (y >> 24) * t->row_stride + (z >> 24) * t->plane_stride;
            wx[i] = (((x >> down) & mask) << up) * 0x10001u;
            wy[i] = (((y >> down) & mask) << up) * 0x10001u;
            wz[i] = (int32_t)((z >> down) & mask);
        }
    }
}

/* a + (d*w >> weight_bits), with w raised to bits 14 down and d doubled: floor either way. */
INLINE int16_t step_half(int16_t d, int16_t w)
{
    return (int16_t)(((int32_t)d * w) >> 16);
}

INLINE void linear8_body(const fused_texture *t, int32_t count, fused_batch *b)
{
    const uint32_t *words = t->words;
    int32_t guard = t->guard_bits, half = (1 << guard) >> 1, whole = groups_of(count) * FUSED_LANES;
    for (int32_t i = 0; i < count; i++) {
        b->near.word[i] = words[b->index[i]];
        b->far.word[i] = words[b->index[i] + t->plane_stride];
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
        b->density[i] = (uint16_t)((near + (((far - near) * b->wz[i]) >> t->weight_bits) + half) >> guard);
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
    for (int32_t first = 0; first < count; first += FUSED_LANES) {
        uint64_t near[FUSED_LANES], far[FUSED_LANES];
        int32_t last = count - first < FUSED_LANES ? count - first : FUSED_LANES;
        const uint32_t *index = b->index + first, *wx = b->wx.word + first, *wy = b->wy.word + first;
        for (int32_t i = 0; i < FUSED_LANES; i++) {
            near[i] = i < last ? words[index[i]] : 0;
            far[i] = i < last ? words[index[i] + t->plane_stride] : 0;
        }
        for (int32_t i = 0; i < FUSED_LANES; i++) {
            int32_t x = (int32_t)((wx[i] & 0xffff) >> down), y = (int32_t)((wy[i] & 0xffff) >> down);
            int32_t n = plane12(near[i], x, y, bits, guard), f = plane12(far[i], x, y, bits, guard);
            b->density[first + i] = (uint16_t)((lerp(n, f, b->wz[first + i], bits) + half) >> guard);
        }
    }
}

INLINE void nearest8_body(const fused_texture *t, int32_t count, fused_batch *b)
{
    const uint32_t *words = t->words;
    for (int32_t i = 0; i < count; i++)
        b->density[i] = (uint16_t)words[b->index[i]];
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

INLINE void over8_body(const uint32_t *table, const uint16_t *density, int32_t count, uint32_t *pixels)
{
    for (int32_t first = 0; first < count; first += FUSED_LANES) {
        uint32_t source[FUSED_LANES];
        int32_t last = count - first < FUSED_LANES ? count - first : FUSED_LANES;
        for (int32_t i = 0; i < FUSED_LANES; i++)
            source[i] = i < last ? table[density[first + i]] : 0;
        for (int32_t i = 0; i < FUSED_LANES; i++) {
            uint32_t pixel = pixels[first + i], through = 255 - (source[i] >> 24);
            uint32_t even = scale_pair(pixel & 0x00ff00ffu, through),
                     odd = scale_pair((pixel >> 8) & 0x00ff00ffu, through);
            pixels[first + i] = source[i] + (even | (odd << 8));
        }
    }
}

INLINE uint64_t scale16(uint64_t channel, uint64_t m)
{
    uint32_t t = (uint32_t)channel * (uint32_t)m + 0x8000u;
    return (t + (t >> 16)) >> 16;
}

INLINE void over16_body(const uint64_t *table, const uint16_t *density, int32_t count, uint64_t *pixels)
{
    for (int32_t first = 0; first < count; first += FUSED_LANES) {
        uint64_t source[FUSED_LANES];
        int32_t last = count - first < FUSED_LANES ? count - first : FUSED_LANES;
        for (int32_t i = 0; i < FUSED_LANES; i++)
            source[i] = i < last ? table[density[first + i]] : 0;
        for (int32_t i = 0; i < FUSED_LANES; i++) {
            uint64_t p = pixels[first + i], m = 65535 - (source[i] >> 48);
            pixels[first + i] = source[i] + (scale16(p & 0xffff, m) | scale16((p >> 16) & 0xffff, m) << 16 |
                                             scale16((p >> 32) & 0xffff, m) << 32 | scale16(p >> 48, m) << 48);
        }
    }
}

#define DEFINE_KERNELS(set, target)                                                                                    \
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
    target static void over8_##set(const uint32_t *table, const uint16_t *density, int32_t count, uint32_t *pixels)    \
    {                                                                                                                  \
        over8_body(table, density, count, pixels);                                                                     \
    }                                                                                                                  \
    target static void over16_##set(const uint64_t *table, const uint16_t *density, int32_t count, uint64_t *pixels)   \
    {                                                                                                                  \
        over16_body(table, density, count, pixels);                                                                    \
    }                                                                                                                  \
    static const fused_kernels kernels_##set = {address_##set,   linear8_##set, linear12_##set, nearest8_##set,        \
                                                nearest12_##set, over8_##set,   over16_##set}

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
