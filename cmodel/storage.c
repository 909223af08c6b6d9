#include "storage.h"

#include <stdlib.h>
#include <string.h>

#include "pixel_word.h"
#include "voxels.h"

bool storage_start(storage *s, const vodr_machine *machine, const vodr_view *view, const vodr_volume *volume,
                   const int32_t edge_vox[3])
{
    *s = (storage){.machine = machine, .volume = volume};
    for (int c = 0; c < 3; c++)
        s->edge_vox[c] = edge_vox[c];
    s->texture_base = fb_layout_of(machine, view->width_px, view->height_px).lines * line_bytes(machine);
    s->brick_room_bytes = brick_room_bytes(machine, edge_vox);
    s->lines = calloc((size_t)s->texture_base, 1);
    return s->lines != NULL;
}

/* The voxels that lie in memory for a brick. */
static vox_box region_of(const storage *s, int64_t brick)
{
    const vox_box drawn = voxels_drawn(s->volume);
    vox_box box;
    for (int c = 0; c < 3; c++) {
        const int32_t edge = s->edge_vox[c], count = ceil_div32(drawn.hi[c] - drawn.lo[c], edge);
        box.lo[c] = drawn.lo[c] + (int32_t)(brick % count) * edge;
        box.hi[c] = edge < drawn.hi[c] - box.lo[c] ? box.lo[c] + edge : drawn.hi[c];
        brick /= count;
    }
    return voxels_reach(s->volume->dims_vox, &box, filter_border_vox(s->machine));
}

static void read_brick(const storage *s, int64_t brick, int64_t bytes, uint8_t *data)
{
    const vox_box region = region_of(s, brick);
    int32_t size = density_bytes(s->machine);
    for (int32_t z = region.lo[2]; z < region.hi[2]; z++)
        for (int32_t y = region.lo[1]; y < region.hi[1]; y++)
            for (int32_t x = region.lo[0]; x < region.hi[0] && bytes > 0; x++, data += size, bytes -= size) {
                uint16_t density;
                voxels_row(s->volume, stored_bits(s->machine), voxel_index(s->volume->dims_vox, x, y, z), 1, &density);
                word_store(data, density, size);
            }
}

void storage_read(const storage *s, int64_t address, int64_t bytes, uint8_t *data)
{
    if (address < s->texture_base)
        memcpy(data, s->lines + address, (size_t)bytes);
    else
        read_brick(s, (address - s->texture_base) / s->brick_room_bytes, bytes, data);
}

void storage_write(storage *s, int64_t address, int64_t bytes, const uint8_t *data)
{
    memcpy(s->lines + address, data, (size_t)bytes);
}

void storage_finish(storage *s)
{
    free(s->lines);
    *s = (storage){0};
}
