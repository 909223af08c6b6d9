/* volume_quantise.c - the densities that the machine draws, from a volume's stored voxels. */
#include "volume_file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "spline.h"

typedef struct window {
    double lo, hi;
    double most; /* the largest density */
} window;

static uint16_t density(const window *w, double value)
{
    double scaled = w->hi == w->lo ? 0 : (value - w->lo) / (w->hi - w->lo) * w->most;
    if (!(scaled > 0))
        return 0;
    return scaled >= w->most ? (uint16_t)w->most : (uint16_t)floor(scaled + 0.5);
}

static const uint16_t *fill_map(volume *v, const window *w)
{
    bool identity = true;
    for (int i = 0; i < 256; i++) {
        int stored = v->type == VOLUME_INT8 && i > 127 ? i - 256 : i;
        v->map[i] = density(w, stored * v->slope + v->inter);
        identity = identity && v->map[i] == i;
    }
    return identity && w->most == 255 ? NULL : v->map;
}

/* Densities replace the voxels from the head of the same memory: voxel i is read before its place is written, as a
 * density is never wider than a voxel. */
static void store(volume *v, size_t i, uint16_t d, bool wide)
{
    if (wide)
        memcpy((unsigned char *)v->voxels + 2 * i, &d, sizeof d);
    else
        ((unsigned char *)v->voxels)[i] = (unsigned char)d;
}

static void convert_16_bits(volume *v, const window *w, bool wide)
{
    uint16_t table[65536];
    for (int i = 0; i < 65536; i++) {
        int stored = v->type == VOLUME_INT16 && i > 32767 ? i - 65536 : i;
        table[i] = density(w, stored * v->slope + v->inter);
    }
    for (size_t i = 0, n = volume_count(v); i < n; i++) {
        uint16_t stored;
        memcpy(&stored, (const unsigned char *)v->voxels + 2 * i, sizeof stored);
        store(v, i, table[stored], wide);
    }
}

static void convert(volume *v, const window *w, bool wide)
{
    if (volume_type_bytes(v->type) == 2) {
        convert_16_bits(v, w, wide);
        return;
    }
    for (size_t i = 0, n = volume_count(v); i < n; i++)
        store(v, i, density(w, volume_value(v, i)), wide);
}

/* Gives back what lies behind the first `bytes` of the voxels. */
static void shrink(volume *v, size_t bytes)
{
    v->bytes = bytes;
    if (v->mapping) {
        size_t page = (size_t)sysconf(_SC_PAGESIZE);
        size_t used = (size_t)((unsigned char *)v->voxels - (unsigned char *)v->mapping) + bytes;
        size_t kept = (used + page - 1) / page * page;
        if (kept < v->mapping_bytes && munmap((unsigned char *)v->mapping + kept, v->mapping_bytes - kept) == 0)
            v->mapping_bytes = kept;
    } else {
        void *smaller = realloc(v->voxels, bytes);
        v->voxels = smaller ? smaller : v->voxels;
    }
}

host_status volume_quantise(volume *v, double lo, double hi, int density_bits, vodr_volume *out, host_error *error)
{
    if (v->quantised)
        return host_fail(error, HOST_BAD_INPUT, "%s: is quantised already", v->path);
    if (density_bits != 8 && density_bits != 12)
        return host_fail(error, HOST_BAD_INPUT, "density_bits %d: must be 8 or 12", density_bits);
    if (!isfinite(hi - lo))
        return host_fail(error, HOST_BAD_INPUT, "window %g:%g: must be finite", lo, hi);
    v->quantised = true;
    const window w = {lo, hi, density_bits == 8 ? 255 : 4095};
    bool wide = density_bits > 8 && volume_type_bytes(v->type) > 1;
    *out = (vodr_volume){.voxel_bytes = wide ? 2 : 1};
    memcpy(out->dims_vox, v->dims_vox, sizeof out->dims_vox);
    if (volume_type_bytes(v->type) == 1) {
        out->map = fill_map(v, &w);
    } else {
        convert(v, &w, wide);
        shrink(v, volume_count(v) * (size_t)out->voxel_bytes);
    }
    out->voxels = v->voxels;
    return HOST_OK;
}

host_status volume_coefficients(volume *v, int density_bits, vodr_volume *densities, host_error *error)
{
    const size_t bytes = volume_count(v) * sizeof(int16_t);
    int16_t *coefficients = malloc(bytes);
    if (!coefficients)
        return host_fail(error, HOST_ENVIRONMENT, "no memory for %zu bytes of coefficients", bytes);
    host_status status = spline_coefficients(densities, density_bits, coefficients, error);
    if (status != HOST_OK) {
        free(coefficients);
        return status;
    }
    volume_free_voxels(v);
    v->voxels = coefficients;
    v->bytes = bytes;
    densities->voxels = coefficients;
    densities->voxel_bytes = 2;
    densities->map = NULL;
    return HOST_OK;
}
