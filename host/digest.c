/* digest.c - SHA-256 of frames, voxels and files (libcrypto). */
#include "digest.h"

#include <errno.h>
#include <openssl/evp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "image.h"

enum { BLOCK_BYTES = 1 << 16 };

static void put_hex(const uint8_t *hash, char hex[DIGEST_CHARS])
{
    for (int i = 0; i < (DIGEST_CHARS - 1) / 2; i++)
        snprintf(hex + 2 * i, 3, "%02x", hash[i]);
}

static host_status fail(const char *what, host_error *error)
{
    return host_fail(error, HOST_ENVIRONMENT, "libcrypto cannot compute the SHA-256 of %s", what);
}

host_status digest_frame(const vodr_frame *frame, char hex[DIGEST_CHARS], host_error *error)
{
    uint8_t hash[EVP_MAX_MD_SIZE];
    size_t row_bytes = image_raw_row_bytes(frame);
    uint8_t *row = malloc(row_bytes);
    EVP_MD_CTX *context = EVP_MD_CTX_new();
    bool ok = row && context && EVP_DigestInit_ex(context, EVP_sha256(), NULL) == 1;
    for (int32_t y = 0; ok && y < frame->height_px; y++) {
        image_raw_row(frame, y, row);
        ok = EVP_DigestUpdate(context, row, row_bytes) == 1;
    }
    ok = ok && EVP_DigestFinal_ex(context, hash, NULL) == 1;
    EVP_MD_CTX_free(context);
    free(row);
    if (!ok)
        return fail("the frame", error);
    put_hex(hash, hex);
    return HOST_OK;
}

host_status digest_bytes(const void *bytes, size_t count, char hex[DIGEST_CHARS], host_error *error)
{
    uint8_t hash[EVP_MAX_MD_SIZE];
    if (EVP_Digest(bytes, count, hash, NULL, EVP_sha256(), NULL) != 1)
        return fail("the voxels", error);
    put_hex(hash, hex);
    return HOST_OK;
}

host_status digest_file(const char *path, char hex[DIGEST_CHARS], host_error *error)
{
    uint8_t hash[EVP_MAX_MD_SIZE], *block = malloc(BLOCK_BYTES);
    EVP_MD_CTX *context = EVP_MD_CTX_new();
    FILE *file = fopen(path, "rb");
    int code = errno;
    bool ok = block && context && EVP_DigestInit_ex(context, EVP_sha256(), NULL) == 1;
    for (size_t n = 1; ok && file && n > 0;) {
        n = fread(block, 1, BLOCK_BYTES, file);
        ok = EVP_DigestUpdate(context, block, n) == 1;
    }
    ok = ok && EVP_DigestFinal_ex(context, hash, NULL) == 1;
    if (file && ferror(file))
        code = EIO;
    bool read = file && !ferror(file);
    EVP_MD_CTX_free(context);
    free(block);
    if (file)
        fclose(file);
    if (!read)
        return host_fail(error, HOST_BAD_INPUT, "%s: %s", path, strerror(code));
    if (!ok)
        return fail("a file", error);
    put_hex(hash, hex);
    return HOST_OK;
}
