/* transfer_builtin.c - the built-in transfer functions' control points.
 *
 * Opacities rise over many densities and from exactly 0: what 8 bits a channel lose grows with the number of nearly
 * transparent samples on a ray and with the steepness of the table. */
#include "transfer_builtin.h"

#include <stdlib.h>
#include <string.h>

/* The windows for CT take in all that a scanner writes, so that no density is clamped before it is interpolated. */
enum { MAX_POINTS = 7, HU_LO = -1024, HU_HI = 3071 };

typedef struct point_list {
    size_t count;
    transfer_point points[MAX_POINTS]; /* value, r, g, b, a */
} point_list;

struct transfer_builtin {
    const char *name;
    point_list normalized;
    point_list ct;       /* Hounsfield units; empty: the normalized points serve CT too */
    double ct_lo, ct_hi; /* equal: no window of its own */
};

/* clang-format off */
static const transfer_builtin builtins[] = {
    {.name = "ramp",
     .normalized = {2, {{0, 1, 1, 1, 0},
                        {1, 1, 1, 1, 0.05}}},
     .ct_lo = -500, .ct_hi = 1500},
    {.name = "bone",
     .normalized = {4, {{0.15, 0.30, 0.16, 0.09, 0},
                        {0.35, 0.62, 0.42, 0.28, 0.06},
                        {0.60, 0.94, 0.84, 0.68, 0.20},
                        {1.00, 1.00, 0.98, 0.92, 0.50}}},
     .ct = {4, {{150, 0.30, 0.16, 0.09, 0},
                {400, 0.62, 0.42, 0.28, 0.06},
                {900, 0.94, 0.84, 0.68, 0.20},
                {1700, 1.00, 0.98, 0.92, 0.50}}},
     .ct_lo = HU_LO, .ct_hi = HU_HI},
    {.name = "skin-bone",
     .normalized = {5, {{0.06, 0.45, 0.22, 0.15, 0},
                        {0.18, 0.88, 0.62, 0.48, 0.06},
                        {0.32, 0.82, 0.62, 0.48, 0.03},
                        {0.60, 0.96, 0.88, 0.74, 0.20},
                        {1.00, 1.00, 1.00, 0.96, 0.50}}},
     .ct = {7, {{-750, 0.70, 0.45, 0.33, 0},
                {-450, 0.90, 0.64, 0.50, 0.16},
                {-200, 0.90, 0.64, 0.50, 0},
                {200, 0.50, 0.30, 0.20, 0},
                {500, 0.75, 0.56, 0.42, 0.10},
                {900, 0.96, 0.88, 0.74, 0.22},
                {1700, 1.00, 1.00, 0.96, 0.50}}},
     .ct_lo = HU_LO, .ct_hi = HU_HI},
    {.name = "vessels",
     .normalized = {4, {{0.08, 0.35, 0.02, 0.02, 0},
                        {0.30, 0.75, 0.12, 0.07, 0.12},
                        {0.60, 0.95, 0.45, 0.28, 0.30},
                        {1.00, 1.00, 0.85, 0.70, 0.60}}},
     .ct = {4, {{120, 0.35, 0.02, 0.02, 0},
                {350, 0.75, 0.12, 0.07, 0.06},
                {800, 0.95, 0.45, 0.28, 0.20},
                {1700, 1.00, 0.85, 0.70, 0.50}}},
     .ct_lo = HU_LO, .ct_hi = HU_HI},
    {.name = "mri",
     .normalized = {5, {{0.12, 0.20, 0.12, 0.12, 0},
                        {0.32, 0.55, 0.34, 0.29, 0.05},
                        {0.50, 0.88, 0.72, 0.62, 0.10},
                        {0.75, 0.98, 0.90, 0.80, 0.18},
                        {1.00, 1.00, 1.00, 0.98, 0.30}}}},
};
/* clang-format on */

enum { BUILTINS = sizeof builtins / sizeof *builtins };

const char *const *transfer_names(void)
{
    static const char *const names[] = {"ramp", "bone", "skin-bone", "vessels", "mri", NULL};
    return names;
}

const transfer_builtin *transfer_builtin_find(const char *name)
{
    for (size_t i = 0; i < BUILTINS; i++)
        if (strcmp(builtins[i].name, name) == 0)
            return &builtins[i];
    return NULL;
}

host_status transfer_builtin_open(const transfer_builtin *b, bool ct, transfer *t, host_error *error)
{
    const point_list *list = ct && b->ct.count ? &b->ct : &b->normalized;
    *t = (transfer){.name = b->name,
                    .normalized = list == &b->normalized,
                    .builtin = true,
                    .has_ct_window = b->ct_lo < b->ct_hi,
                    .ct_lo = b->ct_lo,
                    .ct_hi = b->ct_hi,
                    .count = list->count};
    t->points = malloc(list->count * sizeof *t->points);
    if (!t->points)
        return host_fail(error, HOST_ENVIRONMENT, "no memory for the transfer function %s", b->name);
    memcpy(t->points, list->points, list->count * sizeof *t->points);
    return HOST_OK;
}
