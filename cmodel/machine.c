/* machine.c - the machine as data: named machines, machine files, `--set`, and which combinations can be built.
 * Parameters themselves are described in hw/parameters.txt and nowhere else. */
#include <ctype.h>
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "layout.h"
#include "vodr.h"

const vodr_parameter *vodr_parameters(size_t *count)
{
    *count = VODR_PARAMETER_COUNT;
    return vodr_hw_parameters;
}

static const vodr_parameter *find_parameter(const char *name)
{
    for (size_t i = 0; i < VODR_PARAMETER_COUNT; i++)
        if (strcmp(vodr_hw_parameters[i].name, name) == 0)
            return &vodr_hw_parameters[i];
    return NULL;
}

/* A whole decimal integer, nothing before or after it. */
static bool parse_integer(const char *text, int64_t *value)
{
    char *end;
    if (!isdigit((unsigned char)text[0]))
        return false;
    errno = 0;
    *value = strtoll(text, &end, 10);
    return errno == 0 && *end == '\0';
}

static bool is_power_of_two(int64_t value)
{
    return value > 0 && (value & (value - 1)) == 0;
}

static bool parse_shape(const char *text, int64_t hi, vodr_shape *shape)
{
    char width[16];
    const char *cross = strchr(text, 'x');
    int64_t w, h;
    if (!cross || (size_t)(cross - text) >= sizeof width)
        return false;
    memcpy(width, text, (size_t)(cross - text));
    width[cross - text] = '\0';
    if (!parse_integer(width, &w) || !parse_integer(cross + 1, &h))
        return false;
    if (!is_power_of_two(w) || !is_power_of_two(h) || w > hi || h > hi)
        return false;
    *shape = (vodr_shape){(int32_t)w, (int32_t)h};
    return true;
}

static bool parse_choice(const vodr_parameter *p, const char *text, int64_t *value)
{
    for (int64_t i = 0; p->choices[i]; i++)
        if (strcmp(p->choices[i], text) == 0) {
            *value = p->kind == VODR_KIND_WORDS ? i : strtoll(text, NULL, 10);
            return true;
        }
    return false;
}

static bool parse_value(const vodr_parameter *p, const char *text, vodr_machine *machine)
{
    char *field = (char *)machine + p->offset;
    int64_t value = 0;
    bool ok = false;
    switch (p->kind) {
    case VODR_KIND_SHAPE: return parse_shape(text, p->hi, (vodr_shape *)field);
    case VODR_KIND_WORDS:
    case VODR_KIND_NUMBERS: ok = parse_choice(p, text, &value); break;
    case VODR_KIND_RANGE: ok = parse_integer(text, &value) && value >= p->lo && value <= p->hi; break;
    default: /* VODR_KIND_POW2 */
        ok = parse_integer(text, &value) && value >= p->lo && value <= p->hi && is_power_of_two(value);
        break;
    }
    if (ok)
        *(int32_t *)field = (int32_t)value;
    return ok;
}

vodr_machine vodr_machine_default(void)
{
    vodr_machine machine = {0};
    for (size_t i = 0; i < VODR_PARAMETER_COUNT; i++)
        parse_value(&vodr_hw_parameters[i], vodr_hw_parameters[i].fallback, &machine);
    return machine;
}

static const char *explain_values(const vodr_parameter *p, char *text, size_t size)
{
    switch (p->kind) {
    case VODR_KIND_RANGE: snprintf(text, size, "an integer from %" PRId64 " to %" PRId64, p->lo, p->hi); break;
    case VODR_KIND_POW2: snprintf(text, size, "a power of two from %" PRId64 " to %" PRId64, p->lo, p->hi); break;
    case VODR_KIND_SHAPE: snprintf(text, size, "WIDTHxHEIGHT, powers of two from 1 to %" PRId64, p->hi); break;
    default: snprintf(text, size, "one of %s", p->values);
    }
    return text;
}

vodr_status vodr_machine_set(vodr_machine *machine, const char *name, const char *value, vodr_error *error)
{
    const vodr_parameter *p = find_parameter(name);
    char range[128];
    if (!p)
        return vodr_fail(error, VODR_INVALID, "the machine has no parameter '%.64s' (`vodr machine show` lists them)",
                         name);
    if (!parse_value(p, value, machine))
        return vodr_fail(error, VODR_INVALID, "%s is '%.64s' but must be %s", name, value,
                         explain_values(p, range, sizeof range));
    return VODR_OK;
}

void vodr_machine_get(const vodr_machine *machine, const vodr_parameter *parameter, char *text, size_t size)
{
    const char *field = (const char *)machine + parameter->offset;
    if (parameter->kind == VODR_KIND_SHAPE) {
        const vodr_shape *shape = (const vodr_shape *)field;
        snprintf(text, size, "%" PRId32 "x%" PRId32, shape->width, shape->height);
        return;
    }
    int32_t value = *(const int32_t *)field;
    if (parameter->kind == VODR_KIND_WORDS)
        snprintf(text, size, "%s", parameter->choices[value]);
    else
        snprintf(text, size, "%" PRId32, value);
}

/* Cuts blanks and a comment off a line, in place. */
static char *strip(char *line)
{
    line[strcspn(line, "#")] = '\0';
    while (isspace((unsigned char)*line))
        line++;
    size_t n = strlen(line);
    while (n && isspace((unsigned char)line[n - 1]))
        line[--n] = '\0';
    return line;
}

static vodr_status parse_line(char *line, const char *where, int number, bool *seen, vodr_machine *machine,
                              vodr_error *error)
{
    char *equals = strchr(line, '=');
    if (!equals)
        return vodr_fail(error, VODR_INVALID, "%s:%d: '%.64s' is not of the form name = value", where, number, line);
    *equals = '\0';
    const char *name = strip(line), *value = strip(equals + 1);
    vodr_error reason;
    if (vodr_machine_set(machine, name, value, &reason) != VODR_OK)
        return vodr_fail(error, VODR_INVALID, "%s:%d: %s", where, number, reason.text);
    bool *twice = &seen[find_parameter(name) - vodr_hw_parameters];
    if (*twice)
        return vodr_fail(error, VODR_INVALID, "%s:%d: %s is set a second time", where, number, name);
    *twice = true;
    return VODR_OK;
}

vodr_status vodr_machine_parse(const char *text, const char *where, vodr_machine *machine, vodr_error *error)
{
    vodr_machine parsed = vodr_machine_default();
    bool seen[VODR_PARAMETER_COUNT] = {false};
    char line[256];
    for (int number = 1; *text; number++) {
        size_t n = strcspn(text, "\n");
        if (n >= sizeof line)
            return vodr_fail(error, VODR_INVALID, "%s:%d: the line has %zu characters, at most %zu are read", where,
                             number, n, sizeof line - 1);
        memcpy(line, text, n);
        line[n] = '\0';
        text += n + (text[n] == '\n');
        char *content = strip(line);
        vodr_status status = VODR_OK;
        if (*content)
            status = parse_line(content, where, number, seen, &parsed, error);
        if (status != VODR_OK)
            return status;
    }
    *machine = parsed;
    return VODR_OK;
}

const char *vodr_machine_text(const char *name)
{
    for (size_t i = 0; i < VODR_NAMED_MACHINE_COUNT; i++)
        if (strcmp(vodr_hw_machines[i].name, name) == 0)
            return vodr_hw_machines[i].text;
    return NULL;
}

const char *vodr_machine_name(size_t i)
{
    return i < VODR_NAMED_MACHINE_COUNT ? vodr_hw_machines[i].name : NULL;
}

vodr_status vodr_machine_named(const char *name, vodr_machine *machine, vodr_error *error)
{
    const char *text = vodr_machine_text(name);
    if (text)
        return vodr_machine_parse(text, name, machine, error);
    char names[256] = "";
    for (size_t i = 0; i < VODR_NAMED_MACHINE_COUNT; i++) {
        size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s%s", i ? ", " : "", vodr_hw_machines[i].name);
    }
    return vodr_fail(error, VODR_INVALID, "there is no machine '%.64s'; the named machines are %s", name, names);
}

vodr_status vodr_machine_check(const vodr_machine *m, vodr_error *error)
{
    /* A machine made without vodr_machine_set() may hold anything: every value must survive being said and read. */
    for (size_t i = 0; i < VODR_PARAMETER_COUNT; i++) {
        const vodr_parameter *p = &vodr_hw_parameters[i];
        int64_t value = *(const int32_t *)((const char *)m + p->offset);
        char text[32], range[128];
        vodr_machine copy = *m;
        if (p->kind == VODR_KIND_WORDS && (value < p->lo || value > p->hi))
            return vodr_fail(error, VODR_INVALID, "%s is %" PRId64 " but must be %s", p->name, value,
                             explain_values(p, range, sizeof range));
        vodr_machine_get(m, p, text, sizeof text);
        vodr_status status = vodr_machine_set(&copy, p->name, text, error);
        if (status != VODR_OK)
            return status;
    }
    int64_t set_bytes = (int64_t)m->ways * line_bytes(m);
    if (m->cache_bytes % set_bytes != 0)
        return vodr_fail(error, VODR_INVALID,
                         "cache_bytes=%" PRId32 " is not a multiple of a set: ways=%" PRId32 " lines of %" PRId32
                         " bytes (line_px=%" PRId32 "x%" PRId32 ", fb_bits=%" PRId32 ") are %" PRId64 " bytes",
                         m->cache_bytes, m->ways, line_bytes(m), m->line_px.width, m->line_px.height, m->fb_bits,
                         set_bytes);
    if (m->dram_refresh_cycles && m->dram_trfc_cycles >= m->dram_refresh_cycles)
        return vodr_fail(error, VODR_INVALID,
                         "dram_trfc_cycles=%" PRId32 " must be below dram_refresh_cycles=%" PRId32
                         ": a refresh would last until the next",
                         m->dram_trfc_cycles, m->dram_refresh_cycles);
    return VODR_OK;
}
