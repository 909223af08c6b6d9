/* vectors.h - the public face of test vectors of single blocks (docs/vectors.md). */
#ifndef VECTORS_H
#define VECTORS_H

#include <stdio.h>

#include "vodr.h"

#define VECTORS_VERSION "1"

typedef enum vectors_status {
    VECTORS_OK,
    VECTORS_DIFFERENT,   /* an output is not what the model has; the sentence says line, column, expected and got */
    VECTORS_INVALID,     /* no such vectors; the sentence says line and reason */
    VECTORS_ENVIRONMENT, /* no memory, or the file cannot be read or written */
} vectors_status;

/* What vectors are made of. */
typedef struct vectors_choice {
    vodr_block block;
    int32_t level; /* 1 or 2 */
    uint64_t seed;
    vodr_machine machine; /* what its case does not draw anew */
} vectors_choice;

/* Level 1, seed 1, and the block's machine. */
vectors_choice vectors_choice_default(vodr_block block);

/* The block of this name; VODR_BLOCK_COUNT when there is none. */
vodr_block vectors_block(const char *name);

/* Writes vectors. */
vectors_status vectors_generate(const vectors_choice *choice, FILE *file, vodr_error *error);

/* Reads vectors of a block and recomputes every output; `where` names the file in sentences. *transactions counts the
 * cycles that were compared. */
vectors_status vectors_check(vodr_block block, FILE *file, const char *where, uint64_t *transactions,
                             vodr_error *error);

#endif
