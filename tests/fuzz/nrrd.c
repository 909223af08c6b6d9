/* nrrd.c - fuzzes the reader of NRRD files. */
#include "fuzz.h"

#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size < 8 || memcmp(data, "NRRD000", 7) != 0)
        return -1;
    fuzz_volume(data, size);
    return 0;
}
