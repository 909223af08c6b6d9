/* marks.h - what the fast path's picture tells its counting walk of each fragment: whether it lived, whether it wrote.
 *
 * Neither depends on the traversal: a pixel meets its fragments in the same order whatever the bricks. One bit a
 * fragment, in rows of the frame, slice after slice. */
#ifndef VODR_MARKS_H
#define VODR_MARKS_H

#include <string.h>

#include "vodr.h"

typedef struct marks {
    uint8_t *alive;   /* was not dropped by kill_transparent; NULL: all were */
    uint8_t *written; /* wrote its pixel; NULL: all that lived did */
    size_t row_bytes; /* with room for a word beyond the last bit */
    int32_t height_px;
} marks;

/* Little endian: bit x of a row is bit x%8 of byte x/8. */
static inline uint8_t *marks_row(const marks *m, uint8_t *bits, int32_t k, int32_t y)
{
    return bits + ((size_t)k * (size_t)m->height_px + (size_t)y) * m->row_bytes;
}

/* The bits of `count` fragments from x on, lowest first; count is at most 32. */
static inline uint32_t marks_get(const uint8_t *row, int32_t x, int32_t count)
{
    uint64_t word;
    memcpy(&word, row + (x >> 3), sizeof word);
    return (uint32_t)((word >> (x & 7)) & ((UINT64_C(1) << count) - 1));
}

/* Sets the bits of `count` fragments from x on whose flag is 1. */
static inline void marks_set(uint8_t *row, int32_t x, const uint8_t *flags, int32_t count)
{
    for (int32_t i = 0; i < count; i += 32) {
        uint64_t bits = 0, word;
        for (int32_t n = 0; n < 32 && i + n < count; n++)
            bits |= (uint64_t)flags[i + n] << n;
        memcpy(&word, row + ((x + i) >> 3), sizeof word);
        word |= bits << ((x + i) & 7);
        memcpy(row + ((x + i) >> 3), &word, sizeof word);
    }
}

#endif
