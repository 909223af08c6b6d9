/* clocked.c - joins the clocked blocks: wires their ports, and clocks them. All that blocks register lies in two banks:
 * of one they see what was registered in the cycle before, into the other they write. So the order in which they are
 * clocked makes no difference. A machine of several pipelines has all of them several times, but one frame buffer. */
#include "clocked.h"

#include <stdlib.h>
#include <string.h>

#include "clocked_blocks.h"
#include "clocked_counts.h"
#include "error.h"
#include "frame_buffer.h"
#include "pixel_word.h"
#include "texture_unit.h"
#include "volume_divider.h"
#include "voxels.h"

enum { PROGRESS_CYCLES = 1 << 16 };

/* What each block sees of a bank. */
typedef struct block_ins {
    volume_divider_in volume_divider;
    slice_generator_in slice_generator;
    rasterizer_in rasterizer;
    texture_unit_in texture_unit;
    alpha_blender_in alpha_blender;
    pixel_cache_in pixel_cache;
    frame_buffer_in frame_buffer;
    voxel_memory_in voxel_memory;
} block_ins;

typedef struct clocked_pipeline {
    volume_divider walk;
    block_setup setup;
    block_faces faces;
    block_outs bank[2];
    block_ins ins[2];
} clocked_pipeline;

struct clocked {
    const vodr_machine *machine;
    const vodr_view *view;
    texture_unit tables;
    storage storage;
    int current; /* the bank that was written last */
    clocked_sums sums;
    clocked_counts *counts;   /* by pipeline */
    frame_buffer_face shared; /* of several pipelines; the first has clock_shared() in its place */
    int32_t count;
    clocked_pipeline pipelines[];
};

/* ---- wires ---- */

static void wire(const block_outs *o, block_ins *i)
{
    i->volume_divider = (volume_divider_in){.brick = &o->slice_generator.brick};
    i->slice_generator = (slice_generator_in){.brick = &o->volume_divider.brick, .slice = &o->rasterizer.slice};
    i->rasterizer = (rasterizer_in){.slice = &o->slice_generator.slice, .fragment = &o->texture_unit.fragment};
    i->texture_unit = (texture_unit_in){.brick = &o->volume_divider.brick,
                                        .fragment = &o->rasterizer.fragment,
                                        .load = &o->frame_buffer.load,
                                        .voxels = &o->voxel_memory.voxels,
                                        .colour = &o->pixel_cache.door};
    i->alpha_blender = (alpha_blender_in){
        .colour = &o->texture_unit.colour, .door = &o->pixel_cache.door, .pixel = &o->pixel_cache.pixel};
    i->pixel_cache = (pixel_cache_in){.colour = &o->texture_unit.colour,
                                      .blended = &o->alpha_blender.blended,
                                      .filled = &o->frame_buffer.filled,
                                      .written = &o->frame_buffer.written,
                                      .before = {&o->volume_divider.report, &o->slice_generator.report,
                                                 &o->rasterizer.report, &o->texture_unit.report}};
    i->frame_buffer =
        (frame_buffer_in){.fill = &o->pixel_cache.fill, .write = &o->pixel_cache.write, .load = &o->texture_unit.load};
    i->voxel_memory = (voxel_memory_in){.fetch = &o->texture_unit.fetch};
}

/* The frame buffer that several pipelines share, in the first one's place: at once for all. */
static void clock_shared(void *state, const frame_buffer_in *first_in, frame_buffer_out *first_out)
{
    clocked *c = state;
    const frame_buffer_in *in[CLOCKED_PIPELINES] = {first_in};
    frame_buffer_out *out[CLOCKED_PIPELINES] = {first_out};
    for (int32_t i = 1; i < c->count; i++) {
        in[i] = &c->pipelines[i].ins[c->current].frame_buffer;
        out[i] = &c->pipelines[i].bank[!c->current].frame_buffer;
    }
    clocked_frame_buffer_ports(c->shared.state, in, out);
}

/* In the place of the others'. */
static void clock_nothing(void *state, const frame_buffer_in *in, frame_buffer_out *out)
{
    (void)state, (void)in, (void)out;
}

static void clock_block(block_faces *f, int block, const block_ins *in, block_outs *out)
{
#define CLOCK(name) f->name.clock(f->name.state, &in->name, &out->name)
    switch (block) {
    case VODR_BLOCK_VOLUME_DIVIDER: CLOCK(volume_divider); break;
    case VODR_BLOCK_SLICE_GENERATOR: CLOCK(slice_generator); break;
    case VODR_BLOCK_RASTERIZER: CLOCK(rasterizer); break;
    case VODR_BLOCK_TEXTURE_UNIT: CLOCK(texture_unit); break;
    case VODR_BLOCK_ALPHA_BLENDER: CLOCK(alpha_blender); break;
    case VODR_BLOCK_PIXEL_CACHE: CLOCK(pixel_cache); break;
    case VODR_BLOCK_FRAME_BUFFER: CLOCK(frame_buffer); break;
    default: CLOCK(voxel_memory);
    }
#undef CLOCK
}

static bool all_idle(const block_outs *o)
{
    return o->volume_divider.report.idle && o->slice_generator.report.idle && o->rasterizer.report.idle &&
           o->texture_unit.report.idle && o->alpha_blender.report.idle && o->pixel_cache.report.idle &&
           o->frame_buffer.report.idle;
}

static void clock_pipeline(clocked_pipeline *p, int current, const uint8_t *order)
{
    for (int i = 0; i < CLOCKED_BLOCKS; i++)
        clock_block(&p->faces, order ? order[i] : i, &p->ins[current], &p->bank[!current]);
}

bool clocked_step(clocked *c, const uint8_t *order)
{
    bool left = false;
    for (int32_t i = 0; i < c->count; i++)
        clock_pipeline(&c->pipelines[i], c->current, order);
    for (int32_t i = 0; i < c->count; i++) {
        const block_outs *bank = c->pipelines[i].bank;
        clocked_counts_cycle(&c->counts[i], &bank[c->current], &bank[!c->current]);
        left |= !all_idle(&bank[!c->current]);
    }
    c->current = !c->current;
    return left;
}

/* ---- start and end ---- */

static bool make_blocks(const block_setup *s, block_faces *f, block_outs *o)
{
    return clocked_volume_divider(s, &f->volume_divider, &o->volume_divider) &&
           clocked_slice_generator(s, &f->slice_generator, &o->slice_generator) &&
           clocked_rasterizer(s, &f->rasterizer, &o->rasterizer) &&
           clocked_texture_unit(s, &f->texture_unit, &o->texture_unit) &&
           clocked_alpha_blender(s, &f->alpha_blender, &o->alpha_blender) &&
           clocked_pixel_cache(s, &f->pixel_cache, &o->pixel_cache) &&
           clocked_voxel_memory(s, &f->voxel_memory, &o->voxel_memory);
}

/* The frame buffer of pipeline i: its own when it is the only one. */
static bool make_frame_buffer(clocked *c, int32_t i)
{
    clocked_pipeline *p = &c->pipelines[i], *first = &c->pipelines[0];
    if (c->count == 1)
        return clocked_frame_buffer(&p->setup, &p->faces.frame_buffer, &p->bank[0].frame_buffer);
    p->faces.frame_buffer = (frame_buffer_face){.clock = clock_nothing};
    p->bank[0].frame_buffer = first->bank[0].frame_buffer;
    if (i > 0)
        return true;
    p->faces.frame_buffer = (frame_buffer_face){.state = c, .clock = clock_shared};
    return clocked_frame_buffer(&p->setup, &c->shared, &p->bank[0].frame_buffer);
}

/* Pipeline i, after the one before it. */
static vodr_status start_pipeline(clocked *c, int32_t i, const block_setup *setup, const vodr_observer *observer,
                                  vodr_error *error)
{
    clocked_pipeline *p = &c->pipelines[i];
    const px_rect window = {0, 0, c->view->width_px, c->view->height_px};
    p->setup = *setup;
    p->setup.walk = &p->walk;
    vodr_status status = volume_divider_start(&p->walk, c->machine, setup->volume, c->view, setup->edge_vox, &window,
                                              c->tables.transparent_to, error);
    if (status != VODR_OK)
        return status;
    volume_divider_deal(&p->walk, c->machine, i);
    bool made = make_frame_buffer(c, i);
    made = made && make_blocks(&p->setup, &p->faces, &p->bank[0]);
    made = made && clocked_counts_start(&c->counts[i], c->machine, &p->walk.window, observer, &c->sums);
    for (int b = 0; b < 2; b++)
        wire(&p->bank[b], &p->ins[b]);
    return made ? VODR_OK : vodr_fail(error, VODR_NO_MEMORY, "no memory for the clocked machine");
}

static vodr_status start(clocked *c, const vodr_volume *volume, const vodr_table *table, const vodr_observer *observer,
                         vodr_error *error)
{
    const vodr_machine *m = c->machine;
    int32_t edge = volume_divider_edge(m, c->view);
    block_setup setup = {.machine = m, .view = c->view, .volume = volume, .tables = &c->tables, .storage = &c->storage};
    const vox_box drawn = voxels_drawn(volume);
    size_t bricks = 1;
    for (int i = 0; i < 3; i++) {
        setup.edge_vox[i] = edge ? edge : volume->dims_vox[i];
        bricks *= (size_t)ceil_div32(drawn.hi[i] - drawn.lo[i], setup.edge_vox[i]);
    }
    vodr_status status = texture_unit_start(&c->tables, m, volume, table, c->view, error);
    if (status == VODR_OK && edge)
        status = volume_divider_check(m, volume->dims_vox, edge, error);
    if (status != VODR_OK)
        return status;
    c->sums.seen = calloc(bricks, 1);
    c->counts = calloc((size_t)c->count, sizeof *c->counts);
    if (!c->sums.seen || !c->counts || !storage_start(&c->storage, m, c->view, volume, setup.edge_vox))
        return vodr_fail(error, VODR_NO_MEMORY, "no memory for the clocked machine");
    c->sums.n.brick_vox = edge;
    c->sums.n.tile_px = tile_px(m);
    for (int32_t i = 0; status == VODR_OK && i < c->count; i++)
        status = start_pipeline(c, i, &setup, observer, error);
    c->sums.n.skipped_bricks = c->pipelines[0].walk.empty_bricks;
    return status;
}

vodr_status clocked_start(clocked **c, const vodr_machine *machine, const vodr_volume *volume, const vodr_table *table,
                          const vodr_view *view, const vodr_observer *observer, vodr_error *error)
{
    *c = calloc(1, sizeof **c + (size_t)machine->pipelines * sizeof *(*c)->pipelines);
    if (!*c)
        return vodr_fail(error, VODR_NO_MEMORY, "no memory for the clocked machine");
    (*c)->machine = machine;
    (*c)->view = view;
    (*c)->count = machine->pipelines;
    vodr_status status = start(*c, volume, table, observer, error);
    if (status == VODR_OK)
        return VODR_OK;
    clocked_free(*c);
    *c = NULL;
    return status;
}

block_faces *clocked_faces(clocked *c)
{
    return &c->pipelines[0].faces;
}

const block_setup *clocked_setup(const clocked *c)
{
    return &c->pipelines[0].setup;
}

block_outs *clocked_reset(clocked *c)
{
    return &c->pipelines[0].bank[c->current];
}

const block_outs *clocked_outs(const clocked *c)
{
    return &c->pipelines[0].bank[c->current];
}

double clocked_done(const clocked *c)
{
    double done = 0;
    for (int32_t i = 0; i < c->count; i++)
        done += volume_divider_done(&c->pipelines[i].walk);
    return done / c->count;
}

vodr_status clocked_readout(const clocked *c, vodr_frame *frame, vodr_counters *counters, vodr_error *error)
{
    const vodr_machine *m = c->machine;
    frame_buffer pixels;
    vodr_status status = frame_buffer_start(&pixels, m, c->view, true, error);
    for (int64_t i = 0; status == VODR_OK && i < pixels.layout.lines * pixels.line_pixels; i++)
        pixels.pixels[i] = pixel_of_word(m, word_load(c->storage.lines + i * pixels.pixel_bytes, pixels.pixel_bytes));
    if (status == VODR_OK)
        status = frame_buffer_readout(&pixels, m, m->blend == VODR_BLEND_MIP ? c->tables.readout : NULL, frame, error);
    frame_buffer_finish(&pixels);
    if (status != VODR_OK)
        return status;
    *counters = c->sums.n;
    counters->cycles = clocked_counts_close(c->counts, c->count);
    return VODR_OK;
}

static void free_pipeline(clocked_pipeline *p)
{
#define FINISH(name)                                                                                                   \
    if (p->faces.name.state && p->faces.name.finish)                                                                   \
    p->faces.name.finish(p->faces.name.state)
    FINISH(volume_divider);
    FINISH(slice_generator);
    FINISH(rasterizer);
    FINISH(texture_unit);
    FINISH(alpha_blender);
    FINISH(pixel_cache);
    FINISH(frame_buffer);
    FINISH(voxel_memory);
#undef FINISH
    volume_divider_finish(&p->walk);
}

void clocked_free(clocked *c)
{
    if (!c)
        return;
    for (int32_t i = 0; i < c->count; i++) {
        free_pipeline(&c->pipelines[i]);
        if (c->counts)
            clocked_counts_finish(&c->counts[i]);
    }
    if (c->shared.state)
        c->shared.finish(c->shared.state);
    free(c->counts);
    free(c->sums.seen);
    storage_finish(&c->storage);
    texture_unit_finish(&c->tables);
    free(c);
}

vodr_status clocked_render(const vodr_machine *machine, const vodr_volume *volume, const vodr_table *table,
                           const vodr_view *view, const vodr_options *options, vodr_frame *frame,
                           vodr_counters *counters, vodr_error *error)
{
    clocked *c;
    vodr_status status = clocked_start(&c, machine, volume, table, view, options->observer, error);
    if (status != VODR_OK)
        return status;
    for (int64_t cycle = 1; clocked_step(c, NULL); cycle++)
        if (options->progress && cycle % PROGRESS_CYCLES == 0)
            options->progress(options->progress_context, clocked_done(c));
    status = clocked_readout(c, frame, counters, error);
    clocked_free(c);
    return status;
}
