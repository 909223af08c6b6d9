/* cpu_layout.c - coefficients in an order that suits a view, with what lies beyond their border. */
#include "cpu_layout.h"

#include <stdlib.h>
#include <string.h>

#include "cpu_job.h"
#include "pages.h"

/* A copy being filled; its axes are those of the volume from first_axis on. */
typedef struct filling {
    const float *from;
    int32_t size[3]; /* voxels along the copy's axes */
    size_t apart[3]; /* of the volume's voxels along them */
    kernel_layout layout;
    size_t row, layer; /* of the copy: floats of a row, or of four, and of a layer */
} filling;

/* Rows of a layer, or quads of them. */
static size_t rows_of(kernel_layout layout, int32_t size)
{
    if (layout == KERNEL_QUADS) /* from that of the rows -4 to -1 to the one after that of the last cell's first row */
        return (size_t)((size - LAYOUT_MARGIN_VOX + 2 * LAYOUT_QUAD) / LAYOUT_QUAD + 1);
    return (size_t)size + 2 * LAYOUT_MARGIN_VOX;
}

static int32_t clamp(int32_t i, int32_t size)
{
    return i < 0 ? 0 : i < size ? i : size - 1;
}

/* Layers [k0, k1) of the copy, its margin's among them. */
static void fill_layers(const cpu_job *job, int32_t k0, int32_t k1, uint64_t *samples)
{
    const filling *g = job->input;
    const bool quads = g->layout == KERNEL_QUADS;
    const int32_t step = quads ? LAYOUT_QUAD : 1, begin = quads ? -LAYOUT_QUAD : -LAYOUT_MARGIN_VOX;
    const int32_t rows = (int32_t)rows_of(g->layout, g->size[1]);
    (void)samples;
    for (int32_t k = k0; k < k1; k++) {
        const float *layer = g->from + (size_t)clamp(k - LAYOUT_MARGIN_VOX, g->size[2]) * g->apart[2];
        float *to = (float *)job->output + (size_t)k * g->layer;
        for (int32_t j = 0; j < rows; j++) {
            const float *row[LAYOUT_QUAD];
            for (int32_t n = 0; n < step; n++)
                row[n] = layer + (size_t)clamp(j * step + n + begin, g->size[1]) * g->apart[1];
            for (int32_t i = -LAYOUT_MARGIN_VOX; i < g->size[0] + LAYOUT_MARGIN_VOX; i++)
                for (int32_t n = 0; n < step; n++)
                    *to++ = row[n][(size_t)clamp(i, g->size[0]) * g->apart[0]];
        }
    }
}

const cpu_layout *cpu_layout_of(cpu_layout copies[CPU_LAYOUTS], const reference_volume *v, kernel_layout layout,
                                int32_t first_axis, int32_t threads, reference_stats *stats)
{
    cpu_layout *copy = &copies[layout == KERNEL_QUADS ? CPU_LAYOUTS - 1 : first_axis];
    const size_t apart[3] = {1, (size_t)v->dims_vox[0], (size_t)v->dims_vox[0] * (size_t)v->dims_vox[1]};
    const size_t step = layout == KERNEL_QUADS ? LAYOUT_QUAD : 1, margin = LAYOUT_MARGIN_VOX;
    filling g = {.from = v->voxels, .layout = layout};
    if (copy->memory)
        return copy;
    for (int a = 0; a < 3; a++) {
        g.size[a] = v->dims_vox[(first_axis + a) % 3];
        g.apart[a] = apart[(first_axis + a) % 3];
    }
    g.row = ((size_t)g.size[0] + 2 * margin) * step;
    g.layer = g.row * rows_of(layout, g.size[1]);
    const size_t layers = (size_t)g.size[2] + 2 * margin;
    if (g.layer > INT32_MAX / layers || !(copy->memory = pages_alloc(layers * g.layer * sizeof *copy->memory)))
        return NULL;
    cpu_job job = {.work = fill_layers, .input = &g, .output = copy->memory, .rows = (int32_t)layers};
    stats->preprocess_ms += cpu_job_run(threads, &job);
    copy->first = copy->memory + margin * g.layer + (layout == KERNEL_QUADS ? 1 : margin) * g.row + margin * step;
    copy->stride[0] = (int32_t)step;
    copy->stride[1] = (int32_t)g.row;
    copy->stride[2] = (int32_t)g.layer;
    return copy;
}

static void turn_whole(int32_t axes[3], int32_t first)
{
    const int32_t old[3] = {axes[0], axes[1], axes[2]};
    for (int a = 0; a < 3; a++)
        axes[a] = old[(first + a) % 3];
}

static void turn_real(double axes[3], int32_t first)
{
    const double old[3] = {axes[0], axes[1], axes[2]};
    for (int a = 0; a < 3; a++)
        axes[a] = old[(first + a) % 3];
}

void cpu_layout_turn_axes(kernel_frame *f, int32_t first_axis)
{
    int32_t *whole[] = {f->volume.dims_vox, f->part.whole_vox, f->part.origin_vox, f->part.lo_vox, f->part.hi_vox};
    for (size_t i = 0; i < sizeof whole / sizeof *whole; i++)
        turn_whole(whole[i], first_axis);
    for (int i = 0; i < 3; i++) {
        turn_real(f->camera.origin[i], first_axis);
        turn_real(f->camera.direction[i], first_axis);
    }
    turn_real(f->camera.spacing_vox, first_axis);
}

void cpu_layout_free(cpu_layout *copy)
{
    free(copy->memory);
    *copy = (cpu_layout){0};
}
