/* machine.c - fuzzes machine files. */
#include "fuzz.h"

#include <stdlib.h>
#include <string.h>

#include "vodr.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = fuzz_text(data, size);
    if (!text)
        return 0;
    vodr_machine machine = vodr_machine_default();
    vodr_error error = {""};
    if (vodr_machine_parse(text, "fuzz", &machine, &error) != VODR_OK ||
        vodr_machine_check(&machine, &error) != VODR_OK)
        fuzz_check(error.text[0] && !strchr(error.text, '\n'), "a failure has one sentence");
    free(text);
    return 0;
}
