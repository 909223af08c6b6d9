/* render.c - `vodr render`: a volume through the machine into a picture, its statistics, and the machine's inputs. */
#include <stdio.h>

#include "commands.h"
#include "cosim_options.h"
#include "cycle_stats.h"
#include "draw.h"
#include "image.h"
#include "output_set.h"
#include "registers.h"
#include "stats.h"
#include "text.h"
#include "view_options.h"

enum { PNG, RAW, STATS, REGISTERS, OUTPUTS };

static const char *const output_option[OUTPUTS] = {"output", "raw", "stats", "registers"};

typedef struct render_options {
    view_options view;
    output_set outputs;
    cosim_choice cosim;
} render_options;

static const option rows[] = {
    {"output", 'o', "OUT.png", false, output_set_path, "the picture, 8 or 16 bits a channel as fb_bits says"},
    {"raw", 0, "OUT.rgba", false, output_set_path,
     "the frame: rows top to bottom, premultiplied RGBA, 8 bits,\n"
     "or 16 bits little endian"},
    {"stats", 0, "OUT.json", false, output_set_path, "what the machine counted"},
    {"registers", 0, "OUT.json", false, output_set_path, "what the machine was given: registers, parameters, table"},
    {"repeat", 0, "N", false, output_set_repeat, "draw N times, 1 to 1000, and report the median time (1)"},
};
static const option_table table = {"Output (none is required):", rows, sizeof rows / sizeof *rows};

/* ---- output ---- */

typedef struct drawn {
    const render_options *options;
    const scene *scene;
    const result *result;
} drawn;

static host_status write_one(void *context, int i, output *o, host_error *error)
{
    const drawn *d = context;
    const view_options *v = &d->options->view;
    switch (i) {
    case PNG: return image_write_png(o, &d->result->frame, &v->style, error);
    case RAW: return image_write_raw(o, &d->result->frame, error);
    case STATS: return stats_write(o, d->scene, v, d->result, error);
    default: return registers_write(o, d->scene, v, error);
    }
}

static void print_cycles(const vodr_counters *c)
{
    char each[48] = "", bottleneck[192];
    if (c->fragments)
        snprintf(each, sizeof each, "  (%.3f a fragment)", (double)c->cycles.total / (double)c->fragments);
    text_print_count("cycles", c->cycles.total, each);
    cycle_stats_bottleneck(&c->cycles, bottleneck, sizeof bottleneck);
    printf("bottleneck         %s\n", bottleneck);
}

static void print_summary(const render_options *options, const scene *s, const result *r)
{
    const vodr_counters *c = &r->counters;
    char rate[48] = "";
    if (c->hits + c->misses)
        snprintf(rate, sizeof rate, "  (hit rate %.4f %%)", 100 * stats_hit_rate(c));
    scene_print_volume(s);
    printf("frame              %dx%d pixels of %d slices, machine %s\n", s->view.width_px, s->view.height_px,
           s->view.slices, s->machine_name);
    text_print_count("fragments", c->fragments, "");
    text_print_count("hits", c->hits, rate);
    text_print_count("misses", c->misses, "");
    text_print_count("write-backs", c->writebacks, "");
    text_print_count("frame buffer", c->fb_read_bytes, " bytes read");
    text_print_count("", c->fb_write_bytes, " bytes written");
    text_print_count("texture load", c->texture_load_bytes, " bytes");
    text_print_count("bricks", c->bricks, "");
    text_print_count("brick visits", c->brick_visits, "");
    if (options->view.cycles)
        print_cycles(c);
    printf("time               %.6f s, %.1f million fragments a second\n", r->wall_s, stats_fragments_per_s(r) / 1e6);
    printf("frame_sha256       %s\n", r->frame_sha256);
}

static host_status render(const char *path, render_options *options, host_error *error)
{
    scene s;
    result r = {.repeat = 0};
    view_options *v = &options->view;
    v->cycles |= options->cosim.any;
    draw_options how = {.label = "drawing",
                        .threads = v->threads,
                        .path = v->path,
                        .simd = v->simd,
                        .cycles = v->cycles,
                        .repeat = options->outputs.repeat,
                        .cosim = options->cosim.any ? &options->cosim.cosim : NULL};
    host_status status = output_set_check(&options->outputs, v, path, error);
    if (status == HOST_OK)
        status = cosim_choice_check(&options->cosim, options->outputs.path[PNG], error);
    if (status == HOST_OK)
        status = scene_open(path, &options->view, &s, error);
    if (status != HOST_OK)
        return status;
    status = draw(&s, &s.machine, &how, &r, error);
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
    render_options options = {.view = view_options_default(),
                              .outputs = {.option = output_option, .count = OUTPUTS, .repeat = 1},
                              .cosim = cosim_choice_default()};
    void *const targets[] = {&options.outputs, &options.cosim,       &options.view,
                             &options.view,    &options.view.volume, &options.view};
    const char *operands[OPTION_OPERANDS];
    bool help;
    host_status status = options_parse(&command_render, argc, argv, targets, operands, &help, error);
    if (status == HOST_OK && !help)
        status = render(operands[0], &options, error);
    cosim_choice_free(&options.cosim);
    view_options_free(&options.view);
    return status;
}

const command command_render = {
    .name = "render",
    .operands = {"VOLUME"},
    .required = 1,
    .summary = "draw a volume with the machine: the picture, and what it cost",
    .example = "  vodr render head.nrrd -o head.png --tf skin-bone --view -30,20 --size 512x512 --stats head.json",
    .tables = {&table, &option_cosim, &option_view, &option_machine, &option_volume, &option_picture},
    .run = run,
};
