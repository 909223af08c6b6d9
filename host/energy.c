/* energy.c - reads the table of energies, hw/energy.txt or one that replaces it. */
#include "energy.h"

#include <stdlib.h>
#include <string.h>

#include "text.h"

static const char *const names[ENERGY_TERMS] = {
    [ENERGY_ADD] = "add",
    [ENERGY_MULTIPLY] = "multiply",
    [ENERGY_SRAM_WORD] = "sram_word",
    [ENERGY_DRAM_BYTE] = "dram_byte",
};

static const double most_pj = 1e9;

/* Cuts blanks off both ends, in place. */
static char *trim(char *text)
{
    text += strspn(text, " \t\r");
    size_t n = strlen(text);
    while (n && strchr(" \t\r", text[n - 1]))
        text[--n] = '\0';
    return text;
}

static host_status parse_line(char *line, const char *where, int number, bool *seen, energy_table *table,
                              host_error *error)
{
    char *bar = strchr(line, '|');
    if (!bar) {
        text_make_printable(line);
        return host_fail(error, HOST_BAD_INPUT, "%s:%d: '%.64s' is not of the form name | pJ", where, number, line);
    }
    *bar = '\0';
    char *name = trim(line), *value = bar + 1;
    value[strcspn(value, "|")] = '\0';
    value = trim(value);
    text_make_printable(name);
    text_make_printable(value);
    int term = 0;
    while (term < ENERGY_TERMS && strcmp(names[term], name) != 0)
        term++;
    if (term == ENERGY_TERMS)
        return host_fail(error, HOST_BAD_INPUT,
                         "%s:%d: there is no energy '%.64s'; there are add, multiply, sram_word and dram_byte", where,
                         number, name);
    if (seen[term])
        return host_fail(error, HOST_BAD_INPUT, "%s:%d: %s is there a second time", where, number, name);
    seen[term] = true;
    if (!text_number(value, 0, most_pj, &table->pj[term]))
        return host_fail(error, HOST_BAD_INPUT, "%s:%d: %s is '%.64s' but must be a number of pJ from 0 to %.0f", where,
                         number, name, value, most_pj);
    return HOST_OK;
}

/* Changes what the text names and nothing else. */
static host_status parse_over(const char *text, const char *where, energy_table *table, host_error *error)
{
    bool seen[ENERGY_TERMS] = {false};
    host_status status = HOST_OK;
    for (int number = 1; status == HOST_OK && *text; number++) {
        size_t n = strcspn(text, "\n");
        char *line = strndup(text, n);
        if (!line)
            return host_fail(error, HOST_ENVIRONMENT, "no memory to read '%s'", where);
        text += n + (text[n] == '\n');
        char *content = trim(line);
        if (*content && *content != '#')
            status = parse_line(content, where, number, seen, table, error);
        free(line);
    }
    return status;
}

host_status energy_parse(const char *text, const char *where, energy_table *table, host_error *error)
{
    *table = (energy_table){{0}};
    host_status status = parse_over(hw_energy_text, "hw/energy.txt", table, error);
    return status == HOST_OK ? parse_over(text, where, table, error) : status;
}

host_status energy_open(const char *path, energy_table *table, host_error *error)
{
    if (!path)
        return energy_parse("", "hw/energy.txt", table, error);
    char *text;
    host_status status = text_read(path, "table of energies", &text, error);
    if (status != HOST_OK)
        return status;
    status = energy_parse(text, path, table, error);
    free(text);
    return status;
}

json_t *energy_json(const energy_table *table)
{
    json_t *object = json_object();
    int failed = !object;
    for (int i = 0; i < ENERGY_TERMS; i++)
        failed |= json_object_set_new(object, names[i], json_real(table->pj[i]));
    if (!failed)
        return object;
    json_decref(object);
    return NULL;
}
