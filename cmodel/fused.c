/* fused.c - the fast path's frame: bands of rows dealt out to threads, and the machine's own walk that counts. */
#include "fused.h"

#include <pthread.h>
#include <stdlib.h>
#include <unistd.h>

#include "error.h"
#include "fused_band.h"

enum { MIN_BAND_PX = 32, MAX_THREADS = 256, MAX_MARK_BYTES = 48 << 20 };

/* What the threads share. */
typedef struct fused {
    fused_scene scene;
    const vodr_options *options;
    int32_t threads;
    pthread_mutex_t lock; /* over what follows */
    int32_t next_row_px;
    vodr_status status;
    vodr_error error;
} fused;

/* ---- marks ---- */

/* Rows of marks in all; each has room for a word beyond its last bit. */
static size_t mark_row_bytes(const vodr_view *view)
{
    return (size_t)view->width_px / 8 + 1 + sizeof(uint64_t);
}

static size_t mark_bytes(const vodr_view *view)
{
    return mark_row_bytes(view) * (size_t)view->height_px * (size_t)view->slices;
}

static bool needs_marks(const vodr_machine *m)
{
    return m->kill_transparent || m->blend != VODR_BLEND_OVER;
}

bool fused_supports(const vodr_machine *machine, const vodr_view *view)
{
    const uint16_t one = 1;
    size_t kinds = (machine->kill_transparent ? 1 : 0) + (machine->blend != VODR_BLEND_OVER ? 1 : 0);
    bool bricks_matter = machine->blend == VODR_BLEND_MIP && machine->skip_empty && !machine->kill_transparent;
    return !bricks_matter && kinds * mark_bytes(view) <= MAX_MARK_BYTES && *(const uint8_t *)&one == 1;
}

static vodr_status make_marks(fused_scene *s, vodr_error *error)
{
    size_t bytes = mark_bytes(s->view);
    bool alive = s->machine->kill_transparent, written = s->machine->blend != VODR_BLEND_OVER;
    s->marks = (marks){.row_bytes = mark_row_bytes(s->view), .height_px = s->view->height_px};
    if (alive)
        s->marks.alive = calloc(bytes, 1);
    if (written)
        s->marks.written = calloc(bytes, 1);
    if ((alive && !s->marks.alive) || (written && !s->marks.written))
        return vodr_fail(error, VODR_NO_MEMORY, "no memory for the marks of %zu bytes of fragments", bytes);
    return VODR_OK;
}

/* ---- threads ---- */

/* The next band: large ones first, so that few bricks lie in two, small ones last, so that all threads end together. */
static bool take_band(fused *f, int32_t *y0_px, int32_t *y1_px)
{
    pthread_mutex_lock(&f->lock);
    int32_t left = f->scene.view->height_px - f->next_row_px;
    int32_t rows = f->threads > 1 ? left * 6 / (5 * f->threads) : left;
    rows = rows < MIN_BAND_PX ? MIN_BAND_PX : rows;
    rows = rows < left ? rows : left;
    *y0_px = f->next_row_px;
    *y1_px = f->next_row_px += rows;
    bool more = rows > 0 && f->status == VODR_OK;
    pthread_mutex_unlock(&f->lock);
    return more;
}

static void fail(fused *f, vodr_status status, const vodr_error *error)
{
    pthread_mutex_lock(&f->lock);
    if (f->status == VODR_OK) {
        f->status = status;
        f->error = *error;
    }
    pthread_mutex_unlock(&f->lock);
}

/* Rows handed out, as a share of the frame. */
static void report(fused *f)
{
    if (!f->options->progress)
        return;
    pthread_mutex_lock(&f->lock);
    double done = (double)f->next_row_px / f->scene.view->height_px;
    pthread_mutex_unlock(&f->lock);
    f->options->progress(f->options->progress_context, done);
}

static void draw_bands(fused *f, bool calling_thread)
{
    void *room;
    vodr_error error;
    int32_t y0_px, y1_px;
    if (posix_memalign(&room, _Alignof(fused_band), sizeof(fused_band)) != 0) {
        fail(f, vodr_fail(&error, VODR_NO_MEMORY, "no memory for a thread"), &error);
        return;
    }
    fused_band *band = room;
    vodr_status status = fused_band_start(band, &f->scene, &error);
    while (status == VODR_OK && take_band(f, &y0_px, &y1_px)) {
        status = fused_band_draw(band, y0_px, y1_px, &error);
        if (calling_thread)
            report(f);
    }
    if (status != VODR_OK)
        fail(f, status, &error);
    fused_band_finish(band);
    free(band);
}

static void *thread_main(void *shared)
{
    draw_bands(shared, false);
    return NULL;
}

static int32_t thread_count(const vodr_options *options)
{
    long threads = options->threads > 0 ? options->threads : sysconf(_SC_NPROCESSORS_ONLN);
    return (int32_t)(threads < 1 ? 1 : threads > MAX_THREADS ? MAX_THREADS : threads);
}

static void count_frame(fused *f, pipeline *count)
{
    while (pipeline_step(count))
        report(f);
}

/* The calling thread counts while the others draw, and then draws with them; where counting needs marks, last. */
static vodr_status run(fused *f, pipeline *count, vodr_error *error)
{
    pthread_t threads[MAX_THREADS];
    int32_t started = 0;
    bool counts_last = needs_marks(f->scene.machine);
    if (pthread_mutex_init(&f->lock, NULL) != 0)
        return vodr_fail(error, VODR_NO_MEMORY, "no memory for a lock");
    while (started < f->threads - 1 && pthread_create(&threads[started], NULL, thread_main, f) == 0)
        started++;
    if (!counts_last)
        count_frame(f, count);
    draw_bands(f, true);
    while (started > 0)
        pthread_join(threads[--started], NULL);
    if (f->status == VODR_OK && counts_last) {
        count->marks = &f->scene.marks;
        count_frame(f, count);
    }
    pthread_mutex_destroy(&f->lock);
    if (f->status != VODR_OK && error)
        *error = f->error;
    return f->status;
}

/* ---- the frame ---- */

static vodr_status make_tables(fused_scene *s, vodr_error *error)
{
    size_t count = (size_t)1 << s->machine->density_bits;
    bool mip = s->machine->blend == VODR_BLEND_MIP;
    if (mip || s->machine->fb_bits == 8)
        s->table8 = malloc(count * sizeof *s->table8);
    else
        s->table16 = malloc(count * sizeof *s->table16);
    if (!s->table8 && !s->table16)
        return vodr_fail(error, VODR_NO_MEMORY, "no memory for a table of %zu entries", count);
    for (size_t i = 0; i < count; i++) {
        const vodr_rgba *c = &s->texture->readout[i];
        if (mip)
            s->table8[i] = s->texture->dead[i] ? 0 : (uint32_t)i | FUSED_TOUCHED;
        else if (s->table8)
            s->table8[i] = (uint32_t)c->r | (uint32_t)c->g << 8 | (uint32_t)c->b << 16 | (uint32_t)c->a << 24;
        else
            s->table16[i] = (uint64_t)c->r | (uint64_t)c->g << 16 | (uint64_t)c->b << 32 | (uint64_t)c->a << 48;
    }
    return VODR_OK;
}

static vodr_status make_frame(const fused_scene *s, vodr_error *error)
{
    vodr_frame *f = s->frame;
    *f = (vodr_frame){.width_px = s->view->width_px, .height_px = s->view->height_px, .bits = s->machine->fb_bits};
    f->bytes = (size_t)f->width_px * (size_t)f->height_px * (size_t)f->bits / 2;
    f->pixels = malloc(f->bytes);
    return f->pixels ? VODR_OK : vodr_fail(error, VODR_NO_MEMORY, "no memory for a frame of %zu bytes", f->bytes);
}

static void make_scene(fused_scene *s, const pipeline *count, const vodr_volume *volume, const vodr_options *options)
{
    const vodr_machine *m = count->machine;
    s->machine = m;
    s->walk = *m;
    s->walk.traversal = VODR_TRAVERSAL_LAYER;
    s->walk.skip_empty = 0;
    s->volume = volume;
    s->view = count->view;
    s->kernels = fused_kernels_for(options->simd);
    s->texture = &count->texture;
    s->direct = count->texture;
    s->direct.whole = true;
    s->droppable = m->blend == VODR_BLEND_OVER || m->kill_transparent;
    s->sparse = !fused_brick_edges(m, s->view, s->edge_vox);
    for (int c = 0; c < 3 && s->sparse; c++)
        s->edge_vox[c] = volume->dims_vox[c];
}

vodr_status fused_render(pipeline *count, const vodr_volume *volume, const vodr_options *options, vodr_frame *frame,
                         vodr_error *error)
{
    fused f = {.options = options, .threads = thread_count(options), .scene.frame = frame};
    fused_scene *s = &f.scene;
    make_scene(s, count, volume, options);
    vodr_status status = make_tables(s, error);
    if (status == VODR_OK)
        status = make_marks(s, error);
    if (status == VODR_OK)
        status = make_frame(s, error);
    if (status == VODR_OK)
        status = run(&f, count, error);
    free(s->table8);
    free(s->table16);
    free(s->marks.alive);
    free(s->marks.written);
    if (status != VODR_OK)
        vodr_frame_free(frame);
    return status;
}
