/* volume_divider.c - traffic for the volume divider: nothing goes in but the slice generator's answer. What comes out
 * follows from view and machine, so an episode is a frame or its beginning, and a transaction a visit, or as many
 * cycles of work as a box takes at least. */
#include "bench.h"

enum { LEAST_SETUP_CYCLES = 29 };

static const char *const machines[] = {"texture_memory_bytes=1048576", "skip_empty=1 texture_memory_bytes=1048576",
                                       NULL};

static void draw(rng *random, vodr_machine *m)
{
    m->blend = (int32_t)rng_int(random, VODR_BLEND_OVER, VODR_BLEND_MIP);
    m->traversal = (int32_t)rng_int(random, VODR_TRAVERSAL_WHOLE, VODR_TRAVERSAL_TILE);
    /* Not less: so volumes have 4096 bricks at most, which is as many as a library knows to leave out. */
    m->brick = (int32_t)rng_int(random, 5, rng_one_in(random, 3) ? 60 : 16);
    m->brick_setup_cycles = (int32_t)rng_int(random, LEAST_SETUP_CYCLES, rng_one_in(random, 4) ? 70 : 34);
    m->cache_bytes = 256 << rng_int(random, 0, 6);
}

/* Perspective along an axis in powers of two, the eye on a voxel's corner: corners of boxes lie on pixels exactly, some
 * of them in the eye's plane, so that no quotient has a remainder to hide behind. */
static vodr_view plain_view(rng *random, const int32_t dims_vox[3])
{
    int depth = (int)rng_int(random, 0, 2), across = (depth + 1) % 3, down = (depth + 2) % 3;
    int64_t unit = (rng_one_in(random, 2) ? 1 : -1) * ((int64_t)1 << 28);
    vodr_view v = {.perspective = true, .shift = 8, .footprint = 1 << 20};
    v.width_px = (int32_t)rng_int(random, 1, 40);
    v.height_px = (int32_t)rng_int(random, 1, 40);
    v.slices = (int32_t)rng_int(random, 1, 40);
    v.depth_step = -(rng_int(random, 0, 8) << 16);
    v.depth_first = (rng_int(random, 1, 60) << 16) - v.slices * v.depth_step;
    v.step_s[depth] = unit; /* 1/16 voxel a depth */
    v.step_u[across] = unit >> rng_int(random, 0, 4);
    v.step_v[down] = -unit >> rng_int(random, 0, 4);
    v.step_s[across] = -(v.width_px / 2) * v.step_u[across];
    v.step_s[down] = -(v.height_px / 2) * v.step_v[down];
    for (int c = 0; c < 3; c++)
        v.base[c] = rng_int(random, -10, dims_vox[c] + 10) * (1 << 24);
    return v;
}

static void look(rng *random, const int32_t dims_vox[3], vodr_view *view)
{
    if (rng_one_in(random, 5))
        *view = plain_view(random, dims_vox);
}

static void traffic(bench *b, uint64_t transactions)
{
    volume_divider_face *face = &b->faces->volume_divider;
    volume_divider_out out = b->reset->volume_divider;
    ready_port ready = {false};
    const volume_divider_in in = {.brick = &ready};
    int64_t haste = 1;
    int32_t idle_cycles = 0;
    uint64_t done = 0, visits = 0, busy_cycles = 0;
    for (; done < transactions && idle_cycles < 5 && !bench_differs(b); b->cycles++) {
        if (rng_one_in(&b->random, 300))
            haste = rng_one_in(&b->random, 3) ? rng_int(&b->random, 2, 400) : 1;
        ready.ready = rng_one_in(&b->random, haste);
        visits += out.brick.valid && ready.ready;
        face->clock(face->state, &in, &out);
        idle_cycles += out.report.idle;
        busy_cycles += out.report.status == BLOCK_BUSY;
        done = visits + busy_cycles / LEAST_SETUP_CYCLES;
    }
    b->left = done < transactions ? transactions - done : 0;
}

/* Its one input may be what it likes. */
static const char *illegal(const bench *b, void *rules, const void *inputs, const void *shown)
{
    (void)b;
    (void)rules;
    (void)inputs;
    (void)shown;
    return NULL;
}

const block_bench bench_volume_divider = {.block = VODR_BLOCK_VOLUME_DIVIDER,
                                          .machines = machines,
                                          .draw = draw,
                                          .look = look,
                                          .traffic = traffic,
                                          .illegal = illegal,
                                          .large = true,
                                          .vectors = "skip_empty=1 texture_memory_bytes=1048576",
                                          .case_cycles = 2048,
                                          .level_cycles = {30000, 1000000}};
