#include "replay.h"

#include <stdlib.h>
#include <string.h>

enum { REGISTERS_CYCLES = 2 }; /* of a read's latency, what the frame buffer's own registers take */

const void *replay_shown(const replay *r)
{
    return (const char *)&r->shown + rtl_top_record(r->what->block);
}

bool replay_start(replay *r, const bench *b, const block_bench *what)
{
    const vodr_machine *m = &b->machine;
    *r = (replay){.b = b, .what = what, .shown = *b->reset, .rules = calloc(1, what->rules_bytes + 1)};
    columns_of(&r->columns, what->block, m);
    if (what->block != VODR_BLOCK_FRAME_BUFFER)
        return r->rules != NULL;
    r->behind.delay = (m->memory == VODR_MEMORY_DRAM ? m->dram_tcas_cycles : m->mem_latency_cycles) - REGISTERS_CYCLES;
    if (r->behind.delay < 1)
        r->behind.delay = 1;
    r->behind.bytes = calloc((size_t)r->behind.delay, sizeof *r->behind.bytes);
    return external_memory_start(&r->behind.memory, m, b->setup.storage) && r->behind.bytes && r->rules;
}

void replay_end(replay *r)
{
    external_memory_finish(&r->behind.memory);
    free(r->behind.bytes);
    free(r->rules);
    *r = (replay){0};
}

/* Memory takes what it is shown before the block is clocked: what C is granted next lies in memory at once. */
static void clock_memory(replay *r)
{
    const beat_port *p = &r->shown.frame_buffer.memory;
    const memory_command command = {
        .read = p->read, .write = p->write, .address = p->address, .write_bytes = p->bytes, .write_data = p->data};
    int32_t *bytes = &r->behind.bytes[r->behind.memory.now % r->behind.delay];
    memcpy(r->behind.answer, external_memory_answer(&r->behind.memory), (size_t)r->columns.machine->mem_bus_bytes);
    r->behind.answer_bytes = *bytes;
    *bytes = p->read ? p->bytes : 0;
    external_memory_clock(&r->behind.memory, &command);
}

const char *replay_before(replay *r, const void *in)
{
    if (r->behind.bytes)
        clock_memory(r);
    return r->what->illegal(r->b, r->rules, in, replay_shown(r));
}

void replay_after(replay *r, const void *out)
{
    memcpy((char *)&r->shown + rtl_top_record(r->what->block), out,
           (size_t)(rtl_top_record(r->what->block + 1) - rtl_top_record(r->what->block)));
}

static char *put_input(const replay *r, const column *c, bool rst, const void *in, char *text)
{
    const uint8_t up = rst;
    if (c == &r->columns.at[COLUMN_RST])
        return column_put(text, &up, 1, 1);
    if (c->port && !rst)
        return column_put_field(text, &r->columns, c, in, NULL);
    if (c->port && c->field->when == SIGNAL_ALWAYS) {
        const uint8_t nothing[8] = {0};
        return column_put(text, nothing, c->width_bits, sizeof nothing);
    }
    if (!c->port && !rst && r->behind.answer_bytes)
        return column_put(text, r->behind.answer, c->width_bits, (size_t)r->behind.answer_bytes);
    *text++ = 'x';
    return text;
}

char *replay_line(const replay *r, bool rst, const void *in, char *line)
{
    for (int32_t i = 0; i < r->columns.inputs; i++) {
        line = put_input(r, &r->columns.at[i], rst, in, line);
        *line++ = ' ';
    }
    *line++ = '|';
    for (int32_t i = r->columns.inputs; i < r->columns.count; i++) {
        *line++ = ' ';
        line = column_put_field(line, &r->columns, &r->columns.at[i], NULL, replay_shown(r));
    }
    return line;
}
