/* cells.c - finds a machine's blocks among the rows of what was synthesised. */
#include "cells.h"

#include <stdlib.h>
#include <string.h>

#include "cosim.h"
#include "modules.h"
#include "text.h"

enum { TOP = VODR_BLOCK_COUNT, MODULES, MOST_PARAMETERS = 16 };

static const char *const blanks = " \t\r";

static const char *module_name(int module)
{
    return module == TOP ? "vodr_top" : signals_of((vodr_block)module)->name;
}

/* Names up to NULL; vodr_top has none of its own: they are its blocks'. */
static const char *const *parameters_of(int module)
{
    static const char *const none[] = {NULL};
    return module == TOP ? none : rtl_module_of((vodr_block)module)->parameters;
}

static bool has_parameter(int module, const char *name)
{
    const char *const *p = parameters_of(module);
    while (*p && strcmp(*p, name) != 0)
        p++;
    return *p != NULL;
}

/* ---- reading ---- */

/* The next field of a line, blanks off both ends; *line moves behind its '|'. */
static char *next_field(char **line)
{
    char *field = *line + strspn(*line, blanks), *end = *line + strcspn(*line, "|");
    *line = end + (*end != '\0');
    while (end > field && strchr(blanks, end[-1]))
        end--;
    *end = '\0';
    return field;
}

/* MODULE [NAME=VALUE]...; the row takes the parameters. */
static host_status parse_name(char *text, const char *where, int number, cell_row *row, host_error *error)
{
    const size_t n = strcspn(text, blanks);
    char *parameters = text + n + strspn(text + n, blanks), *rest = NULL;
    text[n] = '\0';
    text_make_printable(text);
    row->module = 0;
    while (row->module < MODULES && strcmp(module_name(row->module), text) != 0)
        row->module++;
    if (row->module == MODULES)
        return host_fail(error, HOST_BAD_INPUT, "%s:%d: there is no module '%.64s'", where, number, text);
    row->parameters = strdup(parameters);
    if (!row->parameters)
        return host_fail(error, HOST_ENVIRONMENT, "no memory to read '%s'", where);
    for (char *p = strtok_r(parameters, blanks, &rest); p; p = strtok_r(NULL, blanks, &rest)) {
        int64_t value;
        text_make_printable(p);
        char *equals = strchr(p, '=');
        if (!equals || !text_integer(equals + 1, 0, INT32_MAX, &value))
            return host_fail(error, HOST_BAD_INPUT, "%s:%d: '%.64s' is not of the form NAME=VALUE", where, number, p);
        *equals = '\0';
        if (!has_parameter(row->module, p))
            return host_fail(error, HOST_BAD_INPUT, "%s:%d: %s has no parameter '%.64s'", where, number, text, p);
    }
    return HOST_OK;
}

static host_status parse_line(char *line, const char *where, int number, cell_row *row, host_error *error)
{
    char *name = next_field(&line), *count = next_field(&line), *flip_flops = next_field(&line);
    char *unit = strstr(count, " word bits");
    host_status status = parse_name(name, where, number, row, error);
    if (status != HOST_OK)
        return status;
    row->words = unit != NULL;
    if (unit)
        *unit = '\0';
    if (text_integer(count, 0, INT32_MAX, &row->count) && text_integer(flip_flops, 0, INT32_MAX, &row->flip_flops))
        return HOST_OK;
    return host_fail(error, HOST_BAD_INPUT, "%s:%d: is not of the form MODULE [NAME=VALUE]... | cells | flip-flops",
                     where, number);
}

static host_status add_line(char *line, const char *where, int number, cell_table *table, host_error *error)
{
    cell_row *grown = realloc(table->rows, (table->count + 1) * sizeof *grown);
    if (!grown)
        return host_fail(error, HOST_ENVIRONMENT, "no memory to read '%s'", where);
    table->rows = grown;
    grown[table->count] = (cell_row){0};
    return parse_line(line, where, number, &grown[table->count++], error);
}

host_status cell_table_parse(const char *text, const char *where, cell_table *table, host_error *error)
{
    host_status status = HOST_OK;
    for (int number = 1; status == HOST_OK && *text; number++) {
        const size_t n = strcspn(text, "\n");
        char *line = strndup(text, n);
        if (!line)
            return host_fail(error, HOST_ENVIRONMENT, "no memory to read '%s'", where);
        text += n + (text[n] == '\n');
        const char first = line[strspn(line, blanks)];
        if (first && first != '#')
            status = add_line(line, where, number, table, error);
        free(line);
    }
    return status;
}

host_status cell_table_open(const char *path, cell_table *table, host_error *error)
{
    *table = (cell_table){0};
    host_status status = cell_table_parse(rtl_synthesis_text, "rtl/synthesis.txt", table, error);
    char *text;
    if (status == HOST_OK && path && (status = text_read(path, "table of cells", &text, error)) == HOST_OK) {
        status = cell_table_parse(text, path, table, error);
        free(text);
    }
    return status;
}

void cell_table_free(cell_table *table)
{
    for (size_t i = 0; i < table->count; i++)
        free(table->rows[i].parameters);
    free(table->rows);
    *table = (cell_table){0};
}

/* ---- finding ---- */

/* Sets the value that a row gives a parameter; leaves it when the row does not name it. */
static void row_value(const cell_row *row, const char *name, int64_t *value)
{
    const size_t n = strlen(name);
    const char *p = row->parameters;
    while (*p) {
        if (strncmp(p, name, n) == 0 && p[n] == '=') {
            *value = strtoll(p + n + 1, NULL, 10);
            return;
        }
        p += strcspn(p, blanks);
        p += strspn(p, blanks);
    }
}

/* A module's parameters: what a machine needs, and what a row has that does not name them. */
typedef struct parameter_values {
    const char *const *names;
    int64_t wanted[MOST_PARAMETERS], standard[MOST_PARAMETERS];
} parameter_values;

static parameter_values values_of(int module, const vodr_machine *machine)
{
    const vodr_machine standard = vodr_machine_default();
    parameter_values v = {.names = parameters_of(module)};
    for (int i = 0; i < MOST_PARAMETERS && v.names[i]; i++) {
        rtl_machine_parameter(machine, v.names[i], &v.wanted[i]);
        rtl_machine_parameter(&standard, v.names[i], &v.standard[i]);
    }
    return v;
}

static bool row_is_of(const cell_row *row, const parameter_values *v)
{
    for (int i = 0; i < MOST_PARAMETERS && v->names[i]; i++) {
        int64_t has = v->standard[i];
        row_value(row, v->names[i], &has);
        if (has != v->wanted[i])
            return false;
    }
    return true;
}

static const cell_row *find_row(const cell_table *table, int module, const vodr_machine *machine)
{
    const parameter_values values = values_of(module, machine);
    for (size_t i = table->count; i-- > 0;)
        if (table->rows[i].module == module && row_is_of(&table->rows[i], &values))
            return &table->rows[i];
    return NULL;
}

bool cells_of(const cell_table *table, const vodr_machine *machine, cell_counts *counts)
{
    vodr_error reason;
    *counts = (cell_counts){0};
    for (int module = 0; module < MODULES; module++) {
        const cell_row *row = find_row(table, module, machine);
        if (!row || (module != TOP && cosim_check((vodr_block)module, machine, &reason) != RTL_OK))
            return false;
        *(row->words ? &counts->word_bits : &counts->cells) += row->count;
        counts->flip_flops += row->flip_flops;
    }
    return true;
}
