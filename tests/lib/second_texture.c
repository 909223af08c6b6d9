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
    if (machine->filter == VODR_FILTER_BSPLINE) {
        return ((const int16_t *)volume->voxels)[at]; /* a coefficient */
    }
    return clamp(((const uint16_t *)volume->voxels)[at], 0, (1 << machine->density_bits) - 1);
}

static int64_t lerp(int64_t a, int64_t b, int64_t w, int weight_bits)
{
    return a + (((b - a) * w) >> weight_bits);
}

/* a/b, rounded down; b is positive. */
static int64_t divide(int64_t a, int64_t b)
{
    return a / b - (a % b < 0);
}

/* The weights of voxels i-1 to i+2 for a share of u/B. */
static void cubic_weights(const vodr_machine *machine, int64_t u, int64_t w[4])
{
    int64_t B = (int64_t)1 << machine->weight_bits, v = B - u;
    if (machine->filter == VODR_FILTER_CARDINAL) {
        w[0] = -divide(2 * u * v * v, B * B);
        w[2] = divide(4 * u * (B * B + 4 * u * B - 3 * u * u) + B * B, 2 * B * B);
        w[3] = -divide(2 * u * u * v, B * B);
    } else {
        w[0] = divide(2 * v * v * v, 3 * B * B);
        w[2] = divide(4 * (B * B * B + 3 * u * B * B + 3 * u * u * B - 3 * u * u * u) + 3 * B * B, 6 * B * B);
        w[3] = divide(2 * u * u * u, 3 * B * B);
    }
    w[1] = 4 * B - w[0] - w[2] - w[3];
}

/* The density of a sum that has its guard bits, and with bspline the fraction of a coefficient. */
static int64_t rounded(const vodr_machine *machine, int64_t sum)
{
    int64_t fraction = machine->filter == VODR_FILTER_BSPLINE && machine->density_bits == 8 ? 8 : 1;
    int64_t unit = fraction * (1 << machine->guard_bits);
    return clamp(divide(sum + unit / 2, unit), 0, (1 << machine->density_bits) - 1);
}

static int64_t cubic(const vodr_machine *machine, const vodr_volume *volume, const int64_t position[3])
{
    int64_t B = (int64_t)1 << machine->weight_bits, i[3], w[3][4], along_z = 0;
    for (int c = 0; c < 3; c++) {
        int64_t q = position[c] - (1 << 23);
        i[c] = divide(q, 1 << 24);
        cubic_weights(machine, divide((q - i[c] * (1 << 24)) * B, 1 << 24), w[c]);
    }
    for (int z = 0; z < 4; z++) {
        int64_t along_y = 0;
        for (int y = 0; y < 4; y++) {
            int64_t along_x = 0;
            for (int x = 0; x < 4; x++) {
                along_x += w[0][x] * second_density(machine, volume, i[0] - 1 + x, i[1] - 1 + y, i[2] - 1 + z) *
                           (1 << machine->guard_bits);
            }
            along_y += w[1][y] * divide(along_x, 4 * B);
        }
        along_z += w[2][z] * divide(along_y, 4 * B);
    }
    return rounded(machine, divide(along_z, 4 * B));
}

void second_filter_bounds(const vodr_machine *machine, int64_t *min, int64_t *max)
{
    if (machine->filter == VODR_FILTER_NEAREST || machine->filter == VODR_FILTER_LINEAR) {
        return;
    }
    int64_t lo = *min * (1 << machine->guard_bits), hi = *max * (1 << machine->guard_bits);
    for (int c = 0; c < 3 && machine->filter == VODR_FILTER_CARDINAL; c++) {
        int64_t d = hi - lo;
        lo -= divide(d + 7, 8);
        hi += divide(d, 8);
    }
    *min = rounded(machine, lo);
    *max = rounded(machine, hi);
}

uint32_t second_filter(const vodr_machine *machine, const vodr_volume *volume, const int64_t position[3])
{
    if (machine->filter == VODR_FILTER_NEAREST) {
        return (uint32_t)second_density(machine, volume, position[0] >> 24, position[1] >> 24, position[2] >> 24);
    }
    if (machine->filter != VODR_FILTER_LINEAR) {
        return (uint32_t)cubic(machine, volume, position);
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
