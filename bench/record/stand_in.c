/* stand_in.c - a volume enlarged to the size of one that a paper measured, and views of it. */
#include "stand_in.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "camera.h"
#include "enlarge.h"

static const struct {
    const char *name;
    double azimuth_deg, elevation_deg;
} views[STAND_IN_VIEWS] = {{"0,0", 0, 0}, {"90,0", 90, 0}, {"0,90", 0, 90}, {"30,30", 30, 30}, {"-60,15", -60, 15}};

bool stand_in_size(const char *text, int32_t size[3])
{
    return sscanf(text, "%dx%dx%d", &size[0], &size[1], &size[2]) == 3 && size[0] > 0 && size[1] > 0 && size[2] > 0;
}

uint16_t *stand_in_read(const stand_in *s)
{
    const size_t count = (size_t)s->from[0] * (size_t)s->from[1] * (size_t)s->from[2];
    const size_t bytes = strcmp(s->type, "uint8") == 0 ? 1 : 2;
    unsigned char *stored = malloc((count + 1) * bytes);
    float *values = malloc(count * sizeof *values), lo = INFINITY, hi = -INFINITY;
    uint16_t *voxels = malloc((size_t)s->to[0] * (size_t)s->to[1] * (size_t)s->to[2] * sizeof *voxels);
    FILE *file = fopen(s->path, "rb");
    bool good = stored && values && voxels && file && fread(stored, bytes, count + 1, file) == count;
    if (file)
        fclose(file);
    for (size_t i = 0; good && i < count; i++) {
        values[i] = bytes == 1 ? stored[i] : (int16_t)(stored[2 * i] | stored[2 * i + 1] << 8);
        lo = fminf(lo, values[i]);
        hi = fmaxf(hi, values[i]);
    }
    good = good && hi > lo && enlarge(values, s->from, s->to, lo, hi, voxels);
    free(stored);
    free(values);
    if (good)
        return voxels;
    fprintf(stderr, "%s: must be a file of %zu voxels of %s, not all the same\n", s->path, count, s->type);
    free(voxels);
    return NULL;
}

static bool rays_from(const stand_in *s, double azimuth_deg, double elevation_deg, reference_camera *rays)
{
    static const double spacing[3] = {1, 1, 1};
    volume geometry = {.spacing = {1, 1, 1}, .axis = {0, 1, 2}, .sign = {1, 1, 1}};
    camera c = camera_default();
    host_error reason;
    vodr_view registers;
    double depth;
    memcpy(geometry.dims_vox, s->to, sizeof geometry.dims_vox);
    c.azimuth_deg = azimuth_deg;
    c.elevation_deg = elevation_deg;
    c.width_px = c.height_px = s->side_px;
    c.slices = s->to[2];
    c.zoom = (double)s->side_px / (s->to[0] > s->to[1] ? s->to[0] : s->to[1]);
    if (camera_view(&c, &geometry, &registers, &depth, &reason) != HOST_OK) {
        fprintf(stderr, "%s\n", reason.text);
        return false;
    }
    *rays = reference_camera_rays(&registers, spacing, 1);
    return true;
}

bool stand_in_rays(const stand_in *s, int view, reference_camera *rays)
{
    return rays_from(s, views[view].azimuth_deg, views[view].elevation_deg, rays);
}

bool stand_in_orbit(const stand_in *s, int frame, int frames, reference_camera *rays)
{
    const double turn = (double)frame / frames;
    return rays_from(s, 360 * turn - 180, 75 * sin(6 * acos(-1) * turn), rays);
}

const char *stand_in_view(int view)
{
    return views[view].name;
}
