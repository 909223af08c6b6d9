#include "columns.h"

#include <string.h>

static int32_t digits_of(int32_t width_bits)
{
    return (width_bits + 3) / 4;
}

static void add(columns *c, const char *name, int32_t width_bits, const signal_port *port, const signal_field *field)
{
    c->at[c->count++] =
        (column){.name = name, .width_bits = width_bits, .digits = digits_of(width_bits), .port = port, .field = field};
}

static void add_ports(columns *c, const block_signals *s, bool outputs)
{
    for (int32_t i = 0; i < s->count; i++) {
        const signal_port *p = &s->ports[i];
        for (int32_t j = 0; p->output == outputs && j < p->count; j++)
            add(c, p->fields[j].name, signal_width(&p->fields[j], c->machine), p, &p->fields[j]);
    }
}

void columns_of(columns *c, vodr_block block, const vodr_machine *machine)
{
    *c = (columns){.machine = machine};
    add(c, "rst", 1, NULL, NULL);
    add_ports(c, signals_of(block), false);
    if (block == VODR_BLOCK_FRAME_BUFFER)
        add(c, "memory_read_data", 8 * machine->mem_bus_bytes, NULL, NULL);
    c->inputs = c->count;
    add_ports(c, signals_of(block), true);
}

char *column_put(char *text, const uint8_t *value, int32_t width_bits, size_t known)
{
    for (int32_t i = digits_of(width_bits) - 1; i >= 0; i--) {
        int32_t bits = width_bits - 4 * i < 4 ? width_bits - 4 * i : 4;
        *text++ = (size_t)i / 2 < known ? "0123456789abcdef"[value[i / 2] >> i % 2 * 4 & ((1 << bits) - 1)] : 'x';
    }
    return text;
}

char *column_put_field(char *text, const columns *c, const column *col, const void *in, const void *out)
{
    const void *record = signal_record(col->port, in, out);
    if (signal_counts(col->field, record))
        return column_put(text, (const uint8_t *)record + col->field->offset, col->width_bits,
                          signal_bytes(col->field, c->machine, record));
    *text++ = 'x';
    return text;
}

/* 16: unknown; -1: no digit. */
static int digit_of(char d)
{
    if (d >= '0' && d <= '9')
        return d - '0';
    if (d == 'x' || d == 'X' || d == 'z' || d == 'Z')
        return 16;
    d = (char)(d | 0x20);
    return d >= 'a' && d <= 'f' ? d - 'a' + 10 : -1;
}

bool column_get(const char *text, size_t length, int32_t width_bits, uint8_t *value, size_t bytes)
{
    int32_t digits = digits_of(width_bits), top = width_bits % 4;
    memset(value, 0, bytes);
    if (length == 1 && digit_of(*text) == 16)
        return true;
    if (length != (size_t)digits)
        return false;
    for (int32_t i = 0; i < digits; i++) {
        int digit = digit_of(text[digits - 1 - i]);
        if (digit < 0 || (i == digits - 1 && top && digit < 16 && digit >> top))
            return false;
        if (digit < 16 && (size_t)i / 2 < bytes)
            value[i / 2] = (uint8_t)(value[i / 2] | digit << i % 2 * 4);
    }
    return true;
}

int32_t column_known(const char *text, size_t length)
{
    int32_t known = 0;
    while ((size_t)known < length && digit_of(text[length - 1 - (size_t)known]) != 16)
        known++;
    return (size_t)known == length ? COLUMN_DIGITS : known;
}
