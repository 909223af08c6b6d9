/* main.c - the vodr command: picks the subcommand, prints the one sentence of a failure, returns the exit code. */
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>

#include "commands.h"
#include "vodr.h"

static const command *const commands[] = {&command_render, &command_reference, &command_report,
                                          &command_sweep,  &command_cluster,   &command_compare,
                                          &command_info,   &command_machine,   &command_vectors};

enum { COMMANDS = sizeof commands / sizeof *commands };

static void print_help(void)
{
    puts("vodr - a bit-exact model of a volume graphics machine\n\n"
         "usage: vodr COMMAND ...\n       vodr COMMAND --help\n       vodr --help | --version\n");
    for (size_t i = 0; i < COMMANDS; i++)
        printf("  %-10s %s\n", commands[i]->name, commands[i]->summary);
    printf(
        "\nExit code: 0 done; 1 a comparison failed; 2 bad usage or bad input; 3 the environment (unwritable output,\n"
        "disk full, no memory, no CUDA device).\n\nExample:\n%s\n",
        command_render.example);
}

static host_status dispatch(int argc, char **argv, host_error *error)
{
    if (argc < 2)
        return host_fail(error, HOST_BAD_INPUT, "a command is needed (see `vodr --help`)");
    const char *name = argv[1];
    bool help = strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0;
    if (help || strcmp(name, "--version") == 0) {
        if (argc > 2)
            return host_fail(error, HOST_BAD_INPUT, "%s does not take a further argument '%s'", name, argv[2]);
        help ? print_help() : (void)puts("vodr " VODR_VERSION);
        return HOST_OK;
    }
    for (size_t i = 0; i < COMMANDS; i++)
        if (strcmp(commands[i]->name, name) == 0)
            return commands[i]->run(argc - 1, argv + 1, error);
    return host_fail(error, HOST_BAD_INPUT, "there is no command '%s' (see `vodr --help`)", name);
}

int main(int argc, char **argv)
{
    host_error error = {""};
#ifdef SIGXFSZ
    signal(SIGXFSZ, SIG_IGN); /* a file-size limit is then a failed write like a full disk */
#endif
    host_status status = dispatch(argc, argv, &error);
    if ((fflush(stdout) != 0 || ferror(stdout)) && status != HOST_BAD_INPUT)
        status = host_fail(&error, HOST_ENVIRONMENT, "cannot write to standard output: %s", strerror(errno));
    if (error.text[0] && status != HOST_OK)
        host_say(&error);
    return (int)status;
}
