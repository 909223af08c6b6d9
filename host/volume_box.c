/* volume_box.c - boxes of a volume: the range of their values, and copies. */
#include "volume.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Defines a function that widens *lo and *hi to n stored voxels. */
#define DEFINE_WIDEN(name, type)                                                                                       \
    static void name(const void *voxels, size_t first, size_t n, double *lo, double *hi)                               \
    {                                                                                                                  \
        const type *stored = (const type *)voxels + first;                                                             \
        type least = stored[0], most = stored[0];                                                                      \
        for (size_t i = 1; i < n; i++) {                                                                               \
            least = stored[i] < least ? stored[i] : least;                                                             \
            most = stored[i] > most ? stored[i] : most;                                                                \
        }                                                                                                              \
        *lo = fmin(*lo, (double)least);                                                                                \
        *hi = fmax(*hi, (double)most);                                                                                 \
    }

DEFINE_WIDEN(widen_uint8, uint8_t)
DEFINE_WIDEN(widen_int8, int8_t)
DEFINE_WIDEN(widen_uint16, uint16_t)
DEFINE_WIDEN(widen_int16, int16_t)
DEFINE_WIDEN(widen_uint32, uint32_t)
DEFINE_WIDEN(widen_int32, int32_t)

static void widen_float32(const void *voxels, size_t first, size_t n, double *lo, double *hi)
{
    const float *stored = (const float *)voxels + first;
    for (size_t i = 0; i < n; i++) {
        *lo = isfinite(stored[i]) ? fmin(*lo, (double)stored[i]) : -INFINITY;
        if (isfinite(stored[i]))
            *hi = fmax(*hi, (double)stored[i]);
    }
}

void volume_box_range(const volume *v, const int32_t lo[3], const int32_t hi[3], double *least, double *most)
{
    static void (*const widen[])(const void *, size_t, size_t, double *, double *) = {
        [VOLUME_UINT8] = widen_uint8,     [VOLUME_INT8] = widen_int8,     [VOLUME_UINT16] = widen_uint16,
        [VOLUME_INT16] = widen_int16,     [VOLUME_UINT32] = widen_uint32, [VOLUME_INT32] = widen_int32,
        [VOLUME_FLOAT32] = widen_float32,
    };
    double stored[2] = {INFINITY, -INFINITY};
    for (int32_t z = lo[2]; z < hi[2]; z++)
        for (int32_t y = lo[1]; y < hi[1]; y++) {
            size_t row = ((size_t)z * (size_t)v->dims_vox[1] + (size_t)y) * (size_t)v->dims_vox[0];
            widen[v->type](v->voxels, row + (size_t)lo[0], (size_t)(hi[0] - lo[0]), &stored[0], &stored[1]);
        }
    const bool finite = stored[0] > -INFINITY, falls = v->slope < 0;
    *least = finite ? stored[falls] * v->slope + v->inter : -INFINITY;
    *most = (falls && finite ? stored[0] : stored[1]) * v->slope + v->inter;
    if (falls && !finite) /* what is least of the finite is not known */
        *most = INFINITY;
}

host_status volume_cut(const volume *v, const int32_t lo[3], const int32_t hi[3], volume *out, host_error *error)
{
    const size_t voxel = volume_type_bytes(v->type), row = (size_t)(hi[0] - lo[0]) * voxel;
    *out = *v;
    out->mapping = NULL;
    out->mapping_bytes = 0;
    for (int a = 0; a < 3; a++)
        out->dims_vox[a] = hi[a] - lo[a];
    out->bytes = volume_count(out) * voxel;
    out->path = strdup(v->path);
    out->voxels = malloc(out->bytes);
    if (!out->path || !out->voxels) {
        volume_close(out);
        return host_fail(error, HOST_ENVIRONMENT, "no memory for %dx%dx%d voxels", hi[0] - lo[0], hi[1] - lo[1],
                         hi[2] - lo[2]);
    }
    char *to = out->voxels;
    for (int32_t z = lo[2]; z < hi[2]; z++)
        for (int32_t y = lo[1]; y < hi[1]; y++, to += row) {
            size_t from = ((size_t)z * (size_t)v->dims_vox[1] + (size_t)y) * (size_t)v->dims_vox[0] + (size_t)lo[0];
            memcpy(to, (const char *)v->voxels + from * voxel, row);
        }
    return HOST_OK;
}
