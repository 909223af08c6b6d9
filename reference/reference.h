/* reference.h - the public interface of the reference renderer: the pictures that the machine is held against.
 *
 * A reference holds one volume on one device: the CPU, or a CUDA card. Both run the kernels of kernel_*.h, compiled
 * from the same lines. reference_fixed() draws in the machine's own arithmetic, written from docs/architecture.md
 * alone; reference_march() follows each pixel's ray in floating point, over the machine's slices or at steps of its
 * own.
 *
 * Errors: a function that can fail returns a status and writes one sentence to its vodr_error. No global mutable state;
 * one reference is used by one thread at a time. */
#ifndef REFERENCE_H
#define REFERENCE_H

#include "vodr.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum reference_status {
    REFERENCE_OK = 0,
    REFERENCE_INVALID,   /* an input is outside what can be drawn; the sentence says which, and the range */
    REFERENCE_NO_MEMORY, /* the host or the device is out of memory */
    REFERENCE_NO_DEVICE, /* there is no CUDA card, or this build has no CUDA */
} reference_status;

typedef enum reference_device { REFERENCE_CPU, REFERENCE_CUDA } reference_device;

/* How a voxel is stored. */
typedef enum reference_voxel { REFERENCE_UINT8, REFERENCE_UINT16, REFERENCE_FLOAT32 } reference_voxel;

/* x fastest, then y, then z, native byte order; the caller owns the voxels and keeps them until reference_close().
 * Floats are finite.
 *
 * It may be a part of a larger volume: whole_vox is the size of that one, 0 where it is whole, and origin_vox where in
 * it the first voxel lies. */
typedef struct reference_volume {
    int32_t dims_vox[3];
    reference_voxel type;
    const void *voxels;
    int32_t whole_vox[3], origin_vox[3];
} reference_volume;

typedef struct reference_options {
    reference_device device;
    int32_t threads; /* CPU: 0 = as many as there are cores */
    vodr_simd simd;  /* CPU: which instructions; none changes a byte */
} reference_options;

typedef struct reference reference;

/* Puts a volume on a device; *r is to be closed on success. A volume that the card has no room for is refused before
 * anything is allocated. */
reference_status reference_open(const reference_options *options, const reference_volume *volume, reference **r,
                                vodr_error *error);
void reference_close(reference *r);

/* What the device is: "NVIDIA H100 80GB HBM3", or "CPU, 2 threads, avx512". */
const char *reference_device_name(const reference *r);

/* What drawing a frame took. */
typedef struct reference_stats {
    uint64_t samples;     /* footprints fetched: of the volume at sample positions, and around them for gradients */
    double draw_ms;       /* the kernel alone: on the card between two events, on the CPU by the clock */
    double prepare_ms;    /* tables of the transfer function, and what is derived of the blocks under it */
    double preprocess_ms; /* what is derived of the volume alone, where this call was the first to need it */
    int32_t copies;       /* aligned: of the coefficients that there are for views of all sides: 3, or 1; else 0 */
    double theta_deg;     /* aligned-paper: by how much the picture was turned */
    double turn_ms;       /* aligned-paper: what turning it back took, on the CPU */
} reference_stats;

/* ---- the machine's arithmetic ---- */

/* Draws what vodr_render() draws, to the byte: `map` and the stored voxels are those of a vodr_volume. Frame as of
 * vodr_render(), to be freed with vodr_frame_free(). */
reference_status reference_fixed(reference *r, const vodr_machine *machine, const uint16_t *map,
                                 const vodr_table *table, const vodr_view *view, vodr_frame *frame,
                                 reference_stats *stats, vodr_error *error);

/* ---- floating point ---- */

typedef enum reference_numbers {
    REFERENCE_FLOAT,
    REFERENCE_DOUBLE,  /* CPU only */
    REFERENCE_TEXTURE, /* float, but weights have 8 fraction bits as in a card's texture unit, which filters on CUDA;
                          not of cubics */
} reference_numbers;

typedef enum reference_blend { REFERENCE_OVER, REFERENCE_MIP } reference_blend;
/* The cubics weight 64 voxels: REFERENCE_CARDINAL is the Catmull-Rom spline through the voxels, REFERENCE_BSPLINE the
 * cubic B-spline through them, of coefficients that are computed once. Beyond the volume voxels, or coefficients, go on
 * as they are at its border. */
typedef enum reference_filter {
    REFERENCE_NEAREST,
    REFERENCE_LINEAR,
    REFERENCE_CARDINAL,
    REFERENCE_BSPLINE,
} reference_filter;
typedef enum reference_shading { REFERENCE_UNLIT, REFERENCE_PHONG } reference_shading;

/* How what does not show is passed over, and how what is sampled is read; none changes a byte, but the last two. */
typedef enum reference_accel {
    REFERENCE_ACCEL_NONE,
    REFERENCE_ACCEL_BLOCK,   /* a block that is transparent, or cannot raise the maximum, is left at its far side */
    REFERENCE_ACCEL_BISECT,  /* mip: the same, its far side found by bisection */
    REFERENCE_ACCEL_SEED,    /* mip: the same, and the middle sample of the ray comes first */
    REFERENCE_ACCEL_BEST,    /* the fastest there is; over: blocks know how far the nearest visible one is; mip: the
                                samples of the greatest bounds first; cubics: cells are passed over too */
    REFERENCE_ACCEL_RIVAL,   /* cubics: blocks bounded by what the worst voxels between their extremes could give */
    REFERENCE_ACCEL_HULL,    /* cubics: blocks bounded by their cells' Bezier points */
    REFERENCE_ACCEL_ALIGNED, /* B-splines: none's samples; pixels that go together, and copies of the coefficients, are
                                such that neighbours read memory side by side */
    REFERENCE_ACCEL_ALIGNED_BEST,  /* B-splines: best's samples, read likewise */
    REFERENCE_ACCEL_ALIGNED_PAPER, /* B-splines: none's picture, turned until its rows run along an axis of the volume,
                                      and turned back, which rounds it */
    REFERENCE_ACCEL_UNSAFE, /* cubics: the rival's bound with a margin of one axis alone, M + (M - m)/8, which loses
                               what three axes overshoot: to be seen in tests and measurements */
    REFERENCE_ACCELS,
} reference_accel;

/* What a picture of REFERENCE_ACCEL_ALIGNED_PAPER is turned for: that pixels side by side are where neighbouring voxels
 * are, on the volume's face that is looked at, or as projected to the image. */
typedef enum reference_theta { REFERENCE_THETA_BOX, REFERENCE_THETA_PLANE } reference_theta;

bool reference_is_cubic(reference_filter filter);

bool reference_accel_is_aligned(reference_accel accel);

/* Whether a blend of a filter's samples has an accel. */
bool reference_accel_suits(reference_accel accel, reference_blend blend, reference_filter filter);

/* The rays of a frame. With o = origin[0] + x*origin[1] + y*origin[2] and d likewise, sample j, 0 the nearest, lies at
 * o + (first + j*spacing)*d, in voxels. */
typedef struct reference_camera {
    int32_t width_px, height_px;
    int32_t first_px[2];                  /* x and y of the first pixel that is drawn, left and top, in the picture */
    double origin[3][3], direction[3][3]; /* [constant, per x, per y][axis] */
    double first, spacing;
    int64_t most;          /* samples on a ray, in the volume or not */
    bool by_length;        /* d is brought to a length of one finest voxel first, and nothing nearer than a depth of one
                              finest voxel counts; d has a depth of one */
    double spacing_vox[3]; /* of the volume: finest voxels that a voxel is long */
} reference_camera;

/* The machine's own slices, nearest first. */
reference_camera reference_camera_slices(const vodr_view *view);

/* Samples `step_vox` finest voxels apart along each ray, the first half a step behind the near face of the volume's
 * depth (parallel), or the eye (perspective). spacing_vox: finest voxels that a voxel is long. */
reference_camera reference_camera_rays(const vodr_view *view, const double spacing_vox[3], double step_vox);

/* A transfer function sampled evenly: entry (g, v) of `columns` values by `rows` gradient magnitudes, premultiplied
 * r, g, b, a as doubles, the opacity that of one sample. Between entries it is linear. */
typedef struct reference_table {
    int32_t columns, rows; /* at least 2 and 1 */
    const double *rgba;
    double gradient_most; /* gradient magnitude of the last row, in windows a finest voxel; 0 with one row */
} reference_table;

typedef struct reference_march_job {
    reference_camera camera;
    reference_numbers numbers;
    reference_blend blend;
    reference_filter filter;
    reference_shading shading;
    reference_accel accel;
    reference_theta theta;
    int32_t copies;    /* aligned: 3, of the coefficients, one for each axis that is looked along most, or 1; 0: 3 where
                          the    device has room */
    int32_t block_vox; /* edge of a block, 2 to VODR_MAX_DIM_VOX; mip's best has blocks of its own */
    double termination; /* a ray ends at this opacity; above 1: never */
    reference_table table;
    double window_scale, window_offset; /* place in the window, 0 to 1 = stored*scale + offset */
    int32_t lo_vox[3], hi_vox[3];       /* only samples in [lo, hi) of the whole volume are drawn; 0, 0, 0: all */
    bool stored;                        /* mip: a pixel is the greatest stored value three times and 1, or four zeros */
} reference_march_job;

/* Voxels beside a box, at each of its sides that is not the whole volume's, that samples in it read. */
int32_t reference_border_vox(const reference_march_job *job);

/* What a march without `stored` gives for pixels drawn with it, rgba[4*count] in place. The maximum of several parts'
 * pixels gives what one march of the whole does, to the bit of a CPU's. */
reference_status reference_show_stored(const reference_march_job *job, double *rgba, size_t count, vodr_error *error);

/* Draws premultiplied r, g, b, a a pixel, 0 to 1, rows top to bottom, into rgba[4*width_px*height_px]. Of a part, what
 * the samples of [lo, hi) show, each to the bit as drawn of the whole volume: the parts' pixels, laid over one another
 * in the order along the rays, are the whole's but for the rounding of sums. Mip has of a part no accel but none and
 * best. */
reference_status reference_march(reference *r, const reference_march_job *job, double *rgba, reference_stats *stats,
                                 vodr_error *error);

/* Rounds to the nearest of 8 or 16 bits. *frame is new. */
reference_status reference_quantise(const reference_camera *camera, const double *rgba, int32_t bits, vodr_frame *frame,
                                    vodr_error *error);

#ifdef __cplusplus
}
#endif

#endif
