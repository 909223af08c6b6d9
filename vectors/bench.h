/* bench.h - one block alone, with traffic that is made up: random but legal, biased towards what breaks hardware, with
 * back-pressure on both sides. Lock-step and test vectors have the same traffic.
 *
 * A block's file, vectors/BLOCK.c, says which machines it is built for, makes the traffic, and knows which traffic is
 * legal. */
#ifndef VECTORS_BENCH_H
#define VECTORS_BENCH_H

#include "clocked_blocks.h"
#include "rng.h"
#include "texture_unit.h"
#include "volume_divider.h"

enum { VECTORS_LEVELS = 2 };

/* What a block's registers and tables come from. */
typedef struct bench_scene {
    vodr_view view;
    vodr_volume input;
    void *voxels; /* NULL where nobody reads bricks */
    vodr_table table;
    vodr_rgba *entries;
} bench_scene;

/* It points into itself and stays where it was made. */
typedef struct bench {
    rng random; /* where traffic goes on */
    bench_scene scene;
    vodr_machine machine;
    block_setup setup;   /* what the block is made from */
    block_faces *faces;  /* faces->BLOCK.clock(faces->BLOCK.state, &in, &out) is a cycle */
    block_outs *reset;   /* what outputs hold before the first */
    uint64_t cycles;     /* count them here */
    uint64_t left;       /* transactions that the frame had no more of: the next seed's */
    const bool *differs; /* where whoever looks on says that he has seen enough; NULL: nobody does */
    struct {
        texture_unit tables;
        volume_divider walk;
        storage storage;
        block_faces faces;
        block_outs reset;
    } own;
} bench;

typedef struct block_bench {
    vodr_block block;
    /* Machines, each as `name=value ...` on top of paper-16: what the Verilog has as parameters. NULL after the last.
     */
    const char *const *machines;
    /* Draws what it has as registers. NULL: nothing. */
    void (*draw)(rng *random, vodr_machine *machine);
    /* Of a volume now and then an edge is up to so long; 0: as long as for all. */
    int32_t longest_vox;
    /* Draws another view of a volume than views_any() did, which is taken if it is legal. NULL: none. */
    void (*look)(rng *random, const int32_t dims_vox[3], vodr_view *view);
    /* Clocks the block until that many transactions are done, or bench_differs(). */
    void (*traffic)(bench *b, uint64_t transactions);
    /* Says why a cycle's inputs are not legal, given what the block shows in that cycle; NULL: they are. It remembers
     * what came before in `rules`, of rules_bytes, all zero before the first cycle. What passes can harm no block in C,
     * and is what the Verilog may count on. */
    const char *(*illegal)(const bench *b, void *rules, const void *in, const void *shown);
    size_t rules_bytes;
    bool large;           /* it has numbers that only large volumes and frames fill: see bench_open_large() */
    const char *vectors;  /* the machine of test vectors, on top of paper-16: small lines, few of them */
    uint64_t case_cycles; /* of a case of them, at most */
    uint64_t level_cycles[VECTORS_LEVELS]; /* of all cases of a level, at least */
} block_bench;

/* DO(NAME, name) for each block. */
#define BENCH_BLOCKS(DO)                                                                                               \
    DO(VOLUME_DIVIDER, volume_divider)                                                                                 \
    DO(SLICE_GENERATOR, slice_generator)                                                                               \
    DO(RASTERIZER, rasterizer)                                                                                         \
    DO(TEXTURE_UNIT, texture_unit)                                                                                     \
    DO(ALPHA_BLENDER, alpha_blender)                                                                                   \
    DO(PIXEL_CACHE, pixel_cache)                                                                                       \
    DO(FRAME_BUFFER, frame_buffer)

/* By number; NULL where there is no such block. */
const block_bench *bench_of(vodr_block block);

/* Sets parameters from "name=value name=value ...". */
vodr_status bench_set(vodr_machine *machine, const char *settings, vodr_error *error);

/* A bench before its first cycle: the machine's registers, a scene and the block. To be closed after any outcome. */
vodr_status bench_open(bench *b, const block_bench *what, const vodr_machine *machine, uint64_t seed,
                       vodr_error *error);

/* The same, of a volume and a frame as large as there can be: for lock-step, which need not write them down. */
vodr_status bench_open_large(bench *b, const block_bench *what, const vodr_machine *machine, uint64_t seed,
                             vodr_error *error);

/* The same in steps, when machine, view and the volume's size are known: what the block is made from, whose tables may
 * be written then, and the block. */
vodr_status bench_set_up(bench *b, vodr_error *error);
vodr_status bench_start(bench *b, vodr_block block, vodr_error *error);

void bench_close(bench *b);

/* One cycle of a block; `in` and `out` are its records. */
void bench_clock(const bench *b, vodr_block block, const void *in, void *out);

static inline bool bench_differs(const bench *b)
{
    return b->differs && *b->differs;
}

/* One of the corners (0, 1, half, all ones) or anything, of so many bits. */
uint64_t bench_bits(rng *random, int32_t bits);

extern const block_bench bench_volume_divider, bench_slice_generator, bench_rasterizer, bench_texture_unit,
    bench_alpha_blender, bench_pixel_cache, bench_frame_buffer;

#endif
