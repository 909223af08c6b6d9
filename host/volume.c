/* volume.c - opens a volume file by its content and holds it. */
#include "volume.h"
#include "orientation.h"
#include "volume_file.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* No scanner's voxel is longer, beside its width. */
enum { MAX_ANISOTROPY = 10000 };

static const struct {
    const char *name;
    size_t bytes;
} types[] = {
    [VOLUME_UINT8] = {"uint8", 1},     [VOLUME_INT8] = {"int8", 1},     [VOLUME_UINT16] = {"uint16", 2},
    [VOLUME_INT16] = {"int16", 2},     [VOLUME_UINT32] = {"uint32", 4}, [VOLUME_INT32] = {"int32", 4},
    [VOLUME_FLOAT32] = {"float32", 4},
};

const char *volume_type_name(volume_type type)
{
    return types[type].name;
}

size_t volume_type_bytes(volume_type type)
{
    return types[type].bytes;
}

bool volume_type_named(const char *name, volume_type *type)
{
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (strcmp(name, types[i].name) == 0) {
            *type = (volume_type)i;
            return true;
        }
    return false;
}

size_t volume_count(const volume *v)
{
    return (size_t)v->dims_vox[0] * (size_t)v->dims_vox[1] * (size_t)v->dims_vox[2];
}

bool volume_is_ct(const volume *v)
{
    return v->min < -500;
}

static host_status check_regular(const char *path, host_error *error)
{
    struct stat status;
    if (stat(path, &status))
        return host_fail(error, HOST_BAD_INPUT, "%s: %s", path, strerror(errno));
    if (S_ISDIR(status.st_mode))
        return host_fail(error, HOST_BAD_INPUT,
                         "%s: is a directory, must be a volume file (dcm2niix makes one of a DICOM series)", path);
    if (!S_ISREG(status.st_mode))
        return host_fail(error, HOST_BAD_INPUT, "%s: is not a regular file", path);
    if (status.st_size == 0)
        return host_fail(error, HOST_BAD_INPUT, "%s: is empty", path);
    FILE *file = fopen(path, "rb");
    if (!file)
        return host_fail(error, HOST_BAD_INPUT, "%s: %s", path, strerror(errno));
    fclose(file);
    return HOST_OK;
}

static host_status read_header(const char *path, const volume_options *options, volume_file *f, host_error *error)
{
    bool damaged;
    if (volume_is_nrrd(path))
        return volume_nrrd_header(path, f, error);
    if (volume_is_nifti(path, &damaged))
        return volume_nifti_header(path, f, error);
    char *header = volume_nifti_header_beside(path);
    if (header) {
        host_status status = volume_nifti_header(header, f, error);
        free(header);
        return status;
    }
    if (damaged && !options->dims_vox[0])
        return host_fail(error, HOST_BAD_INPUT, "%s: is a damaged or truncated gzip file", path);
    return volume_raw_header(path, options, f, error);
}

host_status volume_check_dims(const char *path, const int64_t dims_vox[3], host_error *error)
{
    for (int i = 0; i < 3; i++)
        if (dims_vox[i] < 1 || dims_vox[i] > VODR_MAX_DIM_VOX)
            return host_fail(error, HOST_BAD_INPUT, "%s: the size along %c is %lld, must be 1 to %d voxels", path,
                             "xyz"[i], (long long)dims_vox[i], VODR_MAX_DIM_VOX);
    return HOST_OK;
}

static host_status check_spacing(const char *path, const volume_file *f, host_error *error)
{
    double least = INFINITY, most = 0;
    for (int i = 0; i < 3; i++) {
        if (!(f->spacing[i] >= DBL_MIN) || isinf(f->spacing[i]))
            return host_fail(error, HOST_BAD_INPUT, "%s: the spacing along %c is %g, must be above 0 and finite", path,
                             "xyz"[i], f -> spacing[i]);
        least = fmin(least, f->spacing[i]);
        most = fmax(most, f->spacing[i]);
    }
    if (most / least > MAX_ANISOTROPY)
        return host_fail(error, HOST_BAD_INPUT,
                         "%s: the spacing goes from %g to %g, must not differ by more than %d times", path, least, most,
                         MAX_ANISOTROPY);
    return HOST_OK;
}

static host_status check_options(const char *path, const volume_options *o, const volume_file *f, host_error *error)
{
    for (int i = 0; i < 3; i++) {
        if (o->dims_vox[i] && o->dims_vox[i] != f->dims_vox[i])
            return host_fail(error, HOST_BAD_INPUT, "--dims: the size along %c is %d, but %s is an %s file of %lld",
                             "xyz"[i], o -> dims_vox[i], path, f -> format, (long long)f -> dims_vox[i]);
        if (o->spacing[i] != 0 && o->spacing[i] != f->spacing[i])
            return host_fail(error, HOST_BAD_INPUT, "--spacing: along %c it is %g, but %s is an %s file of %g",
                             "xyz"[i], o -> spacing[i], path, f -> format, f -> spacing[i]);
        if (o->crop && (o->crop_lo[i] < 0 || o->crop_lo[i] >= o->crop_hi[i] || o->crop_hi[i] > f->dims_vox[i]))
            return host_fail(error, HOST_BAD_INPUT, "--crop: the range along %c is %d:%d, must lie within 0:%lld of %s",
                             "xyz"[i], o -> crop_lo[i], o -> crop_hi[i], (long long)f -> dims_vox[i], path);
    }
    return HOST_OK;
}

static host_status check_header(const char *path, const volume_options *o, const volume_file *f, host_error *error)
{
    host_status status = volume_check_dims(path, f->dims_vox, error);
    if (status == HOST_OK)
        status = check_spacing(path, f, error);
    if (status == HOST_OK)
        status = check_options(path, o, f, error);
    if (status != HOST_OK)
        return status;
    if (!isfinite(f->slope) || !isfinite(f->inter))
        return host_fail(error, HOST_BAD_INPUT, "%s: slope %g and intercept %g must be finite", path, f->slope,
                         f->inter);
    if (f->oriented && !o->no_orient && !orientation_is_sound(f->direction))
        return host_fail(error, HOST_BAD_INPUT,
                         "%s: its orientation (sform, qform or space directions) has no rotation: the axes must run in "
                         "three directions (--no-orient leaves it out)",
                         path);
    return HOST_OK;
}

static void set_orientation(const volume_file *f, bool no_orient, volume *v)
{
    static const double none[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    orientation_nearest(f->oriented && !no_orient ? f->direction : none, v->axis, v->sign);
}

/* Of the finite voxels, which it counts; 0 to 0 when there are none. */
static void find_range_float32(volume *v)
{
    const float *stored = v->voxels;
    const size_t n = volume_count(v);
    float lo = INFINITY, hi = -INFINITY;
    for (size_t i = 0; i < n; i++) {
        if (!isfinite(stored[i])) {
            v->nonfinite++;
            continue;
        }
        lo = stored[i] < lo ? stored[i] : lo;
        hi = stored[i] > hi ? stored[i] : hi;
    }
    if (v->nonfinite == n)
        return;
    const double a = lo * v->slope + v->inter, b = hi * v->slope + v->inter;
    v->min = fmin(a, b);
    v->max = fmax(a, b);
}

static host_status find_range(volume *v, host_error *error)
{
    static const int32_t first[3];
    if (v->type == VOLUME_FLOAT32)
        find_range_float32(v);
    else
        volume_box_range(v, first, v->dims_vox, &v->min, &v->max);
    if (!isfinite(v->max - v->min))
        return host_fail(error, HOST_BAD_INPUT, "%s: values from %g to %g are outside the range of double", v->path,
                         v->min, v->max);
    return HOST_OK;
}

/* All but the voxels and their range. */
static void fill_header(const volume_options *o, const volume_file *f, volume *v, int32_t lo[3], int32_t hi[3])
{
    for (int i = 0; i < 3; i++) {
        lo[i] = o->crop ? o->crop_lo[i] : 0;
        hi[i] = o->crop ? o->crop_hi[i] : (int32_t)f->dims_vox[i];
        v->dims_vox[i] = hi[i] - lo[i];
        v->spacing[i] = f->spacing[i];
    }
    v->type = f->type;
    v->slope = f->slope;
    v->inter = f->inter;
    v->format = f->format;
    set_orientation(f, o->no_orient, v);
}

static host_status fill(const volume_options *o, const volume_file *f, volume *v, bool voxels, host_error *error)
{
    int32_t lo[3], hi[3];
    fill_header(o, f, v, lo, hi);
    host_status status = voxels ? volume_read_voxels(f, lo, hi, v, error) : HOST_OK;
    return status == HOST_OK && voxels ? find_range(v, error) : status;
}

static host_status open_file(const char *path, const volume_options *options, volume *v, bool voxels, host_error *error)
{
    *v = (volume){.path = strdup(path)};
    volume_file f = {.slope = 1};
    host_status status = v->path ? check_regular(path, error) : host_fail(error, HOST_ENVIRONMENT, "out of memory");
    if (status == HOST_OK)
        status = read_header(path, options, &f, error);
    if (status == HOST_OK)
        status = check_header(path, options, &f, error);
    if (status == HOST_OK)
        status = fill(options, &f, v, voxels, error);
    volume_file_close(&f);
    if (status != HOST_OK)
        volume_close(v);
    return status;
}

host_status volume_open(const char *path, const volume_options *options, volume *v, host_error *error)
{
    return open_file(path, options, v, true, error);
}

host_status volume_open_header(const char *path, const volume_options *options, volume *v, host_error *error)
{
    return open_file(path, options, v, false, error);
}

void volume_close(volume *v)
{
    volume_free_voxels(v);
    free(v->path);
    *v = (volume){0};
}

void volume_file_close(volume_file *f)
{
    if (f->data)
        fclose(f->data);
    free(f->data_path);
    *f = (volume_file){0};
}

double volume_value(const volume *v, size_t i)
{
    double stored;
    switch (v->type) {
    case VOLUME_UINT8: stored = ((const uint8_t *)v->voxels)[i]; break;
    case VOLUME_INT8: stored = ((const int8_t *)v->voxels)[i]; break;
    case VOLUME_UINT16: stored = ((const uint16_t *)v->voxels)[i]; break;
    case VOLUME_INT16: stored = ((const int16_t *)v->voxels)[i]; break;
    case VOLUME_UINT32: stored = ((const uint32_t *)v->voxels)[i]; break;
    case VOLUME_INT32: stored = ((const int32_t *)v->voxels)[i]; break;
    default: stored = (double)((const float *)v->voxels)[i];
    }
    return isfinite(stored) ? stored * v->slope + v->inter : v->min;
}
