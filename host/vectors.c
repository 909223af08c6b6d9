/* vectors.c - `vodr vectors generate | check BLOCK`: test vectors of one block (docs/vectors.md). */
#include "vectors.h"

#include <inttypes.h>
#include <string.h>

#include "commands.h"
#include "text.h"

#define BLOCKS "volume_divider, slice_generator, rasterizer, texture_unit, alpha_blender, pixel_cache or frame_buffer"

enum { MOST_SETTINGS = 64 };

typedef struct options {
    int64_t level;
    uint64_t seed;
    const char *settings[MOST_SETTINGS]; /* of --set */
    size_t setting_count;
    bool any; /* one was given */
} options;

static host_status set_level(void *target, const option *o, const char *value, host_error *error)
{
    options *c = target;
    c->any = true;
    return text_integer(value, 1, 2, &c->level) ? HOST_OK : option_refuse(o, value, "1 or 2", error);
}

static host_status set_seed(void *target, const option *o, const char *value, host_error *error)
{
    options *c = target;
    int64_t seed;
    c->any = true;
    if (!text_integer(value, 0, INT64_MAX, &seed))
        return option_refuse(o, value, "0 to 9223372036854775807", error);
    c->seed = (uint64_t)seed;
    return HOST_OK;
}

static host_status set_parameter(void *target, const option *o, const char *value, host_error *error)
{
    options *c = target;
    c->any = true;
    if (!strchr(value, '='))
        return option_refuse(o, value, "PARAM=VALUE", error);
    if (c->setting_count == MOST_SETTINGS)
        return host_fail(error, HOST_BAD_INPUT, "--set: may be given %d times", MOST_SETTINGS);
    c->settings[c->setting_count++] = value;
    return HOST_OK;
}

static const option rows[] = {
    {"level", 0, "LEVEL", false, set_level, "1, 10^4 cycles and some more, or 2, 10^6 (1)"},
    {"seed", 0, "SEED", false, set_seed, "other vectors (1)"},
    {"set", 0, "PARAM=VALUE", true, set_parameter,
     "a machine parameter that the block has as a parameter of its module; registers are\n"
     "drawn anew for each case (`vodr machine show paper-16`)"},
};
static const option_table table = {"Options of generate:", rows, sizeof rows / sizeof *rows};

static host_status apply(const options *o, vodr_machine *machine, host_error *error)
{
    vodr_error reason;
    for (size_t i = 0; i < o->setting_count; i++) {
        char name[64];
        size_t length = strcspn(o->settings[i], "=");
        snprintf(name, sizeof name, "%.*s", (int)(length < sizeof name ? length : sizeof name - 1), o->settings[i]);
        if (vodr_machine_set(machine, name, o->settings[i] + length + 1, &reason) != VODR_OK)
            return host_fail(error, HOST_BAD_INPUT, "--set '%s': %s", o->settings[i], reason.text);
    }
    return HOST_OK;
}

static host_status status_of(vectors_status status, const vodr_error *reason, host_error *error)
{
    static const host_status statuses[] = {HOST_OK, HOST_DIFFERENT, HOST_BAD_INPUT, HOST_ENVIRONMENT};
    return status == VECTORS_OK ? HOST_OK : host_fail(error, statuses[status], "%s", reason->text);
}

static host_status generate(vodr_block block, const options *o, host_error *error)
{
    vectors_choice choice = vectors_choice_default(block);
    vodr_error reason = {"no memory"};
    choice.level = (int32_t)o->level;
    choice.seed = o->seed;
    host_status status = apply(o, &choice.machine, error);
    return status == HOST_OK ? status_of(vectors_generate(&choice, stdout, &reason), &reason, error) : status;
}

static host_status check(vodr_block block, const char *name, const options *o, host_error *error)
{
    vodr_error reason = {""};
    uint64_t cycles;
    if (o->any)
        return host_fail(error, HOST_BAD_INPUT, "vectors check takes no options: vectors say what they are");
    host_status status = status_of(vectors_check(block, stdin, "standard input", &cycles, &reason), &reason, error);
    if (status == HOST_OK)
        printf("%s: %" PRIu64 " cycles, every output as expected\n", name, cycles);
    return status;
}

static host_status run(int argc, char **argv, host_error *error)
{
    const char *operands[OPTION_OPERANDS];
    options o = {.level = 1, .seed = 1};
    void *const targets[] = {&o};
    bool help;
    host_status status = options_parse(&command_vectors, argc, argv, targets, operands, &help, error);
    if (status != HOST_OK || help)
        return status;
    bool generates = strcmp(operands[0], "generate") == 0;
    vodr_block block = vectors_block(operands[1]);
    if (!generates && strcmp(operands[0], "check") != 0)
        return host_fail(error, HOST_BAD_INPUT, "vectors '%s': must be generate or check", operands[0]);
    if (block == VODR_BLOCK_COUNT)
        return host_fail(error, HOST_BAD_INPUT, "vectors %s '%s': must be " BLOCKS, operands[0], operands[1]);
    return generates ? generate(block, &o, error) : check(block, operands[1], &o, error);
}

const command command_vectors = {
    .name = "vectors",
    .operands = {"generate|check", "BLOCK"},
    .required = 2,
    .summary = "write test vectors of a block, or check some on standard input",
    .example = "  vodr vectors generate alpha_blender > blender.txt\n"
               "  vodr vectors generate alpha_blender | your_dut | vodr vectors check alpha_blender\n"
               "  BLOCK: volume_divider, slice_generator, rasterizer, texture_unit, alpha_blender, pixel_cache,\n"
               "  frame_buffer. The format is in docs/vectors.md.",
    .tables = {&table},
    .run = run,
};
