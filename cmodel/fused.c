/* fused.c - the fast path (fuses volume_divider, slice_generator, rasterizer, texture_unit and alpha_blender): bands of
 * rows are dealt out to threads; each walks small bricks in visibility order, repacks one at a time and draws its
 * slices in batches. A band is one thread's alone, so every pixel meets its fragments in the machine's order. */
#include "fused.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "error.h"
#include "fused_brick.h"
#include "fused_kernels.h"
#include "rasterizer.h"
#include "slice_generator.h"

enum { MIN_BAND_PX = 16, MAX_THREADS = 256 };

/* What the threads share. */
typedef struct fused {
    const vodr_machine *machine; /* the one drawn */
    vodr_machine walk;           /* the same picture in layers of all bricks */
    bool sparse;                 /* so few samples that voxels are fetched one by one from the volume, undivided */
    texture_unit direct;         /* sparse: drawing the volume whole */
    int32_t edge_vox[3];         /* of the fast path's bricks; sparse: of the volume */
    const vodr_volume *volume;
    const vodr_view *view;
    const vodr_options *options;
    const fused_kernels *kernels;
    const int32_t *transparent_to;
    uint32_t *table8; /* the classification table, packed; one of the two */
    uint64_t *table16;
    vodr_frame *frame;
    int32_t threads;
    pthread_mutex_t lock; /* over what follows */
    int32_t next_row_px;
    vodr_status status;
    vodr_error error;
} fused;

/* Part of a batch: so many fragments on a row of the frame. */
typedef struct band_row {
    int32_t y, x, count;
} band_row;

/* One thread's brick, batch and band of rows. */
typedef struct fused_worker {
    fused *shared;
    fused_brick brick;
    fused_batch batch;
    int32_t count;              /* fragments in the batch */
    band_row rows[FUSED_BATCH]; /* where they go; none is empty */
    int32_t row_count;
    px_rect band;
    size_t stride_px; /* of a band's row, with room for a group of lanes beyond */
    void *pixels;
} fused_worker;

bool fused_supports(const vodr_machine *machine)
{
    const uint16_t one = 1;
    return pipeline_counts_alone(machine) && *(const uint8_t *)&one == 1;
}

/* Filters the batch and blends it onto the band. */
static void flush(fused_worker *w)
{
    const fused *s = w->shared;
    const fused_kernels *k = s->kernels;
    const fused_texture *t = &w->brick.texture;
    fused_batch *b = &w->batch;
    if (!s->sparse && w->brick.linear)
        (w->brick.wide ? k->linear12 : k->linear8)(t, w->count, b);
    else if (!s->sparse)
        (w->brick.wide ? k->nearest12 : k->nearest8)(t, w->count, b);
    if (s->table8)
        for (int32_t i = 0; i < w->count; i++)
            b->colour8[i] = s->table8[b->density[i]];
    else
        for (int32_t i = 0; i < w->count; i++)
            b->colour16[i] = s->table16[b->density[i]];
    for (int32_t i = 0, from = 0; i < w->row_count; i++) {
        const band_row *row = &w->rows[i];
        size_t at = (size_t)(row->y - w->band.y0) * w->stride_px + (size_t)row->x;
        if (s->table8)
            k->over8(b->colour8 + from, row->count, (uint32_t *)w->pixels + at);
        else
            k->over16(b->colour16 + from, row->count, (uint64_t *)w->pixels + at);
        from += row->count;
    }
    w->count = w->row_count = 0;
}

/* Puts a span into the batch, in pieces where it is long: positions, or when sparse densities at once. */
static void add_span(fused_worker *w, const brick_slice *slice, const span *s, fused_row *row)
{
    const fused *shared = w->shared;
    span piece = *s;
    while (piece.x0 < s->x1) {
        int32_t n = s->x1 - piece.x0, room = FUSED_BATCH - w->count;
        n = n < room ? n : room;
        piece.x1 = piece.x0 + n;
        for (int c = 0; c < 3; c++)
            row->a[c] = (uint64_t)piece.a[c];
        if (shared->sparse)
            texture_unit_filter(&shared->direct, slice, &piece, w->batch.density + w->count);
        else
            shared->kernels->address(&w->brick.texture, row, n, &w->batch, w->count);
        w->rows[w->row_count++] = (band_row){.y = s->y, .x = piece.x0, .count = n};
        w->count += n;
        piece.x0 += n;
        for (int c = 0; c < 3 && piece.x0 < s->x1; c++)
            piece.a[c] += n * slice->plane.step_u[c];
        if (w->count == FUSED_BATCH)
            flush(w);
    }
}

/* Repacks a brick that has fragments and sets the positions' origin; false when nothing of it shows. */
static bool load(fused_worker *w, const vox_box *box, fused_row *row)
{
    const vodr_view *view = w->shared->view;
    if (!fused_brick_load(&w->brick, box, w->shared->transparent_to))
        return false;
    for (int c = 0; c < 3; c++) {
        int64_t half = w->brick.linear ? (int64_t)1 << (VODR_POSITION_BITS - 1) : 0;
        row->start[c] = (uint32_t)(view->base[c] - half - ((int64_t)w->brick.origin_vox[c] << VODR_POSITION_BITS));
    }
    return true;
}

static void draw_candidate(fused_worker *w, const candidate *c)
{
    const vodr_view *view = w->shared->view;
    bool loaded = w->shared->sparse;
    fused_row row = {.shift = view->shift};
    slice_generator slices = slice_generator_start(view, &c->box, c->k0, c->k1, false);
    brick_slice slice;
    while (slice_generator_next(&slices, &slice)) {
        rasterizer rows;
        span s;
        rasterizer_start(&rows, &slice, &c->bound);
        for (int i = 0; i < 3; i++)
            row.step[i] = (uint64_t)slice.plane.step_u[i];
        while (rasterizer_next(&rows, &s)) {
            if (!loaded && !load(w, &c->box, &row))
                return;
            loaded = true;
            add_span(w, &slice, &s, &row);
        }
        /* The next slice blends onto the same pixels. */
        if (w->count)
            flush(w);
    }
}

static void store_band(const fused_worker *w)
{
    const vodr_frame *f = w->shared->frame;
    size_t pixel_bytes = (size_t)f->bits / 2, row_bytes = (size_t)f->width_px * pixel_bytes;
    for (int32_t y = w->band.y0; y < w->band.y1; y++)
        memcpy((uint8_t *)f->pixels + (size_t)y * row_bytes,
               (const uint8_t *)w->pixels + (size_t)(y - w->band.y0) * w->stride_px * pixel_bytes, row_bytes);
}

static vodr_status draw_band(fused_worker *w, vodr_error *error)
{
    const fused *s = w->shared;
    size_t bytes = w->stride_px * (size_t)(w->band.y1 - w->band.y0) * (size_t)s->frame->bits / 2;
    w->pixels = calloc(bytes, 1);
    if (!w->pixels)
        return vodr_fail(error, VODR_NO_MEMORY, "no memory for a band of %zu bytes", bytes);
    volume_divider d;
    vodr_status status =
        volume_divider_start(&d, &s->walk, s->volume, s->view, s->edge_vox, &w->band, s->transparent_to, error);
    candidate c;
    while (status == VODR_OK && volume_divider_next(&d, &c))
        draw_candidate(w, &c);
    volume_divider_finish(&d);
    if (status == VODR_OK)
        store_band(w);
    free(w->pixels);
    return status;
}

/* The next band: large ones first, so that few bricks lie in two, small ones last, so that all threads end together. */
static bool take_band(fused *s, px_rect *band)
{
    pthread_mutex_lock(&s->lock);
    int32_t left = s->view->height_px - s->next_row_px, rows = s->threads > 1 ? left / (2 * s->threads) : left;
    rows = rows < MIN_BAND_PX ? MIN_BAND_PX : rows;
    rows = rows < left ? rows : left;
    *band = (px_rect){0, s->next_row_px, s->view->width_px, s->next_row_px + rows};
    s->next_row_px += rows;
    bool more = rows > 0 && s->status == VODR_OK;
    pthread_mutex_unlock(&s->lock);
    return more;
}

static void fail(fused *s, vodr_status status, const vodr_error *error)
{
    pthread_mutex_lock(&s->lock);
    if (s->status == VODR_OK) {
        s->status = status;
        s->error = *error;
    }
    pthread_mutex_unlock(&s->lock);
}

/* Rows handed out, as a share of the frame. */
static void report(fused *s)
{
    if (!s->options->progress)
        return;
    pthread_mutex_lock(&s->lock);
    double done = (double)s->next_row_px / s->view->height_px;
    pthread_mutex_unlock(&s->lock);
    s->options->progress(s->options->progress_context, done);
}

static void draw_bands(fused *s, bool first_thread)
{
    fused_worker *w = NULL;
    vodr_error error;
    vodr_status status = VODR_OK;
    if (posix_memalign((void **)&w, 64, sizeof *w) != 0) {
        vodr_fail(&error, VODR_NO_MEMORY, "no memory for a thread");
        fail(s, VODR_NO_MEMORY, &error);
        return;
    }
    memset(w, 0, sizeof *w);
    w->shared = s;
    w->stride_px = (size_t)s->view->width_px + FUSED_LANES;
    if (!s->sparse)
        status = fused_brick_start(&w->brick, s->machine, s->volume, s->edge_vox, s->kernels, &error);
    while (status == VODR_OK && take_band(s, &w->band)) {
        status = draw_band(w, &error);
        if (first_thread)
            report(s);
    }
    if (status != VODR_OK)
        fail(s, status, &error);
    fused_brick_finish(&w->brick);
    free(w);
}

static void *thread_main(void *shared)
{
    draw_bands(shared, false);
    return NULL;
}

static vodr_status pack_table(fused *s, const vodr_rgba *colours, vodr_error *error)
{
    size_t count = (size_t)1 << s->machine->density_bits;
    if (s->machine->fb_bits == 8)
        s->table8 = malloc(count * sizeof *s->table8);
    else
        s->table16 = malloc(count * sizeof *s->table16);
    if (!s->table8 && !s->table16)
        return vodr_fail(error, VODR_NO_MEMORY, "no memory for a table of %zu entries", count);
    for (size_t i = 0; i < count; i++) {
        const vodr_rgba *c = &colours[i];
        if (s->table8)
            s->table8[i] = (uint32_t)c->r | (uint32_t)c->g << 8 | (uint32_t)c->b << 16 | (uint32_t)c->a << 24;
        else
            s->table16[i] = (uint64_t)c->r | (uint64_t)c->g << 16 | (uint64_t)c->b << 32 | (uint64_t)c->a << 48;
    }
    return VODR_OK;
}

static int32_t thread_count(const vodr_options *options)
{
    long threads = options->threads > 0 ? options->threads : sysconf(_SC_NPROCESSORS_ONLN);
    return (int32_t)(threads < 1 ? 1 : threads > MAX_THREADS ? MAX_THREADS : threads);
}

/* The calling thread counts first and then draws with the others. */
static void run_threads(fused *s, pipeline *count)
{
    pthread_t threads[MAX_THREADS];
    int32_t started = 0;
    while (started < s->threads - 1 && pthread_create(&threads[started], NULL, thread_main, s) == 0)
        started++;
    while (pipeline_step(count))
        report(s);
    draw_bands(s, true);
    while (started > 0)
        pthread_join(threads[--started], NULL);
}

vodr_status fused_render(pipeline *count, const vodr_volume *volume, const vodr_options *options, vodr_frame *frame,
                         vodr_error *error)
{
    const vodr_machine *m = count->machine;
    fused s = {.machine = m,
               .walk = *m,
               .volume = volume,
               .view = count->view,
               .options = options,
               .kernels = fused_kernels_for(options->simd),
               .transparent_to = count->texture.transparent_to,
               .frame = frame,
               .threads = thread_count(options)};
    s.walk.traversal = VODR_TRAVERSAL_LAYER;
    s.walk.skip_empty = 0;
    s.sparse = !fused_brick_edges(m, s.view, s.edge_vox);
    s.direct = count->texture;
    s.direct.whole = true;
    for (int c = 0; c < 3 && s.sparse; c++)
        s.edge_vox[c] = volume->dims_vox[c];
    frame->width_px = s.view->width_px;
    frame->height_px = s.view->height_px;
    frame->bits = m->fb_bits;
    frame->bytes = (size_t)frame->width_px * (size_t)frame->height_px * (size_t)m->fb_bits / 2;
    frame->pixels = malloc(frame->bytes);
    vodr_status status = pack_table(&s, count->texture.colours, error);
    if (status == VODR_OK && !frame->pixels)
        status = vodr_fail(error, VODR_NO_MEMORY, "no memory for a frame of %zu bytes", frame->bytes);
    if (status == VODR_OK && pthread_mutex_init(&s.lock, NULL) == 0) {
        run_threads(&s, count);
        pthread_mutex_destroy(&s.lock);
        status = s.status;
        if (status != VODR_OK && error)
            *error = s.error;
    }
    free(s.table8);
    free(s.table16);
    if (status != VODR_OK)
        vodr_frame_free(frame);
    return status;
}
