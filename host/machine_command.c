/* machine_command.c - `vodr machine list | show NAME`: the named machines. */
#include <stdio.h>
#include <string.h>

#include "commands.h"
#include "vodr.h"

/* The first line of a machine's file is a comment that says what it is. */
static void print_names(void)
{
    const char *name;
    for (size_t i = 0; (name = vodr_machine_name(i)) != NULL; i++) {
        const char *text = vodr_machine_text(name);
        const char *comment = text + strspn(text, "# ");
        printf("%-16s %.*s\n", name, *text == '#' ? (int)strcspn(comment, "\n") : 0, comment);
    }
}

/* In the form of a machine file, every parameter with its range and meaning. */
static host_status show(const char *name, host_error *error)
{
    vodr_machine machine;
    vodr_error reason;
    if (vodr_machine_named(name, &machine, &reason) != VODR_OK)
        return host_fail(error, HOST_BAD_INPUT, "%s", reason.text);
    size_t count;
    const vodr_parameter *parameters = vodr_parameters(&count);
    printf("# %s\n", name);
    for (size_t i = 0; i < count; i++) {
        const vodr_parameter *p = &parameters[i];
        char value[64];
        vodr_machine_get(&machine, p, value, sizeof value);
        printf("%-20s = %-8s # %s%s%s; %s\n", p->name, value, p->values, strcmp(p->unit, "-") == 0 ? "" : " ",
               strcmp(p->unit, "-") == 0 ? "" : p->unit, p->meaning);
    }
    return HOST_OK;
}

static host_status run(int argc, char **argv, host_error *error)
{
    const char *operands[OPTION_OPERANDS];
    bool help;
    host_status status = options_parse(&command_machine, argc, argv, NULL, operands, &help, error);
    if (status != HOST_OK || help)
        return status;
    bool list = strcmp(operands[0], "list") == 0;
    if (!list && strcmp(operands[0], "show") != 0)
        return host_fail(error, HOST_BAD_INPUT, "machine '%s': must be list or show", operands[0]);
    if (list && operands[1])
        return host_fail(error, HOST_BAD_INPUT, "machine list does not take a further operand '%s'", operands[1]);
    if (!list && !operands[1])
        return host_fail(error, HOST_BAD_INPUT, "machine show needs the name of a machine (`vodr machine list`)");
    if (list)
        print_names();
    return list ? HOST_OK : show(operands[1], error);
}

const command command_machine = {
    .name = "machine",
    .operands = {"list|show", "NAME"},
    .required = 1,
    .summary = "list the named machines, or show one's parameters as a machine file",
    .example = "  vodr machine list\n"
               "  vodr machine show paper-16 > mine.txt    # edit it, then: vodr render VOLUME --machine mine.txt",
    .tables = {NULL},
    .run = run,
};
