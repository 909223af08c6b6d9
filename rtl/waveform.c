#include "waveform.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static void show(FILE *file, const char *module, const vodr_rtl_port *p)
{
    fprintf(file, "TOP.%s.%s", module, p->name);
    if (p->width_bits > 1)
        fprintf(file, "[%d:0]", p->width_bits - 1);
    fputc('\n', file);
}

static bool save(const char *path, const char *stem, const waveform *w, const difference *d, uint64_t cycle)
{
    const rtl_library *l = &w->block->library;
    const char *module = signals_of(w->block->block)->name, *base = strrchr(stem, '/');
    FILE *file = fopen(path, "w");
    if (!file)
        return false;
    fprintf(file, "[*] the first difference: cycle %" PRIu64 ", port %s, expected %s, got %s\n", cycle, d->field->name,
            d->expected, d->got);
    fprintf(file, "[dumpfile] \"%s.fst\"\n[timestart] %" PRIu64 "\n[sst_expanded] 1\n*-3 %" PRIu64 "\n",
            base ? base + 1 : stem, 2 * (cycle > 20 ? cycle - 20 : 0), 2 * cycle + 1);
    const vodr_rtl_port *differs = rtl_library_port(l, d->field->name);
    show(file, module, rtl_library_port(l, "clk"));
    if (differs)
        show(file, module, differs);
    for (int32_t i = 0; i < l->model.port_count; i++)
        if (&l->model.ports[i] != differs && strcmp(l->model.ports[i].name, "clk") != 0)
            show(file, module, &l->model.ports[i]);
    return fclose(file) == 0;
}

rtl_status waveform_open(waveform *w, const char *stem, rtl_block *block, const difference *d, uint64_t cycle,
                         vodr_error *error)
{
    char path[4096];
    *w = (waveform){.block = block,
                    .first_cycle = cycle > WAVEFORM_BEFORE_CYCLES ? cycle - WAVEFORM_BEFORE_CYCLES : 0,
                    .end_cycle = cycle + 1 + WAVEFORM_AFTER_CYCLES};
    snprintf(path, sizeof path, "%s.fst", stem);
    if (!block->library.model.trace(block->library.model.state, path))
        return rtl_fail(error, RTL_ENVIRONMENT, "%s cannot be written", path);
    snprintf(path, sizeof path, "%s.gtkw", stem);
    if (!save(path, stem, w, d, cycle))
        return rtl_fail(error, RTL_ENVIRONMENT, "%s cannot be written: %s", path, strerror(errno));
    return RTL_OK;
}

void waveform_cycle(waveform *w, uint64_t cycle)
{
    w->block->dumps = cycle >= w->first_cycle;
    w->block->time = 2 * cycle;
}
