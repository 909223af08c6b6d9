/* check.c - reads vectors, clocks the block in C with their inputs, and holds their outputs against what it says. */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "bench.h"
#include "case_text.h"
#include "error.h"
#include "header.h"
#include "replay.h"

enum { MOST_LINE = 1 << 20 };

typedef struct checker {
    FILE *file;
    char *line, *expected; /* of MOST_LINE characters; a line of ours */
    uint64_t number, cycles;
    bool too_long;
    vectors_choice choice;
    char *header;
    bench *bench; /* of the case at hand; NULL: none */
    replay replay;
    bool fresh; /* the next cycle is the case's first */
    vodr_error *error;
} checker;

/* ---- lines ---- */

static const char *next_line(void *context)
{
    checker *c = context;
    c->number++;
    if (!fgets(c->line, MOST_LINE, c->file))
        return NULL;
    size_t length = strlen(c->line);
    c->too_long = length == MOST_LINE - 1 && c->line[length - 1] != '\n';
    if (length && c->line[length - 1] == '\n')
        c->line[length - 1] = '\0';
    return c->line;
}

static vectors_status refuse(const checker *c, const char *why)
{
    vodr_fail(c->error, VODR_INVALID, "%s", why);
    return VECTORS_INVALID;
}

/* ---- columns ---- */

/* A word of a line, and where the next begins. */
typedef struct word {
    const char *text;
    size_t length;
} word;

static word next_word(const char **line)
{
    const word w = {*line, strcspn(*line, " ")};
    *line += w.length;
    *line += **line == ' ';
    return w;
}

static vectors_status refuse_word(const checker *c, const column *col, word w)
{
    if (!w.length)
        vodr_fail(c->error, VODR_INVALID, "the line ends before column %s", col->name);
    else
        vodr_fail(c->error, VODR_INVALID,
                  "column %s is '%.*s', not %" PRId32 " digits of a number of %" PRId32 " bit%s", col->name,
                  (int)(w.length < 40 ? w.length : 40), w.text, col->digits, col->width_bits,
                  col->width_bits == 1 ? "" : "s");
    return VECTORS_INVALID;
}

/* The inputs that a block is shown: a record for each port. */
typedef struct inputs {
    const void *in[COLUMNS_MOST]; /* the block's `in`: pointers to records */
    union {
        write_port write;
        filled_port filled;
        slice_port slice;
        brick_port brick;
        loaded_port loaded;
        voxels_port voxels;
        int64_t whole;
    } records[16];
} inputs;

static void *input_record(inputs *i, const signal_port *p)
{
    return (void *)*(const void **)((char *)i->in + p->record);
}

/* Every port of a block its record. */
static void wire(inputs *i, vodr_block block)
{
    const block_signals *s = signals_of(block);
    memset(i, 0, sizeof *i);
    for (int32_t p = 0; p < s->count; p++)
        if (!s->ports[p].output)
            *(const void **)((char *)i->in + s->ports[p].record) = &i->records[p];
}

/* The texture unit listens to `fresh` alone, which comes with a valid. */
static void show_fresh(const checker *c, inputs *i)
{
    brick_port *brick = &i->records[0].brick;
    if (c->choice.block == VODR_BLOCK_TEXTURE_UNIT)
        brick->valid = brick->fresh;
}

/* Reads the inputs up to the bar. */
static vectors_status read_inputs(const checker *c, const char **line, inputs *i, word words[COLUMNS_MOST])
{
    const columns *cols = &c->replay.columns;
    for (int32_t n = 0; n < cols->inputs; n++) {
        const column *col = &cols->at[n];
        uint8_t value[PORT_BEAT_BYTES];
        words[n] = next_word(line);
        uint8_t *to = col->port ? (uint8_t *)input_record(i, col->port) + col->field->offset : value;
        size_t bytes = col->port ? (size_t)col->field->bytes : sizeof value;
        if (!words[n].length || !column_get(words[n].text, words[n].length, col->width_bits, to, bytes))
            return refuse_word(c, col, words[n]);
    }
    show_fresh(c, i);
    const word bar = next_word(line);
    return bar.length == 1 && *bar.text == '|' ? VECTORS_OK : refuse(c, "a bar must stand between inputs and outputs");
}

/* What means something must be known. */
static vectors_status check_known(const checker *c, inputs *i, const word words[COLUMNS_MOST])
{
    const columns *cols = &c->replay.columns;
    for (int32_t n = 0; n < cols->inputs; n++) {
        const column *col = &cols->at[n];
        const void *record = col->port ? input_record(i, col->port) : NULL;
        if (!col->port || !signal_counts(col->field, record))
            continue;
        int32_t digits = 2 * (int32_t)signal_bytes(col->field, cols->machine, record);
        if (column_known(words[n].text, words[n].length) >= (digits < col->digits ? digits : col->digits))
            continue;
        vodr_fail(c->error, VODR_INVALID, "column %s means something in this cycle, and has unknown digits", col->name);
        return VECTORS_INVALID;
    }
    return VECTORS_OK;
}

/* ---- comparison ---- */

static vectors_status tell(const checker *c, const column *col, word expected, word got)
{
    vodr_fail(c->error, VODR_INVALID, "column %s: expected %.*s, got %.*s", col->name,
              (int)(expected.length < 160 ? expected.length : 160), expected.text,
              (int)(got.length < 160 ? got.length : 160), got.text);
    return VECTORS_DIFFERENT;
}

/* A digit that is expected to mean nothing may be any. */
static bool agree(word expected, word got)
{
    bool nothing = expected.length == 1 && *expected.text == 'x', same = nothing || expected.length == got.length;
    for (size_t i = 0; same && !nothing && i < expected.length; i++) {
        char a = expected.text[i], b = got.text[i];
        same = a == 'x' || a == b || (b >= 'A' && b <= 'F' && a == (b | 0x20));
    }
    return same;
}

/* Columns from `first` on, of the line and of ours. */
static vectors_status compare(const checker *c, const char **line, const char **expected, int32_t first, int32_t end)
{
    for (int32_t n = first; n < end; n++) {
        const column *col = &c->replay.columns.at[n];
        uint8_t value[PORT_LINE_BYTES];
        const word got = next_word(line), must = next_word(expected);
        if (!got.length || !column_get(got.text, got.length, col->width_bits, value, sizeof value))
            return refuse_word(c, col, got);
        if (!agree(must, got))
            return tell(c, col, must, got);
    }
    return VECTORS_OK;
}

/* Of inputs, what memory answers is no choice of whoever wrote them. */
static vectors_status compare_answer(const checker *c, const word words[COLUMNS_MOST], const char *expected)
{
    const columns *cols = &c->replay.columns;
    word must = {expected, 0};
    for (int32_t n = 0; n < cols->inputs; n++) {
        must = next_word(&expected);
        if (n != COLUMN_RST && !cols->at[n].port && !agree(must, words[n]))
            return tell(c, &cols->at[n], must, words[n]);
    }
    return VECTORS_OK;
}

/* ---- a cycle ---- */

static const char *outputs_of(const char *line)
{
    return strchr(line, '|') + 2;
}

static void put_expected(checker *c, bool rst, const void *in)
{
    *replay_line(&c->replay, rst, in, c->expected) = '\0';
}

static vectors_status check_cycle(checker *c)
{
    const columns *cols = &c->replay.columns;
    const char *line = c->line, *why = NULL;
    word words[COLUMNS_MOST];
    inputs i;
    wire(&i, c->choice.block);
    vectors_status status = read_inputs(c, &line, &i, words);
    bool rst = status == VECTORS_OK && *words[COLUMN_RST].text == '1';
    if (status == VECTORS_OK && rst != c->fresh)
        return refuse(c, "rst must be 1 in the first cycle of a case, and in no other");
    if (status == VECTORS_OK && !rst)
        status = check_known(c, &i, words);
    if (status == VECTORS_OK && !rst)
        why = replay_before(&c->replay, i.in);
    if (why)
        return refuse(c, why);
    if (status != VECTORS_OK)
        return status;
    c->fresh = false;
    if (!rst) {
        put_expected(c, false, i.in);
        status = compare_answer(c, words, c->expected);
        block_outs outs = c->replay.shown;
        void *out = (char *)&outs + rtl_top_record(c->choice.block);
        bench_clock(c->bench, c->choice.block, i.in, out);
        replay_after(&c->replay, out);
    }
    if (status != VECTORS_OK)
        return status;
    put_expected(c, rst, i.in);
    const char *expected = outputs_of(c->expected);
    status = compare(c, &line, &expected, cols->inputs, cols->count);
    c->cycles++;
    return status == VECTORS_OK && *line ? refuse(c, "the line goes on after its last column") : status;
}

/* ---- cases ---- */

static void close_case(checker *c)
{
    if (!c->bench)
        return;
    replay_end(&c->replay);
    bench_close(c->bench);
    free(c->bench);
    c->bench = NULL;
}

/* Of all cases the module must be the one that the header has. */
static vectors_status check_header(const checker *c)
{
    char *header = header_text(&c->choice, c->bench);
    if (!header)
        return VECTORS_ENVIRONMENT;
    const char *is = c->header, *must = header;
    while (*is && *is == *must) {
        is++;
        must++;
    }
    bool same = *is == *must;
    while (!same && must > header && must[-1] != ' ' && must[-1] != ',') {
        must--;
        is--;
    }
    if (!same)
        vodr_fail(c->error, VODR_INVALID, "by this case's machine the header must have '%.*s', not '%.*s'",
                  (int)strcspn(must, " ,"), must, (int)strcspn(is, " ,"), is);
    free(header);
    return same ? VECTORS_OK : VECTORS_INVALID;
}

static vectors_status open_case(checker *c)
{
    if (c->bench && c->fresh)
        return refuse(c, "the case before has no cycle");
    close_case(c);
    c->bench = malloc(sizeof *c->bench);
    if (!c->bench)
        return VECTORS_ENVIRONMENT;
    vectors_status status = case_text_get(c->line, next_line, c, &c->choice, c->bench, c->error);
    if (status == VECTORS_OK)
        status = check_header(c);
    if (status == VECTORS_OK && !replay_start(&c->replay, c->bench, bench_of(c->choice.block)))
        status = VECTORS_ENVIRONMENT;
    c->fresh = true;
    return status;
}

static vectors_status check_end(checker *c, const char *line)
{
    uint64_t cycles;
    int taken = 0;
    if (sscanf(line, "end %20" SCNu64 "%n", &cycles, &taken) != 1 || line[taken])
        return refuse(c, "the last line must be 'end NUMBER'");
    if (cycles != c->cycles) {
        vodr_fail(c->error, VODR_INVALID, "it ends after %" PRIu64 " cycles, but says %" PRIu64, c->cycles, cycles);
        return VECTORS_INVALID;
    }
    return next_line(c) ? refuse(c, "something follows the last line") : VECTORS_OK;
}

static vectors_status check_header_line(checker *c, vodr_block block)
{
    const char *line = next_line(c);
    if (!line)
        return refuse(c, "there are no vectors");
    vectors_status status = header_read(line, &c->choice, c->error);
    if (status == VECTORS_OK && c->choice.block != block) {
        vodr_fail(c->error, VODR_INVALID, "these are vectors of %s, not of %s", signals_of(c->choice.block)->name,
                  signals_of(block)->name);
        return VECTORS_INVALID;
    }
    c->header = strdup(line);
    return status == VECTORS_OK && !c->header ? VECTORS_ENVIRONMENT : status;
}

static vectors_status check_lines(checker *c, vodr_block block)
{
    vectors_status status = check_header_line(c, block);
    while (status == VECTORS_OK) {
        const char *line = next_line(c);
        if (!line)
            return refuse(c, "the last line, 'end NUMBER', is missing");
        if (c->too_long)
            return refuse(c, "the line is longer than any of vectors");
        if (strncmp(line, "end", 3) == 0)
            return check_end(c, line);
        bool is_cycle = (*line == '0' || *line == '1') && c->bench;
        status = is_cycle ? check_cycle(c) : open_case(c);
    }
    return status;
}

vectors_status vectors_check(vodr_block block, FILE *file, const char *where, uint64_t *transactions, vodr_error *error)
{
    vodr_error why = {""};
    checker c = {.file = file, .line = malloc(MOST_LINE), .expected = malloc(REPLAY_LINE), .error = &why};
    vectors_status status = c.line && c.expected ? check_lines(&c, block) : VECTORS_ENVIRONMENT;
    if (status == VECTORS_ENVIRONMENT || ferror(file)) {
        status = VECTORS_ENVIRONMENT;
        vodr_fail(error, VODR_NO_MEMORY, ferror(file) ? "%s cannot be read" : "no memory to check %s", where);
    } else if (status != VECTORS_OK) {
        vodr_fail(error, VODR_INVALID, "%s, line %" PRIu64 ": %s", where, c.number, why.text);
    }
    *transactions = c.cycles;
    close_case(&c);
    free(c.header);
    free(c.line);
    free(c.expected);
    return status;
}
