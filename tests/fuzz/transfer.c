/* transfer.c - fuzzes transfer functions as text. */
#include "fuzz.h"
#include "transfer_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_transfer(data, size, transfer_parse_text);
    return 0;
}
