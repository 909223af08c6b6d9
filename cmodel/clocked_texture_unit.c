/* clocked_texture_unit.c - the texture unit, clocked: accepts fragments as long as there is room for them on their way
 * to the alpha blender, and hands their colours on after its latency. Its loader is in clocked_loader.c. */
#include "texture_unit.h"

#include <stdlib.h>

#include "clocked_blocks.h"
#include "clocked_loader.h"
#include "layout.h"
#include "pixel_word.h"
#include "ring.h"

/* A fragment on its way; it can be seen at the end from that cycle on. */
typedef struct shaded {
    int32_t x, y;
    uint64_t colour;
    bool dead;
    int64_t cycle;
} shaded;

/* One whose voxels were fetched from external memory. */
typedef struct fetching {
    int32_t x, y;
    int64_t a[3];
    int64_t cycle;
} fetching;

RING(shaded_ring, shaded)
RING(fetching_ring, fetching)

typedef struct unit_state {
    const vodr_machine *machine;
    const vodr_view *view;
    texture_unit
        texture; /* filter and tables; with a brick's densities in each buffer, or a fragment's voxels in one */
    bool whole;
    int64_t now, latency, room, count; /* of fragments accepted and not gone */
    int64_t free_cycle;                /* in which the banks have fetched for the last fragment */
    int32_t groups, asked, got;        /* whole: of eight voxels, a fragment's; of the last one; of the oldest */
    loader loader;
    shaded_ring fifo;
    fetching_ring fetches;
    texture_unit_out out;
} unit_state;

/* Filters and classifies with the current buffer's densities. */
static void shade(unit_state *s, int32_t x, int32_t y, const int64_t a[3], int64_t cycle)
{
    const brick_slice here = {.plane.origin = {a[0], a[1], a[2]}};
    const span one = {.y = y, .x0 = x, .x1 = x + 1};
    uint16_t density;
    texture_unit_filter(&s->texture, &here, &one, &density);
    shaded_ring_push(&s->fifo, (shaded){.x = x,
                                        .y = y,
                                        .colour = pixel_word(s->machine, s->texture.colours[density]),
                                        .dead = s->texture.dead[density],
                                        .cycle = cycle});
}

/* The first voxel of a fragment's filter along an axis, which may lie outside the volume. */
static int32_t first_voxel(const unit_state *s, const int64_t a[3], int c)
{
    int64_t position = s->view->base[c] + (a[c] >> s->view->shift), half = (int64_t)1 << (VODR_POSITION_BITS - 1);
    if (s->machine->filter == VODR_FILTER_NEAREST)
        return (int32_t)(position >> VODR_POSITION_BITS);
    return (int32_t)((position - half) >> VODR_POSITION_BITS) - (filter_is_cubic(s->machine) ? 1 : 0);
}

static int32_t inside(const unit_state *s, int32_t i, int c)
{
    int32_t last = s->texture.volume->dims_vox[c] - 1;
    return i < 0 ? 0 : i > last ? last : i;
}

/* Which voxels a fragment's filter takes: one, a cube of two, or of a cube of four the part `group`. */
static fetch_port fetch_of(const unit_state *s, const int64_t a[3], int32_t group)
{
    fetch_port f = {.valid = true};
    for (int c = 0; c < 3; c++) {
        int32_t i = first_voxel(s, a, c) + 2 * (group >> c & 1);
        f.lo[c] = inside(s, i, c);
        f.hi[c] = s->machine->filter == VODR_FILTER_NEAREST ? f.lo[c] : inside(s, i + 1, c);
    }
    return f;
}

static void accept(unit_state *s, const fragment_port *f)
{
    s->count++;
    s->free_cycle = s->now + filter_fetch_cycles(s->machine);
    if (!s->whole) {
        s->texture.current = loader_buffer(&s->loader);
        shade(s, f->x, f->y, f->a, s->now + s->latency);
        return;
    }
    s->asked = 0;
    fetching_ring_push(
        &s->fetches, (fetching){.x = f->x, .y = f->y, .a = {f->a[0], f->a[1], f->a[2]}, .cycle = s->now + s->latency});
}

/* Asks external memory for the next voxels of the fragment that was accepted last. */
static void ask(unit_state *s)
{
    s->out.fetch.valid = s->asked < s->groups;
    if (s->out.fetch.valid)
        s->out.fetch = fetch_of(s, fetching_ring_back(&s->fetches)->a, s->asked++);
}

/* Voxels of the oldest fragment that waits for some. */
static void fetched(unit_state *s, const voxels_port *voxels)
{
    const fetching *f = fetching_ring_front(&s->fetches);
    const fetch_port first = fetch_of(s, f->a, 0), last = fetch_of(s, f->a, s->groups - 1);
    const fetch_port here = fetch_of(s, f->a, s->got);
    texture_buffer *b = &s->texture.buffers[0];
    int32_t size[3];
    for (int c = 0; c < 3; c++) {
        b->region.lo[c] = first.lo[c];
        b->region.hi[c] = last.hi[c] + 1;
        size[c] = b->region.hi[c] - b->region.lo[c];
    }
    for (int i = 0; i < 8; i++) { /* hi is lo at the volume's sides, and in `nearest` */
        int32_t at[3];
        for (int c = 0; c < 3; c++)
            at[c] = (i >> c & 1 ? here.hi[c] : here.lo[c]) - first.lo[c];
        b->densities[(at[2] * size[1] + at[1]) * size[0] + at[0]] = voxels->density[i];
    }
    if (++s->got < s->groups)
        return;
    s->got = 0;
    shade(s, f->x, f->y, f->a, f->cycle);
    fetching_ring_pop(&s->fetches);
}

/* What is seen at the FIFO's end in the next cycle. */
static void show(unit_state *s)
{
    colour_port *c = &s->out.colour;
    if (c->valid || !s->fifo.count || shaded_ring_front(&s->fifo)->cycle > s->now + 1)
        return;
    const shaded *f = shaded_ring_front(&s->fifo);
    *c = (colour_port){.valid = true, .dead = f->dead, .x = f->x, .y = f->y, .colour = f->colour};
    shaded_ring_pop(&s->fifo);
}

static void clock(void *state, const texture_unit_in *in, texture_unit_out *out)
{
    unit_state *s = state;
    accept_port *door = &s->out.fragment;
    report_port *report = &s->out.report;
    const bool fetches = s->now < s->free_cycle; /* for a fragment accepted before */
    s->out.colour.valid &= !in->colour->ready;
    s->count -= in->colour->gone;
    report->status = BLOCK_IDLE;
    if (in->voxels->valid)
        fetched(s, in->voxels);
    if (in->fragment->valid && door->ready)
        accept(s, in->fragment);
    if (s->now < s->free_cycle) {
        report->status = BLOCK_BUSY;
    } else if (in->fragment->valid) {
        report->status = BLOCK_STALLED + (door->loading ? VODR_STALL_TEXTURE_LOAD : VODR_STALL_FRAGMENT_FIFO);
    }
    ask(s);
    show(s);
    loader_clock(&s->loader, in, fetches, &s->out.load);
    door->loading = !loader_ready(&s->loader);
    door->ready = !door->loading && s->count < s->room && s->now + 1 >= s->free_cycle;
    report->idle = s->count == 0;
    s->now++;
    *out = s->out;
}

static void finish(void *state)
{
    unit_state *s = state;
    shaded_ring_free(&s->fifo);
    fetching_ring_free(&s->fetches);
    for (int i = 0; i < 2; i++)
        free(s->texture.buffers[i].densities);
    free(s);
}

bool clocked_texture_unit(const block_setup *setup, texture_unit_face *face, texture_unit_out *reset)
{
    const vodr_machine *m = setup->machine;
    unit_state *s = calloc(1, sizeof *s);
    *face = (texture_unit_face){.state = s, .clock = clock, .finish = finish};
    if (!s)
        return false;
    s->machine = m;
    s->view = setup->view;
    s->whole = m->traversal == VODR_TRAVERSAL_WHOLE;
    s->texture = *setup->tables;
    s->texture.whole = false; /* what the filter takes lies in a buffer in either case */
    s->room = m->fragment_fifo + (s->whole ? m->mem_latency_cycles : 0);
    s->groups = s->asked = s->whole ? filter_fetch_cycles(m) : 0;
    /* One cycle is the link's to the cache; in the last that fetches the filter has its voxels. */
    s->latency = m->texture_latency_cycles + (s->whole ? m->mem_latency_cycles : 0) + filter_fetch_cycles(m) - 2;
    s->out.fragment.loading = true;
    s->out.report.idle = true;
    *reset = s->out;
    loader_start(&s->loader, setup, s->texture.buffers);
    return shaded_ring_reserve(&s->fifo, (size_t)s->room) && fetching_ring_reserve(&s->fetches, (size_t)s->room) &&
           texture_unit_reserve(&s->texture, s->whole ? 2 : setup->edge_vox[0], NULL) == VODR_OK;
}
