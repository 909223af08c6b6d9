/* seeds.c - writes small good files for the fuzzers to start from.
 *   seeds DIRECTORY    fills DIRECTORY/TARGET/ (which must be there) of every target */
#include <nifti2_io.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "image.h"
#include "vectors.h"

enum { X = 3, Y = 2, Z = 2, COUNT = X * Y * Z, BYTES = 8 * COUNT };

typedef struct seeds {
    const char *directory;
    char path[512];
    bool failed;
} seeds;

static const char *path_of(seeds *s, const char *target, const char *name)
{
    snprintf(s->path, sizeof s->path, "%s/%s/%s", s->directory, target, name);
    return s->path;
}

/* Writes a header as it is and then the data, zipped or not. */
static void put(seeds *s, const char *target, const char *name, const void *header, size_t header_bytes,
                const void *data, size_t bytes, bool zip)
{
    FILE *file = fopen(path_of(s, target, name), "wb");
    bool good = file && fwrite(header, 1, header_bytes, file) == header_bytes;
    good = good && (zip || fwrite(data, 1, bytes, file) == bytes);
    good = file && fclose(file) == 0 && good;
    gzFile stream = zip ? gzopen(s->path, "ab9") : NULL;
    if (zip)
        good = stream && gzwrite(stream, data, (unsigned)bytes) == (int)bytes && gzclose(stream) == Z_OK && good;
    s->failed = s->failed || !good;
}

static void put_text(seeds *s, const char *target, const char *name, const char *text)
{
    put(s, target, name, text, strlen(text), "", 0, false);
}

static void nrrd(seeds *s, const unsigned char *voxels)
{
    static const struct {
        const char *type, *encoding, *fields;
        size_t bytes;
    } files[] = {
        {"uchar", "raw", "", COUNT},
        {"int8", "gzip", "spacings: 1 nan 2\n", COUNT},
        {"uint16", "raw", "endian: big\nspace: RAS\nspace directions: (0,2,0) (1,0,0) (0,0,-1)\n", 2 * COUNT},
        {"short", "gzip", "endian: little\nspace dimension: 3\nspace directions: (0,2,0) (1,0,0) (0,0,-1)\n",
         2 * COUNT},
        {"uint", "raw", "endian: little\nline skip: 0\nbyte skip: 0\n", 4 * COUNT},
        {"int", "raw", "endian: little\nbyte skip: -1\nkey:=value\n# comment\ncontent: x\n", 4 * COUNT},
        {"float", "raw", "endian: little\nkinds: domain domain domain\n", 4 * COUNT},
        {"double", "raw", "endian: big\nlabels: \"x\" \"y\" \"z\"\nspace origin: (1,2,3)\nspace: LPS\n", 8 * COUNT},
    };
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        char header[512];
        snprintf(header, sizeof header, "NRRD0005\ntype: %s\ndimension: 3\nsizes: %d %d %d\nencoding: %s\n%s\n",
                 files[i].type, X, Y, Z, files[i].encoding, files[i].fields);
        put(s, "nrrd", files[i].type, header, strlen(header), voxels, files[i].bytes,
            strcmp(files[i].encoding, "gzip") == 0);
    }
    put_text(
        s, "nrrd", "ascii",
        "NRRD0001\ntype: float\ndimension: 3\nsizes: 3 2 2\nencoding: ascii\n\n1 2 nan 4,5\n-6 7e3 8 9 inf 11 12\n");
    put_text(s, "nrrd", "detached",
             "NRRD0004\ntype: uchar\ndimension: 4\nsizes: 1 3 2 2\nencoding: raw\ndata file: voxels\n");
}

static void nifti(seeds *s, const unsigned char *voxels)
{
    static const struct {
        const char *name;
        short code, bits;
        bool swap, zip, oriented;
    } files[] = {
        {"uint8", DT_UINT8, 8, false, false, false},   {"int8", DT_INT8, 8, false, true, true},
        {"uint16", DT_UINT16, 16, true, false, true},  {"int16", DT_INT16, 16, false, false, true},
        {"uint32", DT_UINT32, 32, false, true, false}, {"int32", DT_INT32, 32, false, false, false},
        {"float", DT_FLOAT32, 32, false, false, true}, {"double", DT_FLOAT64, 64, true, false, false},
    };
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        unsigned char all[352 + BYTES] = {0};
        nifti_1_header h = {.sizeof_hdr = 348, .dim = {3, X, Y, Z, 1, 1, 1, 1}, .pixdim = {1, 1, 2, 3}, .magic = "n+1"};
        size_t bytes = (size_t)files[i].bits / 8 * COUNT;
        h.datatype = files[i].code;
        h.bitpix = files[i].bits;
        h.vox_offset = 352;
        h.scl_slope = 2;
        h.sform_code = files[i].oriented;
        h.qform_code = files[i].swap;
        h.srow_x[1] = -2, h.srow_y[2] = 3, h.srow_z[0] = 1;
        if (files[i].swap)
            swap_nifti_header(&h, 1);
        memcpy(all, &h, sizeof h);
        memcpy(all + 352, voxels, bytes);
        put(s, "nifti", files[i].name, "", 0, all, 352 + bytes, files[i].zip);
        if (!files[i].zip)
            put(s, "nifti", files[i].name, all, 352 + bytes, "", 0, false);
    }
    nifti_2_header h = {.sizeof_hdr = 540, .magic = "n+2\0\r\n\032\n", .datatype = DT_UINT8, .bitpix = 8};
    unsigned char all[544 + COUNT] = {0};
    const int64_t dims[8] = {3, X, Y, Z, 1, 1, 1, 1};
    memcpy(h.dim, dims, sizeof dims);
    h.pixdim[1] = h.pixdim[2] = h.pixdim[3] = 1;
    h.vox_offset = 544;
    memcpy(all, &h, sizeof h);
    memcpy(all + 544, voxels, COUNT);
    put(s, "nifti", "nifti2", all, sizeof all, "", 0, false);
}

static void texts(seeds *s)
{
    put_text(s, "machine", "all", "# a machine\ntraversal = tile\nline_px=4x4 # lines\nways = 2\nfb_bits = 16\n");
    put_text(s, "costs", "energy", "# pJ\nadd | 0.03\nsram_word|10 | 64 bits\n");
    put_text(s, "costs", "cells", "pixel_cache WAYS=2 LINE_W=8 | 70 | 8 | 9\nrasterizer | 9 word bits | 2\n");
    put_text(s, "transfer", "units", "# comment\n-100 0 0 0 0\r\n  300 1 0.5 0 0.8\n\n1e3 1 1 1 1\n");
    put_text(s, "transfer", "rows", "gradient 1\n0 1 1 1 0\n2 1 1 1 0\ngradient 20\n1 1 1 1 0.05\n");
    put_text(s, "transfer", "normalized", "# normalized\n0 1 1 1 0\n1 1 1 1 0.05\n");
    static const char *const spaces[] = {"RGB", "HSV", "Lab", "Diverging"};
    for (int i = 0; i < 4; i++) {
        char text[512];
        snprintf(
            text, sizeof text,
            "[{\"ColorSpace\":\"%s\",\"HSVWrap\":%d,\"Name\":\"x\",\"NanColor\":[1,0,0],\n\"RGBPoints\":[0,0.2,0.3,"
            "0.8,100,0.9,0.9,0.9,255,0.7,0.1,0.1],\"Points\":[0,0,0.5,0,128,0.2,0.3,0.5,255,1,0.5,1]}]\n",
            spaces[i], i);
        put_text(s, "paraview", spaces[i], text);
    }
    put_text(s, "paraview", "object", "{\"RGBPoints\":[0,0,0,0,1,1,1,1],\"Normalized\":true}");
}

static void pictures(seeds *s)
{
    uint16_t pixels[4 * COUNT];
    for (int i = 0; i < 4 * COUNT; i++)
        pixels[i] = (uint16_t)(i % 4 == 3 ? 65535 : i * 1000);
    for (int i = 0; i < 4; i++) {
        vodr_frame frame = {.width_px = 4, .height_px = 3, .bits = i & 1 ? 16 : 8, .pixels = pixels};
        output o = {0};
        host_error error;
        const char *path = path_of(s, "png", (const char *[]){"rgb8", "rgb16", "rgba8", "rgba16"}[i]);
        bool good = output_open(&o, path, &error) == HOST_OK &&
                    image_write_png(&o, &frame, &(image_style){.alpha = i & 2}, &error) == HOST_OK &&
                    output_close(&o, &error) == HOST_OK && output_commit(&o, &error) == HOST_OK;
        output_discard(&o);
        s->failed = s->failed || !good;
    }
}

/* The beginning of what is generated, and the last line that it then needs. */
static void vectors(seeds *s)
{
    enum { CYCLES = 20 };
    for (int block = 0; block < VODR_BLOCK_COUNT; block++) {
        const vectors_choice choice = vectors_choice_default((vodr_block)block);
        char *text = NULL, name[8];
        size_t size = 0, cycles = 0;
        FILE *file = open_memstream(&text, &size);
        bool good = file && vectors_generate(&choice, file, NULL) == VECTORS_OK;
        good = file && fclose(file) == 0 && good;
        char *end = good ? text : NULL;
        while (end && cycles < CYCLES) {
            cycles += *end == '0' || *end == '1';
            end = strchr(end, '\n') + 1;
        }
        if (end)
            sprintf(end, "end %d\n", CYCLES);
        snprintf(name, sizeof name, "%d", block);
        if (end)
            put_text(s, "vectors", name, text);
        s->failed = s->failed || !end;
        free(text);
    }
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fputs("usage: seeds DIRECTORY\n", stderr);
        return 2;
    }
    seeds s = {.directory = argv[1]};
    unsigned char voxels[BYTES];
    for (int i = 0; i < BYTES; i++)
        voxels[i] = (unsigned char)(i * 37);
    nrrd(&s, voxels);
    nifti(&s, voxels);
    texts(&s);
    pictures(&s);
    vectors(&s);
    if (s.failed)
        fprintf(stderr, "seeds: cannot write under %s\n", s.directory);
    return s.failed ? 3 : 0;
}
