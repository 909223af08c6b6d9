/* test_volume_divider.c - brick size, the walk over the bricks, and its order (docs/architecture.md, section 4).
 * A walk is judged by the frame's samples: each must lie in exactly one candidate, and along each pixel the candidates
 * must come in the order of the samples. */
#include "volume_divider.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lib/unit.h"

static const int32_t opaque[4096]; /* transparent_to[] of a table that shows everything but density 0; not used */

static vodr_volume volume_of(const int32_t dims[3], const void *voxels)
{
    return (vodr_volume){.dims_vox = {dims[0], dims[1], dims[2]}, .voxel_bytes = 1, .voxels = voxels};
}

/* T of the page. */
static int32_t plain_tile(const vodr_machine *m)
{
    int32_t t = 1;
    while ((int64_t)(t + 1) * (t + 1) * m->fb_bits / 2 <= m->cache_bytes)
        t++;
    return t;
}

static int32_t plain_edge(const vodr_machine *m, uint32_t footprint)
{
    int64_t t = plain_tile(m), n = 0, bytes = (m->density_bits == 8 ? 1 : 2) * (m->double_buffer ? 2 : 1);
    int64_t border = m->filter == VODR_FILTER_LINEAR ? 2 : 0;
    if (m->traversal == VODR_TRAVERSAL_WHOLE)
        return 0;
    if (m->brick)
        return m->brick;
    while ((n + 1) * footprint <= t << 20 &&
           (n + 1 + border) * (n + 1 + border) * (n + 1 + border) * bytes <= m->texture_memory_bytes)
        n++;
    return (int32_t)(n < m->brick_min ? m->brick_min : n);
}

static void the_edge_is_the_formula(void **state)
{
    (void)state;
    rng c = {101};
    for (int round = 0; round < 20000; round++) {
        vodr_machine m = vodr_machine_default();
        m.traversal = (int32_t)rng_int(&c, 0, 3);
        m.cache_bytes = 64 << rng_int(&c, 0, 14);
        m.fb_bits = rng_one_in(&c, 2) ? 16 : 8;
        m.density_bits = rng_one_in(&c, 2) ? 12 : 8;
        m.double_buffer = rng_one_in(&c, 2);
        m.filter = rng_one_in(&c, 2) ? VODR_FILTER_NEAREST : VODR_FILTER_LINEAR;
        m.brick = rng_one_in(&c, 8) ? (int32_t)rng_int(&c, 1, 4096) : 0;
        m.brick_min = rng_one_in(&c, 2) ? 1 : (int32_t)rng_int(&c, 1, 64);
        m.texture_memory_bytes = (int32_t)(rng_next(&c) >> rng_int(&c, 35, 57)) + 64;
        vodr_view v = {.footprint = (uint32_t)(rng_next(&c) >> rng_int(&c, 32, 50)) + 1};
        assert_int_equal(volume_divider_edge(&m, &v), plain_edge(&m, v.footprint));
    }
    vodr_machine m = vodr_machine_default();
    vodr_view v = {.footprint = 1 << 20};
    assert_int_equal(volume_divider_edge(&m, &v), 32); /* the paper's */
    v.footprint = 1;
    assert_int_equal(volume_divider_edge(&m, &v), 48); /* 50^3 twice is 250,000 bytes */
    v.footprint = UINT32_MAX;
    assert_int_equal(volume_divider_edge(&m, &v), 8);
}

/* Starts a walk in the bricks that the machine takes: cubes, or the whole volume. */
static void start(volume_divider *d, const vodr_machine *m, const vodr_volume *v, const vodr_view *view,
                  const int32_t *transparent_to)
{
    int32_t edge = volume_divider_edge(m, view);
    const int32_t cube[3] = {edge, edge, edge};
    const px_rect frame = {0, 0, view->width_px, view->height_px};
    assert_int_equal(volume_divider_start(d, m, v, view, edge ? cube : v->dims_vox, &frame, transparent_to, NULL),
                     VODR_OK);
}

/* The place of each index along an axis, by the page's words. */
static void plain_axis(const vodr_view *v, int c, int32_t size, int32_t edge, int32_t count, bool under, int32_t *place)
{
    int32_t eye = count, sequence[64], n = 0;
    if (v->perspective) {
        int64_t voxel = v->base[c] >> 24;
        eye = v->base[c] < 0 ? -1 : voxel >= size ? count : (int32_t)(voxel / edge);
        for (int32_t i = 0; i < count && i < eye; i++)
            sequence[n++] = i;
        for (int32_t i = count - 1; i > eye; i--)
            sequence[n++] = i;
        if (eye >= 0 && eye < count)
            sequence[n++] = eye;
    } else {
        for (int32_t i = 0; i < count; i++)
            sequence[n++] = v->step_s[c] >= 0 ? i : count - 1 - i;
    }
    for (int32_t i = 0; i < count; i++)
        place[sequence[i]] = under ? count - 1 - i : i;
}

static int plain_dominant(const vodr_view *v)
{
    int dominant = 0;
    wide_int largest = -1;
    for (int c = 0; c < 3; c++) {
        wide_int d = v->step_s[c];
        if (v->perspective)
            d = 2 * d + (wide_int)(v->width_px - 1) * v->step_u[c] + (wide_int)(v->height_px - 1) * v->step_v[c];
        d = d < 0 ? -d : d;
        dominant = d >= largest ? c : dominant;
        largest = d >= largest ? d : largest;
    }
    return dominant;
}

/* One walk and the frame it is judged by. */
typedef struct walk {
    vodr_machine machine;
    vodr_view view;
    int32_t dims[3], edge[3], count[3], tile, columns; /* edge: of a brick */
    int32_t bricks, places;                            /* places: tiles times bricks */
    px_rect window;
    int32_t place[3][64]; /* of an index in its axis's order */
    candidate *visited;   /* by tile and brick; k1 = 0 where there is none */
    int64_t *rank;        /* likewise: when it came */
} walk;

static void start_walk(walk *w, volume_divider *d)
{
    const vodr_machine *m = &w->machine;
    vodr_error error;
    vodr_volume v = volume_of(w->dims, NULL);
    if (volume_divider_start(d, m, &v, &w->view, w->edge, &w->window, opaque, &error) != VODR_OK)
        fail_msg("%s", error.text);
    w->bricks = 1;
    for (int c = 0; c < 3; c++) {
        w->count[c] = w->dims[c] / w->edge[c] + (w->dims[c] % w->edge[c] != 0);
        assert_true(w->count[c] <= 64);
        assert_int_equal(d->bricks[c], w->count[c]);
        w->bricks *= w->count[c];
        plain_axis(&w->view, c, w->dims[c], w->edge[c], w->count[c], m->blend == VODR_BLEND_UNDER, w->place[c]);
    }
    w->tile = m->traversal == VODR_TRAVERSAL_TILE ? plain_tile(m) : VODR_MAX_SIZE_PX;
    w->columns = (w->view.width_px + w->tile - 1) / w->tile;
    w->places = w->columns * ((w->view.height_px + w->tile - 1) / w->tile) * w->bricks;
    w->visited = calloc((size_t)w->places, sizeof *w->visited);
    w->rank = calloc((size_t)w->places, sizeof *w->rank);
    assert_true(w->visited && w->rank);
}

/* Where a candidate must come in the walk: tile, then the three loops from the outermost. */
static int64_t plain_rank(const walk *w, int32_t tile, const int32_t index[3])
{
    int dominant = plain_dominant(&w->view), nest[3], n = 0;
    bool column = w->machine.traversal == VODR_TRAVERSAL_COLUMN;
    if (!column)
        nest[n++] = dominant;
    for (int c = 2; c >= 0; c--)
        if (c != dominant)
            nest[n++] = c;
    if (column)
        nest[n] = dominant;
    int64_t rank = tile;
    for (n = 0; n < 3; n++)
        rank = rank * w->count[nest[n]] + w->place[nest[n]][index[nest[n]]];
    return rank;
}

/* Takes a candidate down, checking it against the page. Returns its rank. */
static int64_t take(walk *w, const candidate *k)
{
    int32_t index[3], number = 0, tile = (k->bound.y0 / w->tile) * w->columns + k->bound.x0 / w->tile;
    for (int c = 2; c >= 0; c--) {
        index[c] = k->box.lo[c] / w->edge[c];
        assert_int_equal(k->box.lo[c], index[c] * w->edge[c]);
        int32_t end = (index[c] + 1) * w->edge[c];
        assert_int_equal(k->box.hi[c], end < w->dims[c] ? end : w->dims[c]);
        number = number * w->count[c] + index[c];
    }
    assert_int_equal(k->brick, number);
    assert_true(k->bound.x0 >= w->window.x0 && k->bound.y0 >= w->window.y0 && k->bound.x1 <= w->window.x1 &&
                k->bound.y1 <= w->window.y1 && k->k0 >= 0 && k->k1 <= w->view.slices);
    assert_int_equal((k->bound.y1 - 1) / w->tile * w->columns + (k->bound.x1 - 1) / w->tile, tile);
    size_t place = (size_t)tile * (size_t)w->bricks + (size_t)number;
    assert_int_equal(w->visited[place].k1, 0); /* once */
    w->visited[place] = *k;
    w->rank[place] = plain_rank(w, tile, index);
    return w->rank[place];
}

/* Every sample in the volume lies in a candidate, and the pixel's candidates come in the order of its slices. */
static void check_pixel(const walk *w, int32_t x, int32_t y)
{
    bool under = w->machine.blend == VODR_BLEND_UNDER;
    int64_t last = -1;
    for (int32_t n = 0; n < w->view.slices; n++) {
        int32_t k = under ? w->view.slices - 1 - n : n, number = 0;
        const int32_t origin[3] = {0, 0, 0};
        int64_t position[3];
        unit_position(&w->view, x, y, k, position);
        if (!unit_inside(position, origin, w->dims))
            continue;
        for (int c = 2; c >= 0; c--)
            number = number * w->count[c] + (int32_t)(position[c] >> 24) / w->edge[c];
        size_t place = (size_t)(y / w->tile * w->columns + x / w->tile) * (size_t)w->bricks + (size_t)number;
        const candidate *v = &w->visited[place];
        assert_true(unit_inside(position, v->box.lo, v->box.hi));
        assert_true(x >= v->bound.x0 && x < v->bound.x1 && y >= v->bound.y0 && y < v->bound.y1);
        assert_true(k >= v->k0 && k < v->k1);
        assert_true(w->rank[place] >= last);
        last = w->rank[place];
    }
}

/* Boxes bounded in a tile below loop `level`, the loops outside it standing at `first` to `last`. */
static int64_t plain_boxes(const walk *w, const projection *p, const px_rect *tile, int level, int32_t first[3],
                           int32_t last[3])
{
    bool column = w->machine.traversal == VODR_TRAVERSAL_COLUMN;
    int dominant = plain_dominant(&w->view), other[2], n = 0;
    for (int c = 2; c >= 0; c--)
        if (c != dominant)
            other[n++] = c;
    int axis = column ? (level < 2 ? other[level] : dominant) : level > 0 ? other[level - 1] : dominant;
    int64_t boxes = 0;
    for (int32_t i = 0; i < w->count[axis]; i++) {
        vox_box box;
        px_rect bound;
        int32_t k0, k1;
        first[axis] = last[axis] = i;
        for (int c = 0; c < 3; c++) {
            int32_t end = (last[c] + 1) * w->edge[c];
            box.lo[c] = first[c] * w->edge[c];
            box.hi[c] = end < w->dims[c] ? end : w->dims[c];
        }
        boxes++;
        if (projection_bound(p, &box, tile, &bound, &k0, &k1) && level < 2)
            boxes += plain_boxes(w, p, tile, level + 1, first, last);
    }
    first[axis] = 0;
    last[axis] = w->count[axis] - 1;
    return boxes;
}

/* Cycles of the search, by docs/timing.md, section 2. */
static int64_t plain_search(const walk *w)
{
    projection p = projection_of(&w->view, w->dims);
    int64_t boxes = 0;
    for (int32_t y = w->window.y0; y < w->window.y1; y += w->tile)
        for (int32_t x = w->window.x0; x < w->window.x1; x += w->tile) {
            px_rect tile = {x, y, x + w->tile < w->window.x1 ? x + w->tile : w->window.x1,
                            y + w->tile < w->window.y1 ? y + w->tile : w->window.y1};
            int32_t first[3] = {0, 0, 0}, last[3] = {w->count[0] - 1, w->count[1] - 1, w->count[2] - 1};
            boxes += plain_boxes(w, &p, &tile, 0, first, last);
        }
    return boxes * w->machine.brick_setup_cycles;
}

static void run_walk(walk *w)
{
    volume_divider d;
    candidate k;
    int64_t last = -1, work = 0;
    double done = 0;
    start_walk(w, &d);
    while (volume_divider_next(&d, &k)) {
        int64_t rank = take(w, &k);
        assert_true(rank > last);
        last = rank;
        double now = volume_divider_done(&d);
        assert_true(now >= done && now < 1);
        done = now;
        work += volume_divider_work(&d);
    }
    assert_int_equal(work + volume_divider_work(&d), plain_search(w));
    for (int32_t y = w->window.y0; y < w->window.y1; y++)
        for (int32_t x = w->window.x0; x < w->window.x1; x++)
            check_pixel(w, x, y);
    volume_divider_finish(&d);
    free(w->visited);
    free(w->rank);
}

static walk random_walk(rng *c, bool perspective)
{
    walk w = {.machine = vodr_machine_default()};
    for (int i = 0; i < 3; i++)
        w.dims[i] = (int32_t)rng_int(c, 1, 40);
    volume geometry = unit_volume(w.dims[0], w.dims[1], w.dims[2]);
    w.view = rng_one_in(c, 2) ? unit_camera_view(c, &geometry, perspective) : views_wild(c, w.dims, perspective);
    w.machine.traversal = (int32_t)rng_int(c, 0, 3);
    w.machine.blend = rng_one_in(c, 2) ? VODR_BLEND_UNDER : VODR_BLEND_OVER;
    w.machine.cache_bytes = 64 << rng_int(c, 0, 6);
    int32_t cube = rng_one_in(c, 2) ? (int32_t)rng_int(c, 1, 20) : 0;
    for (int i = 0; i < 3; i++) {
        w.edge[i] = cube ? cube : (int32_t)rng_int(c, 1, 20);
        w.edge[i] = w.machine.traversal == VODR_TRAVERSAL_WHOLE ? w.dims[i] : w.edge[i];
    }
    w.window = (px_rect){0, 0, w.view.width_px, w.view.height_px};
    if (w.machine.traversal != VODR_TRAVERSAL_TILE && rng_one_in(c, 3)) {
        w.window.x0 = (int32_t)rng_int(c, 0, w.view.width_px - 1);
        w.window.y1 = (int32_t)rng_int(c, 1, w.view.height_px);
    }
    return w;
}

/* Cases 1 and 2 of the paper: faces, edges and corners towards the viewer. */
static void parallel_walks(void **state)
{
    (void)state;
    rng c = {102};
    for (int round = 0; round < 600; round++) {
        walk w = random_walk(&c, false);
        run_walk(&w);
    }
}

/* Case 3, the eye inside the volume, outside, and on the borders of bricks. */
static void perspective_walks(void **state)
{
    (void)state;
    rng c = {103};
    for (int round = 0; round < 600; round++) {
        walk w = random_walk(&c, true);
        run_walk(&w);
    }
}

/* Brick numbers in the order visited, as text. */
static void assert_order(const camera *cam, const char *settings, int32_t side, const char *order)
{
    const int32_t dims[3] = {side, side, side};
    volume geometry = unit_volume(side, side, side);
    vodr_volume v = volume_of(dims, NULL);
    vodr_machine m = unit_machine(settings);
    vodr_view view;
    double depth;
    host_error error;
    char got[512] = "";
    assert_int_equal(camera_view(cam, &geometry, &view, &depth, &error), HOST_OK);
    volume_divider d;
    start(&d, &m, &v, &view, opaque);
    for (candidate k; volume_divider_next(&d, &k);)
        snprintf(got + strlen(got), sizeof got - strlen(got), "%s%d", *got ? " " : "", (int)k.brick);
    assert_string_equal(got, order);
    volume_divider_finish(&d);
}

/* The orders that one can write down: brick = x + 2y + 4z, or x + 3y + 9z. */
static void the_papers_cases(void **state)
{
    (void)state;
    camera c = camera_default();
    assert_order(&c, "brick=8", 16, "0 1 2 3 4 5 6 7");
    assert_order(&c, "brick=8 blend=under", 16, "7 6 5 4 3 2 1 0");
    assert_order(&c, "brick=8 traversal=column", 16, "0 4 1 5 2 6 3 7");
    c.azimuth_deg = 180;
    assert_order(&c, "brick=8", 16, "4 5 6 7 0 1 2 3");
    c.azimuth_deg = -90; /* from the left: x runs away from the viewer */
    assert_order(&c, "brick=8", 16, "1 3 5 7 0 2 4 6");
    c = (camera){.azimuth_deg = -120, .elevation_deg = -20, .zoom = 1, .width_px = 32, .height_px = 32, .slices = 32};
    assert_order(&c, "brick=8", 16, "7 5 3 1 6 4 2 0");
    assert_order(&c, "brick=8 traversal=column", 16, "7 6 5 4 3 2 1 0");
    c = (camera){.perspective = true, .fov_deg = 60, .zoom = 1}; /* the eye before the middle brick of the face */
    assert_order(&c, "brick=8", 24, "0 2 1 6 8 7 3 5 4 9 11 10 15 17 16 12 14 13 18 20 19 24 26 25 21 23 22");
}

static void empty_bricks(void **state)
{
    (void)state;
    static uint8_t voxels[16 * 16 * 16];
    int32_t transparent_to[256];
    const int32_t dims[3] = {16, 16, 16};
    volume geometry = unit_volume(16, 16, 16);
    vodr_volume v = volume_of(dims, voxels);
    camera cam = camera_default();
    vodr_view view;
    double depth;
    host_error error;
    assert_int_equal(camera_view(&cam, &geometry, &view, &depth, &error), HOST_OK);
    for (int i = 0; i < 256; i++) /* 0 to 9 and 20 to 29 are transparent, the rest shows */
        transparent_to[i] = i < 10 ? 9 : i >= 20 && i < 30 ? 29 : i - 1;
    static const struct {
        const char *settings;
        uint8_t background, speck;
        uint64_t empty;
    } cases[] = {
        {"filter=nearest", 5, 15, 7}, /* the speck is in brick 0, and in the border of x's neighbour */
        {"filter=linear", 5, 15, 6},
        {"filter=linear", 5, 9, 8},
        {"filter=nearest", 5, 25, 7}, /* between 5 and 25 something shows */
        {"filter=linear", 25, 25, 8},
        {"filter=linear blend=mip", 25, 25, 0}, /* smaller densities count as well */
        {"filter=linear blend=mip", 5, 5, 8},
        {"filter=nearest blend=mip", 5, 25, 7},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char settings[64];
        snprintf(settings, sizeof settings, "brick=8 skip_empty=1 %s", cases[i].settings);
        vodr_machine m = unit_machine(settings);
        memset(voxels, cases[i].background, sizeof voxels);
        voxels[(3 * 16 + 3) * 16 + 7] = cases[i].speck;
        volume_divider d;
        candidate k;
        uint64_t visits = 0;
        start(&d, &m, &v, &view, transparent_to);
        assert_int_equal(d.empty_bricks, cases[i].empty);
        while (volume_divider_next(&d, &k))
            visits++;
        assert_int_equal(visits, 8 - cases[i].empty);
        /* two slabs, four rows, what is left of eight bricks; a look at each of the others */
        assert_int_equal(volume_divider_work(&d), (2 + 4 + visits) * 32 + cases[i].empty);
        volume_divider_finish(&d);
    }
}

/* Texture memory that just holds a brick, and one byte less. */
static void texture_memory_is_checked(void **state)
{
    (void)state;
    const int32_t dims[3] = {100, 100, 12};
    vodr_view view = {.footprint = 1 << 20};
    static const struct {
        const char *settings;
        int32_t fits;
        const char *sentence;
    } cases[] = {
        {"brick=16", 18 * 18 * 12 * 2,
         "a brick of 16 voxels (brick) needs 7776 bytes of texture memory with its border, double-buffered, but "
         "texture_memory_bytes is 7775"},
        {"brick=16 double_buffer=0 density_bits=12 filter=nearest", 16 * 16 * 12 * 2,
         "a brick of 16 voxels (brick) needs 6144 bytes of texture memory with its border, but "
         "texture_memory_bytes is 6143"},
        {"brick_min=9 double_buffer=0", 11 * 11 * 11,
         "a brick of 9 voxels (brick_min) needs 1331 bytes of texture memory with its border, but "
         "texture_memory_bytes is 1330"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        vodr_machine m = unit_machine(cases[i].settings);
        vodr_error error;
        m.texture_memory_bytes = cases[i].fits;
        int32_t edge = volume_divider_edge(&m, &view);
        assert_int_equal(volume_divider_check(&m, dims, edge, &error), VODR_OK);
        m.texture_memory_bytes--;
        assert_int_equal(volume_divider_check(&m, dims, edge, &error), VODR_INVALID);
        assert_string_equal(error.text, cases[i].sentence);
    }
}

/* The frame is refused with that sentence, and drawn whole without. */
static void a_frame_without_room_is_refused(void **state)
{
    (void)state;
    static const vodr_rgba entries[256];
    const int32_t dims[3] = {8, 8, 8};
    static const uint8_t voxels[512];
    vodr_volume v = volume_of(dims, voxels);
    vodr_table table = {entries, 256};
    vodr_view view = {.width_px = 1, .height_px = 1, .slices = 1, .footprint = 1 << 20};
    vodr_machine m = unit_machine("texture_memory_bytes=1023");
    vodr_frame frame;
    vodr_counters counters;
    vodr_error error;
    assert_int_equal(vodr_render(&m, &v, &table, &view, NULL, &frame, &counters, &error), VODR_INVALID);
    assert_string_equal(error.text,
                        "a brick of 8 voxels (brick_min) needs 1024 bytes of texture memory with its border, "
                        "double-buffered, but texture_memory_bytes is 1023");
    m.traversal = VODR_TRAVERSAL_WHOLE;
    assert_int_equal(vodr_render(&m, &v, &table, &view, NULL, &frame, &counters, &error), VODR_OK);
    vodr_frame_free(&frame);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_edge_is_the_formula),
        cmocka_unit_test(parallel_walks),
        cmocka_unit_test(perspective_walks),
        cmocka_unit_test(the_papers_cases),
        cmocka_unit_test(empty_bricks),
        cmocka_unit_test(texture_memory_is_checked),
        cmocka_unit_test(a_frame_without_room_is_refused),
    };
    return cmocka_run_group_tests_name("volume_divider", tests, NULL, NULL);
}
