/* commands.h - the subcommands of vodr; main.c picks one by its name. */
#ifndef HOST_COMMANDS_H
#define HOST_COMMANDS_H

#include "host.h"
#include "options.h"

extern const command command_render, command_reference, command_compare, command_info, command_machine, command_report,
    command_sweep, command_vectors, command_cluster;

#endif
