/* digest.h - SHA-256 of frames, voxels and files. */
#ifndef HOST_DIGEST_H
#define HOST_DIGEST_H

#include "host.h"
#include "vodr.h"

enum { DIGEST_CHARS = 65 };

/* SHA-256, in lower-case hexadecimal, of exactly the bytes that --raw writes. */
host_status digest_frame(const vodr_frame *frame, char hex[DIGEST_CHARS], host_error *error);

/* SHA-256 of bytes in memory; of a file's content. */
host_status digest_bytes(const void *bytes, size_t count, char hex[DIGEST_CHARS], host_error *error);
host_status digest_file(const char *path, char hex[DIGEST_CHARS], host_error *error);

#endif
