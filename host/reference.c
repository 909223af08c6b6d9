/* reference.c - `vodr reference`: a volume through the reference renderer, in the machine's arithmetic or in floating
 * point, on the CPU or on a CUDA card. */
#include <stdio.h>
#include <stdlib.h>

#include "commands.h"
#include "image.h"
#include "output_set.h"
#include "progress.h"
#include "reference_options.h"
#include "reference_stats.h"
#include "text.h"

enum { PNG, RAW, STATS, OUTPUTS };

static const char *const output_option[OUTPUTS] = {"output", "raw", "stats"};

typedef struct command_options {
    view_options view;
    reference_wish wish;
    output_set outputs;
} command_options;

static const option rows[] = {
    {"output", 'o', "OUT.png", false, output_set_path, "the picture, 8 or 16 bits a channel as fb_bits says"},
    {"raw", 0, "OUT.rgba", false, output_set_path,
     "the frame: rows top to bottom, premultiplied RGBA, 8 bits,\n"
     "or 16 bits little endian"},
    {"stats", 0, "OUT.json", false, output_set_path, "samples, times, the frame's hash"},
    {"repeat", 0, "N", false, output_set_repeat, "draw N times, 1 to 1000, and report the median time (1)"},
};
static const option_table table = {"Output (none is required):", rows, sizeof rows / sizeof *rows};

/* ---- drawing ---- */

static void add_stats(reference_result *r, const reference_stats *s)
{
    r->samples = s->samples;
    r->preprocess_ms += s->preprocess_ms;
    r->copies = s->copies;
    r->theta_deg = s->theta_deg;
    r->turn_ms = s->turn_ms;
}

static host_status draw_all(const reference_scene *drawing, reference_result *r, double *times_s, double *kernel_ms,
                            host_error *error)
{
    host_status status = HOST_OK;
    for (int i = 0; status == HOST_OK && i < r->repeat; i++) {
        reference_stats stats;
        vodr_frame_free(&r->frame);
        double begin_s = progress_now_s();
        status = reference_scene_draw(drawing, &r->frame, &stats, error);
        times_s[i] = progress_now_s() - begin_s - stats.preprocess_ms * 1e-3;
        kernel_ms[i] = stats.draw_ms;
        add_stats(r, &stats);
    }
    return status;
}

static host_status draw_scene(scene *s, const command_options *options, reference_result *r, host_error *error)
{
    reference_scene drawing;
    const view_options *v = &options->view;
    host_status status = reference_scene_open(s, &options->wish.choice, v->threads, v->simd, &drawing, error);
    if (status != HOST_OK)
        return status;
    snprintf(r->device, sizeof r->device, "%s", reference_device_name(drawing.renderer));
    double *times = malloc(2 * (size_t)r->repeat * sizeof *times);
    if (times)
        status = draw_all(&drawing, r, times, times + r->repeat, error);
    else
        status = host_fail(error, HOST_ENVIRONMENT, "no memory");
    if (status == HOST_OK) {
        r->wall_s = draw_median(times, r->repeat);
        r->kernel_ms = draw_median(times + r->repeat, r->repeat);
    }
    free(times);
    if (status == HOST_OK && options->wish.choice.accel == REFERENCE_ACCEL_ALIGNED_PAPER)
        status = reference_scene_psnr(&drawing, &r->psnr_db, error);
    reference_scene_close(&drawing);
    return status == HOST_OK ? digest_frame(&r->frame, r->frame_sha256, error) : status;
}

/* ---- output ---- */

typedef struct drawn {
    const command_options *options;
    const scene *scene;
    const reference_result *result;
} drawn;

static host_status write_one(void *context, int i, output *o, host_error *error)
{
    const drawn *d = context;
    const view_options *v = &d->options->view;
    switch (i) {
    case PNG: return image_write_png(o, &d->result->frame, &v->style, error);
    case RAW: return image_write_raw(o, &d->result->frame, error);
    default: return reference_stats_write(o, d->scene, v, &d->options->wish.choice, d->result, error);
    }
}

/* What alignment came to. */
static void print_alignment(const reference_choice *c, const reference_result *r)
{
    const bool no_room =
        r->copies == 1 && c->copies != 1 && (c->device == REFERENCE_CUDA || c->accel == REFERENCE_ACCEL_ALIGNED_PAPER);
    if (r->copies > 0)
        printf("coefficients       %d %s%s\n", r->copies, r->copies == 1 ? "copy" : "copies",
               no_room ? ": there is no room for three" : "");
    if (c->accel == REFERENCE_ACCEL_ALIGNED_PAPER)
        printf("turned             by %.3f degrees, and back: PSNR %.2f dB against the usual frame\n", r->theta_deg,
               r->psnr_db);
}

static void print_summary(const command_options *options, const scene *s, const reference_result *r)
{
    const reference_choice *c = &options->wish.choice;
    scene_print_volume(s);
    printf("frame              %dx%d pixels, ", s->view.width_px, s->view.height_px);
    if (c->method == REFERENCE_RAYCAST)
        printf("rays of a sample every %g voxels\n", c->step_vox);
    else
        printf("%d slices\n", s->view.slices);
    printf("numbers            %s%s%s\n", reference_numbers_name(c),
           c->fixed ? ", machine " : ", empty space: ", c->fixed ? s->machine_name : reference_accel_name(c));
    printf("filter             %s\n", reference_filter_name(c, s));
    print_alignment(c, r);
    printf("device             %s\n", r->device);
    text_print_count("samples", r->samples, "");
    printf("time               %.6f s, %.1f million samples a second\n", r->wall_s, reference_samples_per_s(r) / 1e6);
    printf("frame_sha256       %s\n", r->frame_sha256);
}

static host_status draw_and_write(const char *path, command_options *options, host_error *error)
{
    scene s;
    reference_result r = {.repeat = options->outputs.repeat};
    host_status status = reference_wish_settle(&options->wish, &options->view, error);
    if (status == HOST_OK)
        status = output_set_check(&options->outputs, &options->view, path, error);
    if (status == HOST_OK)
        status = scene_open_stored(path, &options->view, !options->wish.choice.fixed, &s, error);
    if (status != HOST_OK)
        return status;
    status = draw_scene(&s, options, &r, error);
    bool summary = !output_set_takes_stdout(&options->outputs);
    if (status == HOST_OK)
        status = output_set_write(&options->outputs, write_one, &(drawn){options, &s, &r}, error);
    if (status == HOST_OK && summary) {
        print_summary(options, &s, &r);
        output_set_print(&options->outputs);
    }
    vodr_frame_free(&r.frame);
    scene_close(&s);
    return status;
}

static host_status run(int argc, char **argv, host_error *error)
{
    command_options options = {.view = view_options_default(),
                               .wish = reference_wish_default(),
                               .outputs = {.option = output_option, .count = OUTPUTS, .repeat = 1}};
    void *const targets[] = {&options.outputs, &options.wish,        &options.view,
                             &options.view,    &options.view.volume, &options.view};
    const char *operands[OPTION_OPERANDS];
    bool help;
    host_status status = options_parse(&command_reference, argc, argv, targets, operands, &help, error);
    if (status == HOST_OK && !help)
        status = draw_and_write(operands[0], &options, error);
    view_options_free(&options.view);
    return status;
}

const command command_reference = {
    .name = "reference",
    .operands = {"VOLUME"},
    .required = 1,
    .summary = "draw the same frame with the reference renderer, in float or as the machine",
    .example = "  vodr reference head.nrrd -o head.png --tf skin-bone --view -30,20 --size 512x512 --method raycast\n"
               "  vodr reference head.nrrd --numbers fixed --raw head.rgba    # equal to the byte to vodr render's",
    .tables = {&table, &option_reference, &option_view, &option_machine, &option_volume, &option_picture},
    .run = run,
};
