/* transfer.h - transfer functions: built in or read from a file, and the machine's table made from one. */
#ifndef HOST_TRANSFER_H
#define HOST_TRANSFER_H

#include "colour.h"
#include "host.h"
#include "vodr.h"

/* A control point: the function is constant beyond the first and last. */
typedef struct transfer_point {
    double value;   /* in the volume's units, or 0 to 1 over the window where the function is normalized */
    double r, g, b; /* 0 to 1, not premultiplied */
    double a;       /* opacity of one finest voxel of depth, 0 to 1 */
} transfer_point;

/* A control point of an opacity apart from the colours: the way to the next is bent as VTK's piecewise function bends
 * it (docs/transfer-functions.md). */
typedef struct transfer_opacity {
    double value;     /* as of transfer_point */
    double a;         /* 0 to 1 */
    double midpoint;  /* where, 0 to 1 of the way to the next point, the opacity is the mean of both */
    double sharpness; /* 0 linear to 1 a step */
} transfer_opacity;

/* Of a function of value and gradient magnitude: the points [first, first + count) are those at this magnitude. */
typedef struct transfer_row {
    double gradient; /* values of the volume, or windows where the function is normalized, a finest voxel; at least 0 */
    size_t first, count;
} transfer_row;

typedef struct transfer {
    const char *name;
    bool normalized;
    bool builtin;
    bool has_ct_window; /* a window of its own for CT in Hounsfield units: --window's default then */
    double ct_lo, ct_hi;
    transfer_point *points; /* values strictly ascending, of each row where there are rows; at least one */
    size_t count;
    colour_space space;          /* in which colours lie between two points */
    transfer_opacity *opacities; /* values strictly ascending; NULL: the points' own opacities, linear between them */
    size_t opacity_count;
    transfer_row *rows; /* gradients strictly ascending, linear between them, constant beyond; NULL: of values alone */
    size_t row_count;
} transfer;

/* The built-in functions' names (ramp, bone, skin-bone, vessels, mri), NULL after the last. */
const char *const *transfer_names(void);

/* A built-in function by its name, else a file, known by its content: lines of text `value r g b a`, or a colour map of
 * ParaView in JSON (docs/transfer-functions.md). `ct` says that the volume is a CT in Hounsfield units: the built-in
 * functions for CT then have points in Hounsfield units. A function of value and gradient magnitude is refused. */
host_status transfer_open(const char *name_or_path, bool ct, transfer *t, host_error *error);

/* The same, and functions of value and gradient magnitude too, of which only transfer_sample_rows() knows. */
host_status transfer_open_rows(const char *name_or_path, bool ct, transfer *t, host_error *error);
void transfer_close(transfer *t);

/* Colour (not premultiplied) and opacity per finest voxel at a value, exactly as the table samples it.
 * lo, hi: the window. */
transfer_point transfer_at(const transfer *t, double value, double lo, double hi);

/* Fills entries[0 .. 2^density_bits - 1], premultiplied, of tf_bits (8 or 16) a channel. Entry i is the function at
 * value lo + (hi - lo)*i/(2^density_bits - 1); its opacity is corrected to 1 - (1 - a)^depth, `depth` being what one
 * slice stands for, in finest voxels; 1 leaves it as written. With `full_scale` a built-in function's opacities are
 * first scaled so that the largest is 1 (maximum intensity: one sample stands for the whole ray). Every channel is
 * rounded to nearest from exact colour times opacity, so none exceeds the alpha. */
void transfer_table(const transfer *t, double lo, double hi, int density_bits, int tf_bits, double depth,
                    bool full_scale, vodr_rgba *entries);

/* The same before rounding: `count` entries, at least 2, of r, g, b, a, premultiplied; entry i is the function at value
 * lo + (hi - lo)*i/(count - 1). */
void transfer_sample(const transfer *t, double lo, double hi, int count, double depth, bool full_scale, double *rgba);

/* Of a function with rows: row_count rows, at least 2, of `count` entries; row j is the function at j/(row_count - 1)
 * of the last gradient magnitude, between two rows of the function linear in what transfer_sample() gives. *most
 * becomes that last magnitude, in windows a finest voxel. HOST_ENVIRONMENT: no memory. */
host_status transfer_sample_rows(const transfer *t, double lo, double hi, int count, int row_count, double depth,
                                 double *rgba, double *most, host_error *error);

#endif
