/* pixel_word.h - pixels as the words that travel between clocked blocks, and words as the bytes that lie in memory
 * (ports.h). */
#ifndef VODR_PIXEL_WORD_H
#define VODR_PIXEL_WORD_H

#include "vodr.h"

enum { PIXEL_WORD_WRITTEN = 1 << 16 }; /* mip: there is a density */

static inline uint64_t pixel_word(const vodr_machine *m, vodr_rgba p)
{
    int32_t bits = m->fb_bits;
    if (m->blend == VODR_BLEND_MIP)
        return p.r | (p.a ? PIXEL_WORD_WRITTEN : 0);
    return (uint64_t)p.r | (uint64_t)p.g << bits | (uint64_t)p.b << 2 * bits | (uint64_t)p.a << 3 * bits;
}

static inline vodr_rgba pixel_of_word(const vodr_machine *m, uint64_t word)
{
    uint32_t bits = (uint32_t)m->fb_bits, full = (1u << bits) - 1;
    if (m->blend == VODR_BLEND_MIP)
        return (vodr_rgba){.r = (uint16_t)word, .a = (word & PIXEL_WORD_WRITTEN) != 0};
    return (vodr_rgba){(uint16_t)(word & full), (uint16_t)(word >> bits & full), (uint16_t)(word >> 2 * bits & full),
                       (uint16_t)(word >> 3 * bits & full)};
}

/* Lowest byte first. */
static inline uint64_t word_load(const uint8_t *data, int32_t bytes)
{
    uint64_t word = 0;
    for (int32_t i = 0; i < bytes; i++)
        word |= (uint64_t)data[i] << 8 * i;
    return word;
}

static inline void word_store(uint8_t *data, uint64_t word, int32_t bytes)
{
    for (int32_t i = 0; i < bytes; i++)
        data[i] = (uint8_t)(word >> 8 * i);
}

#endif
