/* report.c - `vodr report`: a frame, what it cost and why, as one page to look at. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "draw.h"
#include "report_data.h"
#include "report_page.h"
#include "view_options.h"

typedef struct report_options {
    view_options view;
    const char *path; /* NULL: not given */
    char *command;    /* owned */
} report_options;

static host_status set_output(void *target, const option *o, const char *value, host_error *error)
{
    (void)o, (void)error;
    ((report_options *)target)->path = value;
    return HOST_OK;
}

static const option rows[] = {
    {"output", 'o', "OUT.html", false, set_output, "the page; it must be given"},
};
static const option_table table = {"Output:", rows, sizeof rows / sizeof *rows};

/* ---- drawing ---- */

/* The named machine's organisation with the picture parameters of `picture`, so that it draws the same frame. */
static host_status peer_machine(const char *name, const vodr_machine *picture, vodr_machine *machine, host_error *error)
{
    size_t count;
    const vodr_parameter *parameters = vodr_parameters(&count);
    vodr_error reason;
    vodr_status status = vodr_machine_named(name, machine, &reason);
    for (size_t i = 0; status == VODR_OK && i < count; i++) {
        char value[64];
        vodr_machine_get(picture, &parameters[i], value, sizeof value);
        if (parameters[i].picture)
            status = vodr_machine_set(machine, parameters[i].name, value, &reason);
    }
    return status == VODR_OK ? HOST_OK : host_fail(error, HOST_BAD_INPUT, "%s: %s", name, reason.text);
}

static draw_options drawing(const report_options *options, const char *label, const vodr_observer *observer)
{
    const view_options *v = &options->view;
    return (draw_options){.label = label,
                          .threads = v->threads,
                          .path = v->path,
                          .simd = v->simd,
                          .cycles = true,
                          .repeat = 1,
                          .observer = observer};
}

static host_status draw_peer(const scene *s, const report_options *options, const result *own, report_peer *peer,
                             host_error *error)
{
    vodr_machine machine;
    char label[64];
    snprintf(label, sizeof label, "drawing on %s", peer->machine);
    draw_options how = drawing(options, label, NULL);
    result r = {.repeat = 0};
    host_status status = peer_machine(peer->machine, &s->machine, &machine, error);
    if (status == HOST_OK)
        status = draw(s, &machine, &how, &r, error);
    peer->counters = r.counters;
    peer->same_frame = status == HOST_OK && strcmp(r.frame_sha256, own->frame_sha256) == 0;
    vodr_frame_free(&r.frame);
    return status;
}

static host_status write_page(void *context, output *o, host_error *error)
{
    return report_page_write(o, context, error);
}

static host_status draw_all(const scene *s, const report_options *options, report_trace *trace, host_error *error)
{
    report_peer peers[REPORT_PEERS] = {{.machine = "paper-general"}, {.machine = "paper-16"}, {.machine = "paper-32"}};
    vodr_observer observer = report_trace_observer(trace);
    draw_options how = drawing(options, "drawing", &observer);
    result own = {.repeat = 0};
    host_status status = draw(s, &s->machine, &how, &own, error);
    for (int i = 0; status == HOST_OK && i < REPORT_PEERS; i++)
        status = draw_peer(s, options, &own, &peers[i], error);
    report r = {s, &options->view, &own, trace, peers, options->command};
    bool quiet = output_is_stdout(options->path);
    if (status == HOST_OK)
        status = output_write(options->path, write_page, &r, error);
    if (status == HOST_OK && !quiet)
        printf("written            %s\n", options->path);
    vodr_frame_free(&own.frame);
    return status;
}

static host_status make_report(const char *path, const report_options *options, host_error *error)
{
    if (!options->path)
        return host_fail(error, HOST_BAD_INPUT, "report needs --output (-o) OUT.html");
    scene s;
    report_trace trace;
    host_status status = view_options_output(&options->view, path, options->path, error);
    if (status == HOST_OK)
        status = scene_open(path, &options->view, &s, error);
    if (status != HOST_OK)
        return status;
    status = report_trace_start(&trace, &s.view, error);
    if (status == HOST_OK) {
        status = draw_all(&s, options, &trace, error);
        report_trace_free(&trace);
    }
    scene_close(&s);
    return status;
}

static host_status run(int argc, char **argv, host_error *error)
{
    report_options options = {.view = view_options_default()};
    options.view.cycles = true;
    void *const targets[] = {&options, &options.view, &options.view, &options.view.volume, &options.view};
    const char *operands[OPTION_OPERANDS];
    bool help;
    host_status status = options_parse(&command_report, argc, argv, targets, operands, &help, error);
    if (status == HOST_OK && !help)
        status = options_quote(&command_report, argc, argv, NULL, &options.command, error);
    if (status == HOST_OK && !help)
        status = make_report(operands[0], &options, error);
    free(options.command);
    view_options_free(&options.view);
    return status;
}

const command command_report = {
    .name = "report",
    .operands = {"VOLUME"},
    .required = 1,
    .summary = "draw a volume and show what it cost, and where, on one HTML page",
    .example = "  vodr report head.nrrd -o head.html --tf skin-bone --view -30,20 --size 512x512 --traversal tile",
    .tables = {&table, &option_view, &option_machine, &option_volume, &option_picture},
    .run = run,
};
