/* cases.c - random machines, and whole cases from their parts. */
#include "cases.h"

#include <inttypes.h>
#include <stdlib.h>

#include "case_parts.h"
#include "spline.h"

static vodr_machine random_picture(rng *r, bool delicate)
{
    vodr_machine m = vodr_machine_default();
    if (delicate) { /* the paper's own: over, linear, 8 bits */
        return m;
    }
    m.blend = (int32_t)rng_int(r, VODR_BLEND_OVER, VODR_BLEND_MIP);
    m.filter = rng_one_in(r, 3) ? VODR_FILTER_NEAREST : VODR_FILTER_LINEAR;
    m.density_bits = rng_one_in(r, 2) ? 8 : 12;
    m.weight_bits = (int32_t)rng_int(r, 1, 12);
    m.guard_bits = (int32_t)rng_int(r, 0, 6);
    m.tf_bits = rng_one_in(r, 2) ? 8 : 16;
    m.fb_bits = rng_one_in(r, 2) ? 8 : 16;
    return m;
}

bool case_make(uint64_t seed, test_case *c)
{
    *c = (test_case){.seed = seed, .random = {seed}};
    bool delicate = rng_one_in(&c->random, 4);
    c->machine = random_picture(&c->random, delicate);
    if (!case_make_volume(c, delicate) || !case_make_table(c)) {
        return false;
    }
    case_make_view(c, delicate);
    return true;
}

/* Coefficients in the place of densities: those of a spline through them, or any there can be. */
static bool make_coefficients(test_case *c, rng *r)
{
    host_error error;
    const int32_t *dims = c->input.dims_vox;
    const size_t count = (size_t)dims[0] * (size_t)dims[1] * (size_t)dims[2];
    int16_t *coefficients = malloc(count * sizeof *coefficients);
    bool made =
        coefficients && spline_coefficients(&c->input, c->machine.density_bits, coefficients, &error) == HOST_OK;
    const bool any = rng_one_in(r, 3);
    for (size_t i = 0; made && any && i < count; i++) {
        coefficients[i] = (int16_t)(rng_one_in(r, 8) ? rng_int(r, 0, 1) * 65535 - 32768 : rng_int(r, -32768, 32767));
    }
    free(c->voxels);
    c->voxels = coefficients;
    c->input.voxels = coefficients;
    c->input.voxel_bytes = 2;
    c->input.map = NULL;
    return made;
}

bool case_widen(test_case *c)
{
    rng r = {c->seed + 0x5B11E5};
    if (!rng_one_in(&r, 3)) {
        return true;
    }
    c->machine.filter = rng_one_in(&r, 2) ? VODR_FILTER_CARDINAL : VODR_FILTER_BSPLINE;
    return c->machine.filter == VODR_FILTER_CARDINAL || make_coefficients(c, &r);
}

void case_free(test_case *c)
{
    free(c->voxels);
    free(c->entries);
    *c = (test_case){0};
}

/* ---- organisation ---- */

static void random_cache(rng *r, vodr_machine *m)
{
    static const vodr_shape usual[] = {{16, 1}, {32, 1}, {4, 4}, {8, 8}, {1, 1}};
    m->line_px = usual[rng_int(r, 0, 4)];
    if (rng_one_in(r, 3)) {
        m->line_px.width = 1 << rng_int(r, 0, 5);
        m->line_px.height = 1 << rng_int(r, 0, 5);
    }
    m->ways = 1 << rng_int(r, 0, rng_one_in(r, 12) ? 10 : 3);
    int32_t least = m->ways * m->line_px.width * m->line_px.height * (m->fb_bits / 2);
    m->cache_bytes = least < 64 ? 64 : least;
    for (int64_t doublings = rng_one_in(r, 2) ? 0 : rng_int(r, 1, 4); doublings > 0 && m->cache_bytes < 65536;
         doublings--) {
        m->cache_bytes *= 2;
    }
    m->index = (int32_t)rng_int(r, VODR_INDEX_MODULO, VODR_INDEX_XOR);
    m->replacement = (int32_t)rng_int(r, VODR_REPLACEMENT_LRU, VODR_REPLACEMENT_RANDOM);
    m->write_policy = (int32_t)rng_int(r, VODR_WRITE_POLICY_BACK, VODR_WRITE_POLICY_THROUGH);
    m->clear_on_first_touch = (int32_t)rng_int(r, 0, 1);
    m->nonblocking = (int32_t)rng_int(r, 0, 1);
    m->fb_layout = (int32_t)rng_int(r, VODR_FB_LAYOUT_LINEAR, VODR_FB_LAYOUT_TILED);
    m->mem_latency_cycles = (int32_t)rng_int(r, 1, 300);
    m->mem_bus_bytes = 1 << rng_int(r, 0, 8);
}

/* The least edge that cuts a volume into at most some hundreds of bricks, so that a case stays quick. */
static int32_t least_edge(const int32_t dims_vox[3])
{
    int32_t edge = 0, bricks;
    do {
        edge++;
        bricks = 1;
        for (int i = 0; i < 3; i++) {
            bricks *= (dims_vox[i] + edge - 1) / edge;
        }
    } while (bricks > 600);
    return edge;
}

static int32_t random_edge(rng *r, const int32_t dims_vox[3])
{
    int32_t least = least_edge(dims_vox);
    int32_t half =
        dims_vox[rng_int(r, 0, 2)] / 2; /* a brick's border on the volume's middle: the eye may be there too */
    if (half >= least && rng_one_in(r, 2)) {
        return half;
    }
    return (int32_t)rng_int(r, least, rng_one_in(r, 8) ? 60 : least + 12);
}

/* What bricks of `edge` voxels need of the texture memory. */
static int32_t texture_need_bytes(const vodr_machine *m, const int32_t dims_vox[3], int32_t edge)
{
    static const int32_t borders[] = {
        [VODR_FILTER_NEAREST] = 0, [VODR_FILTER_LINEAR] = 1, [VODR_FILTER_CARDINAL] = 2, [VODR_FILTER_BSPLINE] = 2};
    int32_t border = borders[m->filter];
    bool narrow = m->density_bits == 8 && m->filter != VODR_FILTER_BSPLINE;
    int32_t need = (narrow ? 1 : 2) * (1 + m->double_buffer);
    for (int i = 0; i < 3; i++) {
        int32_t side = edge + 2 * border;
        need *= side < dims_vox[i] ? side : dims_vox[i];
    }
    return need;
}

void case_organise(test_case *c, vodr_machine *m)
{
    rng *r = &c->random;
    random_cache(r, m);
    m->double_buffer = (int32_t)rng_int(r, 0, 1);
    m->skip_empty = (int32_t)rng_int(r, 0, 1);
    m->kill_transparent = (int32_t)rng_int(r, 0, 1);
    int32_t edge = random_edge(r, c->input.dims_vox);
    m->brick = rng_one_in(r, 2) ? edge : 0;
    m->brick_min = rng_one_in(r, 2) ? edge : least_edge(c->input.dims_vox);
    int32_t need = texture_need_bytes(m, c->input.dims_vox, edge);
    int32_t extra = rng_one_in(r, 3) ? 0 : (int32_t)rng_int(r, 0, rng_one_in(r, 2) ? 3 * (int64_t)need : 1 << 20);
    m->texture_memory_bytes = need + extra < 64 ? 64 : need + extra;
}

void case_time(test_case *c, vodr_machine *m)
{
    rng *r = &c->random;
    m->brick_setup_cycles = (int32_t)rng_int(r, 1, 60);
    m->slice_setup_cycles = (int32_t)rng_int(r, 1, 20);
    m->texture_latency_cycles = (int32_t)rng_int(r, 3, 14);
    m->fragment_fifo = (int32_t)rng_int(r, 1, 40);
    m->blend_cycles = (int32_t)rng_int(r, 3, 10);
    m->nonblocking = (int32_t)rng_int(r, 0, 1);
    m->nonblocking_fifo = (int32_t)rng_int(r, 1, 40);
    m->nonblocking_misses = (int32_t)rng_int(r, 1, 10);
    m->write_fifo = (int32_t)rng_int(r, 1, 20);
    m->mem_latency_cycles = (int32_t)rng_int(r, 1, 60);
    m->mem_bus_bytes = 1 << rng_int(r, 0, 5);
    m->texture_burst_bytes = 16 << rng_int(r, 0, 4);
    m->memory = (int32_t)rng_int(r, VODR_MEMORY_FIXED, VODR_MEMORY_DRAM);
    m->dram_banks = 1 << rng_int(r, 0, 3);
    m->dram_row_bytes = 64 << rng_int(r, 0, 5);
    m->dram_trcd_cycles = (int32_t)rng_int(r, 1, 15);
    m->dram_tcas_cycles = (int32_t)rng_int(r, 1, 15);
    m->dram_trp_cycles = (int32_t)rng_int(r, 1, 15);
    m->dram_trfc_cycles = (int32_t)rng_int(r, 1, 100);
    m->dram_refresh_cycles = rng_one_in(r, 3) ? 0 : (int32_t)rng_int(r, m->dram_trfc_cycles + 1, 1500);
}

void case_multiply(test_case *c, vodr_machine *m)
{
    m->pipelines = rng_one_in(&c->random, 2) ? 1 : (int32_t)rng_int(&c->random, 2, 5);
}

void case_any_machine(test_case *c, vodr_machine *m)
{
    *m = c->machine;
    case_organise(c, m);
    m->traversal = (int32_t)rng_int(&c->random, VODR_TRAVERSAL_WHOLE, VODR_TRAVERSAL_TILE);
    case_time(c, m);
    case_multiply(c, m);
}

void case_spoil(test_case *c, vodr_machine *m)
{
    rng *r = &c->random;
    if (rng_one_in(r, 4)) {
        m->cache_bytes = 64;
        return;
    }
    m->brick = random_edge(r, c->input.dims_vox);
    int32_t need = texture_need_bytes(m, c->input.dims_vox, m->brick);
    int32_t have = (int32_t)rng_int(r, 1, 4) * need / 2;
    have -= (int32_t)rng_int(r, 0, 1);
    m->texture_memory_bytes = have < 64 ? 64 : have;
}

/* ---- print ---- */

static void print_view(FILE *file, const vodr_view *v)
{
    fprintf(file, "  registers: width_px=%" PRId32 " height_px=%" PRId32 " slices=%" PRId32, v->width_px, v->height_px,
            v->slices);
    fprintf(file, " perspective=%d shift=%" PRId32 " footprint=%" PRIu32, v->perspective, v->shift, v->footprint);
    fprintf(file, " depth_first=%" PRId64 " depth_step=%" PRId64 "\n", v->depth_first, v->depth_step);
    const char *const names[] = {"base", "step_u", "step_v", "step_s"};
    const int64_t *const values[] = {v->base, v->step_u, v->step_v, v->step_s};
    for (int i = 0; i < 4; i++) {
        fprintf(file, "  %s = %" PRId64 " %" PRId64 " %" PRId64 "\n", names[i], values[i][0], values[i][1],
                values[i][2]);
    }
}

void case_print(FILE *file, const test_case *c, const vodr_machine *machine)
{
    const int32_t *dims = c->input.dims_vox;
    fprintf(file, "case %" PRIu64 ": volume %" PRId32 "x%" PRId32 "x%" PRId32 ", %" PRId32 " bytes a voxel%s\n",
            c->seed, dims[0], dims[1], dims[2], c->input.voxel_bytes, c->input.map ? ", mapped" : "");
    fprintf(file, "  view %g,%g,%g %s fov %g zoom %g\n", c->eye.azimuth_deg, c->eye.elevation_deg, c->eye.roll_deg,
            c->eye.perspective ? "perspective" : "parallel", c->eye.fov_deg, c->eye.zoom);
    print_view(file, &c->view);
    size_t count;
    const vodr_parameter *parameters = vodr_parameters(&count);
    fprintf(file, "  machine:");
    for (size_t i = 0; i < count; i++) {
        char text[32];
        vodr_machine_get(machine, &parameters[i], text, sizeof text);
        fprintf(file, " %s=%s", parameters[i].name, text);
    }
    fprintf(file, "\n");
}
