#include "modules.h"

#include <stddef.h>

#include "layout.h"

#define AXES(name, bits)                                                                                               \
    {name "_x", bits}, {name "_y", bits},                                                                              \
    {                                                                                                                  \
        name "_z", bits                                                                                                \
    }
#define VIEW                                                                                                           \
    {"perspective", 1}, {"shift", 5}, AXES("base", 64), AXES("step_u", 64), AXES("step_v", 64), AXES("step_s", 64),    \
        {"depth_first", 64},                                                                                           \
    {                                                                                                                  \
        "depth_step", 64                                                                                               \
    }
#define BOUND(axis)                                                                                                    \
    AXES("bound_" axis "_m", 32), {"bound_" axis "_lo", 53},                                                           \
    {                                                                                                                  \
        "bound_" axis "_hi", 53                                                                                        \
    }

static const module_register none[] = {{NULL, 0}};
static const char *const no_parameters[] = {NULL};

static const char *const volume_divider_parameters[] = {"EMPTY_BRICKS", NULL};
static const module_register volume_divider[] = {AXES("dim", 16),
                                                 {"width_px", 15},
                                                 {"height_px", 15},
                                                 {"slices", 15},
                                                 VIEW,
                                                 {"blend", 2},
                                                 {"skip_empty", 1},
                                                 {"brick_setup_cycles", 16},
                                                 AXES("edge", 16),
                                                 AXES("bricks", 16),
                                                 AXES("eye", 16),
                                                 {"nest_0", 2},
                                                 {"nest_1", 2},
                                                 {"nest_2", 2},
                                                 {"tile_px", 15},
                                                 {"centre_x", 15},
                                                 {"centre_y", 15},
                                                 BOUND("x"),
                                                 {"bound_x_fraction", 5},
                                                 BOUND("y"),
                                                 {"bound_y_fraction", 5},
                                                 BOUND("z"),
                                                 BOUND("k"),
                                                 {"bound_k_fraction", 5},
                                                 {NULL, 0}};

static const module_register slice_generator[] = {{"blend", 2}, VIEW, {"slice_setup_cycles", 16}, {NULL, 0}};

static const char *const texture_unit_parameters[] = {"DENSITY_BITS",  "WEIGHT_BITS",   "GUARD_BITS",
                                                      "FB_BITS",       "MEM_BUS_BYTES", "BEAT_BYTES",
                                                      "TEXTURE_BYTES", "FRAGMENT_ROOM", NULL};
static const module_register texture_unit[] = {
    {"filter", 1},    {"traversal", 2}, {"texture_latency_cycles", 8}, {"double_buffer", 1},     {"shift", 5},
    AXES("base", 64), AXES("dim", 16),  {"texture_base", 48},          {"brick_room_bytes", 48}, {NULL, 0}};

static const char *const alpha_blender_parameters[] = {"FB_BITS", "BLEND_CYCLES", "NONBLOCKING", "NONBLOCKING_FIFO",
                                                       NULL};
static const module_register alpha_blender[] = {{"blend", 2}, {NULL, 0}};

static const char *const pixel_cache_parameters[] = {
    "FB_BITS",      "LINE_W",      "LINE_H",           "CACHE_BYTES",        "WAYS",
    "BLEND_CYCLES", "NONBLOCKING", "NONBLOCKING_FIFO", "NONBLOCKING_MISSES", "WRITE_FIFO",
    "FRAME_LINES",  NULL};
static const module_register pixel_cache[] = {
    {"index", 1},         {"replacement", 2}, {"write_policy", 1}, {"clear_on_first_touch", 1}, {"fb_layout", 1},
    {"lines_across", 16}, {NULL, 0}};

static const char *const frame_buffer_parameters[] = {
    "FB_BITS", "LINE_W", "LINE_H", "MEM_BUS_BYTES", "NONBLOCKING", "NONBLOCKING_MISSES", "WRITE_FIFO", NULL};
static const module_register frame_buffer[] = {{"memory", 1},
                                               {"mem_latency_cycles", 16},
                                               {"dram_banks", 7},
                                               {"dram_row_bytes", 17},
                                               {"dram_trcd_cycles", 8},
                                               {"dram_tcas_cycles", 8},
                                               {"dram_trp_cycles", 8},
                                               {"dram_refresh_cycles", 20},
                                               {"dram_trfc_cycles", 16},
                                               {"texture_burst_bytes", 13},
                                               {NULL, 0}};

const rtl_module *rtl_module_of(vodr_block block)
{
    static const rtl_module modules[VODR_BLOCK_COUNT] = {
        {volume_divider_parameters, volume_divider, "empty"},
        {no_parameters, slice_generator, NULL},
        {no_parameters, none, NULL},
        {texture_unit_parameters, texture_unit, "table"},
        {alpha_blender_parameters, alpha_blender, NULL},
        {pixel_cache_parameters, pixel_cache, NULL},
        {frame_buffer_parameters, frame_buffer, NULL},
    };
    return &modules[block];
}

int32_t rtl_table_bits(vodr_block block, const vodr_machine *machine)
{
    return block == VODR_BLOCK_TEXTURE_UNIT ? 8 * pixel_bytes(machine) + 1 : 1;
}
