/* test_pixel_cache.c - the cache against a list: a set is the list of its lines, oldest first (docs/architecture.md,
 * section 9). Every transfer to and from memory must be the same, in the same order, and no pixel may be lost. */
#include <stdlib.h>
#include <string.h>

#include "lib/unit.h"
#include "pixel_cache.h"

enum { FRAME_LINES = 256, MOST_SETS = 1024, MOST_WAYS = 16, MOST_TRANSFERS = 1 << 16 };

/* Memory behind the cache; it writes down what it is asked. */
typedef struct memory {
    int32_t line_pixels, count;
    vodr_rgba *pixels;
    int32_t log[MOST_TRANSFERS]; /* line read: its number; written: -1 - its number */
} memory;

static void note(memory *m, int32_t entry)
{
    assert_true(m->count < MOST_TRANSFERS);
    m->log[m->count++] = entry;
}

static void read_line(void *context, int64_t line, vodr_rgba *pixels)
{
    memory *m = context;
    note(m, (int32_t)line);
    if (pixels)
        memcpy(pixels, m->pixels + line * m->line_pixels, (size_t)m->line_pixels * sizeof *pixels);
}

static void write_line(void *context, int64_t line, const vodr_rgba *pixels)
{
    memory *m = context;
    note(m, -1 - (int32_t)line);
    if (pixels)
        memcpy(m->pixels + line * m->line_pixels, pixels, (size_t)m->line_pixels * sizeof *pixels);
}

/* A line of the plain model: which way it sits in matters to `random` and to the order of the flush. */
typedef struct plain_line {
    int32_t number;
    bool valid, dirty;
    int64_t filled, used; /* when */
} plain_line;

typedef struct plain_cache {
    const vodr_machine *machine;
    int32_t sets;
    plain_line line[MOST_SETS][MOST_WAYS];
    bool missed[FRAME_LINES];
    int64_t now;
    uint32_t random;
    uint64_t hits, misses, evictions, writebacks;
    memory *log;
} plain_cache;

static int32_t plain_set(const plain_cache *p, int32_t number)
{
    if (p->machine->index == VODR_INDEX_MODULO)
        return number % p->sets;
    int32_t set = 0;
    for (; p->sets > 1 && number > 0; number /= p->sets)
        set ^= number % p->sets;
    return set;
}

static plain_line *plain_victim(plain_cache *p, plain_line *set)
{
    for (int32_t way = 0; way < p->machine->ways; way++)
        if (!set[way].valid)
            return &set[way];
    if (p->machine->replacement == VODR_REPLACEMENT_RANDOM) {
        p->random = p->random % 2 ? (p->random / 2) ^ 0xB400 : p->random / 2;
        return &set[p->random % (uint32_t)p->machine->ways];
    }
    plain_line *oldest = set;
    for (int32_t way = 1; way < p->machine->ways; way++) {
        bool fifo = p->machine->replacement == VODR_REPLACEMENT_FIFO;
        if (fifo ? set[way].filled < oldest->filled : set[way].used < oldest->used)
            oldest = &set[way];
    }
    return oldest;
}

static void plain_access(plain_cache *p, int32_t number, bool write)
{
    plain_line *set = p->line[plain_set(p, number)], *found = NULL;
    for (int32_t way = 0; way < p->machine->ways; way++)
        if (set[way].valid && set[way].number == number)
            found = &set[way];
    p->now++;
    if (found) {
        p->hits++;
    } else {
        found = plain_victim(p, set);
        p->misses++;
        p->evictions += found->valid;
        if (found->valid && found->dirty) {
            p->writebacks++;
            note(p->log, -1 - found->number);
        }
        if (!p->machine->clear_on_first_touch || p->missed[number])
            note(p->log, number);
        p->missed[number] = true;
        *found = (plain_line){.number = number, .valid = true, .filled = p->now};
    }
    found->used = p->now;
    if (write && p->machine->write_policy == VODR_WRITE_POLICY_BACK)
        found->dirty = true;
}

static void plain_flush(plain_cache *p)
{
    for (int32_t s = 0; s < p->sets; s++)
        for (int32_t way = 0; way < p->machine->ways; way++)
            if (p->line[s][way].dirty) {
                p->writebacks++;
                note(p->log, -1 - p->line[s][way].number);
            }
}

/* The next line to touch: far and near, runs over neighbours, and loops just longer than a set. */
static int32_t next_line(rng *c, int pattern, int32_t last, int32_t sets, int32_t ways)
{
    switch (pattern) {
    case 0: return (int32_t)rng_int(c, 0, FRAME_LINES - 1);
    case 1: return (last + 1) % FRAME_LINES;
    case 2: return (last + sets) % (sets * (ways + 1) <= FRAME_LINES ? sets * (ways + 1) : FRAME_LINES);
    default: return rng_one_in(c, 4) ? (int32_t)rng_int(c, 0, FRAME_LINES - 1) : (last ^ 1);
    }
}

/* The bench that one random machine is run on. */
typedef struct bench {
    pixel_cache cache, blind; /* one with pixels, one that keeps tags only */
    memory behind, expected, unseen;
    plain_cache plain;
    vodr_rgba *truth; /* what each pixel was last set to */
} bench;

static vodr_machine random_machine(rng *c)
{
    static const vodr_shape shapes[] = {{16, 1}, {32, 1}, {4, 4}, {8, 8}, {1, 1}, {2, 4}};
    for (;;) {
        vodr_machine m = vodr_machine_default();
        m.cache_bytes = 64 << rng_int(c, 0, 6);
        m.ways = 1 << rng_int(c, 0, 4);
        m.line_px = shapes[rng_int(c, 0, 5)];
        m.fb_bits = rng_one_in(c, 2) ? 16 : 8;
        m.index = rng_one_in(c, 2) ? VODR_INDEX_XOR : VODR_INDEX_MODULO;
        m.replacement = (int32_t)rng_int(c, VODR_REPLACEMENT_LRU, VODR_REPLACEMENT_RANDOM);
        m.write_policy = rng_one_in(c, 3) ? VODR_WRITE_POLICY_THROUGH : VODR_WRITE_POLICY_BACK;
        m.clear_on_first_touch = rng_one_in(c, 3);
        if (vodr_machine_check(&m, NULL) == VODR_OK)
            return m;
    }
}

/* `count` accesses to a line, then a write or none. */
static void step(bench *b, rng *c, const vodr_machine *m, int32_t line)
{
    int32_t count = (int32_t)rng_int(c, 1, 3), pixels = b->behind.line_pixels;
    bool write = !rng_one_in(c, 3);
    vodr_rgba *held = pixel_cache_access(&b->cache, line, count), *truth = b->truth + line * pixels;
    assert_null(pixel_cache_access(&b->blind, line, count));
    assert_memory_equal(held, truth, (size_t)pixels * sizeof *held);
    for (int32_t i = 0; i < count; i++)
        plain_access(&b->plain, line, write);
    if (!write)
        return;
    int32_t i = (int32_t)rng_int(c, 0, pixels - 1);
    held[i] = truth[i] = (vodr_rgba){(uint16_t)rng_next(c), (uint16_t)rng_next(c), 3, 4};
    if (m->write_policy == VODR_WRITE_POLICY_THROUGH)
        b->behind.pixels[line * pixels + i] = held[i];
    pixel_cache_written(&b->cache);
    pixel_cache_written(&b->blind);
}

static void check_counts(const pixel_cache *got, const memory *behind, const plain_cache *want)
{
    assert_int_equal(got->hits, want->hits);
    assert_int_equal(got->misses, want->misses);
    assert_int_equal(got->evictions, want->evictions);
    assert_int_equal(got->writebacks, want->writebacks);
    assert_int_equal(behind->count, want->log->count);
    assert_memory_equal(behind->log, want->log->log, (size_t)behind->count * sizeof *behind->log);
}

static void run_machine(bench *b, rng *c, const vodr_machine *m)
{
    int32_t line_pixels = m->line_px.width * m->line_px.height;
    size_t bytes = (size_t)FRAME_LINES * (size_t)line_pixels * sizeof(vodr_rgba);
    int32_t sets = m->cache_bytes / (m->ways * line_pixels * m->fb_bits / 2);
    assert_true(sets <= MOST_SETS);
    memset(b, 0, sizeof *b);
    b->behind = (memory){.line_pixels = line_pixels, .pixels = calloc(1, bytes)};
    b->truth = calloc(1, bytes);
    b->plain = (plain_cache){.machine = m, .sets = sets, .random = 0xACE1, .log = &b->expected};
    cache_memory behind = {.context = &b->behind, .read_line = read_line, .write_line = write_line};
    cache_memory unseen = {.context = &b->unseen, .read_line = read_line, .write_line = write_line};
    assert_int_equal(pixel_cache_start(&b->cache, m, FRAME_LINES, true, behind, NULL), VODR_OK);
    assert_int_equal(pixel_cache_start(&b->blind, m, FRAME_LINES, false, unseen, NULL), VODR_OK);
    int32_t line = 0;
    for (int n = 0, pattern = 0; n < 600; n++) {
        pattern = n % 100 ? pattern : (int)rng_int(c, 0, 3);
        line = next_line(c, pattern, line, sets, m->ways);
        step(b, c, m, line);
    }
    for (int flush = 0; flush < 2; flush++) { /* the second finds nothing to write */
        pixel_cache_flush(&b->cache);
        pixel_cache_flush(&b->blind);
    }
    plain_flush(&b->plain);
    check_counts(&b->cache, &b->behind, &b->plain);
    check_counts(&b->blind, &b->unseen, &b->plain);
    assert_memory_equal(b->behind.pixels, b->truth, bytes);
    pixel_cache_finish(&b->cache);
    pixel_cache_finish(&b->blind);
    free(b->behind.pixels);
    free(b->truth);
}

static void every_kind_of_cache_does_what_the_list_does(void **state)
{
    (void)state;
    rng c = {11};
    bench *b = malloc(sizeof *b);
    assert_non_null(b);
    for (int round = 0; round < 1500; round++) {
        vodr_machine m = random_machine(&c);
        run_machine(b, &c, &m);
    }
    free(b);
}

static void ignore_read(void *context, int64_t line, vodr_rgba *pixels)
{
    (void)context;
    (void)line;
    (void)pixels;
}

static void ignore_write(void *context, int64_t line, const vodr_rgba *pixels)
{
    (void)context;
    (void)line;
    (void)pixels;
}

/* Five lines in turn on four ways: lru and fifo miss always. */
static void one_line_too_many_thrashes(void **state)
{
    (void)state;
    vodr_machine m = unit_machine("cache_bytes=256 ways=4 line_px=16x1");
    cache_memory nothing = {.read_line = ignore_read, .write_line = ignore_write};
    for (m.replacement = VODR_REPLACEMENT_LRU; m.replacement <= VODR_REPLACEMENT_FIFO; m.replacement++) {
        pixel_cache cache;
        assert_int_equal(pixel_cache_start(&cache, &m, 5, false, nothing, NULL), VODR_OK);
        assert_int_equal(cache.sets, 1);
        for (int i = 0; i < 50; i++)
            pixel_cache_access(&cache, i % 5, 1);
        assert_int_equal(cache.misses, 50);
        assert_int_equal(cache.evictions, 46);
        assert_int_equal(cache.writebacks, 0);
        pixel_cache_finish(&cache);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_kind_of_cache_does_what_the_list_does),
        cmocka_unit_test(one_line_too_many_thrashes),
    };
    return cmocka_run_group_tests_name("pixel_cache", tests, NULL, NULL);
}
