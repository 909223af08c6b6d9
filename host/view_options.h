/* view_options.h - the options that all drawing subcommands share: volume, view, machine, picture. */
#ifndef HOST_VIEW_OPTIONS_H
#define HOST_VIEW_OPTIONS_H

#include "camera.h"
#include "image.h"
#include "options.h"
#include "vodr.h"
#include "volume.h"

/* One of --set, --blend, --filter, --traversal: applied to the machine in the order given. */
typedef struct machine_override {
    const char *option; /* for error sentences */
    char *parameter;    /* owned */
    const char *value;
} machine_override;

/* Strings belong to argv. */
typedef struct view_options {
    camera camera;
    volume_options volume;
    const char *transfer;
    bool has_window;
    double window_lo, window_hi;
    const char *machine;
    machine_override *overrides;
    size_t override_count;
    const char *energy; /* a file; NULL: hw/energy.txt */
    const char *cells;  /* a file, beside rtl/synthesis.txt; NULL: none */
    int32_t threads;    /* 0 = all cores */
    vodr_path path;
    vodr_simd simd;
    bool cycles; /* count cycles too */
    image_style style;
} view_options;

/* Each takes a view_options as its target, except option_volume, which takes a volume_options. */
extern const option_table option_view, option_machine, option_volume, option_picture;

view_options view_options_default(void);
void view_options_free(view_options *v);

/* Whether an output may be written: it is none of the files that are read, `input` and those of the options, and it can
 * be. */
host_status view_options_output(const view_options *v, const char *input, const char *path, host_error *error);

/* Adds what --`option` PARAM=VALUE would; the parameter's name is the first n characters. */
host_status view_options_override(view_options *v, const char *option, const char *parameter, size_t n,
                                  const char *value, host_error *error);

/* The machine that --machine names: a named one or a file (a name that holds a '/' or that a file has). */
host_status view_options_named_machine(const char *name, vodr_machine *machine, host_error *error);

/* That machine with the overrides applied. */
host_status view_options_overridden(const view_options *v, vodr_machine *machine, host_error *error);

/* The same, checked that it can be built. */
host_status view_options_machine(const view_options *v, vodr_machine *machine, host_error *error);

#endif
