/* digest.h - a frame's SHA-256. */
#ifndef HOST_DIGEST_H
#define HOST_DIGEST_H

#include "host.h"
#include "vodr.h"

enum { DIGEST_CHARS = 65 };

/* SHA-256, in lower-case hexadecimal, of exactly the bytes that --raw writes. */
host_status digest_frame(const vodr_frame *frame, char hex[DIGEST_CHARS], host_error *error);

#endif
