/* unit.h - what the unit tests share: cmocka, views to test with, and exact positions. */
#ifndef TESTS_UNIT_H
#define TESTS_UNIT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "camera.h"
#include "rng.h"
#include "views.h"
#include "vodr.h"

__extension__ typedef __int128 wide_int;

/* What camera_view() reads of a volume: unit spacing, file axes as they are. */
volume unit_volume(int32_t x_vox, int32_t y_vox, int32_t z_vox);

/* A view of the volume through the camera: random angles, size and zoom; the volume fills a good part of it. */
vodr_view unit_camera_view(rng *c, const volume *v, bool perspective);

/* Where pixel (x, y) of slice k samples, by docs/architecture.md, section 2, in integers that cannot overflow. */
void unit_position(const vodr_view *v, int32_t x, int32_t y, int32_t k, int64_t position[3]);

/* Whether a position lies in the half-open box [lo, hi) of voxels. */
bool unit_inside(const int64_t position[3], const int32_t lo[3], const int32_t hi[3]);

/* Sets parameters from "name=value name=value ..."; every value must be right. */
vodr_machine unit_machine(const char *settings);

#endif
