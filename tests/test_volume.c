/* test_volume.c - NRRD and raw files written here and read back: values, geometry, crops, damage, refusals. */
#include "lib/volume_fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- NRRD ---- */

static void nrrd_types_and_encodings(void **state)
{
    fixture *f = *state;
    static const char *const names[] = {"uchar", "int8", "ushort", "short", "uint", "int", "float", "double"};
    for (int type = 0; type < 8; type++)
        for (int variant = 0; variant < 8; variant++) {
            bool big = variant & 1, zip = variant & 2, detached = variant & 4;
            unsigned char data[COUNT * 8];
            char header[512];
            size_t bytes = encode((volume_type)type, big, type == 7, data);
            snprintf(header, sizeof header,
                     "NRRD0004\n# comment\ntype: %s\ndimension: 3\nsizes: 5 4 3\nendian: %s\nencoding: %s\n%s\n",
                     names[type], big ? "big" : "little", zip ? "gzip" : "raw", detached ? "data file: voxels\n" : "");
            if (detached)
                put(f, "voxels", "", 0, data, bytes, zip);
            put(f, "a.nrrd", header, strlen(header), data, detached ? 0 : bytes, zip && !detached);
            check_pattern(f->path, NULL, type == 7 ? VOLUME_FLOAT32 : (volume_type)type, "nrrd");
        }
}

static void nrrd_text(void **state)
{
    fixture *f = *state;
    char text[2048] = "NRRD0001\ntype: short\ndimension: 3\nsizes: 5 4 3\nencoding: ascii\n\n";
    for (int i = 0; i < COUNT; i++)
        snprintf(text + strlen(text), 16, "%g%s", pattern(i), i % 7 ? " " : ",\n");
    check_pattern(put_text(f, "t.nrrd", text, "", 0), NULL, VOLUME_INT16, "nrrd");
    put_text(f, "t.nrrd", text, " 12", 3);
    refused(f->path, NULL, "more than");
    *strrchr(text, ' ') = '\0';
    *strrchr(text, ' ') = '\0';
    refused(put_text(f, "t.nrrd", text, "", 0), NULL, "ends early");
    strcat(text, " 40000");
    refused(put_text(f, "t.nrrd", text, "", 0), NULL, "40000");
}

static void nrrd_skips_and_axes(void **state)
{
    fixture *f = *state;
    unsigned char data[3 + COUNT];
    memcpy(data, "a\nb", 3);
    encode(VOLUME_UINT8, false, false, data + 3);
    put(f, "voxels", "", 0, data, sizeof data, false);
    const char head[] = "NRRD0004\ntype: uchar\ndimension: 5\nsizes: 1 5 4 3 1\nencoding: raw\n";
    char header[256];
    snprintf(header, sizeof header, "%sline skip: 1\nbyte skip: 1\ndata file: voxels\n", head);
    check_pattern(put_text(f, "s.nhdr", header, "", 0), NULL, VOLUME_UINT8, "nrrd");
    snprintf(header, sizeof header, "%sbyte skip: -1\ndata file: voxels\n", head);
    check_pattern(put_text(f, "s.nhdr", header, "", 0), NULL, VOLUME_UINT8, "nrrd");
    put(f, "voxels", "", 0, data, sizeof data, true);
    const char zipped[] = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 5 4 3\nencoding: gzip\nbyte skip: 3\n"
                          "data file: voxels\n";
    check_pattern(put_text(f, "s.nhdr", zipped, "", 0), NULL, VOLUME_UINT8, "nrrd");
}

static void nrrd_orientation(void **state)
{
    static const struct {
        const char *fields;
        double spacing[3];
        int axis[3], sign[3];
    } cases[] = {
        {"", {1, 1, 1}, {0, 1, 2}, {1, 1, 1}},
        {"spacings: 0.5 nan 1.5\n", {0.5, 1, 1.5}, {0, 1, 2}, {1, 1, 1}},
        {"space: LPS\nspace directions: (2,0,0) (0,3,0) (0,0,4)\n", {2, 3, 4}, {0, 2, 1}, {1, 1, -1}},
        {"space: RAS\nspace directions: (2,0,0) (0,3,0) (0,0,4)\n", {2, 3, 4}, {0, 2, 1}, {-1, 1, 1}},
        {"space: LAS\nspace directions: (2,0,0) (0,3,0) (0,0,4)\n", {2, 3, 4}, {0, 2, 1}, {1, 1, 1}},
        {"space: left-posterior-superior\nspace directions: (0,2,0) (0,0,-3) (-4,0,0)\n",
         {2, 3, 4},
         {2, 1, 0},
         {-1, -1, -1}},
        {"space: RAS\nspace directions: (0.8,0.6,0) (-0.6,0.8,0) (0,0,1)\n", {1, 1, 1}, {0, 2, 1}, {-1, 1, 1}},
        {"space: RAS\nspace directions: (0.6,0.8,0) (-0.8,0.6,0) (0,0,1)\n", {1, 1, 1}, {1, 2, 0}, {1, 1, 1}},
        {"space dimension: 3\nspace directions: (0,0,1) (0,1,0) (1,0,0)\n", {1, 1, 1}, {2, 1, 0}, {1, 1, 1}},
        {"space: 3D-left-handed\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n", {1, 1, 1}, {0, 1, 2}, {1, 1, -1}},
    };
    const int plain[3] = {0, 1, 2}, along[3] = {1, 1, 1};
    const volume_options no_orient = {.no_orient = true};
    unsigned char data[COUNT];
    encode(VOLUME_UINT8, false, false, data);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char header[512];
        snprintf(header, sizeof header, "NRRD0005\ntype: uchar\ndimension: 3\nsizes: 5 4 3\n%sencoding: raw\n\n",
                 cases[i].fields);
        const char *path = put_text(*state, "o.nrrd", header, data, COUNT);
        check_geometry(path, NULL, cases[i].spacing, cases[i].axis, cases[i].sign);
        check_geometry(path, &no_orient, cases[i].spacing, plain, along);
    }
}

/* What teem itself would crash on. */
static void nrrd_hostile_headers(void **state)
{
    static const char *const lines[] = {"type: %s\n",      "sizes: %s\n", "what: %s\n",
                                        "data file: %s\n", "%s\n",        "units: %s\r"};
    char text[2000], header[8192];
    memset(text, 'A', sizeof text);
    text[sizeof text - 1] = '\0';
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        strcpy(header, "NRRD0004\n");
        snprintf(header + strlen(header), sizeof header - strlen(header), lines[i], text);
        refused(put_text(*state, "h.nrrd", header, "", 0), NULL, "more than 512 bytes");
    }
    const char hidden[] = "NRRD0004\r# \rdata file: %s%n 1 2 1\r\n";
    refused(put_text(*state, "h.nrrd", hidden, "", 0), NULL, "several");
    unsigned char data[COUNT];
    encode(VOLUME_UINT8, false, false, data);
    snprintf(header, sizeof header,
             "NRRD0004\n# %s\ncontent: %s\nkey:=%s\ntype: uchar\ndimension: 3\nsizes: 5 4 3\nencoding: raw\n\n", text,
             text, text);
    check_pattern(put_text(*state, "h.nrrd", header, data, COUNT), NULL, VOLUME_UINT8, "nrrd");
}

static void nrrd_refusals(void **state)
{
    static const struct {
        const char *header;
        size_t bytes;
        const char *part;
    } cases[] = {
        {"type: uchar\ndimension: 3\nsizes: 5 4 3\nencoding: raw\n\n", COUNT - 1, "59 bytes"},
        {"type: uchar\ndimension: 3\nsizes: 5 4 3\nencoding: raw\n\n", COUNT + 1, "61 bytes"},
        {"type: uchar\ndimension: 3\nsizes: 5 4 3\nencoding: gzip\n\n", COUNT, "not gzip"},
        {"type: uchar\ndimension: 3\nsizes: 30000 30000 30000\nencoding: raw\n\n", COUNT, "27000000000000"},
        {"type: uchar\ndimension: 3\nsizes: 30000 30000 30000\nencoding: gzip\n\n", COUNT, "ends early"},
        {"type: uchar\ndimension: 3\nsizes: 30000 30000 30000\nencoding: ascii\n\n", COUNT, "ends early"},
        {"type: uchar\ndimension: 3\nsizes: 5 4 2147483648\nencoding: raw\n\n", COUNT, "2147483648"},
        {"type: uchar\ndimension: 3\nsizes: 5 0 3\nencoding: raw\n\n", COUNT, "sizes holds 0, must be 1 to 32768"},
        {"type: uchar\ndimension: 3\nsizes: 5 -4 3\nencoding: raw\n\n", COUNT, "sizes holds -4"},
        {"type: uchar\ndimension: 2\nsizes: 12 5\nencoding: raw\n\n", COUNT, "dimension is 2"},
        {"type: uchar\ndimension: 4\nsizes: 3 5 2 2\nencoding: raw\n\n", COUNT, "dimension is 4"},
        {"type: int64\ndimension: 3\nsizes: 5 4 3\nendian: little\nencoding: raw\n\n", COUNT, "type is"},
        {"type: block\nblock size: 3\ndimension: 3\nsizes: 5 4 1\nendian: little\nencoding: raw\n\n", COUNT,
         "type is block"},
        {"type: what\ndimension: 3\nsizes: 5 4 3\nencoding: raw\n\n", COUNT, "what"},
        {"type: uchar\ndimension: 3\nsizes: 5 4 3\nencoding: hex\n\n", COUNT, "encoding is hex"},
        {"type: uchar\ndimension: 3\nsizes: 5 4 3\nspacings: 1 0 1\nencoding: raw\n\n", COUNT, "spacing"},
        {"type: uchar\ndimension: 3\nsizes: 5 4 3\nspacings: 1 -2 1\nencoding: raw\n\n", COUNT,
         "spacing along y is -2, must be above 0"},
        {"type: uchar\ndimension: 3\nsizes: 5 4 3\nspacings: 1 1e30 1\nencoding: raw\n\n", COUNT, "differ by more"},
        {"type: uchar\ndimension: 3\nsizes: 5 4 3\nspacings: 1 inf 1\nencoding: raw\n\n", COUNT, ""},
        {"type: uchar\ndimension: 3\nsizes: 5 4 3\nspace: RAS\nspace directions: (0,0,0) (0,1,0) (0,0,1)\n"
         "encoding: raw\n\n",
         COUNT, "spacing along x"},
        {"type: uchar\ndimension: 3\nsizes: 5 4 3\nspace: RAS\nspace directions: (1,0,0) (2,0,0) (0,0,1)\n"
         "encoding: raw\n\n",
         COUNT, "has no rotation"},
        {"type: uchar\ndimension: 3\nsizes: 5 4 3\nencoding: raw\ndata file: missing.raw\n\n", 0, "NRRD"},
        {"type: uchar\ndimension: 3\nsizes: 5 4 3\nencoding: raw\ndata file: %d.raw 1 3 1\n\n", 0, "several"},
        {"type: uchar\ndimension: 3\nsizes: 5 4 3\nencoding: raw\ndata file: LIST\na\nb\n", 0, "several"},
        {"type: uchar\ndimension: 3\nsizes: 5 4 3\nencoding: raw\ndata file: -\n", 0, "'-'"},
        {"type: uchar\ndimension: 3\nsizes: 5 4 3\nencoding: raw\ndata file: .\n", 0, ""},
        {"type: uchar\n", 0, "NRRD"},
        {"", 0, "NRRD"},
    };
    unsigned char data[COUNT + 1] = {0};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char header[512];
        snprintf(header, sizeof header, "NRRD0004\n%s", cases[i].header);
        refused(put_text(*state, "r.nrrd", header, data, cases[i].bytes), NULL, cases[i].part);
    }
}

/* ---- raw, crop, damaged files ---- */

static void raw_files(void **state)
{
    unsigned char data[COUNT * 4];
    for (int type = 0; type < 7; type++)
        for (int big = 0; big < 2; big++) {
            size_t bytes = encode((volume_type)type, big, false, data);
            volume_options o = {.dims_vox = {W, H, D}, .type = (volume_type)type, .big_endian = big};
            const char *path = put(*state, "a.raw", "", 0, data, bytes, false);
            check_pattern(path, &o, (volume_type)type, "raw");
            o.spacing[1] = 2.5;
            check_geometry(path, &o, (const double[]){1, 2.5, 1}, (const int[]){0, 1, 2}, (const int[]){1, 1, 1});
            o.dims_vox[0]++;
            refused(path, &o, "6x4x3");
        }
    fixture *f = *state;
    refused(f->path, NULL, "neither NRRD nor NIfTI");
    volume_options o = {.dims_vox = {W, H, -1}};
    refused(f->path, &o, "along z is -1");
    o.dims_vox[2] = VODR_MAX_DIM_VOX + 1;
    refused(f->path, &o, "1 to 32768");
    refused(put(f, "empty", "", 0, "", 0, false), &o, "empty");
    refused(f->directory, &o, "directory");
    refused("/dev/null", &o, "regular");
    snprintf(f->path, sizeof f->path, "%s/missing", f->directory);
    refused(f->path, &o, "missing");
}

static void check_crop(const char *path, volume_options o)
{
    for (int mask = 0; mask < 64; mask++) {
        const int dims[3] = {W, H, D};
        volume v;
        o.crop = true;
        for (int i = 0; i < 3; i++) {
            o.crop_lo[i] = mask >> i & 1;
            o.crop_hi[i] = dims[i] - (mask >> (i + 3) & 1);
        }
        open_ok(path, &o, &v);
        size_t at = 0;
        for (int z = o.crop_lo[2]; z < o.crop_hi[2]; z++)
            for (int y = o.crop_lo[1]; y < o.crop_hi[1]; y++)
                for (int x = o.crop_lo[0]; x < o.crop_hi[0]; x++)
                    assert_true(volume_value(&v, at++) == pattern(x + W * (y + H * z)));
        assert_int_equal(at, volume_count(&v));
        volume_close(&v);
    }
    o.crop_hi[1] = H + 1;
    refused(path, &o, "--crop: the range along y");
    o.crop_lo[1] = o.crop_hi[1] = 1;
    refused(path, &o, "--crop: the range along y");
}

static void crops(void **state)
{
    fixture *f = *state;
    unsigned char data[COUNT * 8];
    size_t bytes = encode(VOLUME_INT16, true, false, data);
    put(f, "a.raw", "", 0, data, bytes, false);
    check_crop(f->path, (volume_options){.dims_vox = {W, H, D}, .type = VOLUME_INT16, .big_endian = true});
    const char head[] = "NRRD0004\ntype: short\ndimension: 3\nsizes: 5 4 3\nendian: big\nencoding: gzip\n\n";
    check_crop(put(f, "a.nrrd", head, strlen(head), data, bytes, true), (volume_options){0});
    bytes = encode(VOLUME_FLOAT32, false, true, data);
    const char wide[] = "NRRD0004\ntype: double\ndimension: 3\nsizes: 5 4 3\nendian: little\nencoding: gzip\n\n";
    check_crop(put(f, "a.nrrd", wide, strlen(wide), data, bytes, true), (volume_options){0});
    char text[2048] = "NRRD0001\ntype: float\ndimension: 3\nsizes: 5 4 3\nencoding: ascii\n\n";
    for (int i = 0; i < COUNT; i++)
        snprintf(text + strlen(text), 16, "%g\n", pattern(i));
    check_crop(put_text(f, "t.nrrd", text, "", 0), (volume_options){0});
}

/* A gzip volume cut anywhere is refused, whether or not the crop needs what is missing. */
static void truncated_gzip(void **state)
{
    fixture *f = *state;
    unsigned char data[COUNT], file[1024];
    encode(VOLUME_UINT8, false, false, data);
    const char head[] = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 5 4 3\nencoding: gzip\n\n";
    put(f, "g.nrrd", head, strlen(head), data, COUNT, true);
    FILE *stream = fopen(f->path, "rb");
    size_t bytes = fread(file, 1, sizeof file, stream);
    fclose(stream);
    const volume_options crop = {.crop = true, .crop_hi = {2, 2, 1}};
    for (size_t cut = strlen(head); cut < bytes; cut++) {
        put(f, "g.nrrd", "", 0, file, cut, false);
        refused(f->path, NULL, "g.nrrd");
        refused(f->path, &crop, "g.nrrd");
    }
    file[bytes - 6] ^= 1;
    refused(put(f, "g.nrrd", "", 0, file, bytes, false), NULL, "damaged");
    const char less[] = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 5 4 2\nencoding: gzip\n\n";
    refused(put(f, "g.nrrd", less, strlen(less), data, COUNT, true), NULL, "more than");
    const char more[] = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 5 4 4\nencoding: gzip\n\n";
    put(f, "g.nrrd", more, strlen(more), data, COUNT, true);
    refused(f->path, NULL, "ends early");
    refused(f->path, &crop, "ends early");
}

/* ---- real files, where there are any ---- */

static void real_files(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        int dims[3];
        volume_type type;
        double min, max;
    } files[] = {
        {"bonsai", {256, 256, 256}, VOLUME_UINT8, 0, 255},
        {"tooth16", {103, 94, 161}, VOLUME_UINT16, 0, 1300},
        {"cranium", {256, 256, 108}, VOLUME_INT16, -1024, 2986},
        {"ch2_colin27", {181, 217, 181}, VOLUME_UINT8, 0, 254},
    };
    const char *directory = getenv("VODR_VOLUMES");
    directory = directory ? directory : "../shared/volumes";
    if (access(directory, R_OK) != 0)
        skip();
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        char path[512];
        volume v;
        snprintf(path, sizeof path, "%s/%s.nrrd", directory, files[i].name);
        open_ok(path, NULL, &v);
        assert_memory_equal(v.dims_vox, files[i].dims, sizeof v.dims_vox);
        assert_int_equal(v.type, files[i].type);
        assert_true(v.min == files[i].min && v.max == files[i].max);
        volume_close(&v);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nrrd_types_and_encodings),
        cmocka_unit_test(nrrd_text),
        cmocka_unit_test(nrrd_skips_and_axes),
        cmocka_unit_test(nrrd_orientation),
        cmocka_unit_test(nrrd_hostile_headers),
        cmocka_unit_test(nrrd_refusals),
        cmocka_unit_test(raw_files),
        cmocka_unit_test(crops),
        cmocka_unit_test(truncated_gzip),
        cmocka_unit_test(real_files),
    };
    return cmocka_run_group_tests(tests, fixture_make, fixture_remove);
}
