/* scene.h - everything a frame is drawn from, made from the shared options: machine, volume, table, registers. */
#ifndef HOST_SCENE_H
#define HOST_SCENE_H

#include "costs.h"
#include "host.h"
#include "transfer.h"
#include "view_options.h"
#include "vodr.h"
#include "volume.h"

/* Not to be copied: densities point into volume. */
typedef struct scene {
    const char *machine_name;
    vodr_machine machine;
    volume volume;
    double window_lo, window_hi;
    transfer transfer;
    vodr_volume densities;
    camera camera; /* its size and slices as drawn */
    vodr_view view;
    double depth_vox; /* distance between slices in finest voxels */
    vodr_table table;
    vodr_rgba *entries; /* of table, owned */
    cost_tables tables;
} scene;

/* Opens the volume and computes all of *s, to be closed on success. */
host_status scene_open(const char *path, const view_options *options, scene *s, host_error *error);
void scene_close(scene *s);

/* The same but for densities and table: the volume keeps the voxels of its file. With `rows` the transfer function may
 * be one of value and gradient magnitude too. */
host_status scene_open_stored(const char *path, const view_options *options, bool rows, scene *s, host_error *error);

/* The same without a voxel being read: machine and header alone. Once the volume's min and max are set,
 * scene_settle() makes the rest, `rows` as above. */
host_status scene_open_header(const char *path, const view_options *options, scene *s, host_error *error);
host_status scene_settle(scene *s, const view_options *options, bool rows, host_error *error);

/* Makes those of a scene opened by scene_open_stored() without rows. */
host_status scene_quantise(scene *s, host_error *error);

/* The first lines of a summary: the volume, its window and transfer function. */
void scene_print_volume(const scene *s);

/* The window: as given, else the transfer function's own for a CT in Hounsfield units, else the data's range. */
void scene_window(const view_options *o, const transfer *t, bool ct, double min, double max, double *lo, double *hi);

/* The machine's table for slices so far apart; free() the entries. */
host_status scene_table(const vodr_machine *m, const transfer *t, double lo, double hi, double depth_vox,
                        vodr_rgba **entries, vodr_table *made, host_error *error);

#endif
