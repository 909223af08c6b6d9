/* sweep_values.c - which names may vary in a sweep, and which values they take: those of the shared options and of the
 * machine's parameters, read by the same functions. */
#include "sweep_values.h"

#include <string.h>

#include "transfer.h"

static const option *find_option(const option_table *table, const char *const *allowed, const char *name)
{
    for (; *allowed; allowed++)
        for (size_t i = 0; strcmp(*allowed, name) == 0 && i < table->count; i++)
            if (strcmp(table->options[i].name, name) == 0)
                return &table->options[i];
    return NULL;
}

static const vodr_parameter *find_parameter(const char *name)
{
    size_t count;
    const vodr_parameter *parameters = vodr_parameters(&count);
    for (size_t i = 0; i < count; i++)
        if (strcmp(parameters[i].name, name) == 0)
            return &parameters[i];
    return NULL;
}

host_status sweep_values_name(const char *where, const char *name, sweep_name *n, host_error *error)
{
    static const char *const of_view[] = {"view", "projection", "zoom", "size", "slices", "tf", "window", NULL};
    static const char *const of_machine[] = {"machine", NULL}, *const of_volume[] = {"crop", NULL};
    n->parameter = find_parameter(name);
    n->option = find_option(&option_view, of_view, name);
    if (!n->option)
        n->option = find_option(&option_machine, of_machine, name);
    n->kind = n->parameter ? SWEEP_PARAMETER : SWEEP_VIEW;
    if (n->parameter || n->option)
        return HOST_OK;
    n->option = find_option(&option_volume, of_volume, name);
    n->kind = n->option ? SWEEP_CROP : SWEEP_VOLUME;
    if (n->option || strcmp(name, "volume") == 0)
        return HOST_OK;
    return host_fail(error, HOST_BAD_INPUT,
                     "%s: '%.64s' cannot vary; what can is volume, view, projection, zoom, size, slices, tf, window, "
                     "crop, machine, and every parameter of the machine (`vodr machine show paper-16`)",
                     where, name);
}

char sweep_values_separator(const sweep_name *n, const char *text)
{
    return strchr(text, ';') || (n->option && strchr(n->option->value, ',')) ? ';' : ',';
}

static host_status check_transfer(const char *value, host_error *error)
{
    transfer t;
    host_status status = transfer_open(value, false, &t, error);
    if (status == HOST_OK)
        transfer_close(&t);
    return status;
}

host_status sweep_values_check(const char *where, const sweep_name *n, const char *value, host_error *error)
{
    view_options scratch = view_options_default();
    vodr_machine machine = vodr_machine_default();
    vodr_error reason;
    switch (n->kind) {
    case SWEEP_VOLUME: return HOST_OK;
    case SWEEP_CROP: return n->option->set(&scratch.volume, n->option, value, error);
    case SWEEP_PARAMETER:
        if (vodr_machine_set(&machine, n->parameter->name, value, &reason) == VODR_OK)
            return HOST_OK;
        return host_fail(error, HOST_BAD_INPUT, "%s: %s", where, reason.text);
    case SWEEP_VIEW: break;
    }
    host_status status = n->option->set(&scratch, n->option, value, error);
    if (status == HOST_OK && strcmp(n->option->name, "tf") == 0)
        return check_transfer(value, error);
    if (status == HOST_OK && strcmp(n->option->name, "machine") == 0)
        return view_options_named_machine(value, &machine, error);
    return status;
}

int sweep_values_weight(const sweep_name *n)
{
    if (n->kind == SWEEP_VOLUME)
        return SWEEP_HEAVIEST;
    if (n->kind == SWEEP_CROP)
        return 3;
    if (n->kind == SWEEP_PARAMETER)
        return strcmp(n->parameter->name, "density_bits") == 0 ? 2 : 0;
    /* A machine may bring its own density_bits; a transfer function its own window for CT. */
    if (strcmp(n->option->name, "window") == 0 || strcmp(n->option->name, "machine") == 0)
        return 2;
    return strcmp(n->option->name, "tf") == 0 ? 1 : 0;
}
