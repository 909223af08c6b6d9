/* generate.c - turns the tables of hw/ into a C header, a C source, a Verilog header and a page of the documents.
 *
 *   generate c-header|c-source|verilog|markdown PARAMETERS REGISTERS [MACHINE...] > OUT
 *   generate c-text NAME FILE > OUT    FILE's text as a C string of that name
 *
 * PARAMETERS, REGISTERS: hw/parameters.txt and hw/registers.txt, whose heads describe their lines. MACHINE: the files
 * of hw/machines, taken over as text; a machine is called what its file is called. Exit 2 with one sentence on a bad
 * line. */
#include <ctype.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_ROWS = 64, MAX_FIELDS = 7, MAX_TEXT = 512, MAX_CHOICES = 8, MAX_MACHINES = 32 };

typedef enum kind { RANGE, POW2, NUMBERS, WORDS, SHAPE } kind;

typedef struct parameter {
    char field[MAX_FIELDS][MAX_TEXT];
    kind kind;
    long lo, hi;
    char choice[MAX_CHOICES][32];
    int choices;
} parameter;

typedef struct hardware {
    parameter parameters[MAX_ROWS];
    int parameter_count;
    char registers[MAX_ROWS][4][MAX_TEXT];
    int register_count;
    char *const *machines;
    int machine_count;
} hardware;

enum { NAME, BLOCK, KIND, VALUES, DEFAULT, UNIT, MEANING };

static bool complain(const char *path, int line, const char *what)
{
    fprintf(stderr, "generate: %s:%d: %s\n", path, line, what);
    return false;
}

static char *trim(char *text)
{
    while (isspace((unsigned char)*text))
        text++;
    size_t n = strlen(text);
    while (n && isspace((unsigned char)text[n - 1]))
        text[--n] = '\0';
    return text;
}

/* Splits "a | b | c" into `count` trimmed fields; false when there are more or fewer. */
static bool split(char *line, char (*fields)[MAX_TEXT], int count)
{
    for (int i = 0; i < count; i++) {
        char *bar = i + 1 < count ? strchr(line, '|') : NULL;
        if (!bar && i + 1 < count)
            return false;
        if (bar)
            *bar = '\0';
        snprintf(fields[i], MAX_TEXT, "%s", trim(line));
        line = bar ? bar + 1 : line;
    }
    return strchr(line, '|') == NULL;
}

static bool parse_values(parameter *p)
{
    const char *values = p->field[VALUES];
    if (sscanf(values, "pow2 %ld..%ld", &p->lo, &p->hi) == 2) {
        p->kind = POW2;
    } else if (sscanf(values, "shape %ld", &p->hi) == 1) {
        p->kind = SHAPE;
        p->lo = 1;
    } else if (strstr(values, "..")) {
        p->kind = RANGE;
        if (sscanf(values, "%ld..%ld", &p->lo, &p->hi) != 2)
            return false;
    } else {
        p->kind = isdigit((unsigned char)values[0]) ? NUMBERS : WORDS;
        char copy[MAX_TEXT];
        snprintf(copy, sizeof copy, "%s", values);
        for (char *word = strtok(copy, ","); word; word = strtok(NULL, ",")) {
            if (p->choices == MAX_CHOICES || strlen(word) >= sizeof p->choice[0])
                return false;
            strcpy(p->choice[p->choices++], word);
        }
        if (p->choices == 0)
            return false;
        p->lo = p->kind == NUMBERS ? strtol(p->choice[0], NULL, 10) : 0;
        p->hi = p->kind == NUMBERS ? strtol(p->choice[p->choices - 1], NULL, 10) : p->choices - 1;
    }
    return p->lo <= p->hi;
}

static bool add_row(hardware *hw, bool registers, char *line, const char *path, int number)
{
    int *count = registers ? &hw->register_count : &hw->parameter_count;
    if (*count == MAX_ROWS)
        return complain(path, number, "too many rows");
    if (registers)
        return split(line, hw->registers[(*count)++], 4) || complain(path, number, "a register has 4 fields");
    parameter *p = &hw->parameters[(*count)++];
    if (!split(line, p->field, MAX_FIELDS))
        return complain(path, number, "a parameter has 7 fields");
    if (strcmp(p->field[KIND], "picture") != 0 && strcmp(p->field[KIND], "organisation") != 0)
        return complain(path, number, "the kind is picture or organisation");
    return parse_values(p) || complain(path, number, "cannot read the values");
}

static bool read_rows(hardware *hw, bool registers, const char *path)
{
    FILE *file = fopen(path, "r");
    if (!file)
        return complain(path, 0, "cannot open");
    char line[MAX_TEXT];
    bool ok = true;
    for (int number = 1; ok && fgets(line, sizeof line, file); number++) {
        char *text = trim(line);
        if (*text && *text != '#')
            ok = add_row(hw, registers, text, path, number);
    }
    fclose(file);
    return ok;
}

/* "line_px", "over" -> "LINE_PX_OVER" on stdout. */
static void print_upper(const char *prefix, const char *name)
{
    for (const char *c = prefix; *c; c++)
        putchar(toupper((unsigned char)*c));
    if (*prefix)
        putchar('_');
    for (const char *c = name; *c; c++)
        putchar(*c == '-' ? '_' : toupper((unsigned char)*c));
}

static void c_header(const hardware *hw)
{
    puts("/* Generated from hw/: do not edit. */\n#ifndef VODR_HW_H\n#define VODR_HW_H\n\n"
         "#include <stdbool.h>\n#include <stddef.h>\n#include <stdint.h>\n");
    for (int i = 0; i < hw->parameter_count; i++) {
        const parameter *p = &hw->parameters[i];
        if (p->kind != WORDS)
            continue;
        printf("/* %s: %s */\ntypedef enum vodr_%s {\n", p->field[NAME], p->field[MEANING], p->field[NAME]);
        for (int c = 0; c < p->choices; c++) {
            printf("    VODR_");
            print_upper(p->field[NAME], p->choice[c]);
            puts(",");
        }
        printf("} vodr_%s;\n\n", p->field[NAME]);
    }
    puts("typedef struct vodr_shape {\n    int32_t width, height;\n} vodr_shape;\n\n"
         "/* A machine: one field a parameter. Words hold their enum's value. */\ntypedef struct vodr_machine {");
    for (int i = 0; i < hw->parameter_count; i++) {
        const parameter *p = &hw->parameters[i];
        printf("    %s %s; /* %s, %s: %s */\n", p->kind == SHAPE ? "vodr_shape" : "int32_t", p->field[NAME],
               p->field[VALUES], p->field[UNIT], p->field[MEANING]);
    }
    puts("} vodr_machine;\n\n"
         "typedef enum vodr_kind {\n    VODR_KIND_RANGE,   /* any integer from lo to hi */\n"
         "    VODR_KIND_POW2,    /* a power of two from lo to hi */\n"
         "    VODR_KIND_NUMBERS, /* one of the integers that `choices` spells */\n"
         "    VODR_KIND_WORDS,   /* one of `choices`; the field holds its index */\n"
         "    VODR_KIND_SHAPE,   /* WIDTHxHEIGHT, powers of two from 1 to hi; the field is a vodr_shape */\n"
         "} vodr_kind;\n\n"
         "/* What hw/parameters.txt says of a parameter. */\ntypedef struct vodr_parameter {\n"
         "    const char *name, *block, *values, *unit, *meaning, *fallback; /* fallback: the default, as text */\n"
         "    bool picture; /* changes the frame; else organisation */\n    vodr_kind kind;\n"
         "    int64_t lo, hi;\n    const char *const *choices; /* NULL after the last */\n"
         "    size_t offset; /* of its field in vodr_machine */\n} vodr_parameter;\n\n"
         "/* What hw/registers.txt says of a register. */\ntypedef struct vodr_register {\n"
         "    const char *name, *format, *meaning;\n    uint32_t address; /* bytes */\n    uint32_t words;\n"
         "} vodr_register;\n\n"
         "/* A named machine: its file's text. */\ntypedef struct vodr_named_machine {\n"
         "    const char *name, *text;\n} vodr_named_machine;\n");
    printf("enum { VODR_PARAMETER_COUNT = %d, VODR_REGISTER_COUNT = %d, VODR_NAMED_MACHINE_COUNT = %d };\n\n",
           hw->parameter_count, hw->register_count, hw->machine_count);
    puts("extern const vodr_parameter vodr_hw_parameters[VODR_PARAMETER_COUNT];\n"
         "extern const vodr_register vodr_hw_registers[VODR_REGISTER_COUNT];\n"
         "extern const vodr_named_machine vodr_hw_machines[VODR_NAMED_MACHINE_COUNT];\n\n#endif");
}

static void print_literal(const char *text)
{
    putchar('"');
    for (; *text; text++) {
        if (*text == '\n')
            fputs("\\n\"\n     \"", stdout);
        else if (*text == '"' || *text == '\\')
            printf("\\%c", *text);
        else
            putchar(*text);
    }
    putchar('"');
}

enum { MAX_FILE = 1 << 14 };

static bool read_text(const char *path, char text[MAX_FILE])
{
    FILE *file = fopen(path, "r");
    if (!file)
        return complain(path, 0, "cannot open");
    size_t n = fread(text, 1, MAX_FILE, file);
    fclose(file);
    if (n == MAX_FILE)
        return complain(path, 0, "too long");
    text[n] = '\0';
    return true;
}

static bool c_text(const char *name, const char *path)
{
    char text[MAX_FILE];
    if (!read_text(path, text))
        return false;
    printf("/* Generated from %s: do not edit. */\nextern const char %s[];\nconst char %s[] =\n     ", path, name,
           name);
    print_literal(text);
    puts(";");
    return true;
}

static bool print_machine(const char *path)
{
    char text[MAX_FILE];
    if (!read_text(path, text))
        return false;
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path, *dot = strrchr(name, '.');
    printf("    {\"%.*s\",\n     ", dot ? (int)(dot - name) : (int)strlen(name), name);
    print_literal(text);
    puts("},");
    return true;
}

static bool c_source(const hardware *hw)
{
    static const char *const kinds[] = {"RANGE", "POW2", "NUMBERS", "WORDS", "SHAPE"};
    puts("/* Generated from hw/: do not edit. */\n#include \"vodr_hw.h\"\n");
    for (int i = 0; i < hw->parameter_count; i++) {
        const parameter *p = &hw->parameters[i];
        if (!p->choices)
            continue;
        printf("static const char *const choices_%s[] = {", p->field[NAME]);
        for (int c = 0; c < p->choices; c++)
            printf("\"%s\", ", p->choice[c]);
        puts("NULL};");
    }
    puts("\nconst vodr_parameter vodr_hw_parameters[VODR_PARAMETER_COUNT] = {");
    for (int i = 0; i < hw->parameter_count; i++) {
        const parameter *p = &hw->parameters[i];
        printf("    {\"%s\", \"%s\", \"%s\", \"%s\", ", p->field[NAME], p->field[BLOCK], p->field[VALUES],
               p->field[UNIT]);
        print_literal(p->field[MEANING]);
        printf(", \"%s\", %s, VODR_KIND_%s, %ld, %ld, %s%s, offsetof(vodr_machine, %s)},\n", p->field[DEFAULT],
               strcmp(p->field[KIND], "picture") == 0 ? "true" : "false", kinds[p->kind], p->lo, p->hi,
               p->choices ? "choices_" : "NULL", p->choices ? p->field[NAME] : "", p->field[NAME]);
    }
    puts("};\n\nconst vodr_register vodr_hw_registers[VODR_REGISTER_COUNT] = {");
    for (int i = 0, address = 0; i < hw->register_count; i++) {
        const char(*r)[MAX_TEXT] = hw->registers[i];
        printf("    {\"%s\", \"%s\", ", r[0], r[2]);
        print_literal(r[3]);
        printf(", 0x%02x, %s},\n", address, r[1]);
        address += 4 * atoi(r[1]);
    }
    puts("};\n\nconst vodr_named_machine vodr_hw_machines[VODR_NAMED_MACHINE_COUNT] = {");
    for (int i = 0; i < hw->machine_count; i++)
        if (!print_machine(hw->machines[i]))
            return false;
    puts("};");
    return true;
}

static void verilog(const hardware *hw)
{
    puts("// Generated from hw/: do not edit.\n`ifndef VODR_HW_VH\n`define VODR_HW_VH\n");
    for (int i = 0; i < hw->parameter_count; i++) {
        const parameter *p = &hw->parameters[i];
        printf("// %s: %s (%s, %s)\n", p->field[NAME], p->field[MEANING], p->field[VALUES], p->field[UNIT]);
        for (int c = 0; p->kind == WORDS && c < p->choices; c++) {
            printf("`define VODR_");
            print_upper(p->field[NAME], p->choice[c]);
            printf(" %d\n", c);
        }
        if (p->kind == RANGE || p->kind == POW2 || p->kind == NUMBERS) {
            printf("`define VODR_");
            print_upper("default", p->field[NAME]);
            printf(" %s\n", p->field[DEFAULT]);
        }
    }
    puts("\n// Register addresses, bytes.");
    for (int i = 0, address = 0; i < hw->register_count; i++) {
        printf("`define VODR_");
        print_upper("reg", hw->registers[i][0]);
        printf(" 8'h%02x\n", address);
        address += 4 * atoi(hw->registers[i][1]);
    }
    puts("\n`endif");
}

static void markdown(const hardware *hw)
{
    puts("# Parameters and registers\n\nGenerated from `hw/` by `make docs`.\n\n## Parameters\n\n"
         "A *picture* parameter changes the frame; an *organisation* parameter changes counters and cycles only.\n\n"
         "| parameter | block | kind | values | default | unit | meaning |\n| --- | --- | --- | --- | --- | --- | --- "
         "|");
    for (int i = 0; i < hw->parameter_count; i++) {
        printf("|");
        for (int f = 0; f < MAX_FIELDS; f++)
            printf(f == NAME ? " `%s` |" : " %s |", hw->parameters[i].field[f]);
        puts("");
    }
    puts("\n## Registers\n\nLittle endian, 32-bit words.\n\n| address | register | format | meaning |\n"
         "| --- | --- | --- | --- |");
    for (int i = 0, address = 0; i < hw->register_count; i++) {
        const char(*r)[MAX_TEXT] = hw->registers[i];
        printf("| 0x%02x | `%s` | %s | %s |\n", address, r[0], r[2], r[3]);
        address += 4 * atoi(r[1]);
    }
}

int main(int argc, char **argv)
{
    static hardware hw;
    if (argc < 4) {
        fputs("generate: usage: generate c-header|c-source|verilog|markdown PARAMETERS REGISTERS [MACHINE...]\n"
              "                generate c-text NAME FILE\n",
              stderr);
        return 2;
    }
    if (strcmp(argv[1], "c-text") == 0)
        return c_text(argv[2], argv[3]) && fflush(stdout) == 0 ? 0 : 2;
    hw.machines = argv + 4;
    hw.machine_count = argc - 4;
    if (!read_rows(&hw, false, argv[2]) || !read_rows(&hw, true, argv[3]))
        return 2;
    bool ok = true;
    if (strcmp(argv[1], "c-header") == 0)
        c_header(&hw);
    else if (strcmp(argv[1], "c-source") == 0)
        ok = c_source(&hw);
    else if (strcmp(argv[1], "verilog") == 0)
        verilog(&hw);
    else if (strcmp(argv[1], "markdown") == 0)
        markdown(&hw);
    else
        ok = complain(argv[1], 0, "no such output");
    return ok && fflush(stdout) == 0 ? 0 : 2;
}
