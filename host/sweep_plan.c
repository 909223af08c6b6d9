/* sweep_plan.c - the points of a sweep: axes put together. */
#include "sweep_plan.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "sweep_values.h"
#include "text.h"

static host_status no_memory(host_error *error)
{
    return host_fail(error, HOST_ENVIRONMENT, "no memory for the sweep's points");
}

/* A new axis at the end, without names or values yet. */
static host_status add_axis(sweep_plan *p, sweep_axis **axis, host_error *error)
{
    if (p->axis_count == SWEEP_AXES)
        return host_fail(error, HOST_BAD_INPUT, "--over is given more than %d times", SWEEP_AXES);
    *axis = &p->axes[p->axis_count++];
    **axis = (sweep_axis){0};
    return HOST_OK;
}

/* A name of the last axis; `where` names the option in sentences. */
static host_status add_name(sweep_plan *p, const char *where, const char *name, host_error *error)
{
    if (p->name_count == SWEEP_AXES)
        return host_fail(error, HOST_BAD_INPUT, "%s: there are more than %d names", where, SWEEP_AXES);
    if (sweep_plan_find(p, name) < p->name_count)
        return host_fail(error, HOST_BAD_INPUT, "%s: '%.64s' is an axis already", where, name);
    sweep_name *n = &p->names[p->name_count];
    *n = (sweep_name){.axis = p->axis_count - 1, .column = p->axes[p->axis_count - 1].names};
    host_status status = sweep_values_name(where, name, n, error);
    if (status != HOST_OK)
        return status;
    n->name = strdup(name);
    if (!n->name)
        return no_memory(error);
    p->name_count++;
    p->axes[n->axis].names++;
    return HOST_OK;
}

/* The next value of the last axis, checked; `size` of its characters. */
static host_status add_value(sweep_plan *p, const char *where, const char *text, size_t size, host_error *error)
{
    sweep_axis *a = &p->axes[p->axis_count - 1];
    const size_t filled = a->cells;
    if ((filled & (filled - 1)) == 0) {
        char **grown = realloc(a->values, (filled ? 2 * filled : 1) * sizeof *grown);
        if (!grown)
            return no_memory(error);
        a->values = grown;
    }
    a->values[filled] = strndup(text, size);
    if (!a->values[filled])
        return no_memory(error);
    a->count = ++a->cells / a->names;
    const sweep_name *n = &p->names[p->name_count - a->names + filled % a->names];
    return sweep_values_check(where, n, a->values[filled], error);
}

static host_status refuse_twice(const sweep_name *n, const sweep_axis *a, host_error *error)
{
    const char *last = a->values[a->count - 1];
    for (size_t i = 0; i + 1 < a->count; i++)
        if (strcmp(a->values[i], last) == 0)
            return host_fail(error, HOST_BAD_INPUT, "--over %s: the value '%.64s' is there twice", n->name, last);
    return HOST_OK;
}

static host_status add_orbit(sweep_plan *p, const char *text, host_error *error)
{
    char field[32], value[64];
    int64_t views = 0;
    double elevation = 0;
    size_t n = strcspn(text, ":");
    snprintf(field, sizeof field, "%.*s", (int)n, text);
    if (!text_integer(field, 1, 3600, &views) || (text[n] && !text_number(text + n + 1, -90, 90, &elevation)))
        return host_fail(error, HOST_BAD_INPUT,
                         "--over view 'orbit:%.64s': must be orbit:N or orbit:N:EL with N from 1 to 3600 views and EL "
                         "from -90 to 90 degrees",
                         text);
    host_status status = HOST_OK;
    for (int64_t i = 0; status == HOST_OK && i < views; i++) {
        snprintf(value, sizeof value, "%.10g,%.10g", 360.0 * (double)i / (double)views, elevation);
        status = add_value(p, "--over", value, strlen(value), error);
    }
    return status;
}

static host_status add_values(sweep_plan *p, const char *text, host_error *error)
{
    const sweep_name *n = &p->names[p->name_count - 1];
    const char separator = sweep_values_separator(n, text);
    host_status status = HOST_OK;
    for (bool more = true; status == HOST_OK && more;) {
        const char *end = strchr(text, separator);
        size_t size = end ? (size_t)(end - text) : strlen(text);
        more = end != NULL;
        if (size == 0)
            return host_fail(error, HOST_BAD_INPUT, "--over %s: a value is empty", n->name);
        status = add_value(p, "--over", text, size, error);
        if (status == HOST_OK)
            status = refuse_twice(n, &p->axes[n->axis], error);
        text += size + 1;
    }
    return status;
}

host_status sweep_plan_over(sweep_plan *p, const char *text, host_error *error)
{
    static const char orbit[] = "orbit:";
    char name[64];
    size_t n = strcspn(text, "=");
    if (n == 0 || n >= sizeof name || text[n] == '\0')
        return host_fail(error, HOST_BAD_INPUT, "--over '%.64s': must be PARAM=V1,V2,...", text);
    snprintf(name, sizeof name, "%.*s", (int)n, text);
    text += n + 1;
    sweep_axis *axis = NULL;
    host_status status = add_axis(p, &axis, error);
    if (status == HOST_OK)
        status = add_name(p, "--over", name, error);
    if (status != HOST_OK)
        return status;
    if (strcmp(name, "view") == 0 && strncmp(text, orbit, strlen(orbit)) == 0)
        return add_orbit(p, text + strlen(orbit), error);
    return add_values(p, text, error);
}

/* ---- lists ---- */

/* The fields of a list's line: its names where there are none yet, else values. */
static host_status add_line(sweep_plan *p, const char *where, const char *line, size_t size, host_error *error)
{
    static const char blanks[] = " \t\r";
    sweep_axis *a = &p->axes[p->axis_count - 1];
    const bool naming = a->names == 0;
    const char *end = line + size;
    size_t fields = 0;
    host_status status = HOST_OK;
    while (status == HOST_OK && line < end) {
        size_t n = strcspn(line, " \t\r\n");
        if (line + n > end)
            n = (size_t)(end - line);
        if (n && naming) {
            char name[64];
            snprintf(name, sizeof name, "%.*s", (int)n, line);
            status = add_name(p, where, name, error);
        } else if (n && fields < a->names) {
            status = add_value(p, where, line, n, error);
        }
        fields += n > 0;
        line += n ? n : strspn(line, blanks);
    }
    if (status == HOST_OK && fields != a->names)
        return host_fail(error, HOST_BAD_INPUT, "%s: the line has %zu values for %zu names", where, fields, a->names);
    return status;
}

static host_status read_list(sweep_plan *p, const char *path, const char *text, host_error *error)
{
    sweep_axis *axis = NULL;
    host_status status = add_axis(p, &axis, error);
    for (int number = 1; status == HOST_OK && *text; number++) {
        char where[512];
        size_t n = strcspn(text, "\n"), blank = strspn(text, " \t\r");
        snprintf(where, sizeof where, "--list: %.400s:%d", path, number);
        if (blank < n && text[blank] != '#')
            status = add_line(p, where, text, n, error);
        text += n + (text[n] == '\n');
    }
    if (status != HOST_OK)
        return status;
    if (axis->count == 0)
        return host_fail(error, HOST_BAD_INPUT, "--list: '%s' has no line of values after a line of names", path);
    return HOST_OK;
}

host_status sweep_plan_list(sweep_plan *p, const char *path, host_error *error)
{
    char *text;
    host_status status = text_read(path, "list", &text, error);
    if (status != HOST_OK)
        return status;
    status = read_list(p, path, text, error);
    free(text);
    return status;
}

/* ---- the whole ---- */

host_status sweep_plan_volumes(sweep_plan *p, const char *const *paths, size_t count, host_error *error)
{
    sweep_axis *axis = NULL;
    host_status status = add_axis(p, &axis, error);
    if (status == HOST_OK)
        status = add_name(p, "VOLUME", "volume", error);
    for (size_t i = 0; status == HOST_OK && i < count; i++) {
        status = add_value(p, "VOLUME", paths[i], strlen(paths[i]), error);
        if (status == HOST_OK)
            status = refuse_twice(&p->names[p->name_count - 1], axis, error);
    }
    if (status != HOST_OK)
        return status;
    const sweep_axis volumes = *axis;
    memmove(p->axes + 1, p->axes, (p->axis_count - 1) * sizeof *p->axes);
    p->axes[0] = volumes;
    const sweep_name name = p->names[p->name_count - 1];
    memmove(p->names + 1, p->names, (p->name_count - 1) * sizeof *p->names);
    p->names[0] = name;
    for (size_t i = 0; i < p->name_count; i++)
        p->names[i].axis = i ? p->names[i].axis + 1 : 0;
    return HOST_OK;
}

/* Axes by how much changing their value costs, of equals in their own order. */
static void order_axes(sweep_plan *p)
{
    int weight[SWEEP_AXES] = {0};
    for (size_t i = 0; i < p->name_count; i++) {
        int w = sweep_values_weight(&p->names[i]), *of_axis = &weight[p->names[i].axis];
        *of_axis = w > *of_axis ? w : *of_axis;
    }
    size_t count = 0;
    for (int w = SWEEP_HEAVIEST; w >= 0; w--)
        for (size_t a = 0; a < p->axis_count; a++)
            if (weight[a] == w)
                p->slow_first[count++] = a;
}

host_status sweep_plan_close(sweep_plan *p, host_error *error)
{
    p->points = 1;
    for (size_t a = 0; a < p->axis_count; a++) {
        if (p->axes[a].count > SWEEP_MAX_POINTS / p->points)
            return host_fail(error, HOST_BAD_INPUT, "the sweep has more than %llu points",
                             (unsigned long long)SWEEP_MAX_POINTS);
        p->points *= p->axes[a].count;
    }
    order_axes(p);
    return HOST_OK;
}

void sweep_plan_free(sweep_plan *p)
{
    for (size_t a = 0; a < p->axis_count; a++) {
        sweep_axis *axis = &p->axes[a];
        for (size_t i = 0; i < axis->cells; i++)
            free(axis->values[i]);
        free(axis->values);
    }
    for (size_t i = 0; i < p->name_count; i++)
        free(p->names[i].name);
    *p = (sweep_plan){0};
}

size_t sweep_plan_index(const sweep_plan *p, size_t axis, uint64_t point)
{
    for (size_t a = p->axis_count - 1; a > axis; a--)
        point /= p->axes[a].count;
    return (size_t)(point % p->axes[axis].count);
}

const char *sweep_plan_value(const sweep_plan *p, size_t name, uint64_t point)
{
    const sweep_name *n = &p->names[name];
    const sweep_axis *a = &p->axes[n->axis];
    return a->values[sweep_plan_index(p, n->axis, point) * a->names + n->column];
}

size_t sweep_plan_find(const sweep_plan *p, const char *name)
{
    size_t i = 0;
    while (i < p->name_count && strcmp(p->names[i].name, name) != 0)
        i++;
    return i;
}

uint64_t sweep_plan_turn(const sweep_plan *p, uint64_t turn)
{
    size_t index[SWEEP_AXES] = {0};
    uint64_t point = 0;
    for (size_t i = p->axis_count; i-- > 0;) {
        const sweep_axis *a = &p->axes[p->slow_first[i]];
        index[p->slow_first[i]] = (size_t)(turn % a->count);
        turn /= a->count;
    }
    for (size_t a = 0; a < p->axis_count; a++)
        point = point * p->axes[a].count + index[a];
    return point;
}
