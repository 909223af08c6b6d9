/* slice_generator.c - traffic for the slice generator: any boxes on any slices of the scene's view, parallel or in
 * perspective, on none as well; a divider that offers them, a rasterizer that takes slices when it likes. */
#include "bench.h"

static const char *const machines[] = {"", NULL};

enum { SLICES_A_VIEW = 2000, SLICES_A_BRICK = 60, MOST_CYCLES = 70000 }; /* more than one set-up's */

static void draw(rng *random, vodr_machine *m)
{
    m->blend = (int32_t)rng_int(random, VODR_BLEND_OVER, VODR_BLEND_MIP);
    m->slice_setup_cycles = rng_one_in(random, 3) ? 1 : (int32_t)rng_int(random, 2, 9);
    if (rng_one_in(random, 3)) /* every bit of the count: counts of all lengths, many of a single bit */
        m->slice_setup_cycles =
            (int32_t)(((uint64_t)1 << rng_int(random, 3, 15)) | (rng_one_in(random, 2) ? rng_next(random) % 256 : 0));
}

/* Frames and slices as many as there can be, so that numbers have all their bits. */
static void look(rng *random, const int32_t dims_vox[3], vodr_view *view)
{
    int32_t *const sizes[] = {&view->width_px, &view->height_px, &view->slices};
    (void)dims_vox;
    if (rng_one_in(random, 2))
        return;
    for (int i = 0; i < 3; i++) {
        const int32_t largest = i == 2 ? VODR_MAX_SLICES : VODR_MAX_SIZE_PX;
        if (rng_one_in(random, 2))
            *sizes[i] = rng_one_in(random, 2) ? largest : (int32_t)rng_int(random, 1, largest);
    }
}

/* A range within [0, size], not empty: all of it, its first or last place, or any. */
static void range(rng *random, int32_t size, int32_t *lo, int32_t *hi)
{
    int64_t kind = rng_int(random, 0, 5);
    *lo = kind == 0 || kind == 1 ? 0 : kind == 2 ? size - 1 : (int32_t)rng_int(random, 0, size - 1);
    *hi = kind == 0 ? size : kind == 1 ? 1 : (int32_t)rng_int(random, *lo + 1, size);
}

static brick_port any_brick(bench *b)
{
    const vodr_view *v = &b->scene.view;
    brick_port p = {.valid = false};
    for (int c = 0; c < 3; c++)
        range(&b->random, b->scene.input.dims_vox[c], &p.box.lo[c], &p.box.hi[c]);
    range(&b->random, v->width_px, &p.bound.x0, &p.bound.x1);
    range(&b->random, v->height_px, &p.bound.y0, &p.bound.y1);
    range(&b->random, v->slices, &p.k0, &p.k1);
    if (p.k1 - p.k0 > SLICES_A_BRICK) {
        bool at_end = rng_one_in(&b->random, 2);
        int32_t count = (int32_t)rng_int(&b->random, 1, SLICES_A_BRICK);
        p.k0 = at_end ? p.k1 - count : p.k0;
        p.k1 = at_end ? p.k1 : p.k0 + count;
    }
    if (rng_one_in(&b->random, 20))
        p.k1 = p.k0;
    return p;
}

static void traffic(bench *b, uint64_t transactions)
{
    slice_generator_face *face = &b->faces->slice_generator;
    slice_generator_out out = b->reset->slice_generator;
    brick_port brick = {.valid = false};
    ready_port ready = {false};
    const slice_generator_in in = {.brick = &brick, .slice = &ready};
    uint64_t done = 0, most = transactions < SLICES_A_VIEW ? transactions : SLICES_A_VIEW;
    int64_t haste = 1;
    for (; done < most && b->cycles < MOST_CYCLES && !bench_differs(b); b->cycles++) {
        bool taken = brick.valid && out.brick.ready;
        if (rng_one_in(&b->random, 100))
            haste = rng_one_in(&b->random, 2) ? rng_int(&b->random, 2, 30) : 1;
        done += out.slice.valid && ready.ready;
        face->clock(face->state, &in, &out);
        if (taken || !brick.valid) {
            brick = any_brick(b);
            brick.valid = !rng_one_in(&b->random, 3);
        }
        ready.ready = rng_one_in(&b->random, haste);
    }
    b->left = transactions - done;
}

/* ---- what is legal ---- */

static bool is_within(int32_t lo, int32_t hi, int32_t size)
{
    return lo >= 0 && lo < hi && hi <= size;
}

static const char *illegal(const bench *b, void *rules, const void *inputs, const void *shown)
{
    const brick_port *p = ((const slice_generator_in *)inputs)->brick;
    const vodr_view *v = &b->scene.view;
    (void)rules;
    (void)shown;
    if (!p->valid)
        return NULL;
    for (int c = 0; c < 3; c++)
        if (!is_within(p->box.lo[c], p->box.hi[c], b->scene.input.dims_vox[c]))
            return "brick_lo and brick_hi are no box of the volume";
    if (!is_within(p->bound.x0, p->bound.x1, v->width_px) || !is_within(p->bound.y0, p->bound.y1, v->height_px))
        return "brick_x0, _y0, _x1, _y1 are no rectangle of the frame";
    if (p->k0 > p->k1 || p->k1 > v->slices)
        return "brick_k0 and brick_k1 are no range of slices of the view, nor none";
    return NULL;
}

const block_bench bench_slice_generator = {.block = VODR_BLOCK_SLICE_GENERATOR,
                                           .machines = machines,
                                           .draw = draw,
                                           .longest_vox = VODR_MAX_DIM_VOX,
                                           .look = look,
                                           .traffic = traffic,
                                           .illegal = illegal,
                                           .large = true,
                                           .vectors = "",
                                           .case_cycles = 400,
                                           .level_cycles = {10000, 1000000}};
