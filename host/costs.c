/* costs.c - costs from a machine, its view and its counters (docs/sweep.md, "Costs", has every formula). */
#include "costs.h"

#include <math.h>

enum { SRAM_WORD_BYTES = 8, SRAM_WORD_CAPACITY_BYTES = 8192, CHANNELS = 4, TILE_PX = 32 };

/* Least n with 2^n >= value. */
static int bits_for(uint64_t value)
{
    int n = 0;
    while (n < 63 && (UINT64_C(1) << n) < value)
        n++;
    return n;
}

static uint64_t divided_up(uint64_t a, uint64_t b)
{
    return (a + b - 1) / b;
}

static uint64_t line_pixels(const vodr_machine *m)
{
    return (uint64_t)m->line_px.width * (uint64_t)m->line_px.height;
}

/* Lines that the frame buffer's layout has (docs/architecture.md, section 8). */
static uint64_t frame_lines(const vodr_machine *m, const vodr_view *v)
{
    const uint64_t width = (uint64_t)v->width_px, height = (uint64_t)v->height_px;
    if (m->fb_layout == VODR_FB_LAYOUT_LINEAR)
        return divided_up(width, (uint64_t)m->line_px.width) * divided_up(height, (uint64_t)m->line_px.height);
    return divided_up(width, TILE_PX) * divided_up(height, TILE_PX) * (TILE_PX * TILE_PX / line_pixels(m));
}

static uint64_t pixel_bits(const vodr_machine *m)
{
    return (uint64_t)(CHANNELS * m->fb_bits);
}

/* What one tag holds: the line's number beyond its set, valid, dirty, its age among the ways. */
static uint64_t tag_bits(const vodr_machine *m, const vodr_view *v)
{
    uint64_t lines = (uint64_t)m->cache_bytes * 8 / (line_pixels(m) * pixel_bits(m)), sets = lines / (uint64_t)m->ways;
    int number = bits_for(divided_up(frame_lines(m, v), sets ? sets : 1)),
        dirty = m->write_policy == VODR_WRITE_POLICY_BACK;
    int age = m->replacement == VODR_REPLACEMENT_LRU ? bits_for((uint64_t)m->ways) : 0;
    return (uint64_t)(number + 1 + dirty + age);
}

/* Beside the tags: a set's next victim, or the generator of random ones. */
static uint64_t victim_bits(const vodr_machine *m, uint64_t sets)
{
    switch (m->replacement) {
    case VODR_REPLACEMENT_FIFO: return sets * (uint64_t)bits_for((uint64_t)m->ways);
    case VODR_REPLACEMENT_RANDOM: return 16;
    default: return 0;
    }
}

/* Which pixel of the frame. */
static uint64_t place_bits(const vodr_view *v)
{
    return (uint64_t)(bits_for((uint64_t)v->width_px) + bits_for((uint64_t)v->height_px));
}

/* A fragment under way: its colour, in mip its density, and its pixel. */
static uint64_t fragment_bits(const vodr_machine *m, const vodr_view *v)
{
    return (m->blend == VODR_BLEND_MIP ? (uint64_t)m->density_bits : pixel_bits(m)) + place_bits(v);
}

/* Queues and the write buffer of docs/timing.md; those that the machine's other parameters switch off are not there. */
static uint64_t fifo_bits(const vodr_machine *m, const vodr_view *v)
{
    const uint64_t fragment = fragment_bits(m, v);
    const int line_number = bits_for(frame_lines(m, v));
    uint64_t fragments = (uint64_t)m->fragment_fifo;
    if (m->traversal == VODR_TRAVERSAL_WHOLE)
        fragments += (uint64_t)m->mem_latency_cycles;
    uint64_t bits = fragments * fragment;
    if (m->nonblocking)
        bits += (uint64_t)m->nonblocking_fifo * fragment + (uint64_t)m->nonblocking_misses * (uint64_t)line_number;
    if (m->write_policy == VODR_WRITE_POLICY_THROUGH)
        bits += (uint64_t)m->write_fifo * (pixel_bits(m) + place_bits(v));
    else
        bits += line_pixels(m) * pixel_bits(m) + (uint64_t)line_number;
    return bits;
}

static void count_bits(costs *c, const vodr_machine *m, const vodr_view *v)
{
    const uint64_t lines = (uint64_t)m->cache_bytes * 8 / (line_pixels(m) * pixel_bits(m));
    c->cache_data_bits = (uint64_t)m->cache_bytes * 8;
    c->cache_tag_bits = lines * tag_bits(m, v) + victim_bits(m, lines / (uint64_t)m->ways);
    c->texture_bits = m->traversal == VODR_TRAVERSAL_WHOLE ? 0 : (uint64_t)m->texture_memory_bytes * 8;
    c->table_bits = (UINT64_C(1) << m->density_bits) * pixel_bits(m);
    c->fifo_bits = fifo_bits(m, v);
    c->touch_bits = m->clear_on_first_touch ? frame_lines(m, v) : 0;
}

/* Every pipeline has its own; of the bits of touch each has those of its lines. */
static void multiply_bits(costs *c, uint64_t pipelines)
{
    c->cache_data_bits *= pipelines;
    c->cache_tag_bits *= pipelines;
    c->texture_bits *= pipelines;
    c->table_bits *= pipelines;
    c->fifo_bits *= pipelines;
}

/* Moving so many bytes in or out of an on-chip memory of so many bits. */
static double sram_pj(const energy_table *e, double bytes, uint64_t capacity_bits)
{
    double capacity = (double)capacity_bits / 8 / SRAM_WORD_CAPACITY_BYTES;
    return bytes / SRAM_WORD_BYTES * e->pj[ENERGY_SRAM_WORD] * sqrt(capacity);
}

static double add_pj(const energy_table *e, int bits)
{
    return e->pj[ENERGY_ADD] * bits / 8;
}

static double multiply_pj(const energy_table *e, int bits, int by_bits)
{
    return e->pj[ENERGY_MULTIPLY] * bits * by_bits / 64;
}

/* Interpolating once: the difference, times the weight, plus the first. */
static double lerp_pj(const energy_table *e, const vodr_machine *m)
{
    int bits = m->density_bits + m->guard_bits;
    return 2 * add_pj(e, bits) + multiply_pj(e, bits, m->weight_bits);
}

/* Filtering a fragment: 7 interpolations, or 21 sums of four weighted numbers. */
static double filter_pj(const energy_table *e, const vodr_machine *m)
{
    enum { LERPS = 7, SUMS = 21, TAPS = 4, MORE_WEIGHT_BITS = 2, COEFFICIENT_BITS = 16 };
    const int bits = (m->filter == VODR_FILTER_BSPLINE ? COEFFICIENT_BITS : m->density_bits) + m->guard_bits;
    const int weight_bits = m->weight_bits + MORE_WEIGHT_BITS;
    switch ((vodr_filter)m->filter) {
    case VODR_FILTER_NEAREST: return 0;
    case VODR_FILTER_LINEAR: return LERPS * lerp_pj(e, m);
    default: return SUMS * (TAPS * multiply_pj(e, bits, weight_bits) + (TAPS - 1) * add_pj(e, bits + weight_bits));
    }
}

/* Blending a pixel: on each channel a product, its rounding to a division by 2^n - 1, and the sum; in mip a compare. */
static double blend_pj(const energy_table *e, const vodr_machine *m)
{
    if (m->blend == VODR_BLEND_MIP)
        return add_pj(e, m->density_bits);
    return CHANNELS * (multiply_pj(e, m->fb_bits, m->fb_bits) + 2 * add_pj(e, 2 * m->fb_bits) + add_pj(e, m->fb_bits));
}

static void count_energy(costs *c, const vodr_machine *m, const vodr_view *v, const vodr_counters *n,
                         const energy_table *e)
{
    enum { POSITION_BITS = 43, COMPONENTS = 3 };
    static const int fetches[] = {
        [VODR_FILTER_NEAREST] = 1, [VODR_FILTER_LINEAR] = 8, [VODR_FILTER_CARDINAL] = 64, [VODR_FILTER_BSPLINE] = 64};
    const bool mip = m->blend == VODR_BLEND_MIP, spline = m->filter == VODR_FILTER_BSPLINE;
    const bool whole = m->traversal == VODR_TRAVERSAL_WHOLE;
    const double accesses = (double)(n->hits + n->misses), fragments = (double)n->fragments;
    const double blends = accesses - (double)n->terminated_fragments;
    const double pixel_bytes = (double)pixel_bits(m) / 8, voxel_bytes = spline || m->density_bits > 8 ? 2 : 1;
    const double filled = (double)n->fb_read_bytes;
    const double emptied = m->write_policy == VODR_WRITE_POLICY_BACK ? (double)n->fb_write_bytes : 0;

    c->offchip_pj = (double)costs_offchip_bytes(c) * e->pj[ENERGY_DRAM_BYTE];
    c->cache_pj = sram_pj(e, (accesses + blends) * pixel_bytes + filled + emptied, c->cache_data_bits) +
                  sram_pj(e, accesses * m->ways * (double)tag_bits(m, v) / 8, c->cache_tag_bits);
    if (!whole)
        c->texture_pj =
            sram_pj(e, (double)n->texture_load_bytes + fragments * fetches[m->filter] * voxel_bytes, c->texture_bits);
    if (!mip)
        c->table_pj = sram_pj(e, fragments * pixel_bytes, c->table_bits);
    c->arithmetic_pj = fragments * (COMPONENTS * add_pj(e, POSITION_BITS) + filter_pj(e, m)) + blends * blend_pj(e, m);
}

costs costs_of(const vodr_machine *machine, const vodr_view *view, const vodr_counters *counters,
               const cost_tables *tables)
{
    costs c = {.fb_bytes = counters->fb_read_bytes + counters->fb_write_bytes,
               .texture_bytes = counters->texture_load_bytes};
    count_bits(&c, machine, view);
    count_energy(&c, machine, view, counters, &tables->energy); /* an access costs what one pipeline's memory does */
    multiply_bits(&c, (uint64_t)machine->pipelines);
    c.has_cells = cells_of(&tables->cells, machine, &c.cells);
    return c;
}

host_status cost_tables_open(const char *energy, const char *cells, cost_tables *tables, host_error *error)
{
    *tables = (cost_tables){0};
    host_status status = energy_open(energy, &tables->energy, error);
    return status == HOST_OK ? cell_table_open(cells, &tables->cells, error) : status;
}

void cost_tables_free(cost_tables *tables)
{
    cell_table_free(&tables->cells);
}

uint64_t costs_offchip_bytes(const costs *c)
{
    return c->fb_bytes + c->texture_bytes;
}

uint64_t costs_onchip_bits(const costs *c)
{
    return c->cache_data_bits + c->cache_tag_bits + c->texture_bits + c->table_bits + c->fifo_bits + c->touch_bits;
}

double costs_energy_pj(const costs *c)
{
    return c->offchip_pj + c->cache_pj + c->texture_pj + c->table_pj + c->arithmetic_pj;
}

static json_int_t whole_pj(double pj)
{
    return (json_int_t)llround(pj);
}

static json_t *known(const costs *c, int64_t count)
{
    return c->has_cells ? json_integer((json_int_t)count) : json_null();
}

json_t *costs_json(const costs *c)
{
    return json_pack("{s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:o, s:o, s:o}",
                     "fb_bytes", (json_int_t)c->fb_bytes, "texture_bytes", (json_int_t)c->texture_bytes,
                     "offchip_bytes", (json_int_t)costs_offchip_bytes(c), "energy_pj", whole_pj(costs_energy_pj(c)),
                     "offchip_pj", whole_pj(c->offchip_pj), "cache_pj", whole_pj(c->cache_pj), "texture_pj",
                     whole_pj(c->texture_pj), "table_pj", whole_pj(c->table_pj), "arithmetic_pj",
                     whole_pj(c->arithmetic_pj), "onchip_bits", (json_int_t)costs_onchip_bits(c), "cache_data_bits",
                     (json_int_t)c->cache_data_bits, "cache_tag_bits", (json_int_t)c->cache_tag_bits, "texture_bits",
                     (json_int_t)c->texture_bits, "table_bits", (json_int_t)c->table_bits, "fifo_bits",
                     (json_int_t)c->fifo_bits, "touch_bits", (json_int_t)c->touch_bits, "cells",
                     known(c, c->cells.cells), "word_bits", known(c, c->cells.word_bits), "flip_flops",
                     known(c, c->cells.flip_flops));
}
