/* paraview.c - fuzzes transfer functions as ParaView's colour maps. */
#include "fuzz.h"
#include "transfer_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_transfer(data, size, transfer_parse_paraview);
    return 0;
}
