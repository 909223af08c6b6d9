/* digest.c - a frame's SHA-256 (libcrypto). */
#include "digest.h"

#include <openssl/evp.h>
#include <stdio.h>
#include <stdlib.h>

#include "image.h"

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
        return host_fail(error, HOST_ENVIRONMENT, "libcrypto cannot compute the frame's SHA-256");
    for (int i = 0; i < (DIGEST_CHARS - 1) / 2; i++)
        snprintf(hex + 2 * i, 3, "%02x", hash[i]);
    return HOST_OK;
}
