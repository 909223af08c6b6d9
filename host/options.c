/* options.c - command lines: a subcommand's tables of options, parsed and printed as its help. */
#include "options.h"

#include <stdio.h>
#include <string.h>

/* An option met on the command line: where it is in the tables, and how it was written. */
typedef struct match {
    const option *option;
    int table;
    size_t index;
    const char *attached; /* the text after `=`, NULL if there is none */
} match;

typedef struct parser {
    const command *command;
    int argc, next;
    char **argv;
    uint64_t seen[OPTION_TABLES]; /* bit i: option i of the table was given */
} parser;

host_status option_word(const option *o, const char *value, const char *const *words, const char *form, int *index,
                        host_error *error)
{
    for (*index = 0; words[*index]; (*index)++)
        if (strcmp(value, words[*index]) == 0)
            return HOST_OK;
    return option_refuse(o, value, form, error);
}

host_status option_refuse(const option *o, const char *value, const char *form, host_error *error)
{
    return host_fail(error, HOST_BAD_INPUT, "--%s '%s': must be %s", o->name, value, form);
}

static bool is_written_as(const option *o, const char *argument, size_t n)
{
    if (argument[1] != '-')
        return n == 2 && o->letter && argument[1] == o->letter;
    return n == strlen(o->name) + 2 && strncmp(argument + 2, o->name, n - 2) == 0;
}

static bool find_option(const command *c, const char *argument, match *m)
{
    size_t n = strcspn(argument, "=");
    m->attached = argument[n] ? argument + n + 1 : NULL;
    for (m->table = 0; c->tables[m->table]; m->table++) {
        const option_table *table = c->tables[m->table];
        for (m->index = 0; m->index < table->count; m->index++) {
            m->option = &table->options[m->index];
            if (is_written_as(m->option, argument, n))
                return true;
        }
    }
    return false;
}

/* The option at p->next, with its value, stored in its target. */
static host_status parse_option(parser *p, void *const *targets, host_error *error)
{
    const char *argument = p->argv[p->next++];
    match m;
    if (!find_option(p->command, argument, &m))
        return host_fail(error, HOST_BAD_INPUT, "%s has no option '%s' (see `vodr %s --help`)", p->command->name,
                         argument, p->command->name);
    const option *o = m.option;
    uint64_t bit = UINT64_C(1) << m.index;
    if (p->seen[m.table] & bit && !o->repeats)
        return host_fail(error, HOST_BAD_INPUT, "--%s is given more than once", o->name);
    p->seen[m.table] |= bit;
    const char *value = m.attached;
    if (!o->value && value)
        return host_fail(error, HOST_BAD_INPUT, "--%s '%s': it takes no value", o->name, value);
    if (o->value && !value) {
        if (p->next == p->argc)
            return host_fail(error, HOST_BAD_INPUT, "--%s needs a value: %s", o->name, o->value);
        value = p->argv[p->next++];
    }
    return o->set(targets[m.table], o, value, error);
}

/* Lines of the help text after its first begin in the same column. */
static void print_option(const option *o)
{
    enum { COLUMN = 30 };
    char form[64], letter[8] = "    ";
    if (o->letter)
        snprintf(letter, sizeof letter, "-%c, ", o->letter);
    snprintf(form, sizeof form, "  %s--%s %s", letter, o->name, o->value ? o->value : "");
    printf("%-*s", COLUMN, form);
    if (strlen(form) >= COLUMN)
        printf("\n%*s", COLUMN, "");
    for (const char *text = o->help; *text; text++) {
        putchar(*text);
        if (*text == '\n')
            printf("%*s", COLUMN, "");
    }
    putchar('\n');
}

/* Whether a table before number `table` has an option of that name, and so takes it. */
static bool is_taken(const command *c, int table, const char *name)
{
    for (int t = 0; t < table; t++)
        for (size_t i = 0; i < c->tables[t]->count; i++)
            if (strcmp(c->tables[t]->options[i].name, name) == 0)
                return true;
    return false;
}

static void print_help(const command *c)
{
    printf("vodr %s - %s\n\nusage: vodr %s", c->name, c->summary, c->name);
    for (int i = 0; c->operands[i]; i++)
        printf(i < c->required ? " %s" : " [%s]", c->operands[i]);
    puts(c->more ? "... [OPTION]..." : " [OPTION]...");
    for (int t = 0; c->tables[t]; t++) {
        printf("\n%s\n", c->tables[t]->title);
        for (size_t i = 0; i < c->tables[t]->count; i++)
            if (!is_taken(c, t, c->tables[t]->options[i].name))
                print_option(&c->tables[t]->options[i]);
    }
    printf("\nAn option's value follows a space or `=` and may begin with `-`.\n\nExample:\n%s\n", c->example);
}

/* The operand at p->next. */
static host_status parse_operand(parser *p, int *count, const char **operands, host_error *error)
{
    const char *argument = p->argv[p->next++];
    if (!p->command->more && (*count == OPTION_OPERANDS || !p->command->operands[*count]))
        return host_fail(error, HOST_BAD_INPUT, "%s does not take a further operand '%s' (see `vodr %s --help`)",
                         p->command->name, argument, p->command->name);
    operands[(*count)++] = argument;
    return HOST_OK;
}

static host_status parse_all(parser *p, void *const *targets, const char **operands, bool *help, host_error *error)
{
    int count = 0;
    bool options = true;
    while (p->next < p->argc) {
        const char *argument = p->argv[p->next];
        host_status status = HOST_OK;
        if (options && (strcmp(argument, "--help") == 0 || strcmp(argument, "-h") == 0)) {
            *help = true;
            return HOST_OK;
        }
        if (options && strcmp(argument, "--") == 0) {
            options = false;
            p->next++;
        } else if (options && argument[0] == '-' && argument[1]) {
            status = parse_option(p, targets, error);
        } else {
            status = parse_operand(p, &count, operands, error);
        }
        if (status != HOST_OK)
            return status;
    }
    if (count < p->command->required)
        return host_fail(error, HOST_BAD_INPUT, "%s needs %s (see `vodr %s --help`)", p->command->name,
                         p->command->operands[count], p->command->name);
    return HOST_OK;
}

host_status options_parse(const command *c, int argc, char **argv, void *const *targets, const char **operands,
                          bool *help, host_error *error)
{
    parser p = {.command = c, .argc = argc, .next = 1, .argv = argv};
    for (int i = 0; i < OPTION_OPERANDS; i++)
        operands[i] = NULL;
    *help = false;
    host_status status = parse_all(&p, targets, operands, help, error);
    if (*help)
        print_help(c);
    return status;
}

/* ---- a command line as text ---- */

static void put_quoted(FILE *file, const char *word)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,:/@%";
    if (*word && word[strspn(word, plain)] == '\0') {
        fputs(word, file);
        return;
    }
    putc('\'', file);
    for (; *word; word++)
        *word == '\'' ? fputs("'\\''", file) : putc(*word, file);
    putc('\'', file);
}

static bool is_among(const char *name, const char *const *names)
{
    for (; names && *names; names++)
        if (strcmp(name, *names) == 0)
            return true;
    return false;
}

/* How many words from argv[i] on make one option or operand; *left_out: it is one of `without`. */
static int words_at(const command *c, const char *argument, bool options, const char *const *without, bool *left_out)
{
    match m;
    *left_out = false;
    if (!options || argument[0] != '-' || !argument[1] || !find_option(c, argument, &m))
        return 1;
    *left_out = is_among(m.option->name, without);
    return m.option->value && !m.attached ? 2 : 1;
}

host_status options_quote(const command *c, int argc, char **argv, const char *const *without, char **quoted,
                          host_error *error)
{
    size_t size;
    FILE *file = open_memstream(quoted, &size);
    if (!file)
        return host_fail(error, HOST_ENVIRONMENT, "no memory for the command line");
    fprintf(file, "vodr %s", c->name);
    bool options = true, left_out;
    for (int i = 1, words; i < argc; i += words) {
        words = words_at(c, argv[i], options, without, &left_out);
        options = options && strcmp(argv[i], "--") != 0;
        for (int j = i; j < i + words && j < argc && !left_out; j++) {
            putc(' ', file);
            put_quoted(file, argv[j]);
        }
    }
    return fclose(file) == 0 ? HOST_OK : host_fail(error, HOST_ENVIRONMENT, "no memory for the command line");
}
