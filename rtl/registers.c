#include "registers.h"

#include <ctype.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "layout.h"
#include "pixel_word.h"
#include "texture_unit.h"
#include "volume_divider.h"

struct rtl_registers {
    vodr_machine machine;
    vodr_view view;
    projection bounds;
    int32_t dims_vox[3], edge_vox[3], bricks[3], nest[3], eye[3];
    int32_t tile_px, lines_across;
    int64_t texture_base, brick_room_bytes, frame_lines;
};

/* ---- registers ---- */

/* A derived one. */
typedef struct field {
    const char *name;
    size_t offset, bytes; /* 4, 8: signed */
} field;

#define HERE(name, member)                                                                                             \
    {                                                                                                                  \
        name, offsetof(rtl_registers, member), sizeof(((rtl_registers *)0)->member)                                    \
    }
#define AXES(name, member) HERE(name "_x", member[0]), HERE(name "_y", member[1]), HERE(name "_z", member[2])
#define BOUND(name, row)                                                                                               \
    AXES("bound_" name "_m", bounds.row.m), HERE("bound_" name "_lo", bounds.row.lo),                                  \
        HERE("bound_" name "_hi", bounds.row.hi), HERE("bound_" name "_fraction", bounds.row.fraction)

static const field fields[] = {
    /* derived: the divider's */
    AXES("edge", edge_vox),
    AXES("bricks", bricks),
    HERE("nest_0", nest[0]),
    HERE("nest_1", nest[1]),
    HERE("nest_2", nest[2]),
    AXES("eye", eye),
    HERE("tile_px", tile_px),
    HERE("centre_x", bounds.centre_px[0]),
    HERE("centre_y", bounds.centre_px[1]),
    BOUND("x", x),
    BOUND("y", y),
    BOUND("z", z),
    BOUND("k", k),
    /* derived: where things lie in memory */
    HERE("texture_base", texture_base),
    HERE("brick_room_bytes", brick_room_bytes),
    HERE("lines_across", lines_across),
};

rtl_registers *rtl_registers_of(const block_setup *setup)
{
    const fb_layout layout = fb_layout_of(setup->machine, setup->view->width_px, setup->view->height_px);
    const volume_divider *walk = setup->walk;
    rtl_registers *r = malloc(sizeof *r);
    if (!r)
        return NULL;
    *r = (rtl_registers){.machine = *setup->machine,
                         .view = *setup->view,
                         .bounds = walk->projection,
                         .tile_px = walk->tile_px,
                         .lines_across = layout.tiled ? layout.tiles : layout.columns,
                         .texture_base = layout.lines * line_bytes(setup->machine),
                         .brick_room_bytes = brick_room_bytes(setup->machine, setup->edge_vox),
                         .frame_lines = layout.lines};
    for (int c = 0; c < 3; c++) {
        r->dims_vox[c] = setup->volume->dims_vox[c];
        r->edge_vox[c] = setup->edge_vox[c];
        r->bricks[c] = walk->bricks[c];
        r->nest[c] = walk->nest[c];
        r->eye[c] = volume_divider_eye(walk, c);
    }
    return r;
}

const vodr_machine *rtl_machine(const rtl_registers *r)
{
    return &r->machine;
}

static bool machine_parameter(const vodr_machine *m, const char *name, int32_t *value)
{
    size_t count;
    const vodr_parameter *p = vodr_parameters(&count);
    for (size_t i = 0; i < count; i++)
        if (p[i].kind != VODR_KIND_SHAPE && strcmp(p[i].name, name) == 0) {
            memcpy(value, (const char *)m + p[i].offset, sizeof *value);
            return true;
        }
    return false;
}

bool rtl_register(const rtl_registers *r, const char *name, uint64_t *value)
{
    int64_t wide;
    int32_t narrow;
    if (vodr_register_get(name, &r->view, r->dims_vox, &wide)) {
        *value = (uint64_t)wide;
        return true;
    }
    for (size_t i = 0; i < sizeof fields / sizeof *fields; i++) {
        const char *at = (const char *)r + fields[i].offset;
        if (strcmp(fields[i].name, name) != 0)
            continue;
        memcpy(fields[i].bytes == 8 ? (void *)value : (void *)&narrow, at, fields[i].bytes);
        if (fields[i].bytes == 4)
            *value = (uint64_t)(int64_t)narrow;
        return true;
    }
    if (!machine_parameter(&r->machine, name, &narrow))
        return false;
    *value = (uint64_t)(int64_t)narrow;
    return true;
}

/* ---- parameters ---- */

static int64_t power_of_two(int64_t least)
{
    int64_t power = 1;
    while (power < least)
        power *= 2;
    return power;
}

/* Of one buffer, whole words. */
static int64_t texture_bytes(const vodr_machine *m)
{
    int64_t bytes = m->traversal == VODR_TRAVERSAL_WHOLE ? 0 : m->texture_memory_bytes / (m->double_buffer ? 2 : 1);
    return power_of_two(bytes > m->mem_bus_bytes ? bytes : m->mem_bus_bytes);
}

/* Memories whose size a frame decides come in few sizes, so that few libraries are needed. */
enum { LEAST_BITS = 4096 };

static int64_t memory_bits(int64_t wanted)
{
    return power_of_two(wanted > LEAST_BITS ? wanted : LEAST_BITS);
}

/* A parameter of a frame of so many bricks and lines. */
static bool parameter(const vodr_machine *m, int64_t bricks, int64_t frame_lines, const char *name, int64_t *value)
{
    int64_t beat = m->mem_bus_bytes < m->texture_burst_bytes ? m->mem_bus_bytes : m->texture_burst_bytes;
    const struct {
        const char *name;
        int64_t value;
    } derived[] = {
        {"LINE_W", m->line_px.width},
        {"LINE_H", m->line_px.height},
        {"LINE_BYTES", line_bytes(m)},
        {"BEAT_BYTES", beat},
        {"TEXTURE_BYTES", texture_bytes(m)},
        {"FRAGMENT_ROOM", m->fragment_fifo + (m->traversal == VODR_TRAVERSAL_WHOLE ? m->mem_latency_cycles : 0)},
        {"EMPTY_BRICKS", m->skip_empty ? memory_bits(bricks) : 1},
        {"FRAME_LINES", m->clear_on_first_touch ? memory_bits(frame_lines) : 1},
    };
    for (size_t i = 0; i < sizeof derived / sizeof *derived; i++)
        if (strcmp(derived[i].name, name) == 0) {
            *value = derived[i].value;
            return true;
        }
    char lower[64];
    size_t length = 0;
    for (; name[length] && length + 1 < sizeof lower; length++)
        lower[length] = (char)tolower((unsigned char)name[length]);
    lower[length] = '\0';
    int32_t narrow;
    if (!machine_parameter(m, lower, &narrow))
        return false;
    *value = narrow;
    return true;
}

bool rtl_parameter(const rtl_registers *r, const char *name, int64_t *value)
{
    const int64_t bricks = (int64_t)r->bricks[0] * r->bricks[1] * r->bricks[2];
    return parameter(&r->machine, bricks, r->frame_lines, name, value);
}

bool rtl_machine_parameter(const vodr_machine *machine, const char *name, int64_t *value)
{
    return parameter(machine, 0, 0, name, value);
}

/* ---- tables ---- */

int64_t rtl_table_entries(vodr_block block, const block_setup *setup)
{
    const int32_t *bricks = setup->walk->bricks;
    if (block == VODR_BLOCK_TEXTURE_UNIT)
        return (int64_t)1 << setup->machine->density_bits;
    return setup->walk->empty ? (int64_t)bricks[0] * bricks[1] * bricks[2] : 0;
}

void rtl_table_entry(vodr_block block, const block_setup *setup, int64_t i, uint8_t entry[RTL_TABLE_BYTES])
{
    const vodr_machine *m = setup->machine;
    memset(entry, 0, RTL_TABLE_BYTES);
    if (block == VODR_BLOCK_VOLUME_DIVIDER) {
        entry[0] = setup->walk->empty[i];
        return;
    }
    word_store(entry, pixel_word(m, setup->tables->colours[i]), pixel_bytes(m));
    entry[pixel_bytes(m)] = setup->tables->dead[i];
}
