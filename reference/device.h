/* device.h - private to reference/: what a device does. device_cpu.c and device_cuda.cu each fill one table. */
#ifndef REFERENCE_DEVICE_H
#define REFERENCE_DEVICE_H

#include "hull.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { DEVICE_NAME_CHARS = 160 };

/* How the coefficients of B-splines are to lie for a frame: in whichever way suits the device and the axis of
 * neighbours; with `sorted` in a copy in which that axis is the fastest. */
typedef struct device_alignment {
    bool wanted, sorted;
    int32_t fast_axis, copies; /* as of reference_march_job */
} device_alignment;

/* A frame to march: every pointer lies in the host's memory. */
typedef struct device_march {
    kernel_frame frame;
    device_alignment alignment;
    reference_numbers numbers;
    kernel_mode mode;
} device_march;

/* What the samples of a cubic filter can be in each block: to be filled in. With `cells` the device keeps what they can
 * be in each cell too, for KERNEL_SKIP_CELLS. */
typedef struct device_ranges {
    bool spline, cells;
    hull_bound bound;
    int32_t edge_vox, count[3];
    float *least, *most;
    hull_scale *scale; /* of the cells' codes */
} device_ranges;

typedef struct device_ops {
    /* Puts the volume on the device; *state is closed by close(). name receives what the device is. */
    reference_status (*open)(const reference_options *options, const reference_volume *volume, void **state,
                             char name[DEVICE_NAME_CHARS], vodr_error *error);
    void (*close)(void *state);
    /* Draws all pixels. samples and draw_ms of *stats are set. */
    reference_status (*fixed)(void *state, const kernel_fixed *f, vodr_rgba *pixels, reference_stats *stats,
                              vodr_error *error);
    reference_status (*march)(void *state, const device_march *m, double *rgba, reference_stats *stats,
                              vodr_error *error);
    /* Fills the ranges of blocks; adds to preprocess_ms of *stats. */
    reference_status (*ranges)(void *state, const device_ranges *r, reference_stats *stats, vodr_error *error);
} device_ops;

extern const device_ops device_cpu;

/* NULL in a build without CUDA. */
const device_ops *device_cuda(void);

/* Writes the sentence and returns the status. */
reference_status reference_fail(vodr_error *error, reference_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Of a clock that only goes forward. */
double reference_now_ms(void);

#ifdef __cplusplus
}
#endif

#endif
