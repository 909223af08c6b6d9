/* test_cluster.c - the cluster's parts by themselves: what is empty, who gets what, in what order it is seen, and that
 * pictures put together in any way are the same. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "balance.h"
#include "clustering.h"
#include "composite.h"
#include "footprint.h"
#include "lib/unit.h"
#include "subvolumes.h"

static const cluster_balance methods[] = {CLUSTER_STATIC, CLUSTER_OCTREE, CLUSTER_PAPER, CLUSTER_BEST};
enum { METHODS = sizeof methods / sizeof *methods };

/* ---- what is empty ---- */

/* The function shows columns 3 to 5 of 0 to 9. */
static void test_empty(void **state)
{
    (void)state;
    static const int32_t visible[11] = {0, 0, 0, 0, 1, 2, 3, 3, 3, 3, 3};
    static const struct {
        float least, most;
        bool over, mip;
    } rows[] = {{0, 1, false, false},     {0, 9, true, true},           {3, 3, true, true},
                {6.9f, 9, false, true},   {0, 3, true, true},           {-5, 1.5f, false, false},
                {5.2f, 5.4f, true, true}, {-INFINITY, 1, false, false}, {INFINITY, -INFINITY, false, false}};
    enum { ROWS = sizeof rows / sizeof *rows };
    subvolumes s;
    octree o;
    vodr_error error;
    assert_int_equal(subvolumes_make((int32_t[]){ROWS * 8 - 3, 8, 5}, 8, &s, &error), CLUSTER_OK);
    assert_int_equal(subvolumes_total(s.count), ROWS);
    for (int i = 0; i < ROWS; i++) {
        s.least[i] = rows[i].least;
        s.most[i] = rows[i].most;
    }
    assert_int_equal(octree_make(&s, &o, &error), CLUSTER_OK);
    for (int mip = 0; mip < 2; mip++) {
        uint8_t occupied[ROWS];
        const cluster_function f = {10, visible, 0, 9, mip};
        int64_t count = octree_occupied(&o, &f, occupied), wanted = 0;
        for (int i = 0; i < ROWS; i++) {
            assert_int_equal(occupied[i], mip ? rows[i].mip : rows[i].over);
            wanted += occupied[i];
        }
        assert_int_equal(count, wanted);
    }
    octree_free(&o);
    subvolumes_free(&s);
}

/* ---- who gets what ---- */

typedef struct field {
    int32_t count[3];
    double *occupied;
    sums sums;
} field;

/* Blobs in an empty box; or noise in a small one, which no few planes divide evenly. */
static field random_field(rng *r)
{
    field f;
    vodr_error error;
    double middle[4][4];
    const bool noise = rng_one_in(r, 3);
    for (int a = 0; a < 3; a++)
        f.count[a] = (int32_t)rng_int(r, 1, noise ? 9 : 24);
    for (int i = 0; i < 4; i++)
        for (int a = 0; a < 4; a++)
            middle[i][a] = a < 3 ? rng_real(r, 0, f.count[a]) : rng_real(r, 1, 7);
    f.occupied = malloc(subvolumes_total(f.count) * sizeof *f.occupied);
    size_t i = 0;
    for (int32_t z = 0; z < f.count[2]; z++)
        for (int32_t y = 0; y < f.count[1]; y++)
            for (int32_t x = 0; x < f.count[0]; x++, i++) {
                f.occupied[i] = noise && rng_one_in(r, 3);
                for (int b = 0; !noise && b < 4; b++)
                    if (hypot(hypot(x - middle[b][0], y - middle[b][1]), z - middle[b][2]) < middle[b][3])
                        f.occupied[i] = 1;
            }
    assert_int_equal(sums_make(f.count, f.occupied, &f.sums, &error), CLUSTER_OK);
    return f;
}

static void free_field(field *f)
{
    free(f->occupied);
    sums_free(&f->sums);
}

/* How many leaves with an owner hold a sub-volume. */
static int owners(const kd_tree *t, const int32_t at[3])
{
    int found = 0;
    for (int32_t i = 0; i < t->count; i++) {
        const kd_node *n = &t->node[i];
        bool inside = n->axis == KD_LEAF && n->owner != KD_NOBODY;
        for (int a = 0; a < 3; a++)
            inside = inside && at[a] >= n->box.lo[a] && at[a] < n->box.hi[a];
        found += inside;
    }
    return found;
}

/* The owner of a sub-volume. */
static int32_t owner_of(const kd_tree *t, const int32_t at[3])
{
    int32_t i = 0;
    while (t->node[i].axis != KD_LEAF)
        i = t->node[i].child[at[t->node[i].axis] >= t->node[i].at];
    return t->node[i].owner;
}

/* What has another owner in one tree than in another. */
static double moved_weight(const field *f, const kd_tree *a, const kd_tree *b)
{
    int32_t at[3];
    size_t i = 0;
    double sum = 0;
    for (at[2] = 0; at[2] < f->count[2]; at[2]++)
        for (at[1] = 0; at[1] < f->count[1]; at[1]++)
            for (at[0] = 0; at[0] < f->count[0]; at[0]++, i++)
                sum += owner_of(a, at) != owner_of(b, at) ? f->occupied[i] : 0;
    return sum;
}

/* Each sub-volume that is not empty has one owner, others at most one. */
static void check_cover(const field *f, const kd_tree *t)
{
    int32_t at[3];
    size_t i = 0;
    for (at[2] = 0; at[2] < f->count[2]; at[2]++)
        for (at[1] = 0; at[1] < f->count[1]; at[1]++)
            for (at[0] = 0; at[0] < f->count[0]; at[0]++, i++) {
                int found = owners(t, at);
                assert_true(found == 1 || (found == 0 && f->occupied[i] == 0));
            }
}

static void test_cover(void **state)
{
    (void)state;
    vodr_error error;
    rng r = {7};
    for (int n = 0; n < 80; n++) {
        field f = random_field(&r);
        const balance_input in = {&f.sums, &f.sums, (int32_t)rng_int(&r, 1, 20)};
        for (int m = 0; m < METHODS; m++) {
            kd_tree t;
            int32_t parts[20];
            double total[20], sum = 0;
            const box all = sums_all(&f.sums);
            assert_int_equal(balance_make(methods[m], &in, &t, &error), CLUSTER_OK);
            check_cover(&f, &t);
            balance_leaves(&t, &f.sums, in.nodes, parts);
            balance_total(&t, &f.sums, in.nodes, total);
            for (int i = 0; i < in.nodes; i++) {
                assert_true(parts[i] <= (methods[m] == CLUSTER_BEST ? BALANCE_PARTS : 1));
                sum += total[i];
            }
            assert_true(sum == sums_of(&f.sums, &all));
            assert_int_equal(clustering_refine(&t, &f.sums, 0.8, 15, &error), CLUSTER_OK);
            check_cover(&f, &t);
            for (int32_t i = 0; i < t.count; i++) {
                const kd_node *leaf = &t.node[i];
                if (leaf->axis == KD_LEAF && leaf->owner != KD_NOBODY)
                    assert_true(box_size(&leaf->box) < 15 ||
                                sums_of(&f.sums, &leaf->box) >= 0.8 * (double)box_size(&leaf->box));
            }
            kd_tree_free(&t);
        }
        free_field(&f);
    }
}

/* The paper's figure 6, walked by hand. */
static void test_plane(void **state)
{
    (void)state;
    static const double slabs[] = {1, 0, 5, 2, 2};
    vodr_error error;
    sums s;
    assert_int_equal(sums_make((int32_t[]){5, 1, 1}, slabs, &s, &error), CLUSTER_OK);
    const box all = sums_all(&s);
    assert_int_equal(balance_plane(&s, &all, 0, 1, 1), 3); /* 1 0 5 | 2 2 */
    assert_int_equal(balance_plane(&s, &all, 0, 3, 1), 4); /* 1 0 5 2 | 2 */
    sums_free(&s);
}

/* Where as many sub-volumes as nodes or more can be dealt out evenly, best is even to one, of solid boxes. */
static void test_best_is_even(void **state)
{
    (void)state;
    vodr_error error;
    rng r = {11};
    for (int n = 0; n < 30; n++) {
        field f = random_field(&r);
        const box all = sums_all(&f.sums);
        const double sum = sums_of(&f.sums, &all);
        for (int32_t nodes = 8; nodes <= 16; nodes += 8) {
            const balance_input in = {&f.sums, &f.sums, nodes};
            kd_tree t;
            double total[16];
            if (sum < 60 * nodes)
                continue;
            assert_int_equal(balance_make(CLUSTER_BEST, &in, &t, &error), CLUSTER_OK);
            balance_total(&t, &f.sums, nodes, total);
            assert_true(balance_ratio(total, nodes) >= 0.95);
            kd_tree_free(&t);
        }
        free_field(&f);
    }
    assert_true(balance_ratio((double[]){3, 4, 2}, 3) == 0.5);
    assert_true(balance_ratio((double[]){3, 0}, 2) == 0);
    assert_true(balance_ratio((double[]){0, 0}, 2) == 0);
}

/* Sub-volumes that were not empty weigh more the farther they are along an axis, and some that were become occupied. */
static field other_weights(rng *r, const field *f)
{
    field g = *f;
    vodr_error error;
    const size_t total = subvolumes_total(f->count);
    const double slope = rng_real(r, 0, 0.3);
    g.occupied = malloc(total * sizeof *g.occupied);
    for (size_t i = 0; i < total; i++) {
        const double x = (double)(i % (size_t)f->count[0]);
        g.occupied[i] = f->occupied[i] > 0 ? 1 + slope * x : rng_one_in(r, 6);
    }
    assert_int_equal(sums_make(g.count, g.occupied, &g.sums, &error), CLUSTER_OK);
    return g;
}

/* A division carried over to other weights covers what they cover, is more even than it was, and keeps most in place.
 */
static void test_adjust(void **state)
{
    (void)state;
    vodr_error error;
    rng r = {17};
    double moved = 0, sum = 0;
    for (int n = 0; n < 60; n++) {
        field f = random_field(&r), g = other_weights(&r, &f);
        const int32_t nodes = (int32_t)rng_int(&r, 1, 16);
        const balance_input in = {&f.sums, &f.sums, nodes}, now = {&g.sums, &g.sums, nodes};
        const box all = sums_all(&f.sums);
        kd_tree t, before;
        double total[16], ratio;
        int32_t parts[16];
        assert_int_equal(balance_make(CLUSTER_BEST, &in, &t, &error), CLUSTER_OK);
        balance_widen(&t, &all);
        assert_int_equal(kd_tree_copy(&t, &before, &error), CLUSTER_OK);
        check_cover(&g, &t);
        balance_total(&t, &g.sums, nodes, total);
        ratio = balance_ratio(total, nodes);
        assert_int_equal(balance_adjust(&now, 0.95, &t, &error), CLUSTER_OK);
        check_cover(&g, &t);
        balance_total(&t, &g.sums, nodes, total);
        assert_true(balance_ratio(total, nodes) >= ratio || balance_ratio(total, nodes) >= 0.95);
        balance_leaves(&t, &g.sums, nodes, parts);
        for (int i = 0; i < nodes; i++)
            assert_true(parts[i] <= BALANCE_PARTS);
        moved += moved_weight(&g, &before, &t);
        sum += sums_of(&g.sums, &all);
        kd_tree_free(&t);
        kd_tree_free(&before);
        free_field(&f);
        free_field(&g);
    }
    assert_true(moved > 0 && moved < 0.3 * sum);
}

/* ---- the order of sight ---- */

/* Whether a box may hide another from the eye, by a plane between them. */
static bool is_behind(const box *a, const box *b, const kd_eye *eye)
{
    for (int x = 0; x < 3; x++) {
        if (a->hi[x] <= b->lo[x] && (eye->parallel ? eye->at[x] >= 0 : eye->at[x] <= b->lo[x]))
            return false; /* a is on the eye's side */
        if (b->hi[x] <= a->lo[x] && (eye->parallel ? eye->at[x] <= 0 : eye->at[x] >= b->hi[x]))
            return false;
    }
    return true;
}

static void test_order(void **state)
{
    (void)state;
    vodr_error error;
    rng r = {3};
    for (int n = 0; n < 60; n++) {
        field f = random_field(&r);
        const balance_input in = {&f.sums, &f.sums, 9};
        kd_eye eye = {.parallel = n % 2};
        kd_tree t;
        for (int a = 0; a < 3; a++)
            eye.at[a] = eye.parallel ? rng_real(&r, -1, 1) : rng_real(&r, -10, 34);
        assert_int_equal(balance_make(CLUSTER_BEST, &in, &t, &error), CLUSTER_OK);
        assert_int_equal(clustering_refine(&t, &f.sums, 0.9, 4, &error), CLUSTER_OK);
        int32_t *leaves = malloc((size_t)t.count * sizeof *leaves), count = kd_tree_order(&t, &eye, 1, leaves);
        for (int32_t i = 0; i < count; i++)
            for (int32_t j = i + 1; j < count; j++)
                assert_false(is_behind(&t.node[leaves[i]].box, &t.node[leaves[j]].box, &eye));
        free(leaves);
        kd_tree_free(&t);
        free_field(&f);
    }
}

/* ---- footprints ---- */

static void test_footprint(void **state)
{
    (void)state;
    rng r = {5};
    for (int n = 0; n < 200; n++) {
        volume v = unit_volume(40, 30, 50);
        vodr_view view = unit_camera_view(&r, &v, n % 2);
        const reference_camera c = reference_camera_slices(&view);
        int32_t lo[3], hi[3];
        for (int a = 0; a < 3; a++) {
            lo[a] = (int32_t)rng_int(&r, 0, v.dims_vox[a] - 1);
            hi[a] = (int32_t)rng_int(&r, lo[a] + 1, v.dims_vox[a]);
        }
        const rectangle area = footprint_of(&c, lo, hi);
        for (int32_t y = 0; y < view.height_px; y += 3)
            for (int32_t x = 0; x < view.width_px; x += 3)
                for (int32_t k = 0; k < view.slices; k += 5) {
                    int64_t position[3];
                    unit_position(&view, x, y, k, position);
                    if (unit_inside(position, lo, hi))
                        assert_true(x >= area.x0 && x < area.x1 && y >= area.y0 && y < area.y1);
                }
    }
}

/* ---- compositing ---- */

enum { WIDE = 19, HIGH = 23, PLACES = 40 };

/* A picture of one place: sparse, in a part of the whole; the same from the same seed. */
static void fill_place(uint64_t seed, bool mip, rectangle *area, double *rgba)
{
    rng r = {seed};
    area->x0 = (int32_t)rng_int(&r, 0, WIDE - 1);
    area->y0 = (int32_t)rng_int(&r, 0, HIGH - 1);
    area->x1 = (int32_t)rng_int(&r, area->x0, WIDE);
    area->y1 = (int32_t)rng_int(&r, area->y0, HIGH);
    for (int32_t i = 0; i < (area->x1 - area->x0) * (area->y1 - area->y0); i++) {
        double *pixel = rgba + 4 * i;
        const bool active = rng_one_in(&r, 2);
        pixel[3] = active ? mip ? 1 : rng_real(&r, 0, 0.5) : 0;
        for (int c = 0; c < 3; c++)
            pixel[c] = active ? mip ? floor(rng_real(&r, 0, 200)) : rng_real(&r, 0, 1) * pixel[3] : 0;
    }
}

/* All places one behind the other. */
static void put_together(int32_t places, uint64_t seed, bool mip, double *out)
{
    double rgba[4 * WIDE * HIGH];
    memset(out, 0, 4 * WIDE * HIGH * sizeof *out);
    for (int32_t p = 0; p < places; p++) {
        rectangle area;
        fill_place(seed + (uint64_t)p, mip, &area, rgba);
        const double *from = rgba;
        for (int32_t y = area.y0; y < area.y1; y++)
            for (int32_t x = area.x0; x < area.x1; x++, from += 4) {
                double *to = out + 4 * (y * WIDE + x), through = 1 - to[3];
                for (int c = 0; c < 4; c++)
                    to[c] = !mip ? to[c] + through * from[c] : from[3] == 0 ? to[c] : c == 3 ? 1 : fmax(to[c], from[0]);
            }
    }
}

/* Places dealt out to nodes at random, composited; the greatest difference from all put together. */
static double composite_difference(rng *r, cluster_composite method, int32_t nodes, bool mip, int32_t bits)
{
    static composite_piece piece[32];
    static double rgba[4 * WIDE * HIGH], wanted[4 * WIDE * HIGH];
    const int32_t places = (int32_t)rng_int(r, 1, PLACES);
    const uint64_t seed = rng_next(r);
    const composite_model model = {0.5, 1e9};
    vodr_error error;
    double seconds, most = 0;
    for (int32_t i = 0; i < nodes; i++)
        piece[i] = (composite_piece){{.mip = mip, .bits = bits}, 0, HIGH, 0};
    for (int32_t p = 0; p < places; p++) {
        layers *l = &piece[rng_int(r, 0, nodes - 1)].layers;
        rectangle area;
        fill_place(seed + (uint64_t)p, mip, &area, rgba);
        assert_int_equal(layers_add(l, p, p + 1, area, &error), CLUSTER_OK);
        if (!rectangle_is_empty(area))
            layers_march(l, l->count - 1, area, rgba);
    }
    assert_int_equal(composite_simulate(method, nodes, piece, &model, &seconds, &error), CLUSTER_OK);
    assert_true(nodes == 1 ? seconds == 0 : seconds > 0.5);
    memset(rgba, 0, sizeof rgba);
    if (composite_write(&piece[0], places, WIDE, rgba, &error) != CLUSTER_OK)
        fail_msg("%s", error.text);
    put_together(places, seed, mip, wanted);
    for (int i = 0; i < 4 * WIDE * HIGH; i++)
        most = fmax(most, fabs(rgba[i] - (mip && i % 4 < 3 ? wanted[i - i % 4] : wanted[i])));
    for (int32_t i = 0; i < nodes; i++)
        layers_free(&piece[i].layers);
    return most;
}

static void test_composite(void **state)
{
    (void)state;
    static const cluster_composite ways[] = {CLUSTER_DIRECT, CLUSTER_BINARY_SWAP, CLUSTER_RADIX_K};
    rng r = {13};
    for (int32_t nodes = 1; nodes <= 32; nodes++)
        for (int w = 0; w < 3; w++) {
            assert_true(composite_difference(&r, ways[w], nodes, false, 32) < 1e-6);
            assert_true(composite_difference(&r, ways[w], nodes, true, 32) == 0);
            assert_true(composite_difference(&r, ways[w], nodes, true, 16) == 0); /* maxima stay floats */
            const double rough = composite_difference(&r, ways[w], nodes, false, 16);
            assert_true(rough < 0.5 / 255);
        }
}

/* In a round all members of a group name one another, alike. */
static void test_schedule(void **state)
{
    (void)state;
    static const cluster_composite ways[] = {CLUSTER_DIRECT, CLUSTER_BINARY_SWAP, CLUSTER_RADIX_K};
    static composite_step own, other;
    for (int w = 0; w < 3; w++)
        for (int32_t nodes = 1; nodes <= 70; nodes++)
            for (int32_t round = 0; round < composite_rounds(ways[w], nodes); round++)
                for (int32_t i = 0; i < nodes; i++) {
                    composite_step_of(ways[w], nodes, round, i, &own);
                    assert_true(own.members == 0 || own.member[own.own] == i);
                    for (int32_t j = 0; j < own.members; j++) {
                        composite_step_of(ways[w], nodes, round, own.member[j], &other);
                        assert_int_equal(other.members, own.members);
                        assert_memory_equal(other.member, own.member, (size_t)own.members * sizeof *own.member);
                    }
                }
    assert_int_equal(composite_rounds(CLUSTER_DIRECT, 16), 1);
    assert_int_equal(composite_rounds(CLUSTER_BINARY_SWAP, 16), 4);
    assert_int_equal(composite_rounds(CLUSTER_BINARY_SWAP, 17), 5);
    assert_int_equal(composite_rounds(CLUSTER_RADIX_K, 16), 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_empty),        cmocka_unit_test(test_cover),     cmocka_unit_test(test_plane),
        cmocka_unit_test(test_best_is_even), cmocka_unit_test(test_adjust),    cmocka_unit_test(test_order),
        cmocka_unit_test(test_footprint),    cmocka_unit_test(test_composite), cmocka_unit_test(test_schedule),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
