#include "unit.h"

#include <string.h>

volume unit_volume(int32_t x_vox, int32_t y_vox, int32_t z_vox)
{
    return (volume){.dims_vox = {x_vox, y_vox, z_vox}, .spacing = {1, 1, 1}, .axis = {0, 1, 2}, .sign = {1, 1, 1}};
}

vodr_view unit_camera_view(rng *c, const volume *v, bool perspective)
{
    vodr_view view;
    double depth;
    host_error error;
    camera cam = {.perspective = perspective,
                  .azimuth_deg = (double)rng_int(c, -180, 180),
                  .elevation_deg = (double)rng_int(c, -90, 90),
                  .roll_deg = rng_one_in(c, 2) ? 0 : (double)rng_int(c, 0, 359),
                  .fov_deg = (double)rng_int(c, 5, 140),
                  .zoom = (double)rng_int(c, 5, 40) / 16,
                  .width_px = (int32_t)rng_int(c, 1, 48),
                  .height_px = (int32_t)rng_int(c, 1, 48),
                  .slices = (int32_t)rng_int(c, 1, 48)};
    if (rng_one_in(c, 4)) { /* faces, edges and corners */
        cam.azimuth_deg = (double)rng_int(c, -4, 4) * 45;
        cam.elevation_deg = (double)rng_int(c, -2, 2) * 45;
        cam.roll_deg = 0;
    }
    if (camera_view(&cam, v, &view, &depth, &error) != HOST_OK)
        fail_msg("%s", error.text);
    return view;
}

static wide_int floor_shift(wide_int a, int bits)
{
    wide_int unit = (wide_int)1 << bits, q = a / unit;
    return a % unit < 0 ? q - 1 : q;
}

void unit_position(const vodr_view *v, int32_t x, int32_t y, int32_t k, int64_t position[3])
{
    wide_int z = floor_shift(v->depth_first + (wide_int)k * v->depth_step, 16);
    for (int c = 0; c < 3; c++) {
        wide_int across = (wide_int)x * v->step_u[c] + (wide_int)y * v->step_v[c];
        wide_int a = v->perspective ? z * (v->step_s[c] + across) : (wide_int)k * v->step_s[c] + across;
        position[c] = (int64_t)(v->base[c] + floor_shift(a, v->shift));
    }
}

bool unit_inside(const int64_t position[3], const int32_t lo[3], const int32_t hi[3])
{
    for (int c = 0; c < 3; c++)
        if (position[c] < (int64_t)lo[c] * (1 << 24) || position[c] >= (int64_t)hi[c] * (1 << 24))
            return false;
    return true;
}

vodr_machine unit_machine(const char *settings)
{
    vodr_machine m = vodr_machine_default();
    char copy[512], *rest = copy;
    vodr_error error;
    assert_true(strlen(settings) < sizeof copy);
    strcpy(copy, settings);
    for (char *name = strtok_r(copy, " ", &rest); name; name = strtok_r(NULL, " ", &rest)) {
        char *equals = strchr(name, '=');
        assert_non_null(equals);
        *equals = '\0';
        if (vodr_machine_set(&m, name, equals + 1, &error) != VODR_OK)
            fail_msg("%s", error.text);
    }
    return m;
}
