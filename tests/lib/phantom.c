/* phantom.c - made-up CT volumes: smooth tissues with sharp borders, as pictures are judged on. */
#include "phantom.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* From 0 to 1 as x goes from -width to width, smoothly. */
static double rise(double x, double width)
{
    double t = fmin(fmax((x + width) / (2 * width), 0), 1);
    return t * t * (3 - 2 * t);
}

/* Hounsfield units of an egg-shaped head: air, skin, skull, brain; x, y, z from -1 to 1. */
static double head(double x, double y, double z)
{
    double depth =
        (1 - sqrt(x * x / 0.64 + y * y / 0.81 + z * z / 0.72)) * 0.8 * PHANTOM_VOX / 2; /* voxels under the skin */
    double bone = rise(depth - 4, 1.2) * (1 - rise(depth - 8, 1.2));
    return -1000 + 1040 * rise(depth, 1.2) + 1160 * bone;
}

/* A tube wound round the y axis and a straight one beside it, filled with contrast agent, in soft tissue. */
static double vessels(double x, double y, double z)
{
    double turn = 6 * y, dx = x - 0.55 * cos(turn), dz = z - 0.55 * sin(turn);
    double helix = 0.09 - sqrt(dx * dx + dz * dz) / 1.6, straight = 0.12 - sqrt(x * x + z * z);
    double inside = fmax(rise(helix * PHANTOM_VOX / 2, 1.5), rise(straight * PHANTOM_VOX / 2, 1.5));
    return 30 + 420 * inside;
}

bool phantom_open(const char *name, volume *v)
{
    enum { N = PHANTOM_VOX };
    double (*const hounsfield)(double, double, double) = strcmp(name, "head") == 0 ? head : vessels;
    int16_t *voxel = malloc(sizeof *voxel * N * N * N);
    *v = (volume){.dims_vox = {N, N, N}, .spacing = {1, 1, 1}, .axis = {0, 1, 2}, .sign = {1, 1, 1}};
    if (!voxel)
        return false;
    v->voxels = voxel;
    v->bytes = sizeof *voxel * N * N * N;
    v->type = VOLUME_INT16;
    v->slope = 1;
    for (int z = 0; z < N; z++)
        for (int y = 0; y < N; y++)
            for (int x = 0; x < N; x++)
                *voxel++ =
                    (int16_t)lround(hounsfield((2 * x + 1.0) / N - 1, (2 * y + 1.0) / N - 1, (2 * z + 1.0) / N - 1));
    v->min = -1000; /* a CT */
    v->max = 1400;
    return true;
}
