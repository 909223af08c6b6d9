/* volume_file.h - private to the volume readers: what a file's header says, before a voxel is read.
 *
 * volume_nrrd.c, volume_nifti.c and volume_raw.c fill a volume_file; volume.c checks it; volume_voxels.c reads the
 * voxels, whatever the format. */
#ifndef HOST_VOLUME_FILE_H
#define HOST_VOLUME_FILE_H

#include "volume.h"

#include <stdio.h>

typedef enum volume_encoding {
    VOLUME_PLAIN, /* bytes as in memory */
    VOLUME_GZIP,
    VOLUME_TEXT, /* numbers between blanks or commas */
} volume_encoding;

typedef struct volume_file {
    const char *format;
    char *data_path; /* the file that holds the voxels, for sentences; owned */
    FILE *data;      /* open where the voxels or their gzip stream begin; owned */
    volume_encoding encoding;
    uint64_t skip_bytes; /* VOLUME_GZIP: bytes of the stream before the voxels */
    bool exact;          /* nothing may follow the voxels */
    bool big_endian;
    bool float64; /* stored as float64, read as VOLUME_FLOAT32 */
    volume_type type;
    int64_t dims_vox[3];
    double spacing[3];      /* of each file axis; negative where it runs backwards */
    bool oriented;          /* direction counts, else the file's axes are the world's */
    double direction[3][3]; /* [file axis][world axis], of any length */
    double slope, inter;
} volume_file;

/* Each reads the header of the file at path. On failure *f may be partly filled; volume_file_close() either way. */
host_status volume_nrrd_header(const char *path, volume_file *f, host_error *error);
host_status volume_nifti_header(const char *path, volume_file *f, host_error *error);
host_status volume_raw_header(const char *path, const volume_options *options, volume_file *f, host_error *error);
void volume_file_close(volume_file *f);

/* Whether the file at path begins like one. *damaged: it is a gzip file that cannot be read, so nobody knows. */
bool volume_is_nrrd(const char *path);
bool volume_is_nifti(const char *path, bool *damaged);

/* The NIfTI header beside the voxels of a .hdr/.img pair, given the .img; NULL if path is no .img or none is there. The
 * caller frees it. */
char *volume_nifti_header_beside(const char *path);

/* Refuses dimensions outside 1 to VODR_MAX_DIM_VOX. */
host_status volume_check_dims(const char *path, const int64_t dims_vox[3], host_error *error);

/* Reads the voxels of the box [lo, hi) into v->voxels, v->bytes and v->mapping. Sizes are checked against the file
 * before memory is taken. Needs v->type. */
host_status volume_read_voxels(const volume_file *f, const int32_t lo[3], const int32_t hi[3], volume *v,
                               host_error *error);

/* Frees v->voxels. */
void volume_free_voxels(volume *v);

/* Whether this computer stores the high byte first. */
static inline bool volume_native_big_endian(void)
{
    const uint16_t one = 1;
    return *(const uint8_t *)&one == 0;
}

#endif
