/* rng.h - splitmix64: the same numbers from the same seed everywhere.
 *
 * C leaves the order of operands and arguments open: no expression may hold two draws unless one is an argument of the
 * other, or ?:, && or || lies between. */
#ifndef VECTORS_RNG_H
#define VECTORS_RNG_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct rng {
    uint64_t state;
} rng;

static inline uint64_t rng_next(rng *r)
{
    uint64_t z = r->state += 0x9E3779B97F4A7C15u;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
}

/* An integer from lo to hi, both included. */
static inline int64_t rng_int(rng *r, int64_t lo, int64_t hi)
{
    return lo + (int64_t)(rng_next(r) % (uint64_t)(hi - lo + 1));
}

/* True once in n. */
static inline bool rng_one_in(rng *r, int64_t n)
{
    return rng_int(r, 1, n) == 1;
}

/* A number of either sign whose magnitude has at most `bits` bits, 64 at most: all lengths are equally likely. */
static inline int64_t rng_signed(rng *r, int bits)
{
    int64_t length = rng_int(r, 0, bits);
    int64_t value = length ? (int64_t)(rng_next(r) >> (64 - length)) : 0;
    return rng_one_in(r, 2) ? -value : value;
}

/* A double from lo up to hi, without rounding but the last. */
static inline double rng_real(rng *r, double lo, double hi)
{
    return lo + (hi - lo) * ((double)(rng_next(r) >> 11) * 0x1p-53);
}

#endif
