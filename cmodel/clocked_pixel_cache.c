/* clocked_pixel_cache.c - the pixel cache, clocked: the door at which fragments are looked up, and the stage that
 * evicts, fills and reads (docs/timing.md, section 7). Whether the fragment at the door goes in a cycle is decided at
 * the end of the cycle before, so that it can be registered. */
#include "clocked_pixel_cache.h"

#include <stdlib.h>
#include <string.h>

#include "pixel_word.h"

/* ---- pixels being blended ---- */

static cache_blend *blend_at(cache_state *s, int64_t number)
{
    return &s->blends[number & s->blend_mask];
}

/* Whether a blend of a pixel will not be over in `cycle`. No two were read in one cycle, so those that are not fit the
 * ring. */
static bool blending(cache_state *s, int32_t x, int32_t y, int64_t cycle)
{
    for (int64_t n = s->reads - 1; n >= 0; n--) {
        const cache_blend *b = blend_at(s, n);
        if (b->cycle + s->machine->blend_cycles <= cycle)
            return false;
        if (b->x == x && b->y == y)
            return true;
    }
    return false;
}

static uint8_t *pixel_at(cache_state *s, int32_t line, int32_t offset)
{
    return s->data + (size_t)line * (size_t)s->line_bytes + (size_t)offset * (size_t)s->pixel_bytes;
}

/* What the alpha blender tells of pixels that were read. */
static void take_blended(cache_state *s, const blended_port *b)
{
    if (b->known) {
        const cache_blend *known = blend_at(s, s->known++);
        s->dirty[known->line] |= b->known_writes && !s->through;
    }
    s->settled.valid = b->valid;
    if (!b->valid)
        return;
    const cache_blend *done = blend_at(s, s->done++);
    s->settled = (cache_settled){.valid = true, .writes = b->writes, .pixel = b->pixel, .blend = *done};
    if (b->writes && !done->replaced)
        word_store(pixel_at(s, done->line, done->offset), b->pixel, s->pixel_bytes);
}

/* ---- written through: places of the write FIFO ---- */

/* Every access is read, so a read's number is its access's. */
static cache_place *place_at(const cache_state *s, int64_t number)
{
    return &s->places[number % s->machine->write_fifo];
}

/* The access whose blend is over: writes its pixel, or releases its place. */
static void settle(cache_state *s, const cache_settled *done, write_port *write)
{
    if (!done->valid || !s->through)
        return;
    cache_place *p = place_at(s, done->blend.number);
    p->taken = done->writes;
    if (!done->writes)
        return;
    cache_place_ring_push(&s->writing, p);
    int32_t at = done->blend.offset * s->pixel_bytes;
    write->valid = true;
    write->address = p->line * s->line_bytes + at;
    write->bytes = s->pixel_bytes;
    word_store(write->data, done->pixel, s->pixel_bytes);
}

/* The oldest write that waited for the bus has it. */
static void write_granted(cache_state *s)
{
    s->write_pending = false;
    if (!s->through)
        return;
    (*cache_place_ring_front(&s->writing))->taken = false;
    cache_place_ring_pop(&s->writing);
}

/* ---- lines that are leaving ---- */

/* Whether what memory holds of a line is older than what accesses before `number` wrote, or will write. */
static bool leaving(const cache_state *s, int64_t line, int64_t number)
{
    for (size_t i = 0; i < s->queue.count; i++) {
        const cache_access *a = cache_access_ring_at(&s->queue, i);
        if (s->machine->nonblocking && a->replaces && !a->evicted && a->victim == line)
            return true;
    }
    for (int32_t i = 0; s->through && i < s->machine->write_fifo; i++)
        if (s->places[i].taken && s->places[i].line == line && &s->places[i] != place_at(s, number))
            return true;
    return s->write_pending && s->write_line == line;
}

/* ---- evict, fill, read ---- */

/* A cache line moves to the write buffer, if it may. */
static bool move_out(cache_state *s, int32_t at, int64_t line, write_port *write)
{
    if (s->write_pending || s->last_read + s->machine->blend_cycles > s->now)
        return false;
    s->write_pending = true;
    s->write_line = line;
    s->dirty[at] = false;
    write->valid = true;
    write->address = line * s->line_bytes;
    write->bytes = s->line_bytes;
    memcpy(write->data, pixel_at(s, at, 0), (size_t)s->line_bytes);
    return true;
}

static void ask_for(const cache_state *s, const cache_access *a, fill_port *fill)
{
    *fill = (fill_port){.valid = true, .address = a->line * s->line_bytes};
}

/* A miss's line takes its place. Written through, pixels of the line before may be under way to it still. */
static void install(cache_state *s, const cache_access *a)
{
    uint8_t *line = pixel_at(s, a->at, 0);
    for (int64_t n = s->done; n < s->reads; n++)
        blend_at(s, n)->replaced |= blend_at(s, n)->line == a->at;
    if (a->reads)
        memcpy(line, s->filled + (size_t)(s->fills_used++ % s->misses) * (size_t)s->line_bytes, (size_t)s->line_bytes);
    else
        memset(line, 0, (size_t)s->line_bytes);
}

/* The pixel is read and goes to the alpha blender. */
static void read_pixel(cache_state *s, const cache_access *a, pixel_cache_out *out)
{
    if (a->miss)
        install(s, a);
    *blend_at(s, s->reads) =
        (cache_blend){.x = a->x, .y = a->y, .line = a->at, .offset = a->offset, .number = s->reads, .cycle = s->now};
    s->reads++;
    s->miss_reads += a->miss;
    s->last_read = s->now;
    out->pixel = (pixel_port){.valid = true, .pixel = word_load(pixel_at(s, a->at, a->offset), s->pixel_bytes)};
    out->report.status = BLOCK_BUSY;
}

static bool evicts(const cache_state *s, const cache_access *a)
{
    return a->replaces && s->dirty[a->at];
}

/* An access whose line has left: true when its pixel was read, false while its own line is on its way. */
static bool fill_step(cache_state *s, cache_access *a, pixel_cache_out *out)
{
    if (a->reads && s->fills_come == s->fills_used) {
        out->report.status = BLOCK_STALLED + VODR_STALL_FILL;
        return false;
    }
    read_pixel(s, a, out);
    return true;
}

/* A blocking cache: the one miss under way. True when it is over. */
static bool miss_step(cache_state *s, cache_access *a, pixel_cache_out *out)
{
    if (!a->evicted) {
        bool waits = evicts(s, a) ? !move_out(s, a->at, a->victim, &out->write)
                                  : a->reads && leaving(s, a->line, s->accesses - 1);
        if (waits) {
            out->report.status = BLOCK_STALLED + VODR_STALL_WRITE_BACK;
            return false;
        }
        a->evicted = true;
        if (a->reads)
            ask_for(s, a, &out->fill);
        out->report.status = BLOCK_STALLED + VODR_STALL_FILL;
        return false;
    }
    return fill_step(s, a, out);
}

/* A non-blocking cache: the oldest access. True when its pixel was read. */
static bool data_step(cache_state *s, cache_access *a, pixel_cache_out *out)
{
    if (!a->evicted) {
        if (a->miss && s->last_read == s->now - 1) /* whether that was written is not known yet */
            return false;
        if (blending(s, a->x, a->y, s->now)) {
            out->report.status = BLOCK_STALLED + VODR_STALL_HAZARD;
            return false;
        }
        bool dirty = evicts(s, a);
        a->evicted = !dirty || move_out(s, a->at, a->victim, &out->write);
        if (dirty) { /* the line is overwritten from the next cycle on */
            out->report.status = BLOCK_STALLED + VODR_STALL_WRITE_BACK;
            return false;
        }
    }
    return fill_step(s, a, out);
}

/* The flush: dirty lines leave one after the other. True when none is left. */
static bool flush_step(cache_state *s, write_port *write)
{
    int32_t lines = s->tags.sets * s->tags.ways;
    while (s->flushed < lines && !s->dirty[s->flushed])
        s->flushed++;
    if (s->flushed == lines)
        return true;
    move_out(s, s->flushed, s->tags.lines[s->flushed].number, write);
    return false;
}

/* ---- the door ---- */

/* The fragment at the door is looked up: tags change. */
static void look_up(cache_state *s, pixel_cache_out *out)
{
    cache_access a = {.x = s->door.x, .y = s->door.y, .line = s->door_line};
    pixel_cache_access(&s->tags, a.line, 1);
    a.at = (int32_t)(s->tags.last - s->tags.lines);
    a.offset = line_offset(&s->layout, a.x, a.y);
    a.miss = s->tags.missed;
    a.reads = a.miss && s->tags.read;
    a.replaces = a.miss && s->tags.victim >= 0;
    a.victim = s->tags.victim;
    out->look_up = (look_up_port){.valid = true, .miss = a.miss, .replaced = a.replaces, .x = a.x, .y = a.y};
    if (s->through)
        *place_at(s, s->accesses) = (cache_place){.line = a.line, .taken = true};
    s->accesses++;
    s->misses_seen += a.miss;
    s->wanted = s->machine->nonblocking && a.reads ? a.line : -1;
    if (s->machine->nonblocking || a.miss)
        cache_access_ring_push(&s->queue, a);
    else
        read_pixel(s, &a, out);
}

/* Whether a non-blocking cache has to leave the fragment at the door waiting. */
static bool tags_blocked(const cache_state *s)
{
    if (s->accesses - s->reads >= s->machine->nonblocking_fifo)
        return true;
    if (s->tags.where[s->door_line] >= 0)
        return false;
    return s->misses_seen - s->miss_reads >= s->machine->nonblocking_misses || leaving(s, s->door_line, s->accesses);
}

/* Whether the fragment at the door goes in the next cycle. */
static void decide(cache_state *s, door_port *door)
{
    bool blocking = !s->machine->nonblocking, alive = s->door.valid && !s->door.dead;
    bool full = s->through && place_at(s, s->accesses)->taken;
    bool waits = (blocking && s->queue.count) || (alive && (full || (!blocking && tags_blocked(s))));
    door->hazard = !waits && alive && blocking && blending(s, s->door.x, s->door.y, s->now + 1);
    door->gone = s->door.valid && !waits && !door->hazard;
    door->ready = !s->door.valid || door->gone;
}

static void clock(void *state, const pixel_cache_in *in, pixel_cache_out *out)
{
    cache_state *s = state;
    cache_settled settled = s->settled;
    bool gone = s->gone, took = !s->door.valid || gone, all_idle = true;
    out->look_up.valid = out->pixel.valid = out->fill.valid = out->write.valid = false;
    out->report.status = BLOCK_IDLE;
    take_blended(s, in->blended);
    settle(s, &settled, &out->write);
    if (in->written->valid)
        write_granted(s);
    if (s->wanted >= 0)
        ask_for(s, &(cache_access){.line = s->wanted}, &out->fill);
    s->wanted = -1;
    if (s->queue.count) {
        cache_access *a = cache_access_ring_front(&s->queue);
        if (s->machine->nonblocking ? data_step(s, a, out) : miss_step(s, a, out))
            cache_access_ring_pop(&s->queue);
    }
    if (in->filled->valid)
        memcpy(s->filled + (size_t)(s->fills_come++ % s->misses) * (size_t)s->line_bytes, in->filled->data,
               (size_t)s->line_bytes);
    if (gone && !s->door.dead)
        look_up(s, out);
    s->door.valid &= !gone;
    if (took && in->colour->valid) {
        s->door = *in->colour;
        s->door_line = line_number(&s->layout, s->door.x, s->door.y);
    }
    for (int i = 0; i < 4; i++)
        all_idle &= in->before[i]->idle;
    bool empty = !s->door.valid && !s->queue.count && s->done == s->reads && !s->settled.valid;
    out->report.idle = empty && all_idle && flush_step(s, &out->write) && !out->write.valid;
    decide(s, &out->door);
    s->gone = out->door.gone;
    s->now++;
}

static void finish(void *state)
{
    cache_state *s = state;
    pixel_cache_finish(&s->tags);
    cache_access_ring_free(&s->queue);
    cache_place_ring_free(&s->writing);
    free(s->data);
    free(s->filled);
    free(s->dirty);
    free(s->blends);
    free(s->places);
    free(s);
}

static void read_nothing(void *context, int64_t line, vodr_rgba *pixels)
{
    (void)context;
    (void)line;
    (void)pixels;
}

bool clocked_pixel_cache(const block_setup *setup, pixel_cache_face *face, pixel_cache_out *reset)
{
    const vodr_machine *m = setup->machine;
    cache_state *s = calloc(1, sizeof *s);
    *face = (pixel_cache_face){.state = s, .clock = clock, .finish = finish};
    if (!s)
        return false;
    s->machine = m;
    s->through = m->write_policy == VODR_WRITE_POLICY_THROUGH;
    s->layout = fb_layout_of(m, setup->view->width_px, setup->view->height_px);
    s->line_bytes = line_bytes(m);
    s->pixel_bytes = pixel_bytes(m);
    s->misses = m->nonblocking ? m->nonblocking_misses : 1;
    s->wanted = -1;
    s->last_read = -m->blend_cycles;
    const cache_memory nothing = {.read_line = read_nothing}; /* its tags are never dirty: nothing is written */
    bool made = pixel_cache_start(&s->tags, m, s->layout.lines, false, nothing, NULL) == VODR_OK;
    size_t lines = (size_t)s->tags.sets * (size_t)s->tags.ways;
    s->data = malloc(lines * (size_t)s->line_bytes);
    s->dirty = calloc(lines, sizeof *s->dirty);
    s->filled = malloc((size_t)s->misses * (size_t)s->line_bytes);
    while (s->blend_mask < m->blend_cycles - 1)
        s->blend_mask = 2 * s->blend_mask + 1;
    s->blends = calloc((size_t)s->blend_mask + 1, sizeof *s->blends);
    s->places = calloc((size_t)m->write_fifo, sizeof *s->places);
    made &= cache_access_ring_reserve(&s->queue, (size_t)m->nonblocking_fifo);
    made &= cache_place_ring_reserve(&s->writing, (size_t)m->write_fifo);
    if (!made || !s->data || !s->dirty || !s->filled || !s->blends || !s->places)
        return false;
    decide(s, &reset->door);
    return true;
}
