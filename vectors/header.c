#include "header.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "columns.h"
#include "error.h"
#include "modules.h"
#include "registers.h"

#define MAGIC "vodr-vectors "

vodr_block vectors_block(const char *name)
{
    int block = 0;
    while (block < VODR_BLOCK_COUNT && strcmp(signals_of((vodr_block)block)->name, name) != 0)
        block++;
    return (vodr_block)block;
}

vectors_choice vectors_choice_default(vodr_block block)
{
    vectors_choice c = {.block = block, .level = 1, .seed = 1};
    vodr_machine_named("paper-16", &c.machine, NULL);
    bench_set(&c.machine, bench_of(block)->vectors, NULL);
    return c;
}

/* ---- writing ---- */

void header_put_machine(FILE *file, const vodr_machine *machine, const vodr_machine *from, char between)
{
    size_t count;
    const vodr_parameter *p = vodr_parameters(&count);
    bool first = true;
    for (size_t i = 0; i < count; i++) {
        char value[64], other[64];
        vodr_machine_get(machine, &p[i], value, sizeof value);
        vodr_machine_get(from, &p[i], other, sizeof other);
        if (strcmp(value, other) == 0)
            continue;
        if (!first)
            fputc(between, file);
        first = false;
        fprintf(file, "%s=%s", p[i].name, value);
    }
}

static bool put_parameters(FILE *file, vodr_block block, const block_setup *setup)
{
    rtl_registers *registers = rtl_registers_of(setup);
    const char *separator = "";
    for (const char *const *p = rtl_module_of(block)->parameters; registers && *p; p++) {
        int64_t value = 0;
        rtl_parameter(registers, *p, &value);
        fprintf(file, "%s%s=%" PRId64, separator, *p, value);
        separator = ",";
    }
    free(registers);
    return registers != NULL;
}

static void put_columns(FILE *file, const columns *c, int32_t first, int32_t end)
{
    for (int32_t i = first; i < end; i++)
        fprintf(file, "%s%s:%" PRId32, i > first ? "," : "", c->at[i].name, c->at[i].width_bits);
}

char *header_text(const vectors_choice *choice, const bench *b)
{
    char *text = NULL;
    size_t size;
    FILE *file = open_memstream(&text, &size);
    const rtl_module *m = rtl_module_of(choice->block);
    const vodr_machine from = vodr_machine_default();
    columns c;
    if (!file)
        return NULL;
    columns_of(&c, choice->block, &b->machine);
    fprintf(file, MAGIC VECTORS_VERSION " block=%s level=%" PRId32 " seed=%" PRIu64 " machine=",
            signals_of(choice->block)->name, choice->level, choice->seed);
    header_put_machine(file, &choice->machine, &from, ',');
    fputs(" parameters=", file);
    bool good = put_parameters(file, choice->block, &b->setup);
    fputs(" registers=", file);
    for (const module_register *r = m->registers; r->name; r++)
        fprintf(file, "%s%s:%" PRId32, r > m->registers ? "," : "", r->name, r->width_bits);
    fputs(" table=", file);
    if (m->table)
        fprintf(file, "%s:%" PRId32, m->table, rtl_table_bits(choice->block, &b->machine));
    fputs(" inputs=", file);
    put_columns(file, &c, 0, c.inputs);
    fputs(" outputs=", file);
    put_columns(file, &c, c.inputs, c.count);
    good &= !ferror(file);
    if (fclose(file) != 0 || !good) {
        free(text);
        return NULL;
    }
    return text;
}

/* ---- reading ---- */

static vectors_status refuse(vodr_error *error, const char *what, const char *word)
{
    int length = (int)strcspn(word, " ");
    vodr_fail(error, VODR_INVALID, "%s, not '%.*s'", what, length < 60 ? length : 60, word);
    return VECTORS_INVALID;
}

/* The text after `key` where the line has it; NULL where something else stands. */
static const char *after(const char *line, const char *key)
{
    size_t length = strlen(key);
    return strncmp(line, key, length) == 0 ? line + length : NULL;
}

static vectors_status read_machine(const char *text, vodr_machine *machine, vodr_error *error)
{
    size_t length = strcspn(text, " ");
    char *settings = malloc(length + 1);
    if (!settings)
        return VECTORS_ENVIRONMENT;
    memcpy(settings, text, length);
    settings[length] = '\0';
    for (char *comma = settings; (comma = strchr(comma, ',')) != NULL;)
        *comma = ' ';
    *machine = vodr_machine_default();
    vodr_status status = bench_set(machine, settings, error);
    free(settings);
    return status == VODR_OK ? VECTORS_OK : VECTORS_INVALID;
}

vectors_status header_read(const char *line, vectors_choice *choice, vodr_error *error)
{
    char name[32];
    const char *word = after(line, MAGIC), *next;
    int length = 0;
    if (!word)
        return refuse(error, "vectors begin with '" MAGIC VECTORS_VERSION "'", line);
    if (strncmp(word, VECTORS_VERSION " ", strlen(VECTORS_VERSION) + 1) != 0)
        return refuse(error, "the version must be " VECTORS_VERSION, word);
    word = strchr(word, ' ') + 1;
    if (sscanf(word, "block=%31[a-z_]%n", name, &length) != 1 || word[length] != ' ')
        return refuse(error, "block=NAME must follow the version", word);
    *choice = (vectors_choice){.block = vectors_block(name)};
    if (choice->block == VODR_BLOCK_COUNT)
        return refuse(error, "block= must be followed by a block's name", name);
    word += length + 1;
    if (sscanf(word, "level=%1" SCNd32 " seed=%20" SCNu64 "%n", &choice->level, &choice->seed, &length) != 2 ||
        word[length] != ' ')
        return refuse(error, "level=1|2 seed=NUMBER must follow the block", word);
    word += length + 1;
    next = after(word, "machine=");
    if (!next)
        return refuse(error, "machine=NAME=VALUE,... must follow the seed", word);
    return read_machine(next, &choice->machine, error);
}
