/* volume.h - a volume file in memory: its voxels, spacing and orientation, and its densities for the machine. */
#ifndef HOST_VOLUME_H
#define HOST_VOLUME_H

#include "host.h"
#include "vodr.h"

typedef enum volume_type {
    VOLUME_UINT8,
    VOLUME_INT8,
    VOLUME_UINT16,
    VOLUME_INT16,
    VOLUME_UINT32,
    VOLUME_INT32,
    VOLUME_FLOAT32,
} volume_type;

/* What the command line says about a volume beyond its path; all-zero means nothing. */
typedef struct volume_options {
    int32_t dims_vox[3]; /* raw files: --dims; 0 = not given. Files with a header must agree with it */
    volume_type type;    /* raw files: --type */
    bool big_endian;     /* raw files: --endian big */
    double spacing[3];   /* raw files: --spacing; 0 = 1 */
    bool crop;           /* --crop: half-open voxel ranges in the file's axes */
    int32_t crop_lo[3], crop_hi[3];
    bool no_orient; /* --no-orient */
} volume_options;

/* Geometry is in the file's axes, x fastest. The world's axes are the viewer's at view 0,0: 0 right, 1 up, 2 towards
 * the eye. World axis w runs along file axis axis[w], in its direction (sign[w] = 1) or against it (-1). */
typedef struct volume {
    char *path;
    int32_t dims_vox[3];
    double spacing[3]; /* positive, finite; the file's unit of length */
    int axis[3], sign[3];
    volume_type type;    /* as in the file; float64 is read as VOLUME_FLOAT32 */
    double slope, inter; /* a voxel's value is stored*slope + inter (NIfTI's scl; else 1, 0) */
    double min, max;     /* values, over the finite voxels; 0 where there is none */
    uint64_t nonfinite;  /* NaN and infinite voxels of float volumes: they count as the minimum */
    const char *format;  /* "nrrd", "nifti", "raw" */
    void *voxels;        /* stored voxels, native byte order; densities after volume_quantise() of a wider file */
    size_t bytes;        /* of voxels */
    void *mapping;       /* where voxels lie in a private mapping of the file: its start and length; else NULL */
    size_t mapping_bytes;
    bool quantised;    /* volume_quantise() was called */
    uint16_t map[256]; /* volume_quantise(): density of each byte of an 8-bit file */
} volume;

/* Reads `path` by its content: NRRD, NIfTI, or raw where options give dims. On success the volume owns its memory until
 * volume_close(). Needs no more memory than the voxels themselves and 64 MiB. On failure *v is zeroed. */
host_status volume_open(const char *path, const volume_options *options, volume *v, host_error *error);
void volume_close(volume *v);

/* The same without a voxel being read: voxels is NULL, min, max and nonfinite are 0. */
host_status volume_open_header(const char *path, const volume_options *options, volume *v, host_error *error);

/* Number of voxels. */
size_t volume_count(const volume *v);

/* The value of voxel i (slope and inter applied, nonfinite as the minimum). Not after volume_quantise(). */
double volume_value(const volume *v, size_t i);

/* The least and greatest values in the box [lo, hi), as of volume_value() before volume_quantise(); where one is not
 * finite the least is -INFINITY. */
void volume_box_range(const volume *v, const int32_t lo[3], const int32_t hi[3], double *least, double *most);

/* A copy of the box [lo, hi), with the range of the whole; to be closed on success. */
host_status volume_cut(const volume *v, const int32_t lo[3], const int32_t hi[3], volume *out, host_error *error);

/* Whether the values look like a CT in Hounsfield units: their minimum is below -500. */
bool volume_is_ct(const volume *v);

/* Fills *out with what the machine draws: a value lo becomes density 0, hi the largest of density_bits (8 or 12),
 * linear between and rounded to nearest (half up), clamped outside; lo = hi sends all to 0. 8-bit files keep their
 * voxels and get a map; wider ones are converted in place and give the rest of their memory back. *out lives as long as
 * the volume. Callable once. */
host_status volume_quantise(volume *v, double lo, double hi, int density_bits, vodr_volume *out, host_error *error);

/* Turns densities that volume_quantise() made into the coefficients that filter=bspline takes (spline.h); they replace
 * the volume's voxels. */
host_status volume_coefficients(volume *v, int density_bits, vodr_volume *densities, host_error *error);

const char *volume_type_name(volume_type type);

/* Bytes of a stored voxel. */
size_t volume_type_bytes(volume_type type);

/* The type called `name` ("uint8", ...); false if there is none. */
bool volume_type_named(const char *name, volume_type *type);

#endif
