/* test_volume_quantise.c - densities of every type and width, and the options that say how to read a volume. */
#include "lib/volume_fixture.h"
#include "volume_options.h"

#include <math.h>

/* ---- densities ---- */

static void check_densities(const char *path, volume_options o, double lo, double hi, int bits)
{
    host_error error = {""};
    volume before, v;
    vodr_volume out;
    open_ok(path, &o, &before);
    open_ok(path, &o, &v);
    assert_int_equal(volume_quantise(&v, lo, hi, bits, &out, &error), HOST_OK);
    assert_int_equal(out.voxel_bytes, bits == 12 && volume_type_bytes(v.type) > 1 ? 2 : 1);
    for (size_t i = 0; i < volume_count(&before); i++) {
        double most = bits == 8 ? 255 : 4095;
        double want = hi == lo ? 0 : floor((volume_value(&before, i) - lo) / (hi - lo) * most + 0.5);
        int raw = out.voxel_bytes == 2 ? ((const uint16_t *)out.voxels)[i] : ((const uint8_t *)out.voxels)[i];
        int got = out.map ? out.map[raw] : raw;
        assert_int_equal(got, (int)fmax(0, fmin(want, most)));
    }
    assert_int_equal(volume_quantise(&v, lo, hi, bits, &out, &error), HOST_BAD_INPUT);
    volume_close(&v);
    volume_close(&before);
}

static void densities(void **state)
{
    unsigned char data[COUNT * 4];
    for (int type = 0; type < 7; type++) {
        volume_options o = {.dims_vox = {W, H, D}, .type = (volume_type)type};
        const char *path = put(*state, "q.raw", "", 0, data, encode((volume_type)type, false, false, data), false);
        for (int bits = 8; bits <= 12; bits += 4) {
            check_densities(path, o, 0, 118, bits);
            check_densities(path, o, 20.5, 77.25, bits);
            check_densities(path, o, -300, 1000, bits);
            check_densities(path, o, 5, 5, bits);
            o.crop = true, o.crop_lo[0] = 1, o.crop_hi[0] = W, o.crop_hi[1] = H, o.crop_hi[2] = D;
            check_densities(path, o, 0, 60, bits);
            o.crop = false;
        }
    }
    float strange[] = {1, NAN, INFINITY, -INFINITY, -3, 2};
    volume_options o = {.dims_vox = {3, 2, 1}, .type = VOLUME_FLOAT32};
    volume v;
    open_ok(put(*state, "f.raw", "", 0, strange, sizeof strange, false), &o, &v);
    assert_true(v.nonfinite == 3 && v.min == -3 && v.max == 2 && volume_value(&v, 1) == -3);
    volume_close(&v);
    fixture *f = *state;
    check_densities(f->path, o, -3, 2, 12);
}

/* Bytes that the window leaves as they are need no map. */
static void identity_needs_no_map(void **state)
{
    unsigned char data[COUNT];
    encode(VOLUME_UINT8, false, false, data);
    volume_options o = {.dims_vox = {W, H, D}};
    volume v;
    vodr_volume out;
    open_ok(put(*state, "i.raw", "", 0, data, COUNT, false), &o, &v);
    assert_int_equal(volume_quantise(&v, 0, 255, 8, &out, NULL), HOST_OK);
    assert_null(out.map);
    assert_memory_equal(out.voxels, data, COUNT);
    volume_close(&v);
}

/* ---- options ---- */

static void options(void **state)
{
    (void)state;
    static const char *const bad[][2] = {
        {"dims", "1x2"},    {"dims", "0x1x1"},   {"dims", "2147483648x1x1"}, {"dims", "1x2x3x"},
        {"type", "double"}, {"spacing", "1,1"},  {"spacing", "1,-1,1"},      {"spacing", "1,nan,1"},
        {"endian", "BIG"},  {"crop", "0:1,0:1"}, {"crop", "1:1,0:1,0:1"},    {"crop", "-1:1,0:1,0:1"},
        {"dims", ""},       {"type", ""},        {"no-orient", "1"},
    };
    bool known;
    host_error error;
    volume_options o = {0};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_int_equal(volume_option(&o, bad[i][0], bad[i][1], &known, &error), HOST_BAD_INPUT);
        assert_true(known);
    }
    assert_int_equal(volume_option(&o, "dims", "256x1x32768", &known, &error), HOST_OK);
    assert_int_equal(volume_option(&o, "type", "int16", &known, &error), HOST_OK);
    assert_int_equal(volume_option(&o, "spacing", "0.5,1e-3,2", &known, &error), HOST_OK);
    assert_int_equal(volume_option(&o, "endian", "big", &known, &error), HOST_OK);
    assert_int_equal(volume_option(&o, "crop", "1:2,3:40,5:600", &known, &error), HOST_OK);
    assert_int_equal(volume_option(&o, "no-orient", NULL, &known, &error), HOST_OK);
    assert_true(o.dims_vox[2] == 32768 && o.type == VOLUME_INT16 && o.spacing[1] == 1e-3 && o.big_endian && o.crop &&
                o.crop_lo[1] == 3 && o.crop_hi[2] == 600 && o.no_orient);
    assert_int_equal(volume_option(&o, "view", "0,0", &known, &error), HOST_OK);
    assert_false(known);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(densities),
        cmocka_unit_test(identity_needs_no_map),
        cmocka_unit_test(options),
    };
    return cmocka_run_group_tests(tests, fixture_make, fixture_remove);
}
