#include "signals.h"

#include <stddef.h>
#include <string.h>

#include "layout.h"

#define PART(record, verilog, field, width, up, length)                                                                \
    {                                                                                                                  \
        verilog, width, (int16_t)offsetof(record, field), (int16_t)sizeof(((record *)0)->field), up, length            \
    }
#define FIELD(record, verilog, field, width, up) PART(record, verilog, field, width, up, SIGNAL_WHOLE)
#define ALWAYS(record, verilog, field, width) FIELD(record, verilog, field, width, SIGNAL_ALWAYS)
#define VALID(record, verilog, field, width) FIELD(record, verilog, field, width, (int16_t)offsetof(record, valid))
#define AXES(record, verilog, field, width)                                                                            \
    VALID(record, verilog "_x", field[0], width), VALID(record, verilog "_y", field[1], width),                        \
        VALID(record, verilog "_z", field[2], width)
#define RECTANGLE(record, verilog, field)                                                                              \
    VALID(record, verilog "_x0", field.x0, 15), VALID(record, verilog "_y0", field.y0, 15),                            \
        VALID(record, verilog "_x1", field.x1, 15), VALID(record, verilog "_y1", field.y1, 15)

/* Fields that some block does not have stand at either end. */

enum { BRICK_BOX = 2, BRICK_SEEN = 8, COLOUR_CACHED = 1, COLOUR_BLENDED = 3, DOOR_TEXTURE = 2, SLICE_DRAWN = 1 };

static const signal_field brick[] = {
    ALWAYS(brick_port, "brick_fresh", fresh, 1), VALID(brick_port, "brick_number", brick, 48),
    AXES(brick_port, "brick_lo", box.lo, 16),    AXES(brick_port, "brick_hi", box.hi, 16),
    ALWAYS(brick_port, "brick_valid", valid, 1), RECTANGLE(brick_port, "brick", bound),
    VALID(brick_port, "brick_k0", k0, 15),       VALID(brick_port, "brick_k1", k1, 15),
};
static const signal_field brick_ready[] = {ALWAYS(ready_port, "brick_ready", ready, 1)};
static const signal_field slice[] = {
    VALID(slice_port, "slice_k", slice.k, 15),
    ALWAYS(slice_port, "slice_valid", valid, 1),
    VALID(slice_port, "slice_last", last, 1),
    AXES(slice_port, "slice_origin", slice.plane.origin, 64),
    AXES(slice_port, "slice_step_u", slice.plane.step_u, 64),
    AXES(slice_port, "slice_step_v", slice.plane.step_v, 64),
    AXES(slice_port, "slice_lo", slice.lo, 64),
    AXES(slice_port, "slice_hi", slice.hi, 64),
    RECTANGLE(slice_port, "slice", bound),
};
static const signal_field slice_ready[] = {ALWAYS(ready_port, "slice_ready", ready, 1)};
static const signal_field fragment[] = {
    ALWAYS(fragment_port, "fragment_valid", valid, 1), ALWAYS(fragment_port, "fragment_visit_done", visit_done, 1),
    VALID(fragment_port, "fragment_x", x, 15),         VALID(fragment_port, "fragment_y", y, 15),
    AXES(fragment_port, "fragment_a", a, 64),
};
static const signal_field accept[] = {ALWAYS(accept_port, "fragment_ready", ready, 1),
                                      ALWAYS(accept_port, "fragment_loading", loading, 1)};
static const signal_field load[] = {ALWAYS(load_port, "load_valid", valid, 1),
                                    VALID(load_port, "load_address", address, 48),
                                    VALID(load_port, "load_bytes", bytes, 32)};
static const signal_field loaded[] = {
    ALWAYS(loaded_port, "load_ready", ready, 1),
    ALWAYS(loaded_port, "load_granted", granted, 1),
    ALWAYS(loaded_port, "load_data_valid", data_valid, 1),
    FIELD(loaded_port, "load_data_bytes", bytes, 9, (int16_t)offsetof(loaded_port, data_valid)),
    PART(loaded_port, "load_data", data, WIDTH_BEAT, (int16_t)offsetof(loaded_port, data_valid),
         (int16_t)offsetof(loaded_port, bytes)),
};
static const signal_field fetch[] = {ALWAYS(fetch_port, "fetch_valid", valid, 1), AXES(fetch_port, "fetch_lo", lo, 16),
                                     AXES(fetch_port, "fetch_hi", hi, 16)};
static const signal_field voxels[] = {ALWAYS(voxels_port, "voxels_valid", valid, 1),
                                      VALID(voxels_port, "voxels_density", density, 128)};
static const signal_field colour[] = {
    VALID(colour_port, "colour_rgba", colour, WIDTH_PIXEL),
    ALWAYS(colour_port, "colour_valid", valid, 1),
    VALID(colour_port, "colour_dead", dead, 1),
    VALID(colour_port, "colour_x", x, 15),
    VALID(colour_port, "colour_y", y, 15),
};
static const signal_field door[] = {ALWAYS(door_port, "colour_ready", ready, 1),
                                    ALWAYS(door_port, "colour_gone", gone, 1),
                                    ALWAYS(door_port, "colour_hazard", hazard, 1)};
static const signal_field blended[] = {
    ALWAYS(blended_port, "blended_known", known, 1),
    FIELD(blended_port, "blended_known_writes", known_writes, 1, (int16_t)offsetof(blended_port, known)),
    ALWAYS(blended_port, "blended_valid", valid, 1),
    VALID(blended_port, "blended_writes", writes, 1),
    VALID(blended_port, "blended_rgba", pixel, WIDTH_PIXEL),
};
static const signal_field pixel[] = {ALWAYS(pixel_port, "pixel_valid", valid, 1),
                                     VALID(pixel_port, "pixel_rgba", pixel, WIDTH_PIXEL)};
static const signal_field fill[] = {ALWAYS(fill_port, "fill_valid", valid, 1),
                                    VALID(fill_port, "fill_address", address, 48)};
static const signal_field filled[] = {ALWAYS(filled_port, "filled_valid", valid, 1),
                                      VALID(filled_port, "filled_data", data, WIDTH_LINE)};
static const signal_field writes[] = {ALWAYS(write_port, "write_valid", valid, 1),
                                      VALID(write_port, "write_address", address, 48),
                                      VALID(write_port, "write_bytes", bytes, 14),
                                      PART(write_port, "write_data", data, WIDTH_LINE,
                                           (int16_t)offsetof(write_port, valid), (int16_t)offsetof(write_port, bytes))};
static const signal_field written[] = {ALWAYS(granted_port, "written_valid", valid, 1)};
static const signal_field memory[] = {
    ALWAYS(beat_port, "memory_read", read, 1),
    ALWAYS(beat_port, "memory_write", write, 1),
    VALID(beat_port, "memory_address", address, 48),
    FIELD(beat_port, "memory_write_bytes", bytes, 9, (int16_t)offsetof(beat_port, write)),
    PART(beat_port, "memory_write_data", data, WIDTH_BEAT, (int16_t)offsetof(beat_port, write),
         (int16_t)offsetof(beat_port, bytes)),
};
static const signal_field look_up[] = {
    ALWAYS(look_up_port, "look_up_valid", valid, 1), VALID(look_up_port, "look_up_miss", miss, 1),
    VALID(look_up_port, "look_up_replaced", replaced, 1), VALID(look_up_port, "look_up_x", x, 15),
    VALID(look_up_port, "look_up_y", y, 15)};
static const signal_field report[] = {ALWAYS(report_port, "report_status", status, 4),
                                      ALWAYS(report_port, "report_idle", idle, 1)};
static const signal_field before[][1] = {
    {ALWAYS(report_port, "volume_divider_idle", idle, 1)},
    {ALWAYS(report_port, "slice_generator_idle", idle, 1)},
    {ALWAYS(report_port, "rasterizer_idle", idle, 1)},
    {ALWAYS(report_port, "texture_unit_idle", idle, 1)},
};

#define COUNT(array) (int32_t)(sizeof(array) / sizeof *(array))
#define SOME(fields, first, end, is_output, record)                                                                    \
    {                                                                                                                  \
        (fields) + (first), (end) - (first), is_output, (int32_t)(record)                                              \
    }
#define IN(block, fields, member) SOME(fields, 0, COUNT(fields), false, offsetof(block##_in, member))
#define OUT(block, fields, member) SOME(fields, 0, COUNT(fields), true, offsetof(block##_out, member))

static const signal_port volume_divider[] = {
    IN(volume_divider, brick_ready, brick),
    OUT(volume_divider, brick, brick),
    OUT(volume_divider, report, report),
};
static const signal_port slice_generator[] = {
    SOME(brick, BRICK_BOX, COUNT(brick), false, offsetof(slice_generator_in, brick)),
    IN(slice_generator, slice_ready, slice),
    OUT(slice_generator, brick_ready, brick),
    OUT(slice_generator, slice, slice),
    OUT(slice_generator, report, report),
};
static const signal_port rasterizer[] = {
    SOME(slice, SLICE_DRAWN, COUNT(slice), false, offsetof(rasterizer_in, slice)),
    IN(rasterizer, accept, fragment),
    OUT(rasterizer, slice_ready, slice),
    OUT(rasterizer, fragment, fragment),
    OUT(rasterizer, report, report),
};
static const signal_port texture_unit[] = {
    SOME(brick, 0, BRICK_SEEN, false, offsetof(texture_unit_in, brick)),
    IN(texture_unit, fragment, fragment),
    IN(texture_unit, loaded, load),
    IN(texture_unit, voxels, voxels),
    SOME(door, 0, DOOR_TEXTURE, false, offsetof(texture_unit_in, colour)),
    OUT(texture_unit, accept, fragment),
    OUT(texture_unit, load, load),
    OUT(texture_unit, fetch, fetch),
    OUT(texture_unit, colour, colour),
    OUT(texture_unit, report, report),
};
static const signal_port alpha_blender[] = {
    SOME(colour, 0, COLOUR_BLENDED, false, offsetof(alpha_blender_in, colour)),
    IN(alpha_blender, door, door),
    IN(alpha_blender, pixel, pixel),
    OUT(alpha_blender, blended, blended),
    OUT(alpha_blender, report, report),
};
static const signal_port pixel_cache[] = {
    SOME(colour, COLOUR_CACHED, COUNT(colour), false, offsetof(pixel_cache_in, colour)),
    IN(pixel_cache, blended, blended),
    IN(pixel_cache, filled, filled),
    IN(pixel_cache, written, written),
    IN(pixel_cache, before[0], before[0]),
    IN(pixel_cache, before[1], before[1]),
    IN(pixel_cache, before[2], before[2]),
    IN(pixel_cache, before[3], before[3]),
    OUT(pixel_cache, door, door),
    OUT(pixel_cache, look_up, look_up),
    OUT(pixel_cache, pixel, pixel),
    OUT(pixel_cache, fill, fill),
    OUT(pixel_cache, writes, write),
    OUT(pixel_cache, report, report),
};
static const signal_port frame_buffer[] = {
    IN(frame_buffer, fill, fill),      IN(frame_buffer, writes, write),     IN(frame_buffer, load, load),
    OUT(frame_buffer, filled, filled), OUT(frame_buffer, written, written), OUT(frame_buffer, loaded, load),
    OUT(frame_buffer, memory, memory), OUT(frame_buffer, report, report),
};

/* ---- vodr_top ---- */

#define REPORT(block)                                                                                                  \
    {                                                                                                                  \
        ALWAYS(report_port, #block "_status", status, 4), ALWAYS(report_port, #block "_idle", idle, 1)                 \
    }
static const signal_field reports[][2] = {REPORT(volume_divider), REPORT(slice_generator), REPORT(rasterizer),
                                          REPORT(texture_unit),   REPORT(alpha_blender),   REPORT(pixel_cache),
                                          REPORT(frame_buffer)};

/* Fields that vodr_top shows stand together but for these. */
static const signal_field top_slice[] = {ALWAYS(slice_port, "slice_valid", valid, 1),
                                         VALID(slice_port, "slice_k", slice.k, 15)};
static const signal_field top_bounds[] = {RECTANGLE(brick_port, "brick", bound)};
static const signal_field top_load[] = {ALWAYS(load_port, "load_valid", valid, 1),
                                        VALID(load_port, "load_bytes", bytes, 32)};
static const signal_field top_blended[] = {ALWAYS(blended_port, "blended_valid", valid, 1),
                                           VALID(blended_port, "blended_writes", writes, 1)};
static const signal_field top_write[] = {ALWAYS(write_port, "write_valid", valid, 1),
                                         VALID(write_port, "write_bytes", bytes, 14)};

#define SHOWN(fields, first, end, member) SOME(fields, first, end, true, offsetof(block_outs, member))
#define ALL(fields, member) SHOWN(fields, 0, COUNT(fields), member)

enum { BRICK_TOLD = 8, FRAGMENT_TOLD = 4 };

static const signal_port vodr_top[] = {
    {voxels, COUNT(voxels), false, offsetof(texture_unit_in, voxels)},
    SHOWN(brick, 0, BRICK_TOLD, volume_divider.brick),
    ALL(top_bounds, volume_divider.brick),
    ALL(reports[0], volume_divider.report),
    ALL(top_slice, slice_generator.slice),
    ALL(reports[1], slice_generator.report),
    ALL(slice_ready, rasterizer.slice),
    SHOWN(fragment, 0, FRAGMENT_TOLD, rasterizer.fragment),
    ALL(reports[2], rasterizer.report),
    SHOWN(accept, 0, 1, texture_unit.fragment),
    ALL(top_load, texture_unit.load),
    ALL(fetch, texture_unit.fetch),
    ALL(reports[3], texture_unit.report),
    ALL(top_blended, alpha_blender.blended),
    ALL(reports[4], alpha_blender.report),
    SHOWN(door, 1, DOOR_TEXTURE, pixel_cache.door),
    ALL(look_up, pixel_cache.look_up),
    SHOWN(pixel, 0, 1, pixel_cache.pixel),
    SHOWN(fill, 0, 1, pixel_cache.fill),
    ALL(top_write, pixel_cache.write),
    ALL(reports[5], pixel_cache.report),
    SHOWN(loaded, 0, 1, frame_buffer.load),
    ALL(reports[6], frame_buffer.report),
};

int32_t rtl_top_record(vodr_block block)
{
    static const size_t records[VODR_BLOCK_COUNT + 1] = {
        offsetof(block_outs, volume_divider), offsetof(block_outs, slice_generator), offsetof(block_outs, rasterizer),
        offsetof(block_outs, texture_unit),   offsetof(block_outs, alpha_blender),   offsetof(block_outs, pixel_cache),
        offsetof(block_outs, frame_buffer),   offsetof(block_outs, voxel_memory)};
    return (int32_t)records[block];
}

/* ---- all ---- */

const block_signals *signals_of(vodr_block block)
{
    static const block_signals blocks[VODR_BLOCK_COUNT + 1] = {
        {"volume_divider", volume_divider, COUNT(volume_divider)},
        {"slice_generator", slice_generator, COUNT(slice_generator)},
        {"rasterizer", rasterizer, COUNT(rasterizer)},
        {"texture_unit", texture_unit, COUNT(texture_unit)},
        {"alpha_blender", alpha_blender, COUNT(alpha_blender)},
        {"pixel_cache", pixel_cache, COUNT(pixel_cache)},
        {"frame_buffer", frame_buffer, COUNT(frame_buffer)},
        {"vodr_top", vodr_top, COUNT(vodr_top)},
    };
    return &blocks[block];
}

int32_t signal_width(const signal_field *field, const vodr_machine *machine)
{
    switch (field->width_bits) {
    case WIDTH_PIXEL: return 8 * pixel_bytes(machine);
    case WIDTH_LINE: return 8 * line_bytes(machine);
    case WIDTH_BEAT: return 8 * machine->mem_bus_bytes;
    default: return field->width_bits;
    }
}

size_t signal_bytes(const signal_field *field, const vodr_machine *machine, const void *record)
{
    int32_t bytes = (signal_width(field, machine) + 7) / 8, length;
    if (field->length != SIGNAL_WHOLE) {
        memcpy(&length, (const char *)record + field->length, sizeof length);
        bytes = length < bytes ? length : bytes;
    }
    return (size_t)(bytes < field->bytes ? bytes : field->bytes);
}

const void *signal_record(const signal_port *port, const void *in, const void *out)
{
    if (port->output)
        return (const char *)out + port->record;
    return *(const void *const *)((const char *)in + port->record);
}
