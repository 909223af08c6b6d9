/* case_volume.c - random volumes, in integers only: noise, blobs, shells in emptiness, constants. */
#include "case_parts.h"

#include <stdlib.h>

enum { NOISE, BLOBS, SHELLS, CONSTANT, EXTREMES, KINDS };

typedef struct ball {
    int64_t centre[3]; /* in half voxels */
    int64_t radius;    /* in half voxels */
} ball;

static ball random_ball(rng *r, const int32_t dims_vox[3])
{
    ball b;
    int64_t largest = 1;
    for (int c = 0; c < 3; c++) {
        b.centre[c] = rng_int(r, 0, 2 * dims_vox[c]);
        largest = dims_vox[c] > largest ? dims_vox[c] : largest;
    }
    b.radius = rng_int(r, 1, largest + 1);
    return b;
}

static int64_t distance_squared(const ball *b, const int64_t voxel[3])
{
    int64_t sum = 0;
    for (int c = 0; c < 3; c++) {
        int64_t d = 2 * voxel[c] + 1 - b->centre[c];
        sum += d * d;
    }
    return sum;
}

/* The value, 0 to top, of one voxel; a constant's is the same for all. */
static int64_t voxel_value(rng *r, int kind, const ball balls[3], const int64_t voxel[3], int64_t top, int64_t constant)
{
    int64_t value = 0;
    switch (kind) {
    case NOISE: return rng_int(r, 0, top);
    case EXTREMES: return rng_one_in(r, 2) ? 0 : top;
    case CONSTANT: return constant;
    default: break;
    }
    for (int i = 0; i < 3; i++) {
        int64_t radius_squared = balls[i].radius * balls[i].radius;
        int64_t d = distance_squared(&balls[i], voxel);
        if (kind == BLOBS && d < radius_squared) {
            value += top * (radius_squared - d) / radius_squared;
        } else if (kind == SHELLS && d < radius_squared && 3 * d > 2 * radius_squared) {
            value = top * (i + 1) / 3;
        }
    }
    return value < top ? value : top;
}

static void fill_voxels(test_case *c, int64_t top)
{
    rng *r = &c->random;
    const int32_t *dims = c->input.dims_vox;
    int kind = (int)rng_int(r, 0, KINDS - 1);
    int64_t constant = rng_int(r, 0, top);
    ball balls[3];
    for (int i = 0; i < 3; i++) {
        balls[i] = random_ball(r, dims);
    }
    size_t at = 0;
    for (int64_t z = 0; z < dims[2]; z++) {
        for (int64_t y = 0; y < dims[1]; y++) {
            for (int64_t x = 0; x < dims[0]; x++, at++) {
                const int64_t voxel[3] = {x, y, z};
                int64_t value = voxel_value(r, kind, balls, voxel, top, constant);
                if (c->input.voxel_bytes == 1) {
                    ((uint8_t *)c->voxels)[at] = (uint8_t)value;
                } else {
                    ((uint16_t *)c->voxels)[at] = (uint16_t)value;
                }
            }
        }
    }
}

static void choose_map(test_case *c, int32_t density_top)
{
    rng *r = &c->random;
    bool random = rng_one_in(r, 2);
    for (int32_t i = 0; i < 256; i++) {
        c->map[i] = (uint16_t)(random ? rng_int(r, 0, density_top) : density_top * i / 255);
    }
    if (density_top != 255 || rng_one_in(r, 2)) {
        c->input.map = c->map;
    }
}

static void choose_geometry(test_case *c, bool even)
{
    static const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    rng *r = &c->random;
    int64_t largest = rng_one_in(r, 2) ? 48 : rng_one_in(r, 6) ? 4 : 24;
    int64_t smallest = rng_one_in(r, 6) ? 1 : largest / 2;
    bool cube = even || rng_one_in(r, 4);
    int stretched = !cube && rng_one_in(r, 12) ? (int)rng_int(r, 0, 2) : -1;
    bool isotropic = rng_one_in(r, 2);
    bool oriented = rng_one_in(r, 2);
    const int *order = orders[oriented ? rng_int(r, 0, 5) : 0];
    for (int i = 0; i < 3; i++) {
        c->input.dims_vox[i] = cube && i > 0 ? c->input.dims_vox[0] : (int32_t)rng_int(r, smallest, largest);
        if (i == stretched) {
            c->input.dims_vox[i] = (int32_t)rng_int(r, 49, 150);
        }
        c->input.dims_vox[i] += even && c->input.dims_vox[i] % 2 != 0;
        c->geometry.dims_vox[i] = c->input.dims_vox[i];
        c->geometry.spacing[i] = isotropic ? 1.0 : rng_one_in(r, 2) ? 1.5 : rng_real(r, 0.3, 2.0);
        c->geometry.axis[i] = order[i];
        c->geometry.sign[i] = oriented && rng_one_in(r, 2) ? -1 : 1;
    }
}

bool case_make_volume(test_case *c, bool even)
{
    rng *r = &c->random;
    choose_geometry(c, even);
    int32_t density_top = (1 << c->machine.density_bits) - 1;
    c->input.voxel_bytes = rng_one_in(r, 2) ? 1 : 2;
    int64_t top = density_top;
    if (c->input.voxel_bytes == 1) {
        top = 255;
        choose_map(c, density_top);
    } else if (rng_one_in(r, 4)) {
        top = rng_one_in(r, 2) ? 65535 : density_top + 40; /* voxels out of range: the machine clamps them */
    }
    const int32_t *dims = c->input.dims_vox;
    c->voxels = calloc((size_t)dims[0] * (size_t)dims[1] * (size_t)dims[2], (size_t)c->input.voxel_bytes);
    if (!c->voxels) {
        return false;
    }
    fill_voxels(c, top);
    c->input.voxels = c->voxels;
    return true;
}
