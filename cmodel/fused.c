/* fused.c - the fast path's frame: bands of rows dealt out to threads, and the machine's own walk that counts. */
#include "fused.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <unistd.h>

#include "error.h"
#include "fused_painter.h"

enum { MIN_BAND_PX = 16, SPARSE_BANDS = 4, MAX_THREADS = 256, MAX_MARK_BYTES = 48 << 20 };

/* What the threads share. */
typedef struct fused {
    fused_scene scene;
    const vodr_options *options;
    int32_t threads;
    int32_t tasks_done;   /* of the calling thread's two */
    double told;          /* the share that was told last */
    atomic_int waiting;   /* threads without a band */
    pthread_mutex_t lock; /* over what follows */
    pthread_cond_t changed;
    int32_t next_row_px, band_px; /* rows that nobody has yet, and how many are taken at once */
    int32_t drawing;              /* bands that are being drawn, or given away */
    bool given;
    fused_band gift;
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

static void fail(fused *f, vodr_status status, const vodr_error *error)
{
    if (f->status == VODR_OK) {
        f->status = status;
        f->error = *error;
    }
}

/* Told of the calling thread's own progress, in one of its two tasks; all threads go through the same bricks. A band
 * that another thread gives away may be less far than the last: nothing is told then, as progress never falls. */
static void report(fused *f, double done)
{
    const double all = (f->tasks_done + done) / 2;
    if (!f->options->progress || all < f->told)
        return;
    f->told = all;
    f->options->progress(f->options->progress_context, all);
}

/* Rows that nobody has, or rows that another thread gives away; false when there will be none. Holds the lock. */
static bool take_band(fused *f, fused_band *band)
{
    vodr_error error;
    int32_t height = f->scene.view->height_px, y0 = f->next_row_px, left = height - y0;
    if (f->status == VODR_OK && left > 0) {
        f->next_row_px += f->band_px < left ? f->band_px : left;
        f->drawing++;
        vodr_status status = fused_band_start(band, &f->scene, y0, f->next_row_px, &error);
        if (status != VODR_OK)
            fail(f, status, &error);
        return true;
    }
    atomic_fetch_add(&f->waiting, 1);
    while (!f->given && f->drawing > 0)
        pthread_cond_wait(&f->changed, &f->lock);
    atomic_fetch_sub(&f->waiting, 1);
    bool taken = f->given;
    if (taken) {
        *band = f->gift;
        f->given = false;
    }
    return taken;
}

/* Gives half of a band to a thread that waits, if enough is left to be worth it: the bricks across the cut will be
 * repacked by both. */
static void share_band(fused *f, fused_band *band)
{
    vodr_error error;
    int32_t rows = band->px.y1 - band->px.y0;
    double left = rows * (1 - volume_divider_done(&band->divider));
    if (rows < 2 * MIN_BAND_PX || left * f->threads < MIN_BAND_PX)
        return;
    pthread_mutex_lock(&f->lock);
    if (atomic_load(&f->waiting) > 0 && !f->given) {
        vodr_status status = fused_band_split(band, band->px.y0 + rows / 2, &f->gift, &error);
        if (status == VODR_OK) {
            f->given = true;
            f->drawing++;
        } else {
            fused_band_finish(&f->gift);
            fail(f, status, &error);
        }
        pthread_cond_broadcast(&f->changed);
    }
    pthread_mutex_unlock(&f->lock);
}

static void draw_band(fused *f, fused_painter *painter, fused_band *band, bool calling_thread)
{
    candidate c;
    while (volume_divider_next(&band->divider, &c)) {
        fused_painter_draw(painter, band, &c);
        if (atomic_load_explicit(&f->waiting, memory_order_relaxed) > 0)
            share_band(f, band);
        if (calling_thread)
            report(f, volume_divider_done(&band->divider));
    }
    fused_band_store(band);
}

/* Draws bands until there are no more. */
static void draw_bands(fused *f, bool calling_thread)
{
    void *room = NULL;
    vodr_error error;
    fused_band band;
    vodr_status status = VODR_OK;
    if (posix_memalign(&room, _Alignof(fused_painter), sizeof(fused_painter)) != 0)
        status = vodr_fail(&error, VODR_NO_MEMORY, "no memory for a thread");
    fused_painter *painter = room;
    if (status == VODR_OK)
        status = fused_painter_start(painter, &f->scene, &error);
    pthread_mutex_lock(&f->lock);
    if (status != VODR_OK)
        fail(f, status, &error);
    while (take_band(f, &band)) {
        bool good = f->status == VODR_OK;
        pthread_mutex_unlock(&f->lock);
        if (good)
            draw_band(f, painter, &band, calling_thread);
        fused_band_finish(&band);
        pthread_mutex_lock(&f->lock);
        f->drawing--;
        pthread_cond_broadcast(&f->changed);
    }
    pthread_mutex_unlock(&f->lock);
    if (painter)
        fused_painter_finish(painter);
    free(painter);
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
        report(f, pipeline_done(count));
}

/* The calling thread counts while the others draw, and then draws with them; where counting needs marks, last. */
static vodr_status run(fused *f, pipeline *count, vodr_error *error)
{
    pthread_t threads[MAX_THREADS];
    int32_t started = 0;
    bool counts_last = needs_marks(f->scene.machine);
    if (pthread_mutex_init(&f->lock, NULL) != 0)
        return vodr_fail(error, VODR_NO_MEMORY, "no memory for a lock");
    if (pthread_cond_init(&f->changed, NULL) != 0) {
        pthread_mutex_destroy(&f->lock);
        return vodr_fail(error, VODR_NO_MEMORY, "no memory for a lock");
    }
    while (started < f->threads - 1 && pthread_create(&threads[started], NULL, thread_main, f) == 0)
        started++;
    if (!counts_last) {
        count_frame(f, count);
        f->tasks_done++;
    }
    draw_bands(f, true);
    while (started > 0)
        pthread_join(threads[--started], NULL);
    if (f->status == VODR_OK && counts_last) {
        f->tasks_done++;
        count->marks = &f->scene.marks;
        count_frame(f, count);
    }
    pthread_cond_destroy(&f->changed);
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
    s->cubic = filter_is_cubic(m);
    for (int c = 0; c < 3 && s->sparse; c++)
        s->edge_vox[c] = volume->dims_vox[c];
}

vodr_status fused_render(pipeline *count, const vodr_volume *volume, const vodr_options *options, vodr_frame *frame,
                         vodr_error *error)
{
    fused f = {.options = options, .threads = thread_count(options), .scene.frame = frame};
    fused_scene *s = &f.scene;
    make_scene(s, count, volume, options);
    /* Bands are cut when a thread is in want of one. Without bricks there is no place to cut, and nothing to lose. */
    f.band_px = s->sparse ? 1 + count->view->height_px / (SPARSE_BANDS * f.threads) : count->view->height_px;
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
