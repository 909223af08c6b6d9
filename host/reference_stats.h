/* reference_stats.h - what a frame of the reference renderer took, as JSON (--stats). */
#ifndef HOST_REFERENCE_STATS_H
#define HOST_REFERENCE_STATS_H

#include "digest.h"
#include "draw.h"
#include "output.h"
#include "reference_options.h"

/* What drawing gave; the frame is freed with vodr_frame_free(). */
typedef struct reference_result {
    vodr_frame frame;
    char device[160];
    uint64_t samples;
    double wall_s;        /* median of the repetitions: all but loading and preprocessing */
    double kernel_ms;     /* the same of the kernel alone */
    double preprocess_ms; /* what was derived of the volume alone, once */
    int32_t copies;       /* these as of reference_stats */
    double theta_deg, turn_ms;
    double psnr_db; /* aligned-paper: against the usual frame */
    int repeat;
    char frame_sha256[DIGEST_CHARS];
} reference_result;

/* Samples a second of wall_s; 0 when the time is too short to measure. */
double reference_samples_per_s(const reference_result *r);

host_status reference_stats_write(output *o, const scene *s, const view_options *v, const reference_choice *c,
                                  const reference_result *r, host_error *error);

#endif
