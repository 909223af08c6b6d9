/* volume_raw.c - files without a header: --dims, --type, --spacing and --endian say what they hold. */
#include "volume_file.h"

#include <errno.h>
#include <string.h>

/* A DICOM file has these four letters behind a preamble of 128 bytes. */
static bool is_dicom(const char *path)
{
    char start[132] = "";
    FILE *file = fopen(path, "rb");
    size_t n = file ? fread(start, 1, sizeof start, file) : 0;
    if (file)
        fclose(file);
    return n == sizeof start && memcmp(start + 128, "DICM", 4) == 0;
}

host_status volume_raw_header(const char *path, const volume_options *options, volume_file *f, host_error *error)
{
    if (!options->dims_vox[0] && is_dicom(path))
        return host_fail(error, HOST_BAD_INPUT, "%s: is a DICOM file, must be NRRD, NIfTI or raw: dcm2niix makes NIfTI",
                         path);
    if (!options->dims_vox[0])
        return host_fail(error, HOST_BAD_INPUT, "%s: is neither NRRD nor NIfTI, so it needs --dims XxYxZ", path);
    f->format = "raw";
    f->exact = true;
    f->big_endian = options->big_endian;
    f->type = options->type;
    for (int i = 0; i < 3; i++) {
        f->dims_vox[i] = options->dims_vox[i];
        f->spacing[i] = options->spacing[i] == 0 ? 1 : options->spacing[i];
    }
    f->data_path = strdup(path);
    if (!f->data_path)
        return host_fail(error, HOST_ENVIRONMENT, "%s: out of memory", path);
    f->data = fopen(path, "rb");
    if (!f->data)
        return host_fail(error, HOST_BAD_INPUT, "%s: %s", path, strerror(errno));
    return HOST_OK;
}
