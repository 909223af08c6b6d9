/* png.c - fuzzes the reading of pictures by `vodr compare`. Checksums are put right first, else hardly any input would
 * come further than the first chunk; inputs of an odd length keep theirs. */
#include "fuzz.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "image.h"

static size_t big_endian(const uint8_t *bytes)
{
    return (size_t)bytes[0] << 24 | (size_t)bytes[1] << 16 | (size_t)bytes[2] << 8 | bytes[3];
}

static void mend_checksums(uint8_t *bytes, size_t size)
{
    enum { SIGNATURE = 8, FRAME = 12 }; /* of a chunk: length, type, checksum */
    for (size_t at = SIGNATURE; at + FRAME <= size;) {
        size_t length = big_endian(bytes + at);
        if (length > size - at - FRAME)
            return;
        uint8_t *checksum = bytes + at + 8 + length;
        uLong crc = crc32(0, bytes + at + 4, (uInt)(length + 4));
        for (int i = 0; i < 4; i++)
            checksum[i] = (uint8_t)(crc >> (24 - 8 * i));
        at += FRAME + length;
    }
}

static void read_picture(const uint8_t *data, size_t size)
{
    fuzz_file file;
    image picture;
    host_error error = {""};
    fuzz_open(&file, data, size);
    host_status status = image_read_png(file.path, &picture, &error);
    if (status == HOST_OK) {
        size_t count = 4 * (size_t)picture.width_px * (size_t)picture.height_px;
        for (size_t i = 3; i < count && !picture.has_alpha; i += 4)
            fuzz_check(picture.rgba[i] == 65535, "a picture without transparency is opaque");
        image_free(&picture);
    } else {
        fuzz_refused(status, error.text);
    }
    fuzz_close(&file);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    uint8_t *bytes = malloc(size + 1);
    fuzz_check(bytes != NULL, "there is memory");
    memcpy(bytes, data, size);
    if (size % 2 == 0)
        mend_checksums(bytes, size);
    read_picture(bytes, size);
    free(bytes);
    return 0;
}
