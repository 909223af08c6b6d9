/* case_verilog.c - random machines that the Verilog has too. */
#include "cases.h"

static void draw_parameters(rng *r, vodr_machine *m)
{
    switch (rng_int(r, 0, 3)) { /* each is a set of libraries */
    case 0: break;
    case 1: m->line_px = (vodr_shape){32, 1}; break;
    case 2: m->traversal = VODR_TRAVERSAL_WHOLE; break;
    default: m->nonblocking = 1;
    }
}

static void draw_registers(rng *r, vodr_machine *m)
{
    m->blend = (int32_t)rng_int(r, VODR_BLEND_OVER, VODR_BLEND_MIP);
    m->filter = rng_one_in(r, 3) ? VODR_FILTER_NEAREST : VODR_FILTER_LINEAR;
    if (m->traversal != VODR_TRAVERSAL_WHOLE) {
        m->traversal = (int32_t)rng_int(r, VODR_TRAVERSAL_LAYER, VODR_TRAVERSAL_TILE);
    }
    m->replacement = (int32_t)rng_int(r, VODR_REPLACEMENT_LRU, VODR_REPLACEMENT_RANDOM);
    m->index = rng_one_in(r, 2) ? VODR_INDEX_XOR : VODR_INDEX_MODULO;
    m->fb_layout = rng_one_in(r, 2) ? VODR_FB_LAYOUT_LINEAR : VODR_FB_LAYOUT_TILED;
    m->kill_transparent = rng_one_in(r, 3) ? 1 : 0;
    m->brick_setup_cycles = (int32_t)rng_int(r, 32, 60);
    m->slice_setup_cycles = rng_one_in(r, 4) ? 1 : (int32_t)rng_int(r, 1, 40);
    m->texture_latency_cycles = rng_one_in(r, 4) ? 3 : (int32_t)rng_int(r, 3, 30);
    m->memory = rng_one_in(r, 3) ? VODR_MEMORY_DRAM : VODR_MEMORY_FIXED;
    m->dram_refresh_cycles = rng_one_in(r, 4) ? 0 : (int32_t)rng_int(r, 60, 2000);
    m->dram_trfc_cycles = (int32_t)rng_int(r, 1, 50);
    m->dram_tcas_cycles = (int32_t)rng_int(r, 3, 30);
    m->texture_burst_bytes = 16 << rng_int(r, 0, 5);
}

void case_verilog_machine(test_case *c, vodr_machine *m)
{
    vodr_machine_named("paper-16", m, NULL);
    m->density_bits = c->machine.density_bits;
    m->tf_bits = c->machine.tf_bits;
    draw_parameters(&c->random, m);
    draw_registers(&c->random, m);
}
