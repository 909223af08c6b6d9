/* second_cache.c - docs/architecture.md, sections 8 and 9: line numbers, sets, replacement, write-back. */
#include "second_cache.h"

#include <stdlib.h>

static uint64_t ceil_div(uint64_t a, uint64_t b)
{
    return (a + b - 1) / b;
}

static uint64_t line_number(const second_cache *cache, uint64_t x, uint64_t y)
{
    uint64_t line_w = (uint64_t)cache->machine->line_px.width;
    uint64_t line_h = (uint64_t)cache->machine->line_px.height;
    uint64_t width = (uint64_t)cache->width_px;
    if (cache->machine->fb_layout == VODR_FB_LAYOUT_LINEAR) {
        return (y / line_h) * ceil_div(width, line_w) + x / line_w;
    }
    uint64_t tile = (y / 32) * ceil_div(width, 32) + x / 32;
    return tile * (32 / line_w) * (32 / line_h) + ((y % 32) / line_h) * (32 / line_w) + (x % 32) / line_w;
}

static uint64_t set_of(const second_cache *cache, uint64_t number)
{
    if (cache->sets == 1) {
        return 0;
    }
    if (cache->machine->index == VODR_INDEX_MODULO) {
        return number % cache->sets;
    }
    uint64_t set = 0;
    for (uint64_t rest = number; rest > 0; rest /= cache->sets) {
        set ^= rest % cache->sets;
    }
    return set;
}

vodr_status second_cache_make(second_cache *cache, const vodr_machine *machine, int32_t width_px, int32_t height_px)
{
    *cache = (second_cache){.machine = machine, .width_px = width_px, .random = 0xACE1};
    cache->pixel_bytes = (uint64_t)machine->fb_bits / 2;
    cache->line_bytes = (uint64_t)machine->line_px.width * (uint64_t)machine->line_px.height * cache->pixel_bytes;
    cache->ways = (uint64_t)machine->ways;
    uint64_t set_bytes = cache->ways * cache->line_bytes;
    if ((uint64_t)machine->cache_bytes % set_bytes != 0) {
        return VODR_INVALID;
    }
    cache->sets = (uint64_t)machine->cache_bytes / set_bytes;
    cache->lines = calloc(cache->sets * cache->ways, sizeof *cache->lines);
    /* No layout has more lines than a frame of whole 32x32 tiles has pixels. */
    uint64_t most_lines = ceil_div((uint64_t)width_px, 32) * ceil_div((uint64_t)height_px, 32) * 32 * 32;
    cache->missed = calloc(most_lines, sizeof *cache->missed);
    return cache->lines && cache->missed ? VODR_OK : VODR_NO_MEMORY;
}

void second_cache_free(second_cache *cache)
{
    free(cache->lines);
    free(cache->missed);
    cache->lines = NULL;
    cache->missed = NULL;
}

static uint64_t oldest(const second_line *set, uint64_t ways, bool by_fill)
{
    uint64_t way = 0;
    for (uint64_t i = 1; i < ways; i++) {
        uint64_t age = by_fill ? set[i].filled_at : set[i].used_at;
        uint64_t least = by_fill ? set[way].filled_at : set[way].used_at;
        if (age < least) {
            way = i;
        }
    }
    return way;
}

static uint64_t victim(second_cache *cache, const second_line *set)
{
    for (uint64_t i = 0; i < cache->ways; i++) {
        if (!set[i].valid) {
            return i;
        }
    }
    if (cache->machine->replacement == VODR_REPLACEMENT_RANDOM) {
        cache->random = (cache->random >> 1) ^ (cache->random % 2 == 1 ? 0xB400 : 0);
        return cache->random % cache->ways;
    }
    return oldest(set, cache->ways, cache->machine->replacement == VODR_REPLACEMENT_FIFO);
}

static void write_back(second_cache *cache, second_line *line, vodr_counters *counters)
{
    if (line->valid && line->dirty) {
        counters->writebacks++;
        counters->fb_write_bytes += cache->line_bytes;
        line->dirty = false;
    }
}

static second_line *miss(second_cache *cache, second_line *set, uint64_t number, vodr_counters *counters)
{
    second_line *line = &set[victim(cache, set)];
    counters->misses++;
    counters->evictions += line->valid;
    write_back(cache, line, counters);
    if (!cache->machine->clear_on_first_touch || cache->missed[number]) {
        counters->fb_read_bytes += cache->line_bytes;
    }
    cache->missed[number] = true;
    *line = (second_line){.valid = true, .number = number, .filled_at = cache->now};
    return line;
}

void second_cache_access(second_cache *cache, int32_t x, int32_t y, bool written, vodr_counters *counters)
{
    uint64_t number = line_number(cache, (uint64_t)x, (uint64_t)y);
    second_line *set = &cache->lines[set_of(cache, number) * cache->ways];
    second_line *line = NULL;
    for (uint64_t i = 0; i < cache->ways; i++) {
        if (set[i].valid && set[i].number == number) {
            line = &set[i];
        }
    }
    cache->now++;
    if (line) {
        counters->hits++;
    } else {
        line = miss(cache, set, number, counters);
    }
    line->used_at = cache->now;
    if (written && cache->machine->write_policy == VODR_WRITE_POLICY_THROUGH) {
        counters->fb_write_bytes += cache->pixel_bytes;
    } else if (written) {
        line->dirty = true;
    }
}

void second_cache_flush(second_cache *cache, vodr_counters *counters)
{
    for (uint64_t i = 0; i < cache->sets * cache->ways; i++) {
        write_back(cache, &cache->lines[i], counters);
    }
}
