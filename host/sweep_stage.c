/* sweep_stage.c - a point of a sweep drawn: its values put over the fixed options, inputs shared, one call. */
#include "sweep_stage.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene.h"
#include "stage_volumes.h"

static host_status no_memory(host_error *error)
{
    return host_fail(error, HOST_ENVIRONMENT, "no memory for what the sweep draws from");
}

/* ---- opening ---- */

static const stage_machine *find_machine(const sweep_stage *s, const char *name)
{
    for (size_t i = 0; i < s->machine_count; i++)
        if (strcmp(s->machines[i].name, name) == 0)
            return &s->machines[i];
    return NULL;
}

static const stage_transfer *find_transfer(const sweep_stage *s, const char *name)
{
    for (size_t i = 0; i < s->transfer_count; i++)
        if (strcmp(s->transfers[i].name, name) == 0)
            return &s->transfers[i];
    return NULL;
}

static host_status open_machine(sweep_stage *s, const char *name, host_error *error)
{
    view_options v = *s->fixed;
    if (find_machine(s, name))
        return HOST_OK;
    v.machine = name;
    s->machines[s->machine_count].name = name;
    return view_options_overridden(&v, &s->machines[s->machine_count++].machine, error);
}

static host_status open_transfer(sweep_stage *s, const char *name, host_error *error)
{
    if (find_transfer(s, name))
        return HOST_OK;
    stage_transfer *t = &s->transfers[s->transfer_count++];
    *t = (stage_transfer){.name = name};
    host_status status = transfer_open(name, false, &t->transfers[0], error);
    return status == HOST_OK ? transfer_open(name, true, &t->transfers[1], error) : status;
}

static host_status look_at(sweep_stage *s, const char *name, host_error *error)
{
    return stage_volumes_look(s, name, error);
}

/* Calls `open` for every value of a name that varies, else for the fixed value. */
static host_status open_each(sweep_stage *s, const char *name, const char *fixed,
                             host_status (*open)(sweep_stage *s, const char *value, host_error *error),
                             host_error *error)
{
    const size_t n = sweep_plan_find(s->plan, name);
    if (n == s->plan->name_count)
        return open(s, fixed, error);
    const sweep_axis *a = &s->plan->axes[s->plan->names[n].axis];
    host_status status = HOST_OK;
    for (size_t i = 0; status == HOST_OK && i < a->count; i++)
        status = open(s, a->values[i * a->names + s->plan->names[n].column], error);
    return status;
}

static size_t count_of(const sweep_plan *plan, const char *name)
{
    const size_t n = sweep_plan_find(plan, name);
    return n == plan->name_count ? 1 : plan->axes[plan->names[n].axis].count;
}

host_status sweep_stage_open(sweep_stage *s, const sweep_plan *plan, const view_options *fixed, const char *path,
                             host_error *error)
{
    *s = (sweep_stage){.plan = plan,
                       .fixed = fixed,
                       .volume = path,
                       .machines = calloc(count_of(plan, "machine"), sizeof *s->machines),
                       .transfers = calloc(count_of(plan, "tf"), sizeof *s->transfers)};
    if (!s->machines || !s->transfers || pthread_mutex_init(&s->lock, NULL) != 0)
        return no_memory(error);
    host_status status = cost_tables_open(fixed->energy, fixed->cells, &s->tables, error);
    if (status == HOST_OK)
        status = open_each(s, "machine", fixed->machine, open_machine, error);
    if (status == HOST_OK)
        status = open_each(s, "tf", fixed->transfer, open_transfer, error);
    return status == HOST_OK ? open_each(s, "volume", path, look_at, error) : status;
}

void sweep_stage_close(sweep_stage *s)
{
    for (size_t i = 0; i < s->transfer_count; i++) {
        transfer_close(&s->transfers[i].transfers[0]);
        transfer_close(&s->transfers[i].transfers[1]);
    }
    free(s->transfers);
    free(s->machines);
    cost_tables_free(&s->tables);
    stage_volumes_free(s);
}

/* ---- drawing ---- */

/* A point's values in the place of the fixed ones. */
typedef struct settings {
    view_options view;
    const char *volume;
    const stage_transfer *transfer;
    vodr_machine machine;
} settings;

static host_status settings_at(const sweep_stage *s, uint64_t point, settings *at, host_error *error)
{
    *at = (settings){.view = *s->fixed, .volume = s->volume};
    host_status status = HOST_OK;
    for (size_t i = 0; status == HOST_OK && i < s->plan->name_count; i++) {
        const sweep_name *n = &s->plan->names[i];
        const char *value = sweep_plan_value(s->plan, i, point);
        if (n->kind == SWEEP_VOLUME)
            at->volume = value;
        else if (n->kind != SWEEP_PARAMETER)
            status =
                n->option->set(n->kind == SWEEP_CROP ? (void *)&at->view.volume : &at->view, n->option, value, error);
    }
    if (status != HOST_OK)
        return status;
    at->machine = find_machine(s, at->view.machine)->machine;
    at->transfer = find_transfer(s, at->view.transfer);
    vodr_error reason;
    for (size_t i = 0; i < s->plan->name_count; i++) {
        const sweep_name *n = &s->plan->names[i];
        if (n->kind == SWEEP_PARAMETER &&
            vodr_machine_set(&at->machine, n->name, sweep_plan_value(s->plan, i, point), &reason) != VODR_OK)
            return host_fail(error, HOST_BAD_INPUT, "--over: %s", reason.text);
    }
    return HOST_OK;
}

static host_status draw_from(const sweep_stage *s, const settings *at, const stage_volume *v, sweep_sample *sample,
                             host_error *error)
{
    double depth_vox;
    vodr_table table;
    vodr_rgba *entries;
    vodr_frame frame;
    vodr_error reason;
    host_status status = camera_view(&at->view.camera, &v->volume, &sample->view, &depth_vox, error);
    if (status == HOST_OK)
        status = scene_table(&at->machine, &at->transfer->transfers[v->ct], v->window_lo, v->window_hi, depth_vox,
                             &entries, &table, error);
    if (status != HOST_OK)
        return status;
    const vodr_options how = {.threads = 1, .path = s->fixed->path, .simd = s->fixed->simd, .cycles = s->fixed->cycles};
    vodr_status drawn =
        vodr_render(&at->machine, &v->densities, &table, &sample->view, &how, &frame, &sample->counters, &reason);
    free(entries);
    if (drawn != VODR_OK)
        return host_fail(error, drawn == VODR_NO_MEMORY ? HOST_ENVIRONMENT : HOST_BAD_INPUT, "%s", reason.text);
    status = digest_frame(&frame, sample->frame_sha256, error);
    vodr_frame_free(&frame);
    return status;
}

host_status sweep_stage_draw(sweep_stage *s, uint64_t point, sweep_sample *sample, host_error *error)
{
    settings at;
    stage_volume *v;
    bool refused;
    *sample = (sweep_sample){.refused = ""};
    host_status status = settings_at(s, point, &at, error);
    if (status != HOST_OK)
        return status;
    sample->machine = at.machine;
    status = stage_volumes_take(s, at.volume, &at.view, at.transfer, &at.machine, &v, &refused, error);
    if (status != HOST_OK)
        return status;
    if (!refused) {
        status = draw_from(s, &at, v, sample, error);
        refused = status == HOST_BAD_INPUT;
        stage_volumes_release(s, v);
    }
    if (!refused)
        return status;
    snprintf(sample->refused, sizeof sample->refused, "%s", error->text);
    return HOST_OK;
}
