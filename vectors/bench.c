/* bench.c - makes a block without the machine round it. */
#include "bench.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "layout.h"
#include "views.h"

enum { LARGEST_VOX = 48, LONGEST_VOX = 150, BRICKS_VOX = 12, MOST_EMPTY_BRICKS = 4096, MOST_BRICKS = 1 << 20 };

const block_bench *bench_of(vodr_block block)
{
    static const block_bench *const benches[VODR_BLOCK_COUNT] = {
        &bench_volume_divider, &bench_slice_generator, &bench_rasterizer,  &bench_texture_unit,
        &bench_alpha_blender,  &bench_pixel_cache,     &bench_frame_buffer};
    return block < VODR_BLOCK_COUNT ? benches[block] : NULL;
}

uint64_t bench_bits(rng *random, int32_t bits)
{
    uint64_t all = bits < 64 ? ((uint64_t)1 << bits) - 1 : UINT64_MAX;
    switch (rng_int(random, 0, 7)) {
    case 0: return 0;
    case 1: return all;
    case 2: return 1;
    case 3: return (all >> 1) + 1;
    default: return rng_next(random) & all;
    }
}

vodr_status bench_set(vodr_machine *machine, const char *settings, vodr_error *error)
{
    vodr_status status = VODR_OK;
    while (status == VODR_OK && *settings) {
        char name[64], value[64];
        int length = 0;
        if (sscanf(settings, "%63[^= ]=%63[^ ]%n", name, value, &length) != 2)
            return vodr_fail(error, VODR_INVALID, "'%s': must be NAME=VALUE", settings);
        status = vodr_machine_set(machine, name, value, error);
        settings += length + strspn(settings + length, " ");
    }
    return status;
}

/* ---- the scene ---- */

static bool draw_volume(bench *b, int32_t longest_vox, bool bricks)
{
    rng *r = &b->random;
    vodr_volume *v = &b->scene.input;
    int64_t largest = bricks ? BRICKS_VOX : rng_one_in(r, 2) ? LARGEST_VOX : LARGEST_VOX / 2;
    for (int c = 0; c < 3; c++)
        v->dims_vox[c] = (int32_t)rng_int(r, rng_one_in(r, 6) ? 1 : largest / 2, largest);
    if (!bricks && rng_one_in(r, 5))
        v->dims_vox[rng_int(r, 0, 2)] = (int32_t)rng_int(r, LARGEST_VOX, longest_vox);
    v->voxel_bytes = density_bytes(&b->machine);
    size_t voxels = (size_t)v->dims_vox[0] * (size_t)v->dims_vox[1] * (size_t)v->dims_vox[2];
    v->voxels = b->scene.voxels = bricks ? malloc(voxels * (size_t)v->voxel_bytes) : NULL;
    for (size_t i = 0; v->voxels && i < voxels; i++) {
        uint64_t density = bench_bits(r, b->machine.density_bits);
        if (v->voxel_bytes == 1)
            ((uint8_t *)b->scene.voxels)[i] = (uint8_t)density;
        else
            ((uint16_t *)b->scene.voxels)[i] = (uint16_t)density;
    }
    return v->voxels || !bricks;
}

/* Whether its bricks have addresses in memory, numbers among those that a library can leave out, and a walk over all of
 * them ends in a second. */
static bool has_room(const bench *b)
{
    const vodr_machine *m = &b->machine;
    const int32_t *dims = b->scene.input.dims_vox;
    int32_t edge_vox[3];
    int64_t bricks = 1;
    for (int c = 0; c < 3; c++) {
        edge_vox[c] = m->traversal == VODR_TRAVERSAL_WHOLE || !m->brick ? dims[c] : m->brick;
        bricks *= ceil_div32(dims[c], edge_vox[c]);
    }
    return bricks <= ((int64_t)1 << 46) / brick_room_bytes(m, edge_vox) &&
           bricks <= (m->skip_empty ? MOST_EMPTY_BRICKS : MOST_BRICKS);
}

/* Sides as large as they can be, of which nobody reads a voxel. */
static void draw_large_volume(bench *b)
{
    int32_t *dims = b->scene.input.dims_vox;
    b->scene.input.voxel_bytes = density_bytes(&b->machine);
    for (int c = 0; c < 3; c++)
        dims[c] = rng_one_in(&b->random, 4) ? VODR_MAX_DIM_VOX : (int32_t)rng_int(&b->random, 1, VODR_MAX_DIM_VOX);
    while (!has_room(b))
        for (int c = 0; c < 3; c++)
            dims[c] -= rng_one_in(&b->random, 2) ? dims[c] / 2 : 0;
}

static bool draw_table(bench *b)
{
    rng *r = &b->random;
    size_t count = (size_t)1 << b->machine.density_bits;
    size_t clear = rng_one_in(r, 2) ? (size_t)rng_int(r, 0, (int64_t)count) : 0;
    b->scene.entries = malloc(count * sizeof *b->scene.entries);
    b->scene.table = (vodr_table){.entries = b->scene.entries, .count = count};
    for (size_t i = 0; b->scene.entries && i < count; i++) {
        vodr_rgba *e = &b->scene.entries[i];
        *e = (vodr_rgba){0, 0, 0, 0};
        if (i < clear)
            continue;
        e->a = (uint16_t)bench_bits(r, b->machine.tf_bits);
        e->r = (uint16_t)rng_int(r, 0, e->a);
        e->g = (uint16_t)rng_int(r, 0, e->a);
        e->b = (uint16_t)rng_int(r, 0, e->a);
    }
    return b->scene.entries != NULL;
}

/* Bricks that are left out, whatever may be in them. */
static void draw_empty(bench *b)
{
    volume_divider *walk = &b->own.walk;
    int64_t one_in = rng_int(&b->random, 1, 4), bricks = (int64_t)walk->bricks[0] * walk->bricks[1] * walk->bricks[2];
    for (int64_t i = 0; walk->empty && i < bricks; i++)
        walk->empty[i] = rng_one_in(&b->random, one_in);
}

/* ---- the block ---- */

/* skip_empty would look for bricks to leave out in voxels; which those are is said here instead. */
static vodr_status start_walk(bench *b, vodr_error *error)
{
    const px_rect window = {0, 0, b->scene.view.width_px, b->scene.view.height_px};
    volume_divider *walk = &b->own.walk;
    vodr_machine looks = b->machine;
    looks.skip_empty = 0;
    vodr_status status = volume_divider_start(walk, &looks, &b->scene.input, &b->scene.view, b->setup.edge_vox, &window,
                                              b->own.tables.transparent_to, error);
    if (status != VODR_OK || !b->machine.skip_empty)
        return status;
    walk->empty = calloc((size_t)walk->bricks[0] * (size_t)walk->bricks[1], (size_t)walk->bricks[2]);
    return walk->empty ? VODR_OK : vodr_fail(error, VODR_NO_MEMORY, "no memory for empty bricks");
}

vodr_status bench_set_up(bench *b, vodr_error *error)
{
    const vodr_machine *m = &b->machine;
    const bench_scene *s = &b->scene;
    int32_t edge = volume_divider_edge(m, &s->view);
    b->faces = &b->own.faces;
    b->reset = &b->own.reset;
    b->setup = (block_setup){.machine = m,
                             .view = &s->view,
                             .volume = &s->input,
                             .walk = &b->own.walk,
                             .tables = &b->own.tables,
                             .storage = &b->own.storage};
    for (int c = 0; c < 3; c++)
        b->setup.edge_vox[c] = edge ? edge : s->input.dims_vox[c];
    vodr_status status = vodr_machine_check(m, error);
    if (status == VODR_OK)
        status = vodr_view_check(&s->view, s->input.dims_vox, error);
    if (status == VODR_OK)
        status = texture_unit_start(&b->own.tables, m, &s->input, &s->table, &s->view, error);
    if (status == VODR_OK && edge)
        status = volume_divider_check(m, s->input.dims_vox, edge, error);
    if (status == VODR_OK)
        status = start_walk(b, error);
    if (status == VODR_OK && !storage_start(&b->own.storage, m, &s->view, &s->input, b->setup.edge_vox))
        status = vodr_fail(error, VODR_NO_MEMORY, "no memory for a frame buffer");
    return status;
}

vodr_status bench_start(bench *b, vodr_block block, vodr_error *error)
{
    bool made = false;
    switch (block) {
#define START(NAME, name)                                                                                              \
    case VODR_BLOCK_##NAME: made = clocked_##name(&b->setup, &b->faces->name, &b->reset->name); break;
        BENCH_BLOCKS(START)
    default: break;
    }
    return made ? VODR_OK : vodr_fail(error, VODR_NO_MEMORY, "no memory for a block");
}

vodr_status bench_open_large(bench *b, const block_bench *what, const vodr_machine *machine, uint64_t seed,
                             vodr_error *error)
{
    bool bricks = what->block == VODR_BLOCK_FRAME_BUFFER;
    *b = (bench){.random = {seed}, .machine = *machine};
    if (what->draw)
        what->draw(&b->random, &b->machine);
    if (!bricks)
        draw_large_volume(b);
    if ((bricks && !draw_volume(b, 0, true)) || !draw_table(b))
        return vodr_fail(error, VODR_NO_MEMORY, "no memory for a volume and a table");
    b->scene.view = views_large(&b->random, b->scene.input.dims_vox);
    vodr_status status = bench_set_up(b, error);
    if (status != VODR_OK)
        return status;
    draw_empty(b);
    return bench_start(b, what->block, error);
}

vodr_status bench_open(bench *b, const block_bench *what, const vodr_machine *machine, uint64_t seed, vodr_error *error)
{
    *b = (bench){.random = {seed}, .machine = *machine};
    if (what->draw)
        what->draw(&b->random, &b->machine);
    if (!draw_volume(b, what->longest_vox ? what->longest_vox : LONGEST_VOX, what->block == VODR_BLOCK_FRAME_BUFFER) ||
        !draw_table(b))
        return vodr_fail(error, VODR_NO_MEMORY, "no memory for a volume and a table");
    b->scene.view = views_any(&b->random, b->scene.input.dims_vox);
    vodr_view other = b->scene.view;
    if (what->look)
        what->look(&b->random, b->scene.input.dims_vox, &other);
    if (vodr_view_check(&other, b->scene.input.dims_vox, NULL) == VODR_OK)
        b->scene.view = other;
    vodr_status status = bench_set_up(b, error);
    if (status != VODR_OK)
        return status;
    draw_empty(b);
    return bench_start(b, what->block, error);
}

void bench_close(bench *b)
{
#define FINISH(NAME, name)                                                                                             \
    if (b->own.faces.name.state && b->own.faces.name.finish)                                                           \
        b->own.faces.name.finish(b->own.faces.name.state);
    BENCH_BLOCKS(FINISH)
    storage_finish(&b->own.storage);
    volume_divider_finish(&b->own.walk);
    texture_unit_finish(&b->own.tables);
    free(b->scene.voxels);
    free(b->scene.entries);
}

void bench_clock(const bench *b, vodr_block block, const void *in, void *out)
{
    switch (block) {
#define CLOCK(NAME, name)                                                                                              \
    case VODR_BLOCK_##NAME: b->faces->name.clock(b->faces->name.state, in, out); break;
        BENCH_BLOCKS(CLOCK)
    default: break;
    }
}
