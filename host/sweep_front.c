/* sweep_front.c - the Pareto front. Points are sorted by their first objective, then the next: whatever beats a point
 * comes before it, so each is held against the front so far alone. */
#include "sweep_front.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

host_status sweep_objectives_parse(const char *text, const sweep_columns *c, const sweep_plan *p, sweep_objectives *o,
                                   host_error *error)
{
    *o = (sweep_objectives){.count = 0};
    for (bool more = true; more;) {
        char name[128];
        size_t n = strcspn(text, ",");
        snprintf(name, sizeof name, "%.*s", (int)n, text);
        more = text[n] == ',';
        text += n + more;
        char *how = strchr(name, ':');
        if (how)
            *how++ = '\0';
        size_t column = sweep_columns_find(c, name);
        if (column == c->count)
            return host_fail(
                error, HOST_BAD_INPUT,
                "--objective: there is no column '%.64s' (docs/sweep.md lists them; cycles and stalls come "
                "with --cycles)",
                name);
        if (!sweep_column_is_number(c, p, column))
            return host_fail(error, HOST_BAD_INPUT, "--objective: the values of column '%s' are no numbers", name);
        if (how && strcmp(how, "min") != 0 && strcmp(how, "max") != 0)
            return host_fail(error, HOST_BAD_INPUT, "--objective '%s:%.32s': must be COLUMN, COLUMN:min or COLUMN:max",
                             name, how);
        if (o->count == SWEEP_OBJECTIVES)
            return host_fail(error, HOST_BAD_INPUT, "--objective: there are more than %d columns", SWEEP_OBJECTIVES);
        for (size_t i = 0; i < o->count; i++)
            if (o->column[i] == column)
                return host_fail(error, HOST_BAD_INPUT, "--objective: column '%s' is there twice", name);
        o->column[o->count] = column;
        o->largest[o->count++] = how && strcmp(how, "max") == 0;
    }
    return HOST_OK;
}

/* A point with its values turned so that less is better. */
typedef struct candidate {
    size_t point, count;
    double value[SWEEP_OBJECTIVES];
} candidate;

static int compare(const void *a, const void *b)
{
    const candidate *x = a, *y = b;
    for (size_t k = 0; k < x->count; k++)
        if (x->value[k] != y->value[k])
            return x->value[k] < y->value[k] ? -1 : 1;
    return (x->point > y->point) - (x->point < y->point);
}

/* Given that a comes before b. */
static bool beats(const candidate *a, const candidate *b)
{
    bool better = false;
    for (size_t k = 0; k < a->count; k++) {
        if (a->value[k] > b->value[k])
            return false;
        better |= a->value[k] < b->value[k];
    }
    return better;
}

host_status sweep_front(const double *values, size_t points, const sweep_objectives *o, bool *marks, host_error *error)
{
    candidate *all = malloc((points ? points : 1) * sizeof *all);
    size_t count = 0, front = 0;
    if (!all)
        return host_fail(error, HOST_ENVIRONMENT, "no memory for the front of %zu points", points);
    for (size_t i = 0; i < points; i++) {
        candidate c = {.point = i, .count = o->count};
        bool valid = true;
        for (size_t k = 0; k < o->count; k++) {
            double value = values[i * o->count + k];
            valid = valid && !isnan(value);
            c.value[k] = o->largest[k] ? -value : value;
        }
        marks[i] = false;
        if (valid)
            all[count++] = c;
    }
    qsort(all, count, sizeof *all, compare);
    for (size_t i = 0; i < count; i++) {
        bool beaten = false;
        for (size_t f = 0; f < front && !beaten; f++)
            beaten = beats(&all[f], &all[i]);
        if (!beaten) {
            marks[all[i].point] = true;
            all[front++] = all[i];
        }
    }
    free(all);
    return HOST_OK;
}
