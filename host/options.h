/* options.h - command lines: a subcommand as tables of options, its parsing and its help. */
#ifndef HOST_OPTIONS_H
#define HOST_OPTIONS_H

#include "host.h"

typedef struct option {
    const char *name;  /* "output" for --output */
    char letter;       /* 'o' for -o as well; 0 = none */
    const char *value; /* how the help writes its value ("WxH"); NULL: it takes none */
    bool repeats;      /* may be given more than once */
    /* Stores the value (NULL where it takes none) in `target`; on failure the sentence names option, value and range.
     */
    host_status (*set)(void *target, const struct option *option, const char *value, host_error *error);
    const char *help; /* one line: what it does, its range, its default */
} option;

/* Options that one `target` takes, under a heading of the help. At most 64. */
typedef struct option_table {
    const char *title;
    const option *options;
    size_t count;
} option_table;

enum { OPTION_TABLES = 7, OPTION_OPERANDS = 2 };

typedef struct command {
    const char *name;
    const char *operands[OPTION_OPERANDS + 1];     /* their names, NULL after the last */
    int required;                                  /* how many of them must be there */
    bool more;                                     /* the last one may be there any number of times */
    const char *summary;                           /* one line */
    const char *example;                           /* whole command lines */
    const option_table *tables[OPTION_TABLES + 1]; /* NULL after the last; of a name in two the first has it */
    /* argv[0] is the subcommand's name. The exit code; an empty sentence says nothing on standard error. */
    host_status (*run)(int argc, char **argv, host_error *error);
} command;

/* Reads a command line into targets[i] by tables[i], and its operands (NULL where not given): OPTION_OPERANDS of them,
 * with `more` room for argc and for OPTION_OPERANDS. An option's value follows `=` or a space and may begin with `-`;
 * `--` ends the options. Sets *help, having printed the help on standard output, when --help or -h stands where an
 * option may. */
host_status options_parse(const command *c, int argc, char **argv, void *const *targets, const char **operands,
                          bool *help, host_error *error);

/* The command line as a shell takes it, words quoted where need be, after options_parse() took it. It leaves out the
 * options named in `without` (NULL after the last; NULL: none), values and all. free() it. */
host_status options_quote(const command *c, int argc, char **argv, const char *const *without, char **quoted,
                          host_error *error);

/* Which of the words, NULL after the last, a value is; refused in `form` where it is none of them. */
host_status option_word(const option *o, const char *value, const char *const *words, const char *form, int *index,
                        host_error *error);

/* Fails with "--size '0x3': must be <form>". */
host_status option_refuse(const option *o, const char *value, const char *form, host_error *error);

#endif
