/* costs.c - fuzzes what costs are reckoned from: tables of energies and of cells. */
#include "fuzz.h"

#include <stdlib.h>

#include "costs.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = fuzz_text(data, size);
    if (!text)
        return 0;
    host_error error;
    energy_table energy;
    host_status status = energy_parse(text, "fuzz", &energy, &error);
    if (status != HOST_OK)
        fuzz_refused(status, error.text);
    cell_table cells = {0};
    cell_counts counts;
    const vodr_machine machine = vodr_machine_default();
    status = cell_table_parse(text, "fuzz", &cells, &error);
    if (status != HOST_OK)
        fuzz_refused(status, error.text);
    else if (cells_of(&cells, &machine, &counts))
        fuzz_check(counts.cells >= 0 && counts.word_bits >= 0 && counts.flip_flops >= 0, "sums are not negative");
    cell_table_free(&cells);
    free(text);
    return 0;
}
