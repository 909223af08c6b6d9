/* sweep_values.h - private to sweep plans: which names may vary, and which values they take. */
#ifndef HOST_SWEEP_VALUES_H
#define HOST_SWEEP_VALUES_H

#include "sweep_plan.h"

enum { SWEEP_HEAVIEST = 4 };

/* Fills kind, option and parameter of *n for a name; `where` names the option in sentences. */
host_status sweep_values_name(const char *where, const char *name, sweep_name *n, host_error *error);

/* What parts the values in `text`. */
char sweep_values_separator(const sweep_name *n, const char *text);

/* Whether a value alone is right. A volume is not looked at. */
host_status sweep_values_check(const char *where, const sweep_name *n, const char *value, host_error *error);

/* What another value of this name costs: 0 next to nothing, to SWEEP_HEAVIEST, a volume. */
int sweep_values_weight(const sweep_name *n);

#endif
