/* outcome.c - comparing frames and counters, counter by counter and byte by byte. */
#include "outcome.h"

#include <inttypes.h>
#include <string.h>

typedef struct named_counter {
    const char *name;
    uint64_t value;
} named_counter;

static void list_counters(const vodr_counters *c, named_counter list[OUTCOME_COUNTERS])
{
    const named_counter all[OUTCOME_COUNTERS] = {
        {"fragments", c->fragments},
        {"killed_fragments", c->killed_fragments},
        {"terminated_fragments", c->terminated_fragments},
        {"hits", c->hits},
        {"misses", c->misses},
        {"evictions", c->evictions},
        {"writebacks", c->writebacks},
        {"fb_read_bytes", c->fb_read_bytes},
        {"fb_write_bytes", c->fb_write_bytes},
        {"texture_load_bytes", c->texture_load_bytes},
        {"bricks", c->bricks},
        {"brick_visits", c->brick_visits},
        {"brick_slices", c->brick_slices},
        {"brick_overflows", c->brick_overflows},
        {"skipped_bricks", c->skipped_bricks},
        {"brick_vox", (uint64_t)c->brick_vox},
        {"tile_px", (uint64_t)c->tile_px},
    };
    memcpy(list, all, sizeof all);
}

void outcome_draw(const test_case *c, const vodr_machine *machine, const vodr_options *options, outcome *o)
{
    *o = (outcome){0};
    o->status = vodr_render(machine, &c->input, &c->table, &c->view, options, &o->frame, &o->counters, &o->error);
}

void outcome_free(outcome *o)
{
    vodr_frame_free(&o->frame);
    *o = (outcome){0};
}

bool outcome_same_frame(FILE *file, const outcome *a, const outcome *b)
{
    if (a->status != b->status) {
        fprintf(file, "  status %d (%s), %d (%s)\n", a->status, a->error.text, b->status, b->error.text);
        return false;
    }
    if (a->frame.bytes != b->frame.bytes) {
        fprintf(file, "  frames of %zu and %zu bytes\n", a->frame.bytes, b->frame.bytes);
        return false;
    }
    const uint8_t *left = a->frame.pixels, *right = b->frame.pixels;
    for (size_t i = 0; i < a->frame.bytes; i++) {
        if (left[i] != right[i]) {
            size_t pixel = i / ((size_t)a->frame.bits / 2);
            size_t width = (size_t)a->frame.width_px;
            fprintf(file, "  first difference at byte %zu, pixel (%zu, %zu): %d, %d\n", i, pixel % width, pixel / width,
                    left[i], right[i]);
            return false;
        }
    }
    return true;
}

bool outcome_same_counters(FILE *file, const outcome *a, const outcome *b)
{
    named_counter left[OUTCOME_COUNTERS], right[OUTCOME_COUNTERS];
    list_counters(&a->counters, left);
    list_counters(&b->counters, right);
    bool same = true;
    for (int i = 0; i < OUTCOME_COUNTERS; i++) {
        if (left[i].value != right[i].value) {
            fprintf(file, "  %s: %" PRIu64 ", %" PRIu64 "\n", left[i].name, left[i].value, right[i].value);
            same = false;
        }
    }
    return same;
}

bool outcome_same(FILE *file, const outcome *a, const outcome *b)
{
    const vodr_cycles *left = &a->counters.cycles, *right = &b->counters.cycles;
    if (memcmp(left, right, sizeof *left) != 0) {
        fprintf(file, "  cycles or stalls differ: %" PRIu64 " and %" PRIu64 " in total\n", left->total, right->total);
        return false;
    }
    return outcome_same_frame(file, a, b) && outcome_same_counters(file, a, b);
}

static uint64_t hash_number(uint64_t hash, uint64_t number, int bytes)
{
    for (int i = 0; i < bytes; i++) {
        hash = (hash ^ (number >> (8 * i) & 0xFF)) * 0x100000001B3u;
    }
    return hash;
}

uint64_t outcome_hash(uint64_t hash, const outcome *o)
{
    if (o->frame.bits == 8) {
        for (size_t i = 0; i < o->frame.bytes; i++) {
            hash = hash_number(hash, ((const uint8_t *)o->frame.pixels)[i], 1);
        }
    } else {
        for (size_t i = 0; i < o->frame.bytes / 2; i++) {
            hash = hash_number(hash, ((const uint16_t *)o->frame.pixels)[i], 2);
        }
    }
    named_counter list[OUTCOME_COUNTERS];
    list_counters(&o->counters, list);
    for (int i = 0; i < OUTCOME_COUNTERS; i++) {
        hash = hash_number(hash, list[i].value, 8);
    }
    return hash;
}
