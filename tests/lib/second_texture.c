/* second_texture.c - docs/architecture.md, sections 6 and 7: densities, filter, classification, blend. */
#include "second_texture.h"

static int64_t clamp(int64_t value, int64_t lo, int64_t hi)
{
    return value < lo ? lo : value > hi ? hi : value;
}

int64_t second_density(const vodr_machine *machine, const vodr_volume *volume, int64_t x, int64_t y, int64_t z)
{
    x = clamp(x, 0, volume->dims_vox[0] - 1);
    y = clamp(y, 0, volume->dims_vox[1] - 1);
    z = clamp(z, 0, volume->dims_vox[2] - 1);
    int64_t at = (z * volume->dims_vox[1] + y) * volume->dims_vox[0] + x;
    if (volume->voxel_bytes == 1) {
        uint8_t voxel = ((const uint8_t *)volume->voxels)[at];
        return volume->map ? volume->map[voxel] : voxel;
    }
    return clamp(((const uint16_t *)volume->voxels)[at], 0, (1 << machine->density_bits) - 1);
}

static int64_t lerp(int64_t a, int64_t b, int64_t w, int weight_bits)
{
    return a + (((b - a) * w) >> weight_bits);
}

uint32_t second_filter(const vodr_machine *machine, const vodr_volume *volume, const int64_t position[3])
{
    if (machine->filter == VODR_FILTER_NEAREST) {
        return (uint32_t)second_density(machine, volume, position[0] >> 24, position[1] >> 24, position[2] >> 24);
    }
    int bits = machine->weight_bits;
    int64_t i[3], w[3];
    for (int c = 0; c < 3; c++) {
        int64_t q = position[c] - (1 << 23);
        i[c] = q >> 24;
        w[c] = (q >> (24 - bits)) & ((1 << bits) - 1);
    }
    int64_t along_y[2];
    for (int z = 0; z < 2; z++) {
        int64_t along_x[2];
        for (int y = 0; y < 2; y++) {
            int64_t a = second_density(machine, volume, i[0], i[1] + y, i[2] + z) * (1 << machine->guard_bits);
            int64_t b = second_density(machine, volume, i[0] + 1, i[1] + y, i[2] + z) * (1 << machine->guard_bits);
            along_x[y] = lerp(a, b, w[0], bits);
        }
        along_y[z] = lerp(along_x[0], along_x[1], w[1], bits);
    }
    int64_t v = lerp(along_y[0], along_y[1], w[2], bits);
    return (uint32_t)((v + (1 << machine->guard_bits) / 2) >> machine->guard_bits);
}

uint32_t second_convert(const vodr_machine *machine, uint32_t value)
{
    if (machine->tf_bits == machine->fb_bits) {
        return value;
    }
    return machine->tf_bits == 8 ? value * 257 : (value + 128) / 257;
}

bool second_transparent(const vodr_machine *machine, const vodr_rgba *converted, uint32_t lo, uint32_t hi)
{
    for (uint32_t i = machine->blend == VODR_BLEND_MIP ? 0 : lo; i <= hi; i++) {
        if (converted[i].r != 0 || converted[i].g != 0 || converted[i].b != 0 || converted[i].a != 0) {
            return false;
        }
    }
    return true;
}

static uint32_t scale(uint32_t u, uint32_t v, int fb_bits)
{
    uint64_t t = (uint64_t)u * v + (1u << (fb_bits - 1));
    return (uint32_t)((t + (t >> fb_bits)) >> fb_bits);
}

bool second_blend(const vodr_machine *machine, const vodr_rgba *converted, uint32_t density, second_pixel *pixel,
                  bool *terminated)
{
    uint32_t full = (1u << machine->fb_bits) - 1;
    const vodr_rgba *entry = &converted[density];
    const uint32_t source[4] = {entry->r, entry->g, entry->b, entry->a};
    uint32_t pixel_alpha = pixel->channel[3];
    *terminated = machine->blend == VODR_BLEND_UNDER && pixel_alpha == full;
    if (*terminated) {
        return false;
    }
    if (machine->blend == VODR_BLEND_MIP) {
        bool write = !pixel->written || density > pixel->density;
        pixel->density = write ? density : pixel->density;
        pixel->written = true;
        return write;
    }
    for (int c = 0; c < 4; c++) {
        if (machine->blend == VODR_BLEND_OVER) {
            pixel->channel[c] = source[c] + scale(pixel->channel[c], full - source[3], machine->fb_bits);
        } else {
            pixel->channel[c] += scale(source[c], full - pixel_alpha, machine->fb_bits);
        }
    }
    return true;
}
