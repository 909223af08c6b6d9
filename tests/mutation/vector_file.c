#include "vector_file.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "rng.h"

enum { MOST_PORTS = 80 };

/* Ports of one kind, and where their values lie in a row of bytes. */
typedef struct row {
    int32_t count;
    struct {
        char name[48];
        int32_t width_bits;
        size_t offset, bytes;
    } ports[MOST_PORTS];
    size_t bytes;
} row;

typedef struct vector_case {
    uint64_t first; /* cycle */
    uint8_t *registers, *entries;
    uint64_t entry_count;
} vector_case;

typedef struct cycle {
    uint64_t line;
    uint8_t *inputs, *expected, *known; /* in one block of memory */
} cycle;

struct vector_file {
    row registers, table, inputs, outputs;
    vector_case *cases;
    cycle *cycles;
    uint64_t case_count, cycle_count;
    bool ended;
};

/* ---- values ---- */

static size_t value_bytes(int32_t width_bits)
{
    size_t bytes = 1;
    while (bytes < 8 && 8 * bytes < (size_t)width_bits)
        bytes *= 2;
    return width_bits > 64 ? 4 * (size_t)((width_bits + 31) / 32) : bytes;
}

/* Reads the ports of a word KIND=NAME:BITS,... */
static void read_ports(const char *word, row *r)
{
    const char *at = strchr(word, '=') + 1;
    for (int taken = 0; r->count < MOST_PORTS; at += taken + (at[taken] == ','), taken = 0) {
        int32_t i = r->count;
        if (sscanf(at, "%47[a-z_0-9]:%" SCNd32 "%n", r->ports[i].name, &r->ports[i].width_bits, &taken) != 2 || !taken)
            return;
        r->ports[i].offset = r->bytes;
        r->ports[i].bytes = value_bytes(r->ports[i].width_bits);
        r->bytes += r->ports[i].bytes;
        r->count++;
    }
}

/* Reads a number's digits; `known`, where wanted, gets ones where they are. False where a digit is none. */
static bool read_digits(const char *text, size_t length, uint8_t *value, uint8_t *known)
{
    for (size_t i = 0; i < length; i++) {
        const char *digits = "0123456789abcdef", d = text[length - 1 - i];
        const char *at = d ? strchr(digits, d) : NULL;
        if (!at && d != 'x')
            return false;
        if (at)
            value[i / 2] = (uint8_t)(value[i / 2] | (at - digits) << i % 2 * 4);
        if (at && known)
            known[i / 2] = (uint8_t)(known[i / 2] | 0xF << i % 2 * 4);
    }
    return length > 0;
}

/* Reads a word for each port; returns where the text goes on, NULL when a word is missing or is no number. */
static const char *read_row(const char *text, const row *r, uint8_t *values, uint8_t *known)
{
    for (int32_t i = 0; text && i < r->count; i++) {
        size_t offset = r->ports[i].offset, length = strcspn(text, " \n");
        bool good = length <= 2 * r->ports[i].bytes &&
                    read_digits(text, length, values + offset, known ? known + offset : NULL);
        text = good ? text + length + (text[length] == ' ') : NULL;
    }
    return text;
}

/* ---- reading ---- */

static bool read_cycle(vector_file *f, const char *line, uint64_t number)
{
    if (f->cycle_count % 1024 == 0) {
        cycle *more = realloc(f->cycles, (f->cycle_count + 1024) * sizeof *more);
        if (!more)
            return false;
        f->cycles = more;
    }
    uint8_t *bytes = calloc(2, f->inputs.bytes + f->outputs.bytes);
    cycle *c = &f->cycles[f->cycle_count];
    if (!bytes)
        return false;
    *c = (cycle){number, bytes, bytes + 2 * f->inputs.bytes, bytes + 2 * f->inputs.bytes + f->outputs.bytes};
    f->cycle_count++;
    uint8_t *driven = bytes + f->inputs.bytes;
    const char *after = read_row(line, &f->inputs, c->inputs, driven);
    /* Noise where nothing is driven. */
    rng random = {number};
    for (int32_t i = 0; i < f->inputs.count; i++)
        for (size_t b = 0; 8 * b < (size_t)f->inputs.ports[i].width_bits; b++) {
            size_t at = f->inputs.ports[i].offset + b, left = (size_t)f->inputs.ports[i].width_bits - 8 * b;
            uint8_t noise = (uint8_t)(rng_next(&random) & ~driven[at] & (left < 8 ? (1u << left) - 1 : 0xFFu));
            c->inputs[at] |= noise;
        }
    return after && strncmp(after, "| ", 2) == 0 && read_row(after + 2, &f->outputs, c->expected, c->known);
}

static bool read_case(vector_file *f)
{
    vector_case *more = realloc(f->cases, (f->case_count + 1) * sizeof *more);
    if (!more)
        return false;
    f->cases = more;
    more[f->case_count++] = (vector_case){.first = f->cycle_count, .registers = calloc(1, f->registers.bytes + 1)};
    return more[f->case_count - 1].registers != NULL;
}

static bool read_table(const vector_file *f, const char *line, vector_case *c)
{
    int taken = 0;
    if (sscanf(line, "table %" SCNu64 "%n", &c->entry_count, &taken) != 1)
        return false;
    c->entries = calloc(c->entry_count + 1, f->table.bytes);
    line += taken + 1;
    for (uint64_t i = 0; c->entries && line && i < c->entry_count; i++)
        line = read_row(line, &f->table, c->entries + i * f->table.bytes, NULL);
    return c->entries && line;
}

static bool read_line(vector_file *f, const char *line, uint64_t number)
{
    uint64_t cycles;
    if (sscanf(line, "end %" SCNu64, &cycles) == 1)
        return f->ended = cycles == f->cycle_count && f->case_count && !f->ended;
    if (strncmp(line, "case ", 5) == 0)
        return read_case(f);
    if (!f->case_count)
        return false;
    if (strncmp(line, "registers ", 10) == 0)
        return read_row(line + 10, &f->registers, f->cases[f->case_count - 1].registers, NULL) != NULL;
    if (strncmp(line, "table ", 6) == 0)
        return read_table(f, line, &f->cases[f->case_count - 1]);
    return (*line != '0' && *line != '1') || read_cycle(f, line, number);
}

static bool read_header(vector_file *f, char *line)
{
    const char *words[] = {"vodr-vectors", "1",          "block=", "level=",  "seed=",   "machine=",
                           "parameters=",  "registers=", "table=", "inputs=", "outputs="};
    row *rows[] = {&f->registers, &f->table, &f->inputs, &f->outputs};
    char *rest = NULL, *word = strtok_r(line, " \n", &rest);
    for (size_t i = 0; i < sizeof words / sizeof *words; i++, word = strtok_r(NULL, " \n", &rest)) {
        if (!word || strncmp(word, words[i], strlen(words[i])) != 0)
            return false;
        if (i >= 7)
            read_ports(word, rows[i - 7]);
    }
    return f->inputs.count > 0 && f->outputs.count > 0 && strcmp(f->inputs.ports[0].name, "rst") == 0;
}

vector_file *vector_file_read(const char *path, vodr_error *error)
{
    FILE *file = fopen(path, "r");
    vector_file *f = calloc(1, sizeof *f);
    char *line = NULL;
    size_t room = 0;
    uint64_t number = 0;
    bool good = file && f;
    while (good && getline(&line, &room, file) > 0) {
        number++;
        good = number == 1 ? read_header(f, line) : read_line(f, line, number);
    }
    good = good && f->ended;
    free(line);
    if (file)
        fclose(file);
    if (good)
        return f;
    vodr_fail(error, VODR_INVALID, "%s, line %" PRIu64 ": no vectors of version 1, or not all of them", path, number);
    vector_file_free(f);
    return NULL;
}

void vector_file_free(vector_file *f)
{
    for (uint64_t i = 0; f && i < f->cycle_count; i++)
        free(f->cycles[i].inputs);
    for (uint64_t i = 0; f && i < f->case_count; i++) {
        free(f->cases[i].registers);
        free(f->cases[i].entries);
    }
    if (f) {
        free(f->cycles);
        free(f->cases);
    }
    free(f);
}

/* ---- replay ---- */

/* Where a model keeps the ports of a row. */
typedef struct bound_row {
    const row *row;
    void *data[MOST_PORTS];
} bound_row;

static bool bind(const row *r, const rtl_library *model, bound_row *b, vodr_error *error)
{
    b->row = r;
    for (int32_t i = 0; i < r->count; i++) {
        const vodr_rtl_port *p = rtl_library_port(model, r->ports[i].name);
        if (!p || p->width_bits != r->ports[i].width_bits) {
            vodr_fail(error, VODR_INVALID, "the module has no port %s of %" PRId32 " bits", r->ports[i].name,
                      r->ports[i].width_bits);
            return false;
        }
        b->data[i] = p->data;
    }
    return true;
}

static void drive(const bound_row *b, const uint8_t *values)
{
    for (int32_t i = 0; i < b->row->count; i++)
        memcpy(b->data[i], values + b->row->ports[i].offset, b->row->ports[i].bytes);
}

static const char *differs(const bound_row *b, const cycle *c)
{
    for (int32_t i = 0; i < b->row->count; i++) {
        const uint8_t *got = b->data[i];
        size_t offset = b->row->ports[i].offset;
        for (size_t j = 0; j < b->row->ports[i].bytes; j++)
            if ((got[j] ^ c->expected[offset + j]) & c->known[offset + j])
                return b->row->ports[i].name;
    }
    return NULL;
}

/* The first of the outputs that say whether the rules of rtl/rules/ hold, if there is one that does not. */
static const char *broken_rule(const rtl_library *model)
{
    for (int32_t i = 0; i < model->model.port_count; i++) {
        const vodr_rtl_port *p = &model->model.ports[i];
        size_t length = strlen(p->name);
        if (p->output && length >= 5 && strcmp(p->name + length - 5, "rules") == 0 && !*(const uint8_t *)p->data)
            return p->name;
    }
    return NULL;
}

static void tick(const rtl_library *model, uint8_t *clk)
{
    for (int level = 1; level >= 0; level--) {
        *clk = (uint8_t)level;
        model->model.eval(model->model.state);
    }
}

/* Ports through which a table is written: NAME_write, NAME_address, NAME_data. */
static bool write_table(const vector_file *f, const vector_case *c, const rtl_library *model, uint8_t *clk,
                        vodr_error *error)
{
    static const char *const endings[] = {"write", "address", "data"};
    const vodr_rtl_port *ports[3];
    for (int i = 0; i < 3; i++) {
        char name[64];
        snprintf(name, sizeof name, "%s_%s", f->table.ports[0].name, endings[i]);
        ports[i] = rtl_library_port(model, name);
        if (!ports[i]) {
            vodr_fail(error, VODR_INVALID, "the module has no port %s", name);
            return false;
        }
    }
    for (uint64_t i = 0; i < c->entry_count; i++) {
        *(uint8_t *)ports[0]->data = 1;
        memcpy(ports[1]->data, &i, value_bytes(ports[1]->width_bits));
        memcpy(ports[2]->data, c->entries + i * f->table.bytes, f->table.bytes);
        tick(model, clk);
    }
    *(uint8_t *)ports[0]->data = 0;
    tick(model, clk);
    return true;
}

bool vector_file_replay(const vector_file *f, const rtl_library *model, bool with_rules, vector_difference *first,
                        vodr_error *error)
{
    bound_row inputs, outputs, registers;
    const vodr_rtl_port *clk = rtl_library_port(model, "clk"), *rst = rtl_library_port(model, "rst");
    *first = (vector_difference){0};
    if (!clk || !rst || !bind(&f->inputs, model, &inputs, error) || !bind(&f->outputs, model, &outputs, error) ||
        !bind(&f->registers, model, &registers, error))
        return false;
    /* The first eval() sees no edge. */
    model->model.eval(model->model.state);
    for (uint64_t i = 0, next = 0; i < f->cycle_count; i++) {
        const cycle *c = &f->cycles[i];
        if (next < f->case_count && f->cases[next].first == i) {
            *(uint8_t *)rst->data = 1;
            drive(&registers, f->cases[next].registers);
            if (f->table.count && !write_table(f, &f->cases[next], model, clk->data, error))
                return false;
            next++;
        }
        drive(&inputs, c->inputs);
        model->model.eval(model->model.state);
        const char *name = with_rules ? broken_rule(model) : NULL;
        tick(model, clk->data);
        name = name ? name : differs(&outputs, c);
        if (name) {
            *first = (vector_difference){c->line, name};
            return true;
        }
    }
    return true;
}
