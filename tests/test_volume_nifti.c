/* test_volume_nifti.c - NIfTI files written here and read back: types, scale, orientation, refusals. */
#include "lib/volume_fixture.h"

#include <math.h>
#include <nifti2_io.h>
#include <stdio.h>
#include <string.h>

static nifti_1_header nifti1(volume_type type, const char *magic)
{
    static const short codes[] = {DT_UINT8, DT_INT8, DT_UINT16, DT_INT16, DT_UINT32, DT_INT32, DT_FLOAT32};
    nifti_1_header h = {.sizeof_hdr = 348, .dim = {3, W, H, D, 1, 1, 1, 1}, .pixdim = {1, 0.5f, 2, 1.5f}};
    h.datatype = codes[type];
    h.bitpix = (short)(8 * volume_type_bytes(type));
    h.vox_offset = magic[1] == '+' ? 352 : 0;
    memcpy(h.magic, magic, 4);
    return h;
}

static const char *put_nifti1(fixture *f, const char *name, const nifti_1_header *h, const void *data, size_t bytes,
                              bool zip)
{
    unsigned char all[352 + COUNT * 8 + 8] = {0};
    memcpy(all, h, sizeof *h);
    memcpy(all + 352, data, bytes);
    return put(f, name, "", 0, all, 352 + bytes, zip);
}

static void nifti_types(void **state)
{
    unsigned char data[COUNT * 8];
    for (int type = 0; type < 7; type++)
        for (int variant = 0; variant < 8; variant++) {
            bool big = variant & 1, zip = variant & 2, pair = variant & 4;
            nifti_1_header h = nifti1((volume_type)type, pair ? "ni1" : "n+1");
            size_t bytes = encode((volume_type)type, big, false, data);
            if (big)
                swap_nifti_header(&h, 1);
            if (pair)
                put(*state, zip ? "z.img.gz" : "p.img", "", 0, data, bytes, zip);
            const char *name = pair ? (zip ? "z.hdr.gz" : "p.hdr") : (zip ? "n.nii.gz" : "n.nii");
            check_pattern(put_nifti1(*state, name, &h, data, pair ? 0 : bytes, zip), NULL, (volume_type)type, "nifti");
            if (pair) {
                fixture *f = *state;
                snprintf(f->path, sizeof f->path, "%s/%s", f->directory, zip ? "z.img.gz" : "p.img");
                check_pattern(f->path, NULL, (volume_type)type, "nifti");
            }
        }
    nifti_1_header h = nifti1(VOLUME_FLOAT32, "n+1");
    h.datatype = DT_FLOAT64;
    h.bitpix = 64;
    h.dim[0] = 5;
    encode(VOLUME_FLOAT32, false, true, data);
    check_pattern(put_nifti1(*state, "n.nii", &h, data, sizeof data, false), NULL, VOLUME_FLOAT32, "nifti");
}

static void nifti2_and_name(void **state)
{
    nifti_2_header h = {.sizeof_hdr = 540, .magic = "n+2\0\r\n\032\n", .datatype = DT_UINT8, .bitpix = 8};
    unsigned char all[544 + COUNT] = {0};
    for (int i = 0; i < 8; i++)
        h.dim[i] = i == 0 ? 3 : i == 1 ? W : i == 2 ? H : i == 3 ? D : 1;
    h.pixdim[1] = h.pixdim[2] = h.pixdim[3] = 1;
    h.vox_offset = 544;
    memcpy(all, &h, sizeof h);
    encode(VOLUME_UINT8, false, false, all + 544);
    check_pattern(put(*state, "no-extension", "", 0, all, sizeof all, false), NULL, VOLUME_UINT8, "nifti");
    check_pattern(put(*state, "zipped", "", 0, all, sizeof all, true), NULL, VOLUME_UINT8, "nifti");
}

static void nifti_scale_and_orientation(void **state)
{
    const double spacing[3] = {0.5, 2, 1.5};
    unsigned char data[COUNT];
    encode(VOLUME_UINT8, false, false, data);
    nifti_1_header h = nifti1(VOLUME_UINT8, "n+1");
    const char *path = put_nifti1(*state, "o.nii", &h, data, COUNT, false);
    check_geometry(path, NULL, spacing, (const int[]){0, 1, 2}, (const int[]){1, 1, 1});
    h.qform_code = 1; /* no rotation: RAS */
    put_nifti1(*state, "o.nii", &h, data, COUNT, false);
    check_geometry(path, NULL, spacing, (const int[]){0, 2, 1}, (const int[]){-1, 1, 1});
    h.sform_code = 1; /* goes before the qform */
    h.srow_x[1] = -2, h.srow_y[2] = -1.5f, h.srow_z[0] = 0.5f;
    h.scl_slope = -2;
    h.scl_inter = 10;
    put_nifti1(*state, "o.nii", &h, data, COUNT, false);
    check_geometry(path, NULL, spacing, (const int[]){1, 0, 2}, (const int[]){1, 1, -1});
    volume v;
    open_ok(path, NULL, &v);
    assert_true(v.max == 10 && v.min == 10 - 4 * (COUNT - 1) && volume_value(&v, 1) == 10 - 2 * pattern(1));
    volume_close(&v);
}

static void nifti_refusals(void **state)
{
    unsigned char data[COUNT + 1];
    encode(VOLUME_UINT8, false, false, data);
    const nifti_1_header good = nifti1(VOLUME_UINT8, "n+1");
    for (int i = 0; i < 16; i++) {
        nifti_1_header h = good;
        size_t bytes = COUNT;
        const char *part = "";
        switch (i) {
        case 0: h.dim[0] = 4, h.dim[4] = 2, part = "dim[4]"; break;
        case 1: h.dim[2] = 0, part = "along y is 0"; break;
        case 2: h.dim[2] = -4, part = "along y is -4"; break;
        case 3: h.dim[0] = 2, part = "dim[0] is 2"; break;
        case 4: h.pixdim[3] = 0, part = "spacing along z"; break;
        case 5: h.pixdim[3] = NAN, part = "spacing along z"; break;
        case 6: h.datatype = DT_RGB24, part = "RGB24"; break;
        case 7: h.datatype = DT_INT64, part = "datatype"; break;
        case 8: h.datatype = 12345, part = "datatype"; break;
        case 9: h.vox_offset = NAN, part = "vox_offset"; break;
        case 10: h.pixdim[2] = -1, part = "spacing along y, is -1, must be above 0"; break;
        case 11: h.sform_code = 1, part = "has no rotation"; break;
        case 12:
            h.sform_code = 1;
            h.srow_x[0] = h.srow_y[1] = h.srow_z[1] = 1; /* two axes run one way */
            part = "has no rotation";
            break;
        case 13: h.sform_code = 1, h.srow_x[0] = h.srow_y[1] = 1, h.srow_z[2] = NAN, part = "has no rotation"; break;
        case 14: bytes = COUNT - 1, part = "59 bytes"; break;
        default: bytes = COUNT + 1, part = "61 bytes";
        }
        refused(put_nifti1(*state, "r.nii", &h, data, bytes, false), NULL, part);
    }
    const volume_options no_orient = {.no_orient = true};
    nifti_1_header flat = good;
    flat.sform_code = 1;
    check_geometry(put_nifti1(*state, "flat.nii", &flat, data, COUNT, false), &no_orient, (const double[]){0.5, 2, 1.5},
                   (const int[]){0, 1, 2}, (const int[]){1, 1, 1});
    put(*state, "raw.img", "", 0, data, COUNT, false); /* an .img without a header is raw */
    check_pattern(((fixture *)*state)->path, &(volume_options){.dims_vox = {W, H, D}}, VOLUME_UINT8, "raw");
    nifti_1_header pair = nifti1(VOLUME_UINT8, "ni1");
    refused(put_nifti1(*state, "lonely.hdr", &pair, data, 0, false), NULL, "lonely");
    nifti_1_header large = good;
    large.dim[1] = large.dim[2] = large.dim[3] = 30000;
    refused(put_nifti1(*state, "r.nii.gz", &large, data, COUNT, true), NULL, "ends early");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nifti_types),
        cmocka_unit_test(nifti2_and_name),
        cmocka_unit_test(nifti_scale_and_orientation),
        cmocka_unit_test(nifti_refusals),
    };
    return cmocka_run_group_tests(tests, fixture_make, fixture_remove);
}
