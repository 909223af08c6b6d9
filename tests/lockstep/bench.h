/* bench.h - lock-step of one block: traffic that a test makes goes into the block in Verilog and the block in C, and
 * every output is compared in every cycle (rtl/lockstep.h).
 *
 * A block's file says which machines it is built for and makes traffic: random but legal, biased towards what breaks
 * hardware, with back-pressure on both sides. */
#ifndef TESTS_BENCH_H
#define TESTS_BENCH_H

#include "cases.h"
#include "clocked.h"
#include "lockstep.h"

typedef struct bench {
    uint64_t seed;
    rng random; /* where traffic goes on */
    test_case scene;
    vodr_machine machine;
    clocked *whole; /* what the block is part of; no other block of it is clocked */
    lockstep pair;
    block_faces *faces; /* faces->BLOCK.clock(faces->BLOCK.state, &in, &out) is a cycle */
    block_outs *reset;  /* what outputs hold before the first */
    uint64_t cycles;    /* count them here */
    uint64_t left;      /* transactions that the frame had no more of: the next seed's */
} bench;

typedef struct block_bench {
    vodr_block block;
    /* Machines, each as `name=value ...` on top of paper-16: what the Verilog has as parameters. NULL after the last.
     */
    const char *const *machines;
    /* Draws what it has as registers. NULL: nothing. */
    void (*draw)(rng *random, vodr_machine *machine);
    /* Draws another view than case_make() did. NULL: none. */
    void (*look)(rng *random, test_case *scene);
    /* Clocks the block until that many transactions are done, or bench_differs(). */
    void (*traffic)(bench *b, uint64_t transactions);
} block_bench;

static inline bool bench_differs(const bench *b)
{
    return b->pair.first.found;
}

/* One of the corners (0, 1, half, all ones) or anything, of so many bits. */
uint64_t bench_bits(rng *random, int32_t bits);

extern const block_bench bench_volume_divider, bench_slice_generator, bench_rasterizer, bench_texture_unit,
    bench_alpha_blender, bench_pixel_cache, bench_frame_buffer;

/* Tests of arithmetic, on all operands. */
void lockstep_lerp(void **state);

#endif
