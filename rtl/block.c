#include "block.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "modules.h"
#include "pixel_word.h"

enum { RESET_CYCLES = 2 };

/* ---- values ---- */

static int32_t port_bytes(int32_t width_bits)
{
    return width_bits <= 8    ? 1
           : width_bits <= 16 ? 2
           : width_bits <= 32 ? 4
           : width_bits <= 64 ? 8
                              : 4 * ((width_bits + 31) / 32);
}

/* Numbers of 1, 2, 4 or 8 bytes, wherever they lie. These run for every port in every cycle. */
static inline uint64_t load(const void *from, int32_t bytes)
{
    uint8_t one;
    uint16_t two;
    uint32_t four;
    uint64_t eight;
    switch (bytes) {
    case 1: memcpy(&one, from, 1); return one;
    case 2: memcpy(&two, from, 2); return two;
    case 4: memcpy(&four, from, 4); return four;
    default: memcpy(&eight, from, 8); return eight;
    }
}

static inline void store(void *to, int32_t bytes, uint64_t value)
{
    const uint8_t one = (uint8_t)value;
    const uint16_t two = (uint16_t)value;
    const uint32_t four = (uint32_t)value;
    switch (bytes) {
    case 1: memcpy(to, &one, 1); break;
    case 2: memcpy(to, &two, 2); break;
    case 4: memcpy(to, &four, 4); break;
    default: memcpy(to, &value, 8);
    }
}

static void put(void *data, int32_t width_bits, uint64_t value)
{
    if (width_bits < 64)
        value &= ((uint64_t)1 << width_bits) - 1;
    store(data, port_bytes(width_bits), value);
}

static uint64_t get(const void *data, int32_t width_bits)
{
    return load(data, port_bytes(width_bits));
}

/* Whether both sides of a wire are numbers; else bytes are copied, as many as the narrower has. */
static inline bool is_number(const rtl_wire *w)
{
    int32_t bytes = w->field->bytes;
    return w->width_bits <= 64 && (bytes == 1 || bytes == 2 || bytes == 4 || bytes == 8);
}

static size_t common_bytes(const rtl_wire *w)
{
    int32_t bytes = (w->width_bits + 7) / 8;
    return (size_t)(bytes < w->field->bytes ? bytes : w->field->bytes);
}

static void drive(const rtl_wire *w, const void *record)
{
    const char *from = (const char *)record + w->field->offset;
    if (is_number(w))
        put(w->data, w->width_bits, load(from, w->field->bytes));
    else
        memcpy(w->data, from, common_bytes(w));
}

void rtl_wire_sample(const rtl_wire *w, void *record)
{
    char *to = (char *)record + w->field->offset;
    if (is_number(w))
        store(to, w->field->bytes, get(w->data, w->width_bits));
    else
        memcpy(to, w->data, common_bytes(w));
}

/* ---- clock ---- */

static void tick(rtl_block *b)
{
    const vodr_rtl_model *m = &b->library.model;
    for (int half = 0; half < 2; half++) {
        *b->clk = half == 0;
        m->eval(m->state);
        if (b->dumps)
            m->dump(m->state, b->time + (uint64_t)half);
    }
}

/* The memory takes what was just asked for, so that a frame's last beat is written too, and answers for the next cycle.
 */
static void clock_memory(rtl_block *b)
{
    memory_command command = {.read = *b->memory_ports.read,
                              .write = *b->memory_ports.write,
                              .address = (int64_t)get(b->memory_ports.address, b->memory_ports.address_bits),
                              .write_bytes =
                                  (int32_t)get(b->memory_ports.write_bytes, b->memory_ports.write_bytes_bits),
                              .write_data = b->memory_ports.write_data};
    memcpy(b->memory_ports.read_data, external_memory_answer(&b->memory), (size_t)b->memory.beat_bytes);
    external_memory_clock(&b->memory, &command);
}

static void sample_all(rtl_block *b, void *out)
{
    for (int32_t i = 0; i < b->output_count; i++)
        rtl_wire_sample(&b->outputs[i], (char *)out + b->outputs[i].port->record);
}

void rtl_block_tick(rtl_block *b, const void *in)
{
    for (int32_t i = 0; i < b->input_count; i++)
        drive(&b->inputs[i], signal_record(b->inputs[i].port, in, NULL));
    tick(b);
    if (b->memory.storage)
        clock_memory(b);
}

void rtl_block_clock(rtl_block *b, const void *in, void *out)
{
    rtl_block_tick(b, in);
    sample_all(b, out);
}

/* ---- before the first cycle ---- */

static rtl_status set_register(const rtl_block *b, const vodr_rtl_port *p, const rtl_registers *registers,
                               vodr_error *error)
{
    uint64_t value;
    const char *module = signals_of(b->block)->name;
    if (!rtl_register(registers, p->name, &value))
        return rtl_fail(error, RTL_INVALID, "%s: input %s of module %s is neither a port of this block nor a register",
                        b->library.file, p->name, module);
    int64_t signed_value = (int64_t)value;
    uint64_t beyond = p->width_bits < 64 ? value >> p->width_bits : 0;
    bool negative_fits = p->width_bits < 64 && signed_value < 0 && signed_value >> (p->width_bits - 1) == -1;
    if (beyond && !negative_fits)
        return rtl_fail(error, RTL_INVALID,
                        "%s: register %s is %" PRId64 ", which the %" PRId32 " bits of module %s cannot hold",
                        b->library.file, p->name, signed_value, p->width_bits, module);
    put(p->data, p->width_bits, value);
    return RTL_OK;
}

static bool is_one_of(const char *name, const char *const *names)
{
    for (; *names; names++)
        if (strcmp(name, *names) == 0)
            return true;
    return false;
}

static const char *const table_ports[] = {"table_write",   "table_address", "table_data", "empty_write",
                                          "empty_address", "empty_data",    NULL};
static const char *const memory_inputs[] = {"memory_read_data", NULL};

/* Whether the port is a field of the contract, which becomes a wire. */
static bool add_wire(rtl_block *b, const vodr_rtl_port *p)
{
    const block_signals *s = signals_of(b->block);
    for (int32_t i = 0; i < s->count; i++)
        for (int32_t j = 0; j < s->ports[i].count; j++) {
            const signal_field *f = &s->ports[i].fields[j];
            if (strcmp(f->name, p->name) != 0)
                continue;
            rtl_wire *w = p->output ? &b->outputs[b->output_count++] : &b->inputs[b->input_count++];
            *w = (rtl_wire){.port = &s->ports[i], .field = f, .data = p->data, .width_bits = p->width_bits};
            return true;
        }
    return false;
}

static rtl_status connect(rtl_block *b, const rtl_source *source, const rtl_registers *registers, vodr_error *error)
{
    rtl_status status = RTL_OK;
    b->clk = rtl_library_port(&b->library, "clk")->data;
    b->rst = rtl_library_port(&b->library, "rst")->data;
    for (int32_t i = 0; status == RTL_OK && i < b->library.model.port_count; i++) {
        const vodr_rtl_port *p = &b->library.model.ports[i];
        bool other = p->output || p->data == b->clk || p->data == b->rst || is_one_of(p->name, table_ports) ||
                     is_one_of(p->name, memory_inputs);
        if (source->selector && strcmp(p->name, source->selector) == 0)
            put(p->data, p->width_bits, source->selected);
        else if (!add_wire(b, p) && !other)
            status = set_register(b, p, registers, error);
    }
    return status;
}

static rtl_status connect_memory(rtl_block *b, const block_setup *setup, vodr_error *error)
{
    static const struct {
        const char *name;
        bool output;
    } ports[] = {{"memory_read", true},        {"memory_write", true},      {"memory_address", true},
                 {"memory_write_bytes", true}, {"memory_write_data", true}, {"memory_read_data", false}};
    const vodr_rtl_port *p[6];
    for (int i = 0; i < 6; i++) {
        p[i] = rtl_library_port(&b->library, ports[i].name);
        if (!p[i] || p[i]->output != ports[i].output)
            return rtl_fail(error, RTL_INVALID, "%s: module frame_buffer has no %s %s, for the memory behind it",
                            b->library.file, ports[i].output ? "output" : "input", ports[i].name);
        if (i > 3 && p[i]->width_bits != 8 * setup->machine->mem_bus_bytes)
            return rtl_fail(error, RTL_INVALID,
                            "%s: port %s of module frame_buffer has %" PRId32 " bits; it must have %" PRId32,
                            b->library.file, ports[i].name, p[i]->width_bits, 8 * setup->machine->mem_bus_bytes);
    }
    b->memory_ports.read = p[0]->data;
    b->memory_ports.write = p[1]->data;
    b->memory_ports.address = p[2]->data;
    b->memory_ports.address_bits = p[2]->width_bits;
    b->memory_ports.write_bytes = p[3]->data;
    b->memory_ports.write_bytes_bits = p[3]->width_bits;
    b->memory_ports.write_data = p[4]->data;
    b->memory_ports.read_data = p[5]->data;
    if (!external_memory_start(&b->memory, setup->machine, setup->storage))
        return rtl_fail(error, RTL_NO_MEMORY, "no memory for the frame buffer");
    return RTL_OK;
}

static const vodr_rtl_port *table_port(const rtl_block *b, const char *table, const char *what)
{
    char name[32];
    snprintf(name, sizeof name, "%s_%s", table, what);
    return rtl_library_port(&b->library, name);
}

/* Writes the table of a block, where the module has its ports, while it is held in reset. */
static void load_table(rtl_block *b, vodr_block block, const block_setup *setup)
{
    const char *table = rtl_module_of(block)->table;
    const vodr_rtl_port *w = table_port(b, table, "write"), *a = table_port(b, table, "address"),
                        *d = table_port(b, table, "data");
    int64_t entries = w && a && d ? rtl_table_entries(block, setup) : 0;
    for (int64_t i = 0; i < entries; i++) {
        uint8_t entry[RTL_TABLE_BYTES];
        rtl_table_entry(block, setup, i, entry);
        put(w->data, 1, 1);
        put(a->data, a->width_bits, (uint64_t)i);
        put(d->data, d->width_bits < 64 ? d->width_bits : 64, word_load(entry, 8));
        if (d->width_bits > 64)
            ((uint32_t *)d->data)[2] = entry[8];
        tick(b);
        put(w->data, 1, 0);
    }
}

static void reset(rtl_block *b, const block_setup *setup)
{
    *b->rst = 1;
    for (int i = 0; i < RESET_CYCLES; i++)
        tick(b);
    for (int block = 0; block < VODR_BLOCK_COUNT; block++)
        if (rtl_module_of((vodr_block)block)->table && (b->block == RTL_TOP || b->block == (vodr_block)block))
            load_table(b, (vodr_block)block, setup);
    tick(b);
    *b->rst = 0;
}

rtl_status rtl_block_open(rtl_block *b, const rtl_source *source, vodr_block block, const block_setup *setup, void *out,
                          vodr_error *error)
{
    *b = (rtl_block){.block = block, .machine = setup->machine};
    rtl_registers *registers = rtl_registers_of(setup);
    if (!registers)
        return rtl_fail(error, RTL_NO_MEMORY, "no memory for the registers of %s", signals_of(block)->name);
    rtl_status status = rtl_library_open(source, block, registers, &b->library, error);
    if (status == RTL_OK)
        status = connect(b, source, registers, error);
    if (status == RTL_OK && (block == VODR_BLOCK_FRAME_BUFFER || block == RTL_TOP))
        status = connect_memory(b, setup, error);
    free(registers);
    if (status != RTL_OK) {
        rtl_block_close(b);
        return status;
    }
    reset(b, setup);
    sample_all(b, out);
    return RTL_OK;
}

void rtl_block_close(rtl_block *b)
{
    external_memory_finish(&b->memory);
    rtl_library_close(&b->library);
}
