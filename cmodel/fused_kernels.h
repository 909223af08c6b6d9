/* fused_kernels.h - the inner loops of the fast path: address, filter, classify and blend, many fragments at once.
 * Written once in plain C and compiled for several instruction sets; all give the same bytes. Little-endian computers
 * only. */
#ifndef VODR_FUSED_KERNELS_H
#define VODR_FUSED_KERNELS_H

#include "vodr.h"

enum {
    FUSED_LANES = 16,  /* fragments are handled in groups of this many; what is over is computed and dropped */
    FUSED_BATCH = 512, /* fragments a batch holds */
    FUSED_ROOM = FUSED_BATCH + FUSED_LANES,
    FUSED_MAX_ROW_WORDS = 64,

    FUSED_TOUCHED = 1 << 16,
};

/* A fragment's two neighbours in y as halves of a word. */
typedef union fused_pairs {
    uint32_t word[FUSED_ROOM];
    int16_t half[2 * FUSED_ROOM];
} fused_pairs;

/* Fragments on their way, one array a quantity. Weights lie in bits 14 down of a half, so that the upper half of a
 * product with twice the difference is the interpolation's step; wx and wy twice, wz once as a plain integer. */
typedef struct fused_batch {
    _Alignas(64) uint32_t index[FUSED_ROOM];
    _Alignas(64) fused_pairs wx, wy;
    _Alignas(64) uint32_t wz[FUSED_ROOM];
    _Alignas(64) uint16_t density[FUSED_ROOM];
    _Alignas(64) uint32_t colour8[FUSED_ROOM]; /* of the two, the one of the frame buffer's width */
    _Alignas(64) uint64_t colour16[FUSED_ROOM];
    _Alignas(64) uint8_t flag[FUSED_ROOM]; /* 0 or 1: whether a fragment lived, or wrote */
    _Alignas(64) fused_pairs near, far, other;
    _Alignas(64) uint64_t near12[FUSED_ROOM], far12[FUSED_ROOM];
} fused_batch;

/* A brick's densities, repacked: word (x, y, z), at x + (y << row_bits) + (z << plane_bits), holds voxels (x, y),
 * (x+1, y), (x, y+1), (x+1, y+1) of plane z in ascending bits, 8 bits each in a 32-bit word or 16 in a 64-bit word;
 * with filter=nearest the first alone. */
typedef struct fused_texture {
    const void *words;
    int32_t row_bits, plane_bits; /* a row has a multiple of FUSED_LANES words */
    int32_t weight_bits, guard_bits;
} fused_texture;

/* The positions of a row within a brick: (start + (a + i*step >> shift)) modulo 2^32, in units of 2^-24 voxel from the
 * first word. */
typedef struct fused_row {
    uint32_t start[3];
    uint64_t a[3], step[3];
    int32_t shift;
} fused_row;

/* Bounds of the densities seen, of 8 or 12 bits, column by column. */
typedef struct fused_range {
    uint8_t min8[FUSED_MAX_ROW_WORDS + 1], max8[FUSED_MAX_ROW_WORDS + 1];
    uint16_t min12[FUSED_MAX_ROW_WORDS + 1], max12[FUSED_MAX_ROW_WORDS + 1];
} fused_range;

typedef struct fused_kernels {
    /* One plane of words, `count` rows of `width`, from count + 1 rows of width + 1 densities; widens the range by
     * them. */
    void (*pack8)(const uint8_t *const *rows, int32_t count, int32_t width, uint32_t *words, fused_range *range);
    void (*pack12)(const uint16_t *const *rows, int32_t count, int32_t width, uint64_t *words, fused_range *range);
    /* Indices and weights of `count` fragments into the batch from `at` on; up to FUSED_LANES - 1 beyond are
     * overwritten. */
    void (*address)(const fused_texture *t, const fused_row *row, int32_t count, fused_batch *b, int32_t at);
    /* Densities of the batch's first `count` fragments: 8 or 12 bits, linear or nearest. */
    void (*linear8)(const fused_texture *t, int32_t count, fused_batch *b);
    void (*linear12)(const fused_texture *t, int32_t count, fused_batch *b);
    void (*nearest8)(const fused_texture *t, int32_t count, fused_batch *b);
    void (*nearest12)(const fused_texture *t, int32_t count, fused_batch *b);
    /* `count` colours onto a row of pixels of four 8- or 16-bit channels, r lowest. Rewrites, unchanged, up to
     * FUSED_LANES - 1 pixels beyond. written[i]: whether fragment i wrote its pixel. */
    void (*over8)(const uint32_t *colour, int32_t count, uint32_t *pixels);
    void (*over16)(const uint64_t *colour, int32_t count, uint64_t *pixels);
    void (*under8)(const uint32_t *colour, int32_t count, uint32_t *pixels, uint8_t *written);
    void (*under16)(const uint64_t *colour, int32_t count, uint64_t *pixels, uint8_t *written);
    /* mip: a pixel is the largest token so far, and zero at first; the token of a density is FUSED_TOUCHED more. */
    void (*mip)(const uint32_t *token, int32_t count, uint32_t *pixels, uint8_t *written);
} fused_kernels;

/* The kernels for an instruction set, or the best the computer has below it. */
const fused_kernels *fused_kernels_for(vodr_simd simd);

#endif
