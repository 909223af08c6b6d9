#include "cosim_options.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const block_names[VODR_BLOCK_COUNT + 1] = {
    "volume_divider", "slice_generator", "rasterizer",   "texture_unit",
    "alpha_blender",  "pixel_cache",     "frame_buffer", NULL};

#define RTL_FORM                                                                                                       \
    "all, top, or some of volume_divider, slice_generator, rasterizer, texture_unit, alpha_blender, pixel_cache, "     \
    "frame_buffer with commas between, each once, each perhaps with =FILE.v"

static host_status set_block(cosim_choice *c, const option *o, char *word, host_error *error)
{
    char *file = strchr(word, '=');
    if (file)
        *file++ = '\0';
    for (int b = 0; block_names[b]; b++) {
        if (strcmp(word, block_names[b]) != 0)
            continue;
        if (c->cosim.replaced[b] || (file && !*file))
            return option_refuse(o, word, RTL_FORM, error);
        c->cosim.replaced[b] = true;
        c->cosim.files[b] = file;
        return HOST_OK;
    }
    return option_refuse(o, word, RTL_FORM, error);
}

static host_status set_rtl(void *target, const option *o, const char *value, host_error *error)
{
    cosim_choice *c = target;
    host_status status = HOST_OK;
    c->any = true;
    if (strcmp(value, "all") == 0) {
        for (int b = 0; b < VODR_BLOCK_COUNT; b++)
            c->cosim.replaced[b] = true;
        return HOST_OK;
    }
    if (strcmp(value, "top") == 0) {
        c->cosim.top = true;
        return HOST_OK;
    }
    c->words = strdup(value);
    if (!c->words)
        return host_fail(error, HOST_ENVIRONMENT, "no memory");
    for (char *word = c->words, *next; status == HOST_OK && word; word = next) {
        next = strchr(word, ',');
        if (next)
            *next++ = '\0';
        status = set_block(c, o, word, error);
    }
    return status;
}

static host_status set_compare(void *target, const option *o, const char *value, host_error *error)
{
    static const char *const words[] = {"cycles", "transactions", NULL};
    cosim_choice *c = target;
    int index;
    host_status status = option_word(o, value, words, "cycles or transactions", &index, error);
    if (status == HOST_OK)
        c->cosim.compare = index == 0 ? COSIM_CYCLES : COSIM_TRANSACTIONS;
    c->compare_given = true;
    return status;
}

static const option rows[] = {
    {"rtl", 0, "BLOCKS", false, set_rtl,
     "blocks in Verilog, in lock-step with the model: all, BLOCK[=FILE.v],..., or top, all\n"
     "as one model; FILE.v is a block of yours with our ports (docs/cosimulation.md);\n"
     "counts cycles too"},
    {"compare", 0, "WHAT", false, set_compare, "with --rtl, what has to be equal: cycles, transactions (cycles)"},
};
const option_table option_cosim = {"Co-simulation (needs verilator and g++):", rows, sizeof rows / sizeof *rows};

cosim_choice cosim_choice_default(void)
{
    const char *root = getenv("VODR_ROOT");
    return (cosim_choice){.cosim = {.root = root ? root : VODR_ROOT, .build = VODR_BUILD}};
}

void cosim_choice_free(cosim_choice *c)
{
    free(c->words);
    free(c->waveform);
    c->words = c->waveform = NULL;
}

host_status cosim_choice_check(cosim_choice *c, const char *picture, host_error *error)
{
    if (c->compare_given && !c->any)
        return host_fail(error, HOST_BAD_INPUT, "--compare says what --rtl is held against, and there is no --rtl");
    const char *stem = picture && strcmp(picture, "-") != 0 ? picture : "vodr";
    const char *slash = strrchr(stem, '/'), *dot = strrchr(stem, '.');
    size_t length = dot && (!slash || dot > slash + 1) ? (size_t)(dot - stem) : strlen(stem);
    c->waveform = malloc(length + sizeof "-differs");
    if (!c->waveform)
        return host_fail(error, HOST_ENVIRONMENT, "no memory");
    memcpy(c->waveform, stem, length);
    strcpy(c->waveform + length, "-differs");
    c->cosim.waveform = c->waveform;
    return HOST_OK;
}
