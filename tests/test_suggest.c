/* test_suggest.c - the transfer function and window that `vodr info` suggests, and the histogram they come from. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lib/unit.h"
#include "suggest.h"

enum { EDGE = 20, COUNT = EDGE * EDGE * EDGE };

/* A volume of floats: value(i) of voxel i. */
static volume volume_of(double (*value)(int i), const char *format)
{
    volume v = unit_volume(EDGE, EDGE, EDGE);
    float *voxels = malloc(sizeof *voxels * COUNT);
    assert_non_null(voxels);
    v.voxels = voxels;
    v.bytes = sizeof *voxels * COUNT;
    v.type = VOLUME_FLOAT32;
    v.slope = 1;
    v.format = format;
    v.min = INFINITY;
    v.max = -INFINITY;
    for (int i = 0; i < COUNT; i++) {
        voxels[i] = (float)value(i);
        v.min = fmin(v.min, (double)voxels[i]);
        v.max = fmax(v.max, (double)voxels[i]);
    }
    return v;
}

static double constant(int i)
{
    (void)i;
    return 7;
}

static double few_bright(int i)
{
    return i % 100 == 0 ? 200 + i % 50 : i % 10;
}

static double head_in_air(int i)
{
    return i % 2 ? -1000 : i % 4 ? 40 : 900;
}

static double skull_in_air(int i)
{
    return i % 8 ? -1000 : 900;
}

/* Air around 400 with noise, an object from 700 to 1100, one speck at 5000. */
static double tooth(int i)
{
    return i == 0 ? 5000 : i % 4 ? 400 + i % 7 * 5 : 700 + i % 401;
}

static void suggestions(void **state)
{
    (void)state;
    static const struct {
        double (*value)(int i);
        const char *format, *transfer;
        double lo[2], hi[2]; /* within which the window's ends must be */
    } cases[] = {
        {constant, "raw", "ramp", {7, 7}, {7, 7}},
        {few_bright, "raw", "vessels", {0, 40}, {200, 249}},
        {head_in_air, "raw", "skin-bone", {-1024, -1024}, {3071, 3071}},
        {skull_in_air, "raw", "bone", {-1024, -1024}, {3071, 3071}},
        {tooth, "nrrd", "bone", {430, 700}, {1080, 1200}},
        {tooth, "nifti", "mri", {430, 700}, {1080, 1200}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        volume v = volume_of(cases[i].value, cases[i].format);
        histogram h;
        suggestion s;
        histogram_of(&v, &h);
        assert_int_equal(h.all, COUNT);
        assert_int_equal(histogram_count(&h, 0, 16), COUNT);
        assert_int_equal(suggest(&v, &h, &s, NULL), HOST_OK);
        if (strcmp(s.transfer, cases[i].transfer) != 0 || s.lo < cases[i].lo[0] || s.lo > cases[i].lo[1] ||
            s.hi < cases[i].hi[0] || s.hi > cases[i].hi[1])
            fail_msg("case %zu: %s %g:%g", i, s.transfer, s.lo, s.hi);
        free(v.voxels);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(suggestions)};
    return cmocka_run_group_tests_name("suggest", tests, NULL, NULL);
}
