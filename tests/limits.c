/* limits.c - what no machine can do without, for scripts/findings to hold the machines against: a walk over all samples
 * of a frame by docs/architecture.md, sections 2, 3 and 6, that knows no brick, no line and no order.
 *
 *   limits VOLUME TF WINDOW SIZE_PX SLICES VIEW...    WINDOW `LO:HI`, or `-` for the data's; parallel views `AZ,EL`
 *
 * A line a view: volume, tf, view, and
 *   covered_px   pixels with a sample inside the volume
 *   visible_px   pixels with a sample that is not transparent: each must be written, 4 bytes once
 *   fetched_vox  voxels that a sample inside the volume depends on
 *   visible_vox  voxels that a sample which is not transparent depends on: each must be loaded, a byte once */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene.h"
#include "second_texture.h"
#include "text.h"

enum { FETCHED = 1, VISIBLE = 2, OPERANDS = 6 };

typedef struct limits {
    uint64_t covered_px, visible_px, fetched_vox, visible_vox;
} limits;

/* Where pixel (x, y) of slice k samples; false outside the volume. */
static bool sample(const scene *s, int32_t x, int32_t y, int32_t k, int64_t position[3])
{
    const vodr_view *v = &s->view;
    bool inside = true;
    for (int c = 0; c < 3; c++) {
        position[c] = v->base[c] + k * v->step_s[c] + x * v->step_u[c] + y * v->step_v[c];
        inside = inside && position[c] >= 0 && position[c] < (int64_t)s->densities.dims_vox[c] << VODR_POSITION_BITS;
    }
    return inside;
}

static bool is_visible(const scene *s, const int64_t position[3])
{
    const uint32_t density = second_filter(&s->machine, &s->densities, position);
    return !second_transparent(&s->machine, s->entries, density, density);
}

/* The voxels along axis c that weigh something at a position: one where the other's weight is zero or beyond the side.
 */
static void taps(const scene *s, int c, int64_t position, int64_t *first, int64_t *last)
{
    const int64_t q = position - (INT64_C(1) << (VODR_POSITION_BITS - 1)), side = s->densities.dims_vox[c] - 1;
    const int64_t weight = (q >> (VODR_POSITION_BITS - s->machine.weight_bits)) & ((1 << s->machine.weight_bits) - 1);
    *first = q >> VODR_POSITION_BITS;
    *last = *first + (weight != 0);
    *first = *first < 0 ? 0 : *first;
    *last = *last > side ? side : *last;
}

static void mark_voxels(const scene *s, const int64_t position[3], uint8_t mark, uint8_t *marks)
{
    const int32_t *dims = s->densities.dims_vox;
    int64_t first[3], last[3];
    for (int c = 0; c < 3; c++)
        taps(s, c, position[c], &first[c], &last[c]);
    for (int64_t z = first[2]; z <= last[2]; z++)
        for (int64_t y = first[1]; y <= last[1]; y++)
            for (int64_t x = first[0]; x <= last[0]; x++)
                marks[(z * dims[1] + y) * dims[0] + x] |= mark;
}

/* Marks what a pixel's samples need; returns what the pixel itself is. */
static uint8_t mark_pixel(const scene *s, int32_t x, int32_t y, uint8_t *marks)
{
    uint8_t pixel = 0;
    for (int32_t k = 0; k < s->view.slices; k++) {
        int64_t position[3];
        if (!sample(s, x, y, k, position))
            continue;
        const uint8_t mark = is_visible(s, position) ? FETCHED | VISIBLE : FETCHED;
        mark_voxels(s, position, mark, marks);
        pixel |= mark;
    }
    return pixel;
}

static limits count(const scene *s, uint8_t *marks)
{
    limits n = {0};
    const size_t voxels = volume_count(&s->volume);
    memset(marks, 0, voxels);
    for (int32_t y = 0; y < s->view.height_px; y++)
        for (int32_t x = 0; x < s->view.width_px; x++) {
            const uint8_t pixel = mark_pixel(s, x, y, marks);
            n.covered_px += (pixel & FETCHED) != 0;
            n.visible_px += (pixel & VISIBLE) != 0;
        }
    for (size_t i = 0; i < voxels; i++) {
        n.fetched_vox += (marks[i] & FETCHED) != 0;
        n.visible_vox += (marks[i] & VISIBLE) != 0;
    }
    return n;
}

static host_status read_options(char **argv, view_options *o, host_error *error)
{
    int64_t size_px, slices;
    double window[2];
    o->transfer = argv[2];
    o->has_window = strcmp(argv[3], "-") != 0;
    if (o->has_window && !text_numbers(argv[3], ':', 2, 2, window))
        return host_fail(error, HOST_BAD_INPUT, "the window is '%s', must be LO:HI or -", argv[3]);
    if (o->has_window) {
        o->window_lo = window[0];
        o->window_hi = window[1];
    }
    if (!text_integer(argv[4], 1, VODR_MAX_SIZE_PX, &size_px) || !text_integer(argv[5], 1, VODR_MAX_SLICES, &slices))
        return host_fail(error, HOST_BAD_INPUT, "size and slices are '%s' and '%s', must be integers from 1 to %d",
                         argv[4], argv[5], VODR_MAX_SIZE_PX);
    o->camera.width_px = o->camera.height_px = (int32_t)size_px;
    o->camera.slices = (int32_t)slices;
    return HOST_OK;
}

/* A view of its own is a scene of its own: the distance of slices, and so the table, depends on it. */
static host_status print_view(char **argv, const char *view, const view_options *options, host_error *error)
{
    view_options o = *options;
    double angles_deg[2];
    scene s;
    if (!text_numbers(view, ',', 2, 2, angles_deg))
        return host_fail(error, HOST_BAD_INPUT, "the view is '%s', must be AZ,EL", view);
    o.camera.azimuth_deg = angles_deg[0];
    o.camera.elevation_deg = angles_deg[1];
    host_status status = scene_open(argv[1], &o, &s, error);
    if (status != HOST_OK)
        return status;
    uint8_t *marks = malloc(volume_count(&s.volume));
    if (!marks)
        status = host_fail(error, HOST_ENVIRONMENT, "no memory for a mark a voxel of %s", argv[1]);
    else {
        const limits n = count(&s, marks);
        printf("%s\t%s\t%s\t%" PRIu64 "\t%" PRIu64 "\t%" PRIu64 "\t%" PRIu64 "\n", argv[1], argv[2], view, n.covered_px,
               n.visible_px, n.fetched_vox, n.visible_vox);
    }
    free(marks);
    scene_close(&s);
    return status;
}

int main(int argc, char **argv)
{
    if (argc <= OPERANDS) {
        fputs("usage: limits VOLUME TF WINDOW|- SIZE_PX SLICES AZ,EL...\n", stderr);
        return 2;
    }
    view_options options = view_options_default();
    host_error error;
    host_status status = read_options(argv, &options, &error);
    for (int i = OPERANDS; i < argc && status == HOST_OK; i++)
        status = print_view(argv, argv[i], &options, &error);
    if (status != HOST_OK)
        fprintf(stderr, "limits: %s\n", error.text);
    view_options_free(&options);
    return status == HOST_OK ? 0 : 1;
}
