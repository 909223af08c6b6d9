/* volume_nifti.c - reads the header of a NIfTI-1 or NIfTI-2 file (.nii, .hdr with .img, plain or gzipped) with
 * libnifti. */
#include "orientation.h"
#include "volume_file.h"

#include <errno.h>
#include <math.h>
#include <nifti2_io.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/* Both versions' header; native byte order once read_header() is through. */
typedef struct nifti_header {
    union {
        nifti_1_header v1;
        nifti_2_header v2;
        unsigned char bytes[sizeof(nifti_2_header)];
    } as;
    int version;
    bool swapped;
} nifti_header;

/* Reads the first bytes of the file, unzipped where it is a gzip file. Returns how many, negative for a damaged gzip.
 */
static int read_start(const char *path, nifti_header *h)
{
    *h = (nifti_header){.version = -1};
    gzFile file = gzopen(path, "rb");
    if (!file)
        return 0;
    int n = gzread(file, h->as.bytes, sizeof h->as.bytes), code = Z_OK;
    gzerror(file, &code);
    gzclose(file);
    return code == Z_OK || n > 0 ? n : -1;
}

/* False where the bytes are no header. */
static bool read_header(const char *path, nifti_header *h, bool *damaged)
{
    int n = read_start(path, h);
    *damaged = n < 0;
    if (n < (int)sizeof(nifti_1_header))
        return false;
    nifti_set_debug_level(0);
    h->version = nifti_header_version((const char *)h->as.bytes, (size_t)n);
    if (h->version != 1 && h->version != 2)
        return false;
    if (h->version == 2 && n < (int)sizeof(nifti_2_header))
        return false;
    int native = h->version == 1 ? (int)sizeof(nifti_1_header) : (int)sizeof(nifti_2_header);
    h->swapped = h->as.v1.sizeof_hdr != native;
    if (h->swapped)
        swap_nifti_header(&h->as, h->version);
    return true;
}

bool volume_is_nifti(const char *path, bool *damaged)
{
    nifti_header h;
    return read_header(path, &h, damaged);
}

char *volume_nifti_header_beside(const char *path)
{
    bool damaged;
    size_t length = strlen(path);
    if ((length < 4 || strcmp(path + length - 4, ".img") != 0) &&
        (length < 7 || strcmp(path + length - 7, ".img.gz") != 0))
        return NULL;
    char *header = nifti_findhdrname(path);
    if (header && volume_is_nifti(header, &damaged))
        return header;
    free(header);
    return NULL;
}

/* libnifti silently mends dimensions, voxel sizes and offsets that are wrong, so they are checked before it sees them.
 */
static host_status check_numbers(const char *path, const nifti_header *h, volume_file *f, host_error *error)
{
    int64_t count = h->version == 1 ? h->as.v1.dim[0] : h->as.v2.dim[0];
    if (count < 3 || count > 7)
        return host_fail(error, HOST_BAD_INPUT, "%s: field dim[0] is %lld, must be 3 (to 7, dim[4] and beyond being 1)",
                         path, (long long)count);
    for (int i = 1; i <= count; i++) {
        int64_t dim = h->version == 1 ? h->as.v1.dim[i] : h->as.v2.dim[i];
        double size = h->version == 1 ? (double)h->as.v1.pixdim[i] : h->as.v2.pixdim[i];
        if (i <= 3) {
            if (!(size > 0))
                return host_fail(error, HOST_BAD_INPUT,
                                 "%s: field pixdim[%d], the spacing along %c, is %g, must be "
                                 "above 0",
                                 path, i, "xyz"[i - 1], size);
            f->dims_vox[i - 1] = dim;
            f->spacing[i - 1] = size;
        } else if (dim != 1) {
            return host_fail(error, HOST_BAD_INPUT,
                             "%s: field dim[%d] is %lld, must be 1: one volume of one value a voxel", path, i,
                             (long long)dim);
        }
    }
    double offset = h->version == 1 ? (double)h->as.v1.vox_offset : (double)h->as.v2.vox_offset;
    if (!(offset >= 0 && offset <= INT32_MAX / 2))
        return host_fail(error, HOST_BAD_INPUT, "%s: field vox_offset is %g, must be 0 to %d", path, offset,
                         INT32_MAX / 2);
    return volume_check_dims(path, f->dims_vox, error);
}

static host_status read_type(const char *path, int datatype, volume_file *f, host_error *error)
{
    switch (datatype) {
    case DT_UINT8: f->type = VOLUME_UINT8; break;
    case DT_INT8: f->type = VOLUME_INT8; break;
    case DT_UINT16: f->type = VOLUME_UINT16; break;
    case DT_INT16: f->type = VOLUME_INT16; break;
    case DT_UINT32: f->type = VOLUME_UINT32; break;
    case DT_INT32: f->type = VOLUME_INT32; break;
    case DT_FLOAT32: f->type = VOLUME_FLOAT32; break;
    case DT_FLOAT64:
        f->type = VOLUME_FLOAT32;
        f->float64 = true;
        break;
    default:
        return host_fail(error, HOST_BAD_INPUT,
                         "%s: field datatype is %d (%s), must be an integer of 8, 16 or 32 bits or a float of 32 or 64",
                         path, datatype, nifti_datatype_string(datatype));
    }
    return HOST_OK;
}

static void read_orientation(const nifti_image *image, volume_file *f)
{
    f->oriented = image->sform_code > 0 || image->qform_code > 0;
    const nifti_dmat44 *matrix = image->sform_code > 0 ? &image->sto_xyz : &image->qto_xyz;
    for (int i = 0; i < 3; i++) {
        const double ras[3] = {matrix->m[0][i], matrix->m[1][i], matrix->m[2][i]};
        orientation_of_patient(ras, f->direction[i]);
    }
}

/* Opens the file that holds the voxels: the header's own, or the .img beside a .hdr. */
static host_status open_data(const char *path, const nifti_image *image, volume_file *f, host_error *error)
{
    bool one_file = image->nifti_type == NIFTI_FTYPE_NIFTI1_1 || image->nifti_type == NIFTI_FTYPE_NIFTI2_1;
    f->data_path = one_file ? strdup(path) : nifti_findimgname(path, image->nifti_type);
    if (!f->data_path)
        return host_fail(error, HOST_BAD_INPUT, "%s: the .img file that belongs to this header is missing", path);
    f->data = fopen(f->data_path, "rb");
    if (!f->data)
        return host_fail(error, HOST_BAD_INPUT, "%s: %s", f->data_path, strerror(errno));
    unsigned char magic[2] = {0};
    if (fread(magic, 1, 2, f->data) == 2 && magic[0] == 0x1f && magic[1] == 0x8b) {
        f->encoding = VOLUME_GZIP;
        f->skip_bytes = (uint64_t)image->iname_offset;
    }
    long offset = f->encoding == VOLUME_GZIP ? 0 : (long)image->iname_offset;
    if (fseek(f->data, offset, SEEK_SET))
        return host_fail(error, HOST_BAD_INPUT, "%s: %s", f->data_path, strerror(errno));
    return HOST_OK;
}

host_status volume_nifti_header(const char *path, volume_file *f, host_error *error)
{
    nifti_header h;
    bool damaged;
    if (!read_header(path, &h, &damaged))
        return host_fail(error, HOST_BAD_INPUT, "%s: has no NIfTI header", path);
    f->format = "nifti";
    f->exact = true;
    f->big_endian = volume_native_big_endian() != h.swapped;
    host_status status = check_numbers(path, &h, f, error);
    if (status == HOST_OK)
        status = read_type(path, h.version == 1 ? h.as.v1.datatype : h.as.v2.datatype, f, error);
    if (status != HOST_OK)
        return status;
    nifti_image *image =
        h.version == 1 ? nifti_convert_n1hdr2nim(h.as.v1, NULL) : nifti_convert_n2hdr2nim(h.as.v2, NULL);
    if (!image)
        return host_fail(error, HOST_BAD_INPUT, "%s: has a NIfTI header that libnifti refuses", path);
    if (image->scl_slope != 0) {
        f->slope = image->scl_slope;
        f->inter = image->scl_inter;
    }
    status = open_data(path, image, f, error);
    read_orientation(image, f);
    nifti_image_free(image);
    return status;
}
