/* vectors.c - fuzzes the check of test vectors: whatever stands in them, the block in C is clocked with it or not. */
#include "vectors.h"

#include <stdio.h>
#include <string.h>

#include "fuzz.h"

/* The block that the first line names; the first one where it names none. */
static vodr_block block_of(const uint8_t *data, size_t size)
{
    char line[128] = "", name[32];
    memcpy(line, data, size < sizeof line - 1 ? size : sizeof line - 1);
    const char *at = strstr(line, "block=");
    vodr_block block = VODR_BLOCK_COUNT;
    if (at && sscanf(at, "block=%31[a-z_]", name) == 1)
        block = vectors_block(name);
    return block < VODR_BLOCK_COUNT ? block : VODR_BLOCK_VOLUME_DIVIDER;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    vodr_error error = {""};
    uint64_t cycles;
    FILE *file = fmemopen((void *)data, size ? size : 1, "r");
    if (!file)
        return 0;
    vectors_status status = vectors_check(block_of(data, size), file, "fuzz", &cycles, &error);
    fuzz_check(status == VECTORS_OK || (error.text[0] && !strchr(error.text, '\n')), "a failure has one sentence");
    fclose(file);
    return 0;
}
