/* nifti.c - fuzzes the reader of NIfTI files. */
#include "fuzz.h"

#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size < 4 || memcmp(data, "NRRD", 4) == 0)
        return -1;
    fuzz_volume(data, size);
    return 0;
}
