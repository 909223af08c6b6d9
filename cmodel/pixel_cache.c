/* pixel_cache.c - tags, replacement and write policy (docs/architecture.md, "Pixel cache"). A run of accesses to one
 * line is one look-up: after the first, the others hit, and leave the order of replacement as it is. */
#include "pixel_cache.h"

#include <stdlib.h>

#include "error.h"
#include "layout.h"

enum { LFSR_SEED = 0xACE1, LFSR_TAPS = 0xB400 };

vodr_status pixel_cache_start(pixel_cache *c, const vodr_machine *m, int64_t frame_lines, bool picture,
                              cache_memory memory, vodr_error *error)
{
    *c = (pixel_cache){.memory = memory,
                       .sets = cache_sets(m),
                       .ways = m->ways,
                       .line_pixels = line_pixels(m),
                       .xor_index = m->index == VODR_INDEX_XOR,
                       .through = m->write_policy == VODR_WRITE_POLICY_THROUGH,
                       .clear_on_first_touch = m->clear_on_first_touch,
                       .replacement = (vodr_replacement)m->replacement,
                       .lfsr = LFSR_SEED};
    c->set_bits = log2_of(c->sets);
    size_t lines = (size_t)c->sets * (size_t)c->ways;
    c->lines = malloc(lines * sizeof *c->lines);
    c->pixels = picture ? malloc(lines * (size_t)c->line_pixels * sizeof *c->pixels) : NULL;
    c->touched = calloc(c->clear_on_first_touch ? (size_t)frame_lines : 1, 1);
    c->where = malloc((size_t)frame_lines * sizeof *c->where);
    if (!c->lines || (picture && !c->pixels) || !c->touched || !c->where)
        return vodr_fail(error, VODR_NO_MEMORY, "no memory for a pixel cache of %zu lines", lines);
    for (size_t i = 0; i < lines; i++)
        c->lines[i] = (cache_line){.number = -1};
    for (int64_t i = 0; i < frame_lines; i++)
        c->where[i] = -1;
    return VODR_OK;
}

/* The set of a line: its number modulo the sets, or the exclusive or of its number's digits in base `sets`. */
static int32_t set_of(const pixel_cache *c, int64_t line)
{
    uint64_t mask = (uint64_t)c->sets - 1, set = 0, rest = (uint64_t)line;
    if (!c->xor_index)
        return (int32_t)(rest & mask);
    for (; rest && c->set_bits; rest >>= c->set_bits)
        set ^= rest & mask;
    return (int32_t)set;
}

static vodr_rgba *pixels_of(const pixel_cache *c, const cache_line *line)
{
    if (!c->pixels)
        return NULL;
    return c->pixels + (size_t)(line - c->lines) * (size_t)c->line_pixels;
}

/* An invalid way, lowest first, which its stamp makes the oldest; else the policy's choice. */
static cache_line *choose_victim(pixel_cache *c, cache_line *set)
{
    cache_line *victim = set;
    for (int32_t way = 1; way < c->ways; way++)
        victim = set[way].stamp < victim->stamp ? &set[way] : victim;
    if (c->replacement != VODR_REPLACEMENT_RANDOM || victim->number < 0)
        return victim;
    c->lfsr = (c->lfsr >> 1) ^ (c->lfsr & 1 ? LFSR_TAPS : 0);
    return &set[c->lfsr & (uint32_t)(c->ways - 1)];
}

static void write_back(pixel_cache *c, cache_line *line)
{
    if (!line->dirty)
        return;
    c->memory.write_line(c->memory.context, line->number, pixels_of(c, line));
    line->dirty = false;
    c->writebacks++;
}

static void fill(pixel_cache *c, cache_line *line, int64_t number)
{
    c->evicted_dirty = line->number >= 0 && line->dirty;
    c->victim = line->number;
    c->read = !(c->clear_on_first_touch && !c->touched[number]);
    if (line->number >= 0) {
        write_back(c, line);
        c->where[line->number] = -1;
        c->evictions++;
    }
    c->where[number] = (int32_t)(line - c->lines);
    vodr_rgba *pixels = pixels_of(c, line);
    *line = (cache_line){.number = number, .stamp = c->clock};
    if (!c->read) {
        c->touched[number] = 1;
        for (int32_t i = 0; pixels && i < c->line_pixels; i++)
            pixels[i] = (vodr_rgba){0};
    } else {
        c->memory.read_line(c->memory.context, number, pixels);
    }
}

vodr_rgba *pixel_cache_access(pixel_cache *c, int64_t line, int32_t count)
{
    if (!pixel_cache_hit(c, line, count)) {
        c->clock++;
        c->missed = true;
        c->misses++;
        c->hits += (uint64_t)count - 1;
        c->last = choose_victim(c, c->lines + (size_t)set_of(c, line) * (size_t)c->ways);
        fill(c, c->last, line);
    }
    return pixels_of(c, c->last);
}

void pixel_cache_flush(pixel_cache *c)
{
    for (size_t i = 0; i < (size_t)c->sets * (size_t)c->ways; i++)
        write_back(c, &c->lines[i]);
}

void pixel_cache_empty(pixel_cache *c)
{
    for (size_t i = 0; i < (size_t)c->sets * (size_t)c->ways; i++) {
        if (c->lines[i].number >= 0)
            c->where[c->lines[i].number] = -1;
        c->lines[i] = (cache_line){.number = -1};
    }
    c->lfsr = LFSR_SEED;
}

void pixel_cache_finish(pixel_cache *c)
{
    free(c->lines);
    free(c->pixels);
    free(c->where);
    free(c->touched);
    *c = (pixel_cache){0};
}
