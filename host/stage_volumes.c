/* stage_volumes.c - volumes made ready for the machine, shared between threads; those idle longest go first. */
#include "stage_volumes.h"

#include <stdlib.h>
#include <string.h>

#include "scene.h"

/* Volumes that nobody uses stay as long as they take no more than this. */
static const size_t most_idle_bytes = (size_t)1 << 30;

static bool same_voxels(const stage_volume *n, const char *path, const volume_options *o)
{
    if (strcmp(n->path, path) != 0 || n->options.crop != o->crop)
        return false;
    return !o->crop || (memcmp(n->options.crop_lo, o->crop_lo, sizeof o->crop_lo) == 0 &&
                        memcmp(n->options.crop_hi, o->crop_hi, sizeof o->crop_hi) == 0);
}

static const stage_file *find_file(const sweep_stage *s, const char *path)
{
    const stage_file *f = s->files;
    while (strcmp(f->path, path) != 0)
        f++;
    return f;
}

static host_status look(sweep_stage *s, stage_file *f, host_error *error)
{
    volume_options options = s->fixed->volume;
    volume v;
    if (sweep_plan_find(s->plan, "crop") < s->plan->name_count)
        options.crop = false;
    host_status status = digest_file(f->path, f->file_sha256, error);
    if (status == HOST_OK)
        status = volume_open(f->path, &options, &v, error);
    if (status != HOST_OK)
        return status;
    status = digest_bytes(v.voxels, v.bytes, f->voxels_sha256, error);
    f->header = v;
    f->header.voxels = f->header.mapping = NULL;
    f->header.path = NULL;
    volume_close(&v);
    return status;
}

host_status stage_volumes_look(sweep_stage *s, const char *path, host_error *error)
{
    for (size_t i = 0; i < s->file_count; i++)
        if (strcmp(s->files[i].path, path) == 0)
            return HOST_OK;
    stage_file *grown = realloc(s->files, (s->file_count + 1) * sizeof *grown);
    if (!grown)
        return host_fail(error, HOST_ENVIRONMENT, "no memory for the list of volumes");
    s->files = grown;
    grown[s->file_count] = (stage_file){.path = path};
    return look(s, &grown[s->file_count++], error);
}

static void unload(sweep_stage *s, stage_volume *n)
{
    s->idle_bytes -= n->volume.bytes;
    volume_close(&n->volume);
    n->loaded = false;
}

/* Until those that nobody uses take little enough memory, the one unused longest goes. */
static void make_room(sweep_stage *s)
{
    while (s->idle_bytes > most_idle_bytes) {
        stage_volume *oldest = NULL;
        for (stage_volume *n = s->volumes; n; n = n->next)
            if (n->loaded && n->users == 0 && (!oldest || n->used < oldest->used))
                oldest = n;
        unload(s, oldest);
    }
}

/* A crop that varies may reach beyond a volume; everything else about a volume was looked at before. */
static bool crop_fits(const sweep_stage *s, const char *path, const volume_options *o, host_error *reason)
{
    const stage_file *f = find_file(s, path);
    for (int c = 0; o->crop && c < 3; c++)
        if (sweep_plan_find(s->plan, "crop") < s->plan->name_count && o->crop_hi[c] > f->header.dims_vox[c]) {
            host_fail(reason, HOST_BAD_INPUT, "--crop: the range along %c is %d:%d, must lie within 0:%d of %s",
                      "xyz"[c], o -> crop_lo[c], o -> crop_hi[c], f -> header.dims_vox[c], path);
            return false;
        }
    return true;
}

/* The node of a window, new where there is none; `opened` has its range of values. */
static stage_volume *find_node(sweep_stage *s, const stage_volume *wanted)
{
    for (stage_volume *n = s->volumes; n; n = n->next)
        if (same_voxels(n, wanted->path, &wanted->options) && n->window_lo == wanted->window_lo &&
            n->window_hi == wanted->window_hi && n->density_bits == wanted->density_bits &&
            n->coefficients == wanted->coefficients)
            return n;
    stage_volume *n = malloc(sizeof *n);
    if (!n)
        return NULL;
    *n = *wanted;
    n->next = s->volumes;
    s->volumes = n;
    return n;
}

/* Fills the range of values of *wanted: from a window that was loaded before, else from the file, left open in *opened.
 */
static host_status learn_range(sweep_stage *s, stage_volume *wanted, volume *opened, host_error *error)
{
    for (const stage_volume *n = s->volumes; n; n = n->next)
        if (same_voxels(n, wanted->path, &wanted->options)) {
            wanted->min = n->min;
            wanted->max = n->max;
            wanted->ct = n->ct;
            return HOST_OK;
        }
    host_status status = volume_open(wanted->path, &wanted->options, opened, error);
    wanted->min = opened->min;
    wanted->max = opened->max;
    wanted->ct = status == HOST_OK && volume_is_ct(opened);
    return status;
}

/* Makes the node ready, out of *opened where that is open. */
static host_status load(stage_volume *n, volume *opened, host_error *error)
{
    host_status status = HOST_OK;
    if (!opened->voxels)
        status = volume_open(n->path, &n->options, opened, error);
    if (status != HOST_OK)
        return status;
    n->volume = *opened;
    *opened = (volume){0};
    status = volume_quantise(&n->volume, n->window_lo, n->window_hi, n->density_bits, &n->densities, error);
    if (status == HOST_OK && n->coefficients)
        status = volume_coefficients(&n->volume, n->density_bits, &n->densities, error);
    n->loaded = status == HOST_OK;
    if (!n->loaded)
        volume_close(&n->volume);
    return status;
}

static host_status take(sweep_stage *s, stage_volume *wanted, const view_options *v, const stage_transfer *t,
                        volume *opened, stage_volume **taken, host_error *error)
{
    host_status status = learn_range(s, wanted, opened, error);
    if (status != HOST_OK)
        return status;
    scene_window(v, &t->transfers[wanted->ct], wanted->ct, wanted->min, wanted->max, &wanted->window_lo,
                 &wanted->window_hi);
    stage_volume *n = find_node(s, wanted);
    if (!n)
        return host_fail(error, HOST_ENVIRONMENT, "no memory for the list of volumes");
    if (!n->loaded)
        status = load(n, opened, error);
    else if (n->users == 0)
        s->idle_bytes -= n->volume.bytes;
    if (status != HOST_OK)
        return status;
    n->users++;
    n->used = ++s->uses;
    *taken = n;
    return HOST_OK;
}

host_status stage_volumes_take(sweep_stage *s, const char *path, const view_options *v, const stage_transfer *t,
                               const vodr_machine *m, stage_volume **taken, bool *refused, host_error *error)
{
    stage_volume wanted = {.path = path,
                           .options = v->volume,
                           .density_bits = m->density_bits,
                           .coefficients = m->filter == VODR_FILTER_BSPLINE};
    volume opened = {0};
    *refused = !crop_fits(s, path, &v->volume, error);
    if (*refused)
        return HOST_OK;
    pthread_mutex_lock(&s->lock);
    host_status status = take(s, &wanted, v, t, &opened, taken, error);
    pthread_mutex_unlock(&s->lock);
    volume_close(&opened);
    return status;
}

void stage_volumes_release(sweep_stage *s, stage_volume *taken)
{
    pthread_mutex_lock(&s->lock);
    if (--taken->users == 0) {
        s->idle_bytes += taken->volume.bytes;
        make_room(s);
    }
    pthread_mutex_unlock(&s->lock);
}

void stage_volumes_free(sweep_stage *s)
{
    for (stage_volume *n = s->volumes, *next; n; n = next) {
        next = n->next;
        volume_close(&n->volume);
        free(n);
    }
    s->volumes = NULL;
    free(s->files);
    s->files = NULL;
}
