/* texture_unit.c - positions to densities to colours, in the integer arithmetic of docs/architecture.md, "Filter". */
#include "texture_unit.h"

#include <inttypes.h>
#include <stdlib.h>

#include "error.h"
#include "layout.h"
#include "voxels.h"

/* A channel of tf_bits at the frame buffer's width: 8 to 16 bits exactly, 16 to 8 to nearest. */
static uint16_t convert_channel(uint16_t value, int32_t tf_bits, int32_t fb_bits)
{
    if (tf_bits == fb_bits)
        return value;
    return (uint16_t)(fb_bits == 16 ? value * 257 : (value + 128) / 257);
}

static vodr_status convert_table(texture_unit *t, const vodr_machine *m, const vodr_table *table, vodr_error *error)
{
    uint16_t full = m->tf_bits == 16 ? 65535 : 255;
    for (size_t i = 0; i < table->count; i++) {
        vodr_rgba e = table->entries[i];
        if (e.a > full || e.r > e.a || e.g > e.a || e.b > e.a)
            return vodr_fail(
                error, VODR_INVALID,
                "table entry %zu is (%d,%d,%d,%d) but must be premultiplied, its colours at most its alpha "
                "and that at most %d",
                i, e.r, e.g, e.b, e.a, full);
        t->readout[i] =
            (vodr_rgba){convert_channel(e.r, m->tf_bits, m->fb_bits), convert_channel(e.g, m->tf_bits, m->fb_bits),
                        convert_channel(e.b, m->tf_bits, m->fb_bits), convert_channel(e.a, m->tf_bits, m->fb_bits)};
        t->colours[i] = m->blend == VODR_BLEND_MIP ? (vodr_rgba){.r = (uint16_t)i, .a = 1} : t->readout[i];
    }
    return VODR_OK;
}

/* A density is dead when its fragment cannot change the finished frame: in mip, when no smaller density shows either.
 */
static void find_transparent(texture_unit *t, const vodr_machine *m, int32_t count)
{
    for (int32_t i = count - 1; i >= 0; i--) {
        const vodr_rgba *e = &t->readout[i];
        bool shows = e->r | e->g | e->b | e->a;
        t->transparent_to[i] = shows                                           ? i - 1
                               : i + 1 < count && t->transparent_to[i + 1] > i ? t->transparent_to[i + 1]
                                                                               : i;
    }
    for (int32_t i = 0; i < count; i++)
        t->dead[i] = m->kill_transparent && t->transparent_to[m->blend == VODR_BLEND_MIP ? 0 : i] >= i;
}

vodr_status texture_unit_start(texture_unit *t, const vodr_machine *m, const vodr_volume *volume,
                               const vodr_table *table, const vodr_view *view, vodr_error *error)
{
    size_t count = (size_t)1 << m->density_bits;
    *t = (texture_unit){.volume = volume,
                        .view = view,
                        .filter = (vodr_filter)m->filter,
                        .stored_bits = stored_bits(m),
                        .weight_bits = m->weight_bits,
                        .guard_bits = m->guard_bits,
                        .border_vox = filter_border_vox(m),
                        .voxel_bytes = density_bytes(m),
                        .fetches = filter_fetches(m),
                        .whole = m->traversal == VODR_TRAVERSAL_WHOLE,
                        .buffer_count = m->double_buffer ? 2 : 1};
    if (table->count != count)
        return vodr_fail(error, VODR_INVALID, "the table has %zu entries but must have %zu (density_bits=%" PRId32 ")",
                         table->count, count, m->density_bits);
    t->colours = malloc(count * sizeof *t->colours);
    t->readout = malloc(count * sizeof *t->readout);
    t->transparent_to = malloc(count * sizeof *t->transparent_to);
    t->dead = malloc(count);
    bool weighs = cubic_start(&t->cubic, m);
    if (!t->colours || !t->readout || !t->transparent_to || !t->dead || !weighs)
        return vodr_fail(error, VODR_NO_MEMORY, "no memory for a table of %zu entries", count);
    vodr_status status = convert_table(t, m, table, error);
    if (status == VODR_OK)
        find_transparent(t, m, (int32_t)count);
    return status;
}

vodr_status texture_unit_reserve(texture_unit *t, int32_t edge_vox, vodr_error *error)
{
    size_t voxels = 1;
    for (int c = 0; c < 3; c++) {
        int32_t edge = edge_vox + 2 * t->border_vox;
        voxels *= (size_t)(edge < t->volume->dims_vox[c] ? edge : t->volume->dims_vox[c]);
    }
    for (int i = 0; !t->whole && i < t->buffer_count; i++) {
        t->buffers[i].densities = malloc(voxels * sizeof *t->buffers[i].densities);
        if (!t->buffers[i].densities)
            return vodr_fail(error, VODR_NO_MEMORY, "no memory for a brick of %zu voxels", voxels);
    }
    return VODR_OK;
}

uint64_t texture_unit_load(texture_unit *t, size_t brick, const vox_box *box)
{
    if (t->whole)
        return 0;
    for (int i = 0; i < t->buffer_count; i++)
        if (t->buffers[i].valid && t->buffers[i].brick == brick) {
            t->current = i;
            return 0;
        }
    /* The buffer that is not being drawn from takes the load. */
    t->current = (t->current + 1) % t->buffer_count;
    texture_buffer *b = &t->buffers[t->current];
    b->brick = brick;
    b->valid = true;
    b->region = voxels_reach(t->volume->dims_vox, box, t->border_vox);
    const int32_t *lo = b->region.lo, *hi = b->region.hi;
    int32_t width = hi[0] - lo[0];
    uint16_t *row = b->densities;
    for (int32_t z = lo[2]; row && z < hi[2]; z++)
        for (int32_t y = lo[1]; y < hi[1]; y++, row += width)
            voxels_row(t->volume, t->stored_bits, voxel_index(t->volume->dims_vox, lo[0], y, z), width, row);
    return (uint64_t)width * (uint64_t)(hi[1] - lo[1]) * (uint64_t)(hi[2] - lo[2]) * (uint64_t)t->voxel_bytes;
}

void texture_unit_empty(texture_unit *t)
{
    for (int i = 0; i < t->buffer_count; i++)
        t->buffers[i].valid = false;
}

/* What the fetch stage reads: texture memory, or the volume itself. Indices are inside the region. */
static inline int32_t fetch(const texture_unit *t, bool whole, int32_t x, int32_t y, int32_t z)
{
    if (whole) {
        uint16_t density;
        voxels_row(t->volume, t->stored_bits, voxel_index(t->volume->dims_vox, x, y, z), 1, &density);
        return density;
    }
    const texture_buffer *b = &t->buffers[t->current];
    size_t width = (size_t)(b->region.hi[0] - b->region.lo[0]), height = (size_t)(b->region.hi[1] - b->region.lo[1]);
    return b->densities[((size_t)(z - b->region.lo[2]) * height + (size_t)(y - b->region.lo[1])) * width +
                        (size_t)(x - b->region.lo[0])];
}

static inline int32_t lerp(int32_t a, int32_t b, int32_t weight, int32_t weight_bits)
{
    return a + (((b - a) * weight) >> weight_bits);
}

static inline int32_t clamp(int32_t i, int32_t last)
{
    return i < 0 ? 0 : i > last ? last : i;
}

static inline int32_t filter_nearest(const texture_unit *t, bool whole, const int64_t position[3])
{
    return fetch(t, whole, (int32_t)(position[0] >> VODR_POSITION_BITS), (int32_t)(position[1] >> VODR_POSITION_BITS),
                 (int32_t)(position[2] >> VODR_POSITION_BITS));
}

static inline int32_t filter_linear(const texture_unit *t, bool whole, const int64_t position[3])
{
    int32_t i[3][2], w[3], wb = t->weight_bits, along_x[4], along_y[2];
    for (int c = 0; c < 3; c++) {
        int64_t p = position[c] - ((int64_t)1 << (VODR_POSITION_BITS - 1)); /* from the centre of voxel 0 */
        int32_t first = (int32_t)(p >> VODR_POSITION_BITS), last = t->volume->dims_vox[c] - 1;
        i[c][0] = clamp(first, last);
        i[c][1] = clamp(first + 1, last);
        w[c] = (int32_t)(p >> (VODR_POSITION_BITS - wb)) & ((1 << wb) - 1);
    }
    for (int n = 0; n < 4; n++) {
        int32_t y = i[1][n & 1], z = i[2][n >> 1];
        int32_t a = fetch(t, whole, i[0][0], y, z) << t->guard_bits, b = fetch(t, whole, i[0][1], y, z)
                                                                         << t->guard_bits;
        along_x[n] = lerp(a, b, w[0], wb);
    }
    for (int n = 0; n < 2; n++)
        along_y[n] = lerp(along_x[2 * n], along_x[2 * n + 1], w[1], wb);
    int32_t half = (1 << t->guard_bits) >> 1;
    return (lerp(along_y[0], along_y[1], w[2], wb) + half) >> t->guard_bits;
}

/* Four voxels along x, whose columns are given. */
static inline void fetch_row(const texture_unit *t, bool whole, const int32_t x[CUBIC_TAPS], int32_t y, int32_t z,
                             int32_t row[CUBIC_TAPS])
{
    uint16_t stored[CUBIC_TAPS];
    if (whole && x[3] - x[0] == 3)
        voxels_row(t->volume, t->stored_bits, voxel_index(t->volume->dims_vox, x[0], y, z), CUBIC_TAPS, stored);
    for (int i = 0; i < CUBIC_TAPS; i++)
        row[i] =
            voxel_value(whole && x[3] - x[0] == 3 ? stored[i] : (uint16_t)fetch(t, whole, x[i], y, z), t->stored_bits);
}

static inline int32_t filter_cubic(const texture_unit *t, bool whole, const int64_t position[3])
{
    int32_t i[3][CUBIC_TAPS], share[3], voxels[CUBIC_VOXELS];
    for (int c = 0; c < 3; c++) {
        int64_t p = position[c] - ((int64_t)1 << (VODR_POSITION_BITS - 1));
        int32_t first = (int32_t)(p >> VODR_POSITION_BITS) - 1, last = t->volume->dims_vox[c] - 1;
        for (int n = 0; n < CUBIC_TAPS; n++)
            i[c][n] = clamp(first + n, last);
        share[c] = (int32_t)(p >> (VODR_POSITION_BITS - t->weight_bits)) & ((1 << t->weight_bits) - 1);
    }
    for (int n = 0; n < 16; n++)
        fetch_row(t, whole, i[0], i[1][n & 3], i[2][n >> 2], voxels + CUBIC_TAPS * n);
    return cubic_value(&t->cubic, share, voxels);
}

static inline int32_t filter_at(const texture_unit *t, bool whole, vodr_filter filter, const int64_t position[3])
{
    switch (filter) {
    case VODR_FILTER_NEAREST: return filter_nearest(t, whole, position);
    case VODR_FILTER_LINEAR: return filter_linear(t, whole, position);
    default: return filter_cubic(t, whole, position);
    }
}

static inline void filter_span(const texture_unit *t, bool whole, vodr_filter filter, const brick_slice *slice,
                               const span *s, uint16_t *densities)
{
    int64_t a[3];
    for (int c = 0; c < 3; c++)
        a[c] = numerator_at(&slice->plane, c, s->x0, s->y);
    int32_t shift = t->view->shift;
    for (int32_t n = 0; n < s->x1 - s->x0; n++) {
        int64_t position[3];
        for (int c = 0; c < 3; c++) {
            position[c] = t->view->base[c] + (a[c] >> shift);
            a[c] += n + 1 < s->x1 - s->x0 ? slice->plane.step_u[c] : 0;
        }
        densities[n] = (uint16_t)filter_at(t, whole, filter, position);
    }
}

uint64_t texture_unit_fetched(const texture_unit *t, int32_t count)
{
    return t->whole ? (uint64_t)count * (uint64_t)t->fetches * (uint64_t)t->voxel_bytes : 0;
}

/* A loop of its own for each filter. */
static inline void filter_by(const texture_unit *t, bool whole, const brick_slice *slice, const span *s,
                             uint16_t *densities)
{
    switch (t->filter) {
    case VODR_FILTER_NEAREST: filter_span(t, whole, VODR_FILTER_NEAREST, slice, s, densities); break;
    case VODR_FILTER_LINEAR: filter_span(t, whole, VODR_FILTER_LINEAR, slice, s, densities); break;
    default: filter_span(t, whole, VODR_FILTER_CARDINAL, slice, s, densities); /* or bspline: weights differ */
    }
}

void texture_unit_filter(const texture_unit *t, const brick_slice *slice, const span *s, uint16_t *densities)
{
    if (t->whole)
        filter_by(t, true, slice, s, densities);
    else
        filter_by(t, false, slice, s, densities);
}

void texture_unit_finish(texture_unit *t)
{
    for (int i = 0; i < 2; i++)
        free(t->buffers[i].densities);
    free(t->colours);
    free(t->readout);
    free(t->transparent_to);
    free(t->dead);
    cubic_finish(&t->cubic);
    *t = (texture_unit){0};
}
