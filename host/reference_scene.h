/* reference_scene.h - a scene on the reference renderer: its voxels, transfer function and rays as reference/ takes
 * them. */
#ifndef HOST_REFERENCE_SCENE_H
#define HOST_REFERENCE_SCENE_H

#include "reference.h"
#include "scene.h"

typedef enum reference_method { REFERENCE_SLICES, REFERENCE_RAYCAST } reference_method;

/* What `vodr reference` may be asked for beyond the view. */
typedef struct reference_choice {
    reference_device device;
    reference_method method;
    bool fixed;                /* the machine's own arithmetic; else: */
    reference_numbers numbers; /* and all that follows */
    reference_accel accel;
    reference_filter filter; /* a cubic; else the machine's is drawn with */
    reference_shading shading;
    reference_theta theta;
    int32_t copies;  /* as of reference_march_job */
    double step_vox; /* raycast: finest voxels between samples */
    int32_t block_vox;
    double termination; /* a ray ends at this opacity; 1: never */
} reference_choice;

typedef struct reference_scene {
    const scene *scene;
    bool fixed;
    reference *renderer;
    reference_march_job job;
    double *table; /* of the job, owned */
} reference_scene;

/* Brings voxels into a form that floating point reads, as reference_scene_open() does, by the volume's min;
 * volume_value() is not for them any more. */
reference_volume reference_scene_store(volume *v);

/* What a scene, whose volume's min is known, is as a job on such voxels; its table is new, to be freed. */
host_status reference_scene_job(const scene *s, const reference_choice *choice, double **table,
                                reference_march_job *job, host_error *error);

/* Puts the volume of `s`, opened by scene_open_stored(), on the device; the voxels become densities (fixed), or are
 * brought into a form that floating point reads: integers counted from the least, those of 32 bits rounded to float32,
 * what is not finite replaced by the minimum. To be closed on success, before the scene is; callable once a
 * scene. HOST_ENVIRONMENT where there is no device, or no room on it. */
host_status reference_scene_open(scene *s, const reference_choice *choice, int32_t threads, vodr_simd simd,
                                 reference_scene *r, host_error *error);
void reference_scene_close(reference_scene *r);

/* Draws a frame of the machine's fb_bits, to be freed by vodr_frame_free(). */
host_status reference_scene_draw(const reference_scene *r, vodr_frame *frame, reference_stats *stats,
                                 host_error *error);

/* Decibels of the scene's frame, not quantised, against that of `best`, over all channels of all pixels: INFINITY where
 * none differs. Draws both. */
host_status reference_scene_psnr(const reference_scene *r, double *psnr_db, host_error *error);

/* The filter that a scene is drawn with. */
reference_filter reference_scene_filter(const scene *s, const reference_choice *c);

/* What a failure of reference/ is as an exit code. */
host_status reference_scene_status(reference_status status);

#endif
